//! Into how many pieces a robot falls without one of its modules.
//!
//! Knows cells; knows no moves.

use petgraph::unionfind::UnionFind;

use crate::robot::Cell;

use super::layout::{Bond, Layout};

/// The other modules of a layout, by the pieces that they hold together in.
pub struct Pieces {
    /// Numbers of pieces, by position in the layout; that of the module that is left out means nothing.
    of: Vec<usize>,
    count: usize,
}

impl Pieces {
    /// All modules but the one in `without`, held together by those of the connections `bonds` that are not its own.
    pub fn new(layout: &Layout, bonds: &[Bond], without: Cell) -> Self {
        let modules = layout.placed().len();
        let mut components = UnionFind::<usize>::new(modules);
        for bond in bonds.iter().filter(|bond| !bond.touches(without)) {
            if let [Some(a), Some(b)] = bond.cells().map(|cell| layout.at(cell)) {
                components.union(a, b);
            }
        }
        let left_out = layout.at(without);
        let mut number = vec![None; modules];
        let mut count = 0;
        let of = (0..modules).map(|at| {
            if Some(at) == left_out {
                return usize::MAX;
            }
            *number[components.find(at)].get_or_insert_with(|| {
                count += 1;
                count - 1
            })
        });
        Self { of: of.collect(), count }
    }

    /// Whether a module that the ones in these cells hold makes one of all pieces.
    pub fn are_joined_by(&self, layout: &Layout, holders: impl IntoIterator<Item = Cell>) -> bool {
        let mut is_held = vec![false; self.count];
        for at in holders.into_iter().filter_map(|cell| layout.at(cell)) {
            if let Some(piece) = is_held.get_mut(self.of[at]) {
                *piece = true;
            }
        }
        is_held.into_iter().all(|is_held| is_held)
    }
}
