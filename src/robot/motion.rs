//! How one module of a lattice gets from a cell to another: along a straight line, or about one of its
//! edges. What such a way sweeps and where it leads follow from its geometry alone.
//!
//! Knows cells; does not know which modules can take a way, nor what they need for it.

use std::cmp::Ordering;

use super::lattice::{Cell, Face, Orientation};

/// How far a rotation turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Turn {
    /// By 90 degrees, into the cell beside the module.
    Quarter,
    /// By 180 degrees, round the edge of the support.
    Half,
}

impl Turn {
    /// Its angle in degrees.
    pub const fn degrees(self) -> f64 {
        match self {
            Self::Quarter => 90.0,
            Self::Half => 180.0,
        }
    }

    /// The turn by so many degrees.
    pub const fn of_degrees(degrees: u32) -> Option<Self> {
        match degrees {
            90 => Some(Self::Quarter),
            180 => Some(Self::Half),
            _ => None,
        }
    }
}

/// The way of a module that starts in cell `[0, 0, 0]`, in world directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Straight on, held by the faces that it slides along.
    Translation {
        /// Displacement in cells.
        by: Cell,
    },
    /// About an edge that it shares with a neighbour, its support.
    Rotation {
        /// Direction from the module to its support.
        support: Face,
        /// The edge lies between the module's faces in the directions `support` and `towards`,
        /// which are perpendicular; it turns over the edge to this side.
        towards: Face,
        /// How far.
        turn: Turn,
    },
}

/// Cells relative to the start of a rotation, as steps (towards, away from the support), that a unit square
/// enters as its far corner passes an eighth of a turn. With the hinge at the origin, eighth k reaches from
/// 45 k degrees to 45 (k + 1), counted from `towards` to the direction away from the support.
const PASSED: [[[i32; 2]; 2]; 8] = [
    [[1, 0], [2, 0]],
    [[1, 0], [1, 1]],
    [[0, 0], [0, 1]],
    [[0, 0], [-1, 0]],
    [[0, -1], [-1, -1]],
    [[0, -1], [0, -2]],
    [[1, -1], [1, -2]],
    [[1, -1], [2, -1]],
];

impl Motion {
    /// Displacement in cells.
    pub fn by(self) -> Cell {
        match self {
            Self::Translation { by } => by,
            Self::Rotation { towards, turn: Turn::Quarter, .. } => towards.step(),
            Self::Rotation { support, towards, turn: Turn::Half } => sum(support.step(), towards.step()),
        }
    }

    /// How it turns the module, about world axes.
    pub fn rotation(self) -> Orientation {
        match self {
            Self::Translation { .. } => Orientation::IDENTITY,
            Self::Rotation { support, towards, turn } => {
                let quarter = Orientation::quarter_turn(axis_of_turn(support, towards));
                match turn {
                    Turn::Quarter => quarter,
                    Turn::Half => quarter.turned(quarter),
                }
            }
        }
    }

