//! What rotations have in common: the same question about a module and what it
//! touches on its way, in one layout and in many others.
//!
//! Knows where answers are the same; does not know what they are.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Mutex;

use crate::robot::{Cell, Face, Motion, Orientation, axis_of_turn};

use super::layout::{Layout, displaced, neighbour};
use super::moves::Move;
use super::problem::Problem;

/// A rotation with all that its module touches strictly between its ends, up to a
/// displacement. Valid away from ground and obstacles, whose place it does not know.
///
/// With the hinge at the origin and the axes of [`Move::room`], the module's
/// corner goes round a circle of radius sqrt 2 and reaches the edges of its room at the
/// ends only. So in its own plane it touches the support, and the landing of a quarter
/// turn, along the hinge, and nothing else; its two faces across the axis touch
/// the cells beside those that it sweeps and beside those two.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Neighbourhood {
    motion: Motion,
    class: u16,
    orientation: Orientation,
    /// Filled cells that the module touches, from the one that it leaves, with
    /// the types of the modules there, in a fixed order.
    touched: Vec<(Cell, usize)>,
}

impl Neighbourhood {
    /// What the module of a rotation touches in `layout`; `None` for a translation. The
    /// cell that it leaves must be filled.
    pub fn new(problem: &Problem, layout: &Layout, step: Move) -> Option<Self> {
        let (plane, axis) = plane(step)?;
        let moving = layout.placed()[layout.at(step.from).expect("a fitting move has a module")];
        let beside = |side: Face| plane.iter().map(move |&cell| neighbour(cell, side));
        let cells = plane.iter().copied().chain(beside(axis)).chain(beside(axis.opposite()));
        let back = step.from.map(|coordinate| -coordinate);
        let touched = cells.filter(|&cell| cell != step.from).filter_map(|cell| {
            let class = layout.placed()[layout.at(cell)?].class;
            Some((displaced(cell, back), problem.class(class).module_type))
        });
        Some(Self {
            motion: step.motion,
            class: moving.class,
            orientation: moving.orientation,
            touched: touched.collect(),
        })
    }
}

/// The cells in the plane of a rotation that its module sweeps or touches strictly
/// between its ends, with the axis of its turn; `None` for a translation.
pub fn plane(step: Move) -> Option<(Vec<Cell>, Face)> {
    let Motion::Rotation { support, towards, .. } = step.motion else { return None };
    let mut cells = step.room();
    cells.extend([step.from, neighbour(step.from, support)]);
    let landing = neighbour(step.to(), step.motion.landing()?);
    if !cells.contains(&landing) {
        cells.push(landing);
    }
    Some((cells, axis_of_turn(support, towards)))
}

/// Answers that are kept. Which were kept first depends on what is asked, never
/// on time: searches ask from one thread.
#[derive(Debug)]
pub struct Memo<K, V>(Mutex<HashMap<K, V>>);

impl<K: Eq + Hash, V: Copy> Memo<K, V> {
    /// No answers yet.
    pub fn new() -> Self {
        Self(Mutex::new(HashMap::new()))
    }

    /// The answer to `key`, found by `find` the first time.
    pub fn get(&self, key: K, find: impl FnOnce(&K) -> V) -> V {
        let known = || self.0.lock().expect("no thread panics while it holds the answers");
        if let Some(answer) = known().get(&key) {
            return *answer;
        }
        let answer = find(&key);
        known().insert(key, answer);
        answer
    }

    /// The answer to `key`, if there is one.
    pub fn known(&self, key: &K) -> Option<V> {
        self.0.lock().expect("no thread panics while it holds the answers").get(key).copied()
    }

    /// Replaces the answer to `key`.
    pub fn set(&self, key: K, answer: V) {
        self.0.lock().expect("no thread panics while it holds the answers").insert(key, answer);
    }

    /// Approximate memory in bytes, where a key owns so much heap.
    pub fn bytes(&self, heap_of_key: usize) -> usize {
        let known = self.0.lock().expect("no thread panics while it holds the answers");
        // Slots that are free, and a byte of control for each, are part of the table.
        known.capacity() * (size_of::<(K, V)>() + 1) * 8 / 7 + known.len() * heap_of_key
    }
}
