//! In which order cells are filled and freed, and what dead ends taught about that.
//!
//! Knows cells; knows neither moves nor forces.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::reconfigure::layout::{Layout, Placed};
use crate::robot::Cell;

use super::shape::{Targets, distances, lot, surplus, vacant};

/// How early a cell is taken, smallest first: how often it was not left empty at a dead end, steps, height, and a lot.
pub type Rank = (Reverse<u32>, u32, i32, u64);

/// What dead ends taught.
#[derive(Debug, Default)]
pub struct Lessons {
    /// How often cells of the goal were empty at one.
    empty: BTreeMap<Cell, u32>,
    /// How often cells held a module at one that was wanted elsewhere.
    full: BTreeMap<Cell, u32>,
}

impl Lessons {
    /// Takes note of a dead end.
    pub fn note(&mut self, layout: &Layout, targets: &Targets) {
        for cell in vacant(layout, targets).into_keys() {
            *self.empty.entry(cell).or_default() += 1;
        }
        for placed in surplus(layout, targets) {
            *self.full.entry(placed.cell).or_default() += 1;
        }
    }

    /// Empty cells of the goal with how early they should be filled: first those that stayed empty at dead ends,
    /// then outwards from what is in place.
    pub fn filling_order(
        &self,
        home: &[Cell],
        vacant: &BTreeMap<Cell, u16>,
        targets: &Targets,
        seed: u64,
    ) -> BTreeMap<Cell, Rank> {
        let from_home = distances(home.iter().copied(), |cell| targets.contains_key(&cell));
        let rank = |cell: Cell| {
            let steps = from_home.get(&cell).copied().unwrap_or(u32::MAX);
            let empty = self.empty.get(&cell).copied().unwrap_or(0);
            (Reverse(empty), steps, cell[2], lot(seed, cell))
        };
        vacant.keys().map(|&cell| (cell, rank(cell))).collect()
    }

    /// Modules in the order in which they should leave: first those in cells that were not freed at dead ends, then
    /// those that are farthest from what is in place.
    pub fn freeing_order(&self, home: &[Cell], movers: &[Placed], layout: &Layout, seed: u64) -> Vec<Placed> {
        let from_home = distances(home.iter().copied(), |cell| layout.is_filled(cell));
        let mut movers = movers.to_vec();
        movers.sort_by_key(|placed| {
            let full = self.full.get(&placed.cell).copied().unwrap_or(0);
            let steps = from_home.get(&placed.cell).copied().unwrap_or(u32::MAX);
            (Reverse((full, steps, placed.cell[2])), lot(seed, placed.cell))
        });
        movers
    }
}

/// All cells within the bounds by how close they are to some.
pub fn by_steps(cells: impl Iterator<Item = Cell>, [low, high]: [Cell; 2], seed: u64) -> BTreeMap<Cell, Rank> {
    let within = |cell: Cell| (0..3).all(|i| low[i] <= cell[i] && cell[i] <= high[i]);
    let steps = distances(cells, within);
    steps.into_iter().map(|(cell, steps)| (cell, (Reverse(0), steps, cell[2], lot(seed, cell)))).collect()
}
