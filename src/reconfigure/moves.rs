//! Moves of one module among others, on cells: where they lead, what room they take, what they release and
//! what they leave engaged. All of it follows from the way of the motion; what else a motion
//! needs is in [`ways`](super::ways).
//!
//! Knows nothing of obstacles, ground, forces or module names.

use crate::robot::{Cell, Face, Motion, Orientation};

use super::layout::{Bond, Layout, Placed, displaced, neighbour};

/// A motion of the module in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Move {
    /// The cell that the module leaves.
    pub from: Cell,
    /// Its way, in world directions.
    pub motion: Motion,
    /// Which motion of the catalogue it is: an index into
    /// [`Catalogue::motions`](crate::robot::Catalogue::motions).
    pub kind: u16,
}

impl Move {
    /// The cell that the module arrives in.
    pub fn to(self) -> Cell {
        displaced(self.from, self.motion.by())
    }

    /// How the module is turned by it, about world axes.
    pub fn rotation(self) -> Orientation {
        self.motion.rotation()
    }

    /// The move that leads back: forwards and then backwards is the identity.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self { from: self.to(), motion: self.motion.reversed(), ..self }
    }

    /// The cells that must be empty: together with the module's own cell they
    /// cover its whole sweep, and the sweep enters the interior of each.
    pub fn room(self) -> Vec<Cell> {
        self.motion.swept().into_iter().map(|cell| displaced(self.from, cell)).collect()
    }

    /// Whether the module may keep the connection `bond` of its own until it moves.
    pub fn may_keep(self, bond: Bond) -> bool {
        match self.motion {
            Motion::Translation { .. } => self.motion.sides().any(|side| bond == Bond::new(self.from, side)),
            Motion::Rotation { support, .. } => bond == Bond::new(self.from, support),
        }
    }

    /// The module's own connections at the beginning of the move, ascending:
    /// those that it slides along, or its support.
    pub fn departure(self, layout: &Layout) -> Vec<Bond> {
        match self.motion {
            Motion::Translation { .. } => self.beside(layout, self.from),
            Motion::Rotation { support, .. } => vec![Bond::new(self.from, support)],
        }
    }

    /// The module's own connections after the move, ascending. `layout` may be
    /// the one before or after it.
    pub fn landing(self, layout: &Layout) -> Vec<Bond> {
        match self.motion.landing() {
            None => self.beside(layout, self.to()),
            Some(side) => vec![Bond::new(self.to(), side)],
        }
    }

    /// What holds the module at the moments of its way at which least does, as the cells of the modules that
    /// do: at both ends, and on a long translation wherever it leaves a cell.
    pub fn holders(self, layout: &Layout) -> Vec<Vec<Cell>> {
        let Motion::Translation { .. } = self.motion else {
            let other = |bond: &Bond, own: Cell| bond.cells().into_iter().find(|&cell| cell != own);
            let ends = [(self.departure(layout), self.from), (self.landing(layout), self.to())];
            return ends.map(|(bonds, own)| bonds.iter().filter_map(|bond| other(bond, own)).collect()).into();
        };
        let beside = |cells: Vec<Cell>| {
            let cells = cells.into_iter().map(|cell| displaced(self.from, cell));
            let beside = cells.flat_map(|cell| self.motion.sides().map(move |side| neighbour(cell, side)));
            beside.filter(|&cell| layout.is_filled(cell)).collect()
        };
        self.motion.stations().into_iter().map(beside).collect()
    }

    /// Where a module would hold this one on its way, as the cell and the side
    /// of the moving module that faces it: all along a translation, or the
    /// support of a rotation.
    pub fn sides(self) -> Vec<(Cell, Face)> {
        if let Motion::Rotation { support, .. } = self.motion {
            return vec![(neighbour(self.from, support), support)];
        }
        let by = self.motion.by();
        let mut cells = self.motion.swept();
        cells.push([0; 3]);
        cells.sort_by_key(|cell| (0..3).map(|i| cell[i] * by[i]).sum::<i32>());
        let cells = |side| cells.iter().map(move |&cell| (neighbour(displaced(self.from, cell), side), side));
        self.motion.sides().flat_map(cells).collect()
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

    /// The bonds of a cell with the modules beside the way, ascending.
    fn beside(self, layout: &Layout, cell: Cell) -> Vec<Bond> {
        let sides = self.motion.sides().filter(|&side| layout.is_filled(neighbour(cell, side)));
        let mut bonds: Vec<Bond> = sides.map(|side| Bond::new(cell, side)).collect();
        bonds.sort_unstable();
        bonds
    }
}
