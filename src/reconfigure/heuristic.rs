//! Admissible lower bound on the number of moves to a goal.
//!
//! A move changes the cell of exactly one module. If no motion of the module changes a coordinate by more than `a`, nor
//! the three together by more than `s`, then the module that ends `v = (x, y, z)` cells away has moved at
//! least `max(|x|, |y|, |z|) / a` times and at least `(|x| + |y| + |z|) / s` times. (A cube that slides by a cell and
//! pivots by a quarter and half a turn has `a = 1` and `s = 2`.) Summed over modules and minimised over all ways to assign
//! modules to goal cells of their class, this never exceeds the true number.
//!
//! Each move changes one term by at most one, so the bound is consistent too.

use pathfinding::prelude::{Matrix, kuhn_munkres_min};

use crate::robot::Cell;

use super::layout::{Layout, displaced};
use super::ways::Ability;

/// How far a module can come in one move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Most cells along one axis; 0 for a module that cannot move.
    axis: u32,
    /// Most cells along all axes together.
    sum: u32,
}

impl Reach {
    /// That of a module with this ability.
    pub fn of(ability: &Ability) -> Self {
        let steps = || ability.ways().iter().map(|way| way.motion.by().map(i32::unsigned_abs));
        let axis = steps().flatten().fold(0, u32::max);
        Self { axis, sum: steps().map(|[x, y, z]| x + y + z).fold(0, u32::max) }
    }

    /// Fewest moves that bring a module from one cell to another; `None` when none do.
    pub fn fewest_moves(self, from: Cell, to: Cell) -> Option<u32> {
        let distance: [u32; 3] = std::array::from_fn(|i| from[i].abs_diff(to[i]));
        let along = distance.into_iter().fold(0, u32::max);
        let together = distance.into_iter().fold(0, u32::saturating_add);
        match along {
            0 => Some(0),
            _ if self.axis == 0 => None,
            _ => Some(along.div_ceil(self.axis).max(together.div_ceil(self.sum))),
        }
    }
}

/// The cells that each class must fill.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Targets {
    cells: Vec<Vec<Cell>>,
    reaches: Vec<Reach>,
}

impl Targets {
    /// The targets of a goal layout, with how far modules of each class come in one move.
    pub fn new(goal: &Layout, reaches: Vec<Reach>) -> Self {
        Self { cells: by_class(goal, reaches.len()), reaches }
    }

    /// Whether the layout fills them, displaced by `offset` cells, whatever its orientations.
    pub fn are_met_by(&self, layout: &Layout, offset: Cell) -> bool {
        let present = by_class(layout, self.reaches.len());
        present.iter().zip(&self.cells).all(|(present, targets)| {
            // Both ascend, and a displacement keeps the order.
            present.len() == targets.len()
                && present.iter().zip(targets).all(|(&cell, &target)| cell == displaced(target, offset))
        })
    }

    /// Lower bound on the moves from `layout` to the targets, displaced by
    /// `offset` cells; `None` when they cannot be reached, because a class has
    /// another number of modules or a module that cannot move is elsewhere.
    pub fn fewest_moves(&self, layout: &Layout, offset: Cell) -> Option<u32> {
        let present = by_class(layout, self.reaches.len());
        let mut total: u32 = 0;
        for ((present, targets), &reach) in present.iter().zip(&self.cells).zip(&self.reaches) {
            if present.len() != targets.len() {
                return None;
            }
            total = total.saturating_add(assignment(reach, present, targets, offset)?);
        }
        Some(total)
    }
}

/// The cells of each class, ascending.
fn by_class(layout: &Layout, classes: usize) -> Vec<Vec<Cell>> {
    let mut cells = vec![Vec::new(); classes];
    for placed in layout.placed() {
        cells[usize::from(placed.class)].push(placed.cell);
    }
    cells
}

/// Cheapest assignment of the cells `from` to the equally many cells `to + offset`; `None` when there is none.
fn assignment(reach: Reach, from: &[Cell], to: &[Cell], offset: Cell) -> Option<u32> {
    let cost = |a: Cell, b: Cell| reach.fewest_moves(a, displaced(b, offset));
    if reach.axis == 0 {
        // Both ascend, and a displacement keeps the order.
        return from.iter().zip(to).all(|(&a, &b)| cost(a, b) == Some(0)).then_some(0);
    }
    match (from, to) {
        ([], _) => Some(0),
        (&[a], &[b]) => cost(a, b),
        _ => {
            let weight = |(row, column): (usize, usize)| i64::from(cost(from[row], to[column]).unwrap_or(u32::MAX));
            let weights = Matrix::from_fn(from.len(), to.len(), weight);
            let (total, _) = kuhn_munkres_min(&weights);
            Some(u32::try_from(total).unwrap_or(u32::MAX))
        }
    }
}
