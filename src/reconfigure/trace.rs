//! When two plans are the same but for the order of independent moves.

use crate::robot::Cell;

use super::layout::neighbour;
use super::moves::{Motion, Move, Turn};

/// A sequence of moves up to the order of independent ones: of all orders that
/// swaps of neighbouring independent moves lead to, the smallest. Equal traces
/// are the same plan.
///
/// Source: Mazurkiewicz traces and their lexicographic normal form (A. V.
/// Anisimov, D. E. Knuth: "Inhomogeneous sorting", 1979).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Trace(Vec<Move>);

impl Trace {
    /// The trace of a sequence of moves.
    pub fn new(moves: impl IntoIterator<Item = Move>) -> Self {
        let mut left: Vec<(Move, Vec<Cell>)> = moves.into_iter().map(|step| (step, footprint(step))).collect();
        let mut normal = Vec::with_capacity(left.len());
        while !left.is_empty() {
            let is_free = |at: &usize| left[..*at].iter().all(|before| independent(before, &left[*at]));
            let next = (0..left.len()).filter(is_free).min_by_key(|&at| left[at].0);
            normal.push(left.remove(next.expect("the first move depends on none before it")).0);
        }
        Self(normal)
    }
}

/// The cells whose filling the move depends on: its room, and all cells that
/// may hold it.
fn footprint(step: Move) -> Vec<Cell> {
    let mut cells = step.room();
    cells.extend([step.from, step.to()]);
    cells.extend(step.sides().into_iter().map(|(cell, _)| cell));
    if let Motion::Pivot { support, towards, turn: Turn::Quarter } = step.motion {
        cells.push(neighbour(neighbour(step.from, support), towards));
    }
    cells
}

/// Whether two moves can be taken in either order: neither fills or empties a
/// cell that the other depends on.
fn independent((a, cells_a): &(Move, Vec<Cell>), (b, cells_b): &(Move, Vec<Cell>)) -> bool {
    let touches = |step: &Move, cells: &[Cell]| cells.contains(&step.from) || cells.contains(&step.to());
    !touches(a, cells_b) && !touches(b, cells_a)
}
