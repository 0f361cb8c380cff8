//! Admissible lower bound on the number of moves to a goal.
//!
//! A move changes the cell of exactly one module: a slide or a quarter pivot by
//! one step along one axis, a half pivot by one step along each of two axes. So
//! the module that ends `v = (x, y, z)` cells away has moved at least
//! `max(|x|, |y|, |z|)` times, because no move changes a coordinate by more than one, and
//! at least `ceil((|x| + |y| + |z|) / 2)` times, because none changes their sum by more than two.
//! Summed over modules and minimised over all ways to assign
//! modules to goal cells of their class, this never exceeds the true number.
//!
//! Each move changes one term by at most one, so the bound is consistent too.

use pathfinding::prelude::{Matrix, kuhn_munkres_min};

use crate::robot::Cell;

use super::layout::{Layout, displaced};

/// Fewest moves that bring a module from one cell to another.
pub fn fewest_moves(from: Cell, to: Cell) -> u32 {
    let distance: [u32; 3] = std::array::from_fn(|i| from[i].abs_diff(to[i]));
    let chebyshev = distance.into_iter().fold(0, u32::max);
    let manhattan = distance.into_iter().fold(0, u32::saturating_add);
    chebyshev.max(manhattan.div_ceil(2))
}

/// The cells that each class must fill.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Targets {
    cells: Vec<Vec<Cell>>,
    fixed: Vec<bool>,
}

impl Targets {
    /// The targets of a goal layout, with which classes never move.
    pub fn new(goal: &Layout, fixed: Vec<bool>) -> Self {
        Self { cells: by_class(goal, fixed.len()), fixed }
    }

    /// Whether the layout fills them, displaced by `offset` cells, whatever its orientations.
    pub fn are_met_by(&self, layout: &Layout, offset: Cell) -> bool {
        let present = by_class(layout, self.fixed.len());
        present.iter().zip(&self.cells).all(|(present, targets)| {
            // Both ascend, and a displacement keeps the order.
            present.len() == targets.len()
                && present.iter().zip(targets).all(|(&cell, &target)| cell == displaced(target, offset))
        })
    }

    /// Lower bound on the moves from `layout` to the targets, displaced by
    /// `offset` cells; `None` when they cannot be reached, because a class has
    /// another number of modules or a fixed module is elsewhere.
    pub fn fewest_moves(&self, layout: &Layout, offset: Cell) -> Option<u32> {
        let present = by_class(layout, self.fixed.len());
        let mut total: u32 = 0;
        for ((present, targets), &fixed) in present.iter().zip(&self.cells).zip(&self.fixed) {
            if present.len() != targets.len() {
                return None;
            }
            let cost = assignment(present, targets, offset);
            if fixed && cost > 0 {
                return None;
            }
            total = total.saturating_add(cost);
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

/// Cheapest assignment of the cells `from` to the equally many cells `to + offset`.
fn assignment(from: &[Cell], to: &[Cell], offset: Cell) -> u32 {
    let cost = |a: Cell, b: Cell| fewest_moves(a, displaced(b, offset));
    match (from, to) {
        ([], _) => 0,
        (&[a], &[b]) => cost(a, b),
        _ => {
            let weights = Matrix::from_fn(from.len(), to.len(), |(row, column)| i64::from(cost(from[row], to[column])));
            let (total, _) = kuhn_munkres_min(&weights);
            u32::try_from(total).unwrap_or(u32::MAX)
        }
    }
}
