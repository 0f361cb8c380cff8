//! Canonical placements and connections of lattice modules: what the search
//! compares. Modules appear by class, never by name, so that layouts that
//! differ only by an interchange of equal modules are the same layout.
//!
//! Knows cells; knows no actions, no statics and no module names.

use std::sync::Arc;

use petgraph::unionfind::UnionFind;

use crate::robot::{Cell, Face, Orientation};

/// The cell next to `cell` in the direction of `face`. Cells of a problem are
/// bounded (see `refusal`), so that this never overflows.
pub fn neighbour(cell: Cell, face: Face) -> Cell {
    let step = face.step();
    std::array::from_fn(|i| cell[i] + step[i])
}

/// A cell moved by so many cells along each axis.
pub fn displaced(cell: Cell, by: Cell) -> Cell {
    std::array::from_fn(|i| cell[i] + by[i])
}

/// A module of some class in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Placed {
    /// Where it is.
    pub cell: Cell,
    /// What makes it distinguishable: an index into the problem's classes.
    pub class: u16,
    /// How it is turned; the identity for a class that all 24 rotations leave alone.
    pub orientation: Orientation,
}

/// Which cells hold modules of which class. Equal layouts are the same
/// placement up to the interchange of modules of one class.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Layout(Arc<[Placed]>);

impl Layout {
    /// A layout of these modules, in any order. Their cells must differ.
    pub fn new(mut placed: Vec<Placed>) -> Self {
        placed.sort_unstable();
        debug_assert!(placed.windows(2).all(|pair| pair[0].cell != pair[1].cell), "two modules in one cell");
        Self(placed.into())
    }

    /// The modules, by ascending cell.
    pub fn placed(&self) -> &[Placed] {
        &self.0
    }

    /// Position in [`Layout::placed`] of the module in `cell`.
    pub fn at(&self, cell: Cell) -> Option<usize> {
        self.0.binary_search_by(|placed| placed.cell.cmp(&cell)).ok()
    }

    /// Whether a module fills `cell`.
    pub fn is_filled(&self, cell: Cell) -> bool {
        self.at(cell).is_some()
    }

    /// The layout with the module in `from` replaced by `moved`.
    #[must_use]
    pub fn with_moved(&self, from: Cell, moved: Placed) -> Self {
        let mut placed = self.0.to_vec();
        let index = self.at(from).expect("a module in the cell that a move starts from");
        placed[index] = moved;
        Self::new(placed)
    }

    /// The layout moved by so many cells along each axis.
    #[must_use]
    pub fn displaced(&self, by: Cell) -> Self {
        Self::new(self.0.iter().map(|p| Placed { cell: displaced(p.cell, by), ..*p }).collect())
    }

    /// Every pair of faces that coincide, in ascending order.
    pub fn touching(&self) -> Vec<Bond> {
        let ahead = [Face::PosX, Face::PosY, Face::PosZ];
        let pairs = self.0.iter().flat_map(|placed| ahead.map(|face| (placed.cell, face)));
        pairs.filter(|&(cell, face)| self.is_filled(neighbour(cell, face))).map(|(c, f)| Bond::new(c, f)).collect()
    }

    /// Whether these connections make one component of all modules.
    pub fn is_connected_by(&self, bonds: impl IntoIterator<Item = [Cell; 2]>) -> bool {
        let mut components = UnionFind::<usize>::new(self.0.len());
        let joined = bonds.into_iter().filter(|&[a, b]| match (self.at(a), self.at(b)) {
            (Some(a), Some(b)) => components.union(a, b),
            _ => false,
        });
        joined.count() + 1 >= self.0.len()
    }
}

/// Two coinciding faces, by where they are: the face of `cell` whose normal is
/// the positive direction of `axis`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bond {
    cell: Cell,
    axis: u8,
}

impl Bond {
    /// The face between `cell` and its neighbour in the direction `face`.
    pub fn new(cell: Cell, face: Face) -> Self {
        match face {
            Face::NegX | Face::NegY | Face::NegZ => Self::new(neighbour(cell, face), face.opposite()),
            Face::PosX => Self { cell, axis: 0 },
            Face::PosY => Self { cell, axis: 1 },
            Face::PosZ => Self { cell, axis: 2 },
        }
    }

    /// World direction from the first to the second of its [`Bond::cells`].
    pub fn face(self) -> Face {
        [Face::PosX, Face::PosY, Face::PosZ][usize::from(self.axis)]
    }

    /// The two cells that it lies between.
    pub fn cells(self) -> [Cell; 2] {
        [self.cell, neighbour(self.cell, self.face())]
    }

    /// The bond moved by so many cells along each axis.
    #[must_use]
    pub fn displaced(self, by: Cell) -> Self {
        Self { cell: displaced(self.cell, by), ..self }
    }

    /// Whether it is a face of `cell`.
    pub fn touches(self, cell: Cell) -> bool {
        self.cells().contains(&cell)
    }
}
