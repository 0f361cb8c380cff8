//! Moves of one cube among cubes, on cells: which exist, what room and which
//! connections they need, and what they leave engaged.
//!
//! Notation, with A the supporting neighbour of the module m: `s` leads from A
//! to m, `d` is the direction of travel, perpendicular to `s`. Knows nothing of
//! obstacles, ground, forces or module names.

use crate::robot::{Cell, Face, Orientation};

use super::layout::{Bond, Layout, Placed, neighbour};

/// How far a pivot turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Turn {
    /// By 90 degrees, onto the face of a coplanar neighbour of the support.
    Quarter,
    /// By 180 degrees, round the convex edge of the support.
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
}

/// How a module moves, in world directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Motion {
    /// By one cell over the faces of two coplanar neighbours.
    Slide {
        /// Direction of travel `d`.
        direction: Face,
    },
    /// About an edge that it shares with the support.
    Pivot {
        /// Direction from the module to its support (`-s`).
        support: Face,
        /// Direction of travel `d`: the edge is the support's edge between
        /// its faces `s` and `d`.
        towards: Face,
        /// How far.
        turn: Turn,
    },
}

/// A motion of the module in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Move {
    /// The cell that the module leaves.
    pub from: Cell,
    /// How it moves.
    pub motion: Motion,
}

/// What a module can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Whether it can slide.
    pub slide: bool,
    /// Whether it can pivot about the edge of a module with a hinge.
    pub pivot: bool,
    /// Whether its own edges have hinges.
    pub hinge: bool,
}

/// The four directions perpendicular to `direction`, in the order of [`Face::ALL`].
pub fn perpendicular(direction: Face) -> impl Iterator<Item = Face> {
    Face::ALL.into_iter().filter(move |&side| side != direction && side != direction.opposite())
}

impl Move {
    /// The cell that the module arrives in.
    pub fn to(self) -> Cell {
        match self.motion {
            Motion::Slide { direction } => neighbour(self.from, direction),
            Motion::Pivot { towards, turn: Turn::Quarter, .. } => neighbour(self.from, towards),
            Motion::Pivot { support, towards, turn: Turn::Half } => neighbour(neighbour(self.from, support), towards),
        }
    }

    /// How the module is turned by it, about world axes.
    pub fn rotation(self) -> Orientation {
        match self.motion {
            Motion::Slide { .. } => Orientation::IDENTITY,
            Motion::Pivot { support, towards, turn } => {
                let quarter = Orientation::quarter_turn(pivot_axis(support, towards));
                match turn {
                    Turn::Quarter => quarter,
                    Turn::Half => quarter.turned(quarter),
                }
            }
        }
    }

    /// The move that leads back: forwards and then backwards is the identity.
    #[must_use]
    pub fn inverse(self) -> Self {
        let motion = match self.motion {
            Motion::Slide { direction } => Motion::Slide { direction: direction.opposite() },
            Motion::Pivot { support, towards, turn: Turn::Quarter } => {
                Motion::Pivot { support, towards: towards.opposite(), turn: Turn::Quarter }
            }
            Motion::Pivot { support, towards, turn: Turn::Half } => {
                Motion::Pivot { support: towards.opposite(), towards: support.opposite(), turn: Turn::Half }
            }
        };
        Self { from: self.to(), motion }
    }

    /// The cells that must be empty: together with the module's own cell they
    /// cover its whole sweep, and the sweep enters the interior of each.
    ///
    /// With the hinge at the origin, `d` and `s` as axes and the pitch as unit,
    /// the module turns from [-1, 0] x [0, 1] clockwise. Its points stay
    /// within 1 of the hinge, except near the corner (-1, 1), which goes round
    /// a circle of radius sqrt 2 from 135 degrees to 45 (quarter) or -45 (half). So it
    /// bulges over the cells behind that arc, and it passes the cell diagonally
    /// across the hinge's quadrant in the single point (1, 1), which is no collision.
    pub fn room(self) -> Vec<Cell> {
        match self.motion {
            Motion::Slide { .. } => vec![self.to()],
            Motion::Pivot { support, towards, turn } => {
                let above = neighbour(self.from, support.opposite());
                let beside = neighbour(self.from, towards);
                let mut room = vec![beside, above, neighbour(above, towards)];
                if turn == Turn::Half {
                    let below = neighbour(beside, support);
                    room.extend([below, neighbour(beside, towards), neighbour(below, towards)]);
                }
                room
            }
        }
    }

    /// The sides of the module (directions perpendicular to a slide) on which
    /// it passes from one module to the next: supports of the slide.
    fn slide_supports(self, layout: &Layout, direction: Face) -> impl Iterator<Item = Face> {
        perpendicular(direction).filter(move |&side| {
            layout.is_filled(neighbour(self.from, side)) && layout.is_filled(neighbour(self.to(), side))
        })
    }

    /// Whether cubes are where the move needs them, and nowhere in its room.
    pub fn fits(self, layout: &Layout) -> bool {
        let supported = match self.motion {
            Motion::Slide { direction } => self.slide_supports(layout, direction).next().is_some(),
            Motion::Pivot { support, towards, turn } => {
                let support = neighbour(self.from, support);
                layout.is_filled(support) && (turn == Turn::Half || layout.is_filled(neighbour(support, towards)))
            }
        };
        supported && self.room().into_iter().all(|cell| !layout.is_filled(cell))
    }