    /// The way back: the same states in reverse order.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Translation { by } => Self::Translation { by: by.map(|c| -c) },
            Self::Rotation { support, towards, turn: Turn::Quarter } => {
                Self::Rotation { support, towards: towards.opposite(), turn: Turn::Quarter }
            }
            Self::Rotation { support, towards, turn: Turn::Half } => {
                Self::Rotation { support: towards.opposite(), towards: support.opposite(), turn: Turn::Half }
            }
        }
    }

    /// The cells, but for the module's own, whose interior the module enters on its way.
    ///
    /// Exact. A translation enters a cell while it overlaps it along all three axes at once. In a
    /// rotation, with the hinge at the origin and the pitch as unit, the module's points stay within 1
    /// of the hinge except near its far corner, which goes round a circle of radius sqrt 2. So the module
    /// bulges over the cell behind the arc in every eighth of a turn that the corner passes, and it
    /// passes the cells diagonally across the hinge's quadrants in single points, which is no collision.
    pub fn swept(self) -> Vec<Cell> {
        match self {
            Self::Translation { by } => around(by).filter(|&cell| cell != [0; 3] && is_met(cell, by)).collect(),
            Self::Rotation { support, towards, turn } => {
                let eighths: &[usize] = match turn {
                    Turn::Quarter => &[2, 1],
                    Turn::Half => &[2, 1, 0, 7],
                };
                let (d, s) = (towards.step(), support.opposite().step());
                let mut cells: Vec<Cell> = Vec::new();
                for [along, away] in eighths.iter().flat_map(|&k| PASSED[k]) {
                    let cell = std::array::from_fn(|i| along * d[i] + away * s[i]);
                    if cell != [0; 3] && !cells.contains(&cell) {
                        cells.push(cell);
                    }
                }
                cells
            }
        }
    }

    /// The directions in which other modules may hold on to faces of the module on its way: across a
    /// translation. None in a rotation, where the hinge alone holds.
    pub fn sides(self) -> impl Iterator<Item = Face> {
        Face::ALL.into_iter().filter(move |side| match self {
            Self::Translation { by } => by[side.axis()] == 0,
            Self::Rotation { .. } => false,
        })
    }

    /// The cells that the module is in wherever it is in fewest, in order, start and end included: between
    /// two of these moments it is in the cells of both.
    ///
    /// For a translation these are the moments at which a coordinate is whole, for a rotation its ends.
    pub fn stations(self) -> Vec<Vec<Cell>> {
        let Self::Translation { by } = self else { return vec![vec![[0; 3]], vec![self.by()]] };
        let lengths = by.map(i32::unsigned_abs).into_iter().filter(|&length| length > 0);
        let mut moments: Vec<(i64, i64)> =
            lengths.flat_map(|d| (0..=d).map(move |n| (i64::from(n), i64::from(d)))).collect();
        moments.sort_unstable_by(|a, b| (a.0 * b.1).cmp(&(b.0 * a.1)));
        moments.dedup_by(|a, b| a.0 * b.1 == b.0 * a.1);
        let is_in =
            |cell: Cell, (n, d): (i64, i64)| (0..3).all(|i| (i64::from(cell[i]) * d - n * i64::from(by[i])).abs() < d);
        moments.into_iter().map(|moment| around(by).filter(|&cell| is_in(cell, moment)).collect()).collect()
    }

    /// The least number of equal parts whose ends are at all [stations](Self::stations).
    pub fn stages(self) -> u32 {
        let Self::Translation { by } = self else { return 1 };
        let lengths = by.map(i32::unsigned_abs).into_iter().filter(|&length| length > 0);
        // The least common multiple of the lengths.
        lengths.fold(1, |stages, length| (1..=length).map(|k| k * stages).find(|m| m % length == 0).unwrap_or(stages))
    }

    /// Where the module docks on its arrival after a rotation: the direction of the neighbour that then
    /// shares the edge with it. None for a translation.
    pub fn landing(self) -> Option<Face> {
        match self {
            Self::Translation { .. } => None,
            Self::Rotation { support, turn: Turn::Quarter, .. } => Some(support),
            Self::Rotation { towards, turn: Turn::Half, .. } => Some(towards.opposite()),
        }
    }

    /// For a fixed order: translations before rotations, short before long.
    fn rank(self) -> (u8, u32, [i32; 4]) {
        match self {
            Self::Translation { by } => {
                let length = by.map(i32::unsigned_abs).into_iter().fold(0, u32::saturating_add);
                let axis = by.iter().position(|&c| c != 0).map_or(0, |axis| axis as i32);
                (0, length, [axis, by[0], by[1], by[2]])
            }
            Self::Rotation { support, towards, turn } => (1, 0, [support as i32, towards as i32, turn as i32, 0]),
        }
    }
}

impl Ord for Motion {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank().cmp(&other.rank())
    }
}

impl PartialOrd for Motion {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Axis of a rotation, as the direction that it turns right-handed about: it carries the direction away from
/// the support to `towards`.
///
/// # Panics
/// If the two directions are not perpendicular.
pub fn axis_of_turn(support: Face, towards: Face) -> Face {
    let (s, d) = (support.opposite().step(), towards.step());
    let cross = std::array::from_fn(|i| s[(i + 1) % 3] * d[(i + 2) % 3] - s[(i + 2) % 3] * d[(i + 1) % 3]);
    Face::from_step(cross).expect("a rotation is about an edge")
}

/// The cells of the smallest box that holds both ends of a translation, in ascending order.
fn around(by: Cell) -> impl Iterator<Item = Cell> {
    let [xs, ys, zs] = by.map(|c| c.min(0)..=c.max(0));
    xs.flat_map(move |x| {
        let zs = zs.clone();
        ys.clone().flat_map(move |y| zs.clone().map(move |z| [x, y, z]))
    })
}

/// Whether a cube that moves from cell 0 straight on by `by` is within a cell at some moment. Along
/// an axis it is while `cell - 1 < t by < cell + 1`; the three intervals must have more than an end in common.
fn is_met(cell: Cell, by: Cell) -> bool {
    // Fractions (numerator, denominator > 0).
    let less = |a: (i64, i64), b: (i64, i64)| a.0 * b.1 < b.0 * a.1;
    let (mut from, mut until) = ((0, 1), (1, 1));
    for (cell, by) in cell.into_iter().zip(by).map(|(c, b)| (i64::from(c), i64::from(b))) {
        if by == 0 {
            if cell != 0 {
                return false;
            }
            continue;
        }
        let ends = [(cell - 1) * by.signum(), (cell + 1) * by.signum()].map(|end| (end, by.abs()));
        let [enters, leaves] = if by > 0 { ends } else { [ends[1], ends[0]] };
        from = if less(from, enters) { enters } else { from };
        until = if less(leaves, until) { leaves } else { until };
    }
    less(from, until)
}

fn sum(a: Cell, b: Cell) -> Cell {
    std::array::from_fn(|i| a[i] + b[i])
}
