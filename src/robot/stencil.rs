//! What a motion of lattice modules is, as data: stencils of cells that must be filled or empty, and the way
//! that leads from one cell to another.
//!
//! Knows cells; does not know which modules fill them, nor what holds and stands.

use super::lattice::{Cell, Orientation};
use super::motion::Motion;

/// Farthest cell of a stencil along an axis.
pub const FARTHEST_CELL: i32 = 8;

/// One way to make a motion, for a module in cell `[0, 0, 0]`. It stands for all that the 24 rotations of a cube
/// make of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// The way, in the stencil's own directions.
    pub motion: Motion,
    /// Cells that must hold modules: what it slides along, its support, where it lands.
    pub occupied: Vec<Cell>,
    /// Cells that must be empty, beside those that the way [sweeps](Motion::swept), which always must.
    pub free: Vec<Cell>,
    /// Whether its mirror images are ways of the motion too.
    pub mirrored: bool,
}

/// A motion that modules may be capable of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MotionType {
    /// Name that module types and plans use.
    pub name: String,
    /// All ways to make it, at least one.
    pub stencils: Vec<Stencil>,
}

impl Stencil {
    /// The stencil in every orientation, each once and its cells ascending; in a fixed order.
    pub fn variants(&self) -> Vec<Self> {
        let mirrors: &[bool] = if self.mirrored { &[false, true] } else { &[false] };
        let images = mirrors.iter().flat_map(|&mirror| Orientation::all().map(move |turn| self.image(turn, mirror)));
        let mut images: Vec<Self> = images.collect();
        images.sort_unstable_by(|a, b| (a.motion, &a.occupied, &a.free).cmp(&(b.motion, &b.occupied, &b.free)));
        images.dedup();
        images
    }

    /// The stencil turned, and then, where wanted, seen in a mirror: with every cell opposite to where it is.
    fn image(&self, turn: Orientation, mirror: bool) -> Self {
        let sign = if mirror { -1 } else { 1 };
        let cell = |cell: Cell| turn.carry(cell).map(|c| sign * c);
        let face = |face| if mirror { turn.to_world(face).opposite() } else { turn.to_world(face) };
        let motion = match self.motion {
            Motion::Translation { by } => Motion::Translation { by: cell(by) },
            Motion::Rotation { support, towards, turn } => {
                Motion::Rotation { support: face(support), towards: face(towards), turn }
            }
        };
        let cells = |list: &[Cell]| {
            let mut cells: Vec<Cell> = list.iter().copied().map(cell).collect();
            cells.sort_unstable();
            cells.dedup();
            cells
        };
        Self { motion, occupied: cells(&self.occupied), free: cells(&self.free), mirrored: false }
    }

    /// Whether after this way the way `back` leads back, whatever else is filled or empty.
    pub fn leads_back_by(&self, back: &Self) -> bool {
        let by = self.motion.by();
        let here = |cell: &Cell| -> Cell { std::array::from_fn(|i| cell[i] + by[i]) };
        // Afterwards the module's old cell is empty, like all that it swept and needed empty, but for its new cell.
        let swept = self.motion.swept();
        let is_free = |cell: Cell| cell == [0; 3] || cell != by && (swept.contains(&cell) || self.free.contains(&cell));
        back.motion == self.motion.reversed()
            && back.occupied.iter().map(here).all(|cell| self.occupied.contains(&cell))
            && back.free.iter().map(here).all(is_free)
    }
}