    /// Whether the module may keep the connection `bond` of its own while it moves.
    pub fn may_keep(self, bond: Bond) -> bool {
        match self.motion {
            Motion::Slide { direction } => {
                bond != Bond::new(self.from, direction) && bond != Bond::new(self.from, direction.opposite())
            }
            Motion::Pivot { support, .. } => bond == Bond::new(self.from, support),
        }
    }

    /// Whether the engaged connections `bonds` allow the move: those that it
    /// must have released are, and one that it starts from is engaged.
    pub fn is_allowed_by(self, layout: &Layout, bonds: &[Bond]) -> bool {
        let released = bonds.iter().all(|&bond| !bond.touches(self.from) || self.may_keep(bond));
        let engaged = |side| bonds.binary_search(&Bond::new(self.from, side)).is_ok();
        released
            && match self.motion {
                Motion::Slide { direction } => self.slide_supports(layout, direction).any(engaged),
                Motion::Pivot { support, .. } => engaged(support),
            }
    }

    /// The module's own connections at the beginning of the move, ascending:
    /// those that it slides along, or its support.
    pub fn departure(self, layout: &Layout) -> Vec<Bond> {
        match self.motion {
            Motion::Slide { direction } => beside(layout, self.from, direction),
            Motion::Pivot { support, .. } => vec![Bond::new(self.from, support)],
        }
    }

    /// The module's own connections after the move, ascending. `layout` may be
    /// the one before or after it.
    pub fn landing(self, layout: &Layout) -> Vec<Bond> {
        match self.motion {
            Motion::Slide { direction } => beside(layout, self.to(), direction),
            Motion::Pivot { support, turn: Turn::Quarter, .. } => vec![Bond::new(self.to(), support)],
            Motion::Pivot { towards, turn: Turn::Half, .. } => vec![Bond::new(self.to(), towards.opposite())],
        }
    }

    /// Where a module would hold this one on its way, as the cell and the side
    /// of the moving module that faces it: all along its slide, or the
    /// support of its pivot.
    pub fn sides(self) -> Vec<(Cell, Face)> {
        match self.motion {
            Motion::Slide { direction } => perpendicular(direction)
                .flat_map(|side| [self.from, self.to()].map(|cell| (neighbour(cell, side), side)))
                .collect(),
            Motion::Pivot { support, .. } => vec![(neighbour(self.from, support), support)],
        }
    }

    /// The layout after the move. `turns` says whether the orientation of the
    /// module's class matters.
    #[must_use]
    pub fn applied(self, layout: &Layout, turns: bool) -> Layout {
        let index = layout.at(self.from).expect("a module in the cell that a move starts from");
        let before = layout.placed()[index];
        let orientation = if turns { before.orientation.turned(self.rotation()) } else { before.orientation };
        layout.with_moved(self.from, Placed { cell: self.to(), orientation, ..before })
    }
}

/// The bonds of a cell with the modules beside it, perpendicular to a direction, ascending.
fn beside(layout: &Layout, cell: Cell, direction: Face) -> Vec<Bond> {
    let sides = perpendicular(direction).filter(|&side| layout.is_filled(neighbour(cell, side)));
    let mut bonds: Vec<Bond> = sides.map(|side| Bond::new(cell, side)).collect();
    bonds.sort_unstable();
    bonds
}

/// Axis of a pivot, as the world direction that it turns right-handed about: it carries `s` to `d`.
pub fn pivot_axis(support: Face, towards: Face) -> Face {
    let (s, d) = (support.opposite().step(), towards.step());
    let cross = std::array::from_fn(|i| s[(i + 1) % 3] * d[(i + 2) % 3] - s[(i + 2) % 3] * d[(i + 1) % 3]);
    Face::from_step(cross).expect("a pivot travels perpendicular to its support")
}

/// Every move that fits among the cubes of `layout`, whatever is engaged. In a
/// fixed order: by the moving module's cell, slides before pivots.
pub fn fitting(layout: &Layout, ability: impl Fn(u16) -> Ability) -> Vec<Move> {
    layout.placed().iter().flat_map(|placed| fitting_of(layout, placed, &ability)).collect()
}

/// Every move of one module that fits among the other cubes of `layout`, slides before pivots.
pub fn fitting_of(layout: &Layout, placed: &Placed, ability: impl Fn(u16) -> Ability) -> Vec<Move> {
    let able = ability(placed.class);
    let hinged =
        |support| layout.at(neighbour(placed.cell, support)).map(|at| ability(layout.placed()[at].class).hinge);
    let slides = Face::ALL.into_iter().filter(|_| able.slide).map(|direction| Motion::Slide { direction });
    let supports = Face::ALL.into_iter().filter(|&support| able.pivot && able.hinge && hinged(support) == Some(true));
    let pivots = supports.flat_map(|support| {
        perpendicular(support)
            .flat_map(move |towards| [Turn::Quarter, Turn::Half].map(|turn| Motion::Pivot { support, towards, turn }))
    });
    let motions = slides.chain(pivots).map(|motion| Move { from: placed.cell, motion });
    motions.filter(|candidate| candidate.fits(layout)).collect()
}
