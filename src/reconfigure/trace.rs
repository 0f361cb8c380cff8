//! When two plans are the same but for the order of independent moves.

use crate::robot::Cell;

use super::moves::Move;

/// A sequence of moves up to the order of independent ones: of all orders that
/// swaps of neighbouring independent moves lead to, the smallest. Equal traces
/// are the same plan.
///
/// Source: Mazurkiewicz traces and their lexicographic normal form (A. V.
/// Anisimov, D. E. Knuth: "Inhomogeneous sorting", 1979).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Trace(Vec<Move>);

impl Trace {
    /// The trace of a sequence of moves. `needs` are the cells that a move's motion may need filled or empty.
    pub fn new(moves: impl IntoIterator<Item = Move>, needs: impl Fn(Move) -> Vec<Cell>) -> Self {
        let footprint = |step| (step, footprint(step, needs(step)));
        let mut left: Vec<(Move, Vec<Cell>)> = moves.into_iter().map(footprint).collect();
        let mut normal = Vec::with_capacity(left.len());
        while !left.is_empty() {
            let is_free = |at: &usize| left[..*at].iter().all(|before| independent(before, &left[*at]));
            let next = (0..left.len()).filter(is_free).min_by_key(|&at| left[at].0);
            normal.push(left.remove(next.expect("the first move depends on none before it")).0);
        }
        Self(normal)
    }
}

/// The cells whose filling the move depends on: what it needs, its room, and all cells that
/// may hold it.
fn footprint(step: Move, mut cells: Vec<Cell>) -> Vec<Cell> {
    cells.extend(step.room());
    cells.extend([step.from, step.to()]);
    cells.extend(step.sides().into_iter().map(|(cell, _)| cell));
    cells
}

/// Whether two moves can be taken in either order: neither fills or empties a
/// cell that the other depends on.
fn independent((a, cells_a): &(Move, Vec<Cell>), (b, cells_b): &(Move, Vec<Cell>)) -> bool {
    let touches = |step: &Move, cells: &[Cell]| cells.contains(&step.from) || cells.contains(&step.to());
    !touches(a, cells_b) && !touches(b, cells_a)
}
