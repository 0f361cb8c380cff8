//! Which module fills which cell, and which faces touch.

use super::configuration::{FaceConnection, Module, Port};
use super::lattice::{Cell, Face, Placement, neighbour};

/// The occupied cells of a robot, sorted. A cell that several modules claim
/// belongs to the one with the smallest index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occupancy(Vec<(Cell, usize)>);

impl Occupancy {
    /// These cells with their modules.
    pub fn new(cells: impl IntoIterator<Item = (Cell, usize)>) -> Self {
        let mut cells: Vec<_> = cells.into_iter().collect();
        cells.sort_unstable();
        cells.dedup_by_key(|(cell, _)| *cell);
        Self(cells)
    }

    /// The cells of these placements; module i is at the i-th.
    pub fn of_placements(placements: &[Placement]) -> Self {
        Self::new(placements.iter().enumerate().map(|(i, p)| (p.cell, i)))
    }

    /// The cells of these modules.
    pub fn of_modules(modules: &[Module]) -> Self {
        Self::new(modules.iter().enumerate().map(|(i, m)| (m.placement.cell, i)))
    }

    /// The module in a cell.
    pub fn at(&self, cell: Cell) -> Option<usize> {
        self.0.binary_search_by_key(&cell, |(c, _)| *c).ok().map(|i| self.0[i].1)
    }

    /// The module beyond a face of a cell.
    pub fn beyond(&self, cell: Cell, face: Face) -> Option<usize> {
        self.at(neighbour(cell, face)?)
    }

    /// Occupied cells with their modules, by increasing cell.
    pub fn iter(&self) -> impl Iterator<Item = (Cell, usize)> + '_ {
        self.0.iter().copied()
    }

    /// Every pair of modules whose faces coincide, as (module, world direction
    /// towards the other, other): each pair once, the smaller index first, sorted.
    pub fn touching_pairs(&self) -> Vec<(usize, Face, usize)> {
        let mut pairs = Vec::new();
        for (cell, module) in self.iter() {
            for face in [Face::PosX, Face::PosY, Face::PosZ] {
                match self.beyond(cell, face) {
                    Some(other) if module < other => pairs.push((module, face, other)),
                    Some(other) => pairs.push((other, face.opposite(), module)),
                    None => {}
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }
}

impl Module {
    /// Its face that points in this world direction.
    pub fn face_towards(&self, world: Face) -> Face {
        self.placement.orientation.to_module(world)
    }
}

/// The connection of two touching modules, the second in world direction
/// `towards` from the first.
pub(super) fn connection(modules: &[Module], first: usize, towards: Face, second: usize) -> FaceConnection {
    FaceConnection::new(
        Port { module: first, face: modules[first].face_towards(towards) },
        Port { module: second, face: modules[second].face_towards(towards.opposite()) },
    )
}
