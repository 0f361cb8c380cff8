//! Whether moves of a lattice robot have a margin of at least so much, by bounds carried over from one state to the
//! next.
//!
//! Knows which states are neighbours; knows nothing of how bounds are carried over.

use std::sync::Arc;

use crate::robot::Motion;
use crate::statics::{Bracket, Memory};

use super::domain::{Domain, bonds_after};
use super::layout::{Bond, Layout};
use super::moves::Move;
use super::oracle::Worst;
use super::recollection::matching;

impl Domain<'_> {
    /// Whether the margin of a move with the detachments before it and the attachments after it is at least `floor`.
    /// `bonds` are the connections that it begins with in the saturated layout `from`.
    ///
    /// Of the same states as its margin in the saturated space; the bracket is on one side of the floor wherever that
    /// can be told, and no tighter than that takes.
    pub fn decides(&self, from: &Layout, bonds: &[Bond], step: Move, to: &Layout, floor: f64) -> Worst {
        // With less engaged, as a move ends, no margin is larger.
        let settled = self.decides_settled(to, from, floor);
        if settled.is_out(floor) {
            return settled.cut_short();
        }
        let mut worst = settled;
        let memory = self.memory(from, floor);
        // A translation begins and ends in the states at rest that are its first and its last phase.
        if let Motion::Rotation { .. } = step.motion {
            let landed = bonds_after(from, bonds, step);
            for (layout, bonds) in [(from, bonds), (to, landed.as_slice())] {
                let rest = self.decides_rest(layout, bonds, floor);
                if rest.is_out(floor) {
                    return rest.cut_short();
                }
                worst = worst.or_worse(rest);
            }
        }
        let course = self.oracle.decides_move(self.problem.placements(from), bonds, step, floor, memory.as_deref());
        if course.is_out(floor) { course } else { worst.or_worse(course) }
    }

    /// Whether a layout holds with every possible connection engaged, as a neighbour of another.
    pub(super) fn decides_settled(&self, layout: &Layout, near: &Layout, floor: f64) -> Worst {
        let bonds = layout.touching();
        let known = self.known(layout, &bonds, floor);
        known.unwrap_or_else(|| {
            let placements = self.problem.placements(layout);
            let memory = self.recollection.of(near);
            let matching = matching(&self.problem.placements(near), &placements);
            let near = memory.as_deref().map(|memory| (memory, matching.as_slice()));
            let (worst, memory) = self.oracle.decides_state(&placements, &bonds, floor, near);
            if let Some(memory) = memory {
                self.recollection.keep(layout, Arc::new(memory));
            }
            self.note(layout, bonds, worst)
        })
    }

    /// Whether a layout holds at rest with these connections, as a neighbour of itself with all of them.
    fn decides_rest(&self, layout: &Layout, bonds: &[Bond], floor: f64) -> Worst {
        self.known(layout, bonds, floor).unwrap_or_else(|| {
            let memory = self.memory(layout, floor);
            let placements = self.problem.placements(layout);
            let same: Vec<Option<usize>> = (0..placements.len()).map(Some).collect();
            let near = memory.as_deref().map(|memory| (memory, same.as_slice()));
            let (worst, _) = self.oracle.decides_state(&placements, bonds, floor, near);
            self.note(layout, bonds.to_vec(), worst)
        })
    }

    /// What a layout with every possible connection engaged leaves for its neighbours.
    fn memory(&self, layout: &Layout, floor: f64) -> Option<Arc<Memory>> {
        self.recollection.of(layout).or_else(|| {
            let bonds = layout.touching();
            let (worst, memory) = self.oracle.decides_state(&self.problem.placements(layout), &bonds, floor, None);
            self.note(layout, bonds, worst);
            let memory = Arc::new(memory?);
            self.recollection.keep(layout, Arc::clone(&memory));
            Some(memory)
        })
    }

    /// Bounds on a margin at rest that are on one side of the floor already.
    fn known(&self, layout: &Layout, bonds: &[Bond], floor: f64) -> Option<Worst> {
        let known = self.bounds.known(&(layout.clone(), bonds.to_vec()))?;
        (known.margin.lower >= floor || known.is_out(floor)).then_some(known)
    }

    /// Keeps bounds on a margin at rest, with what was known before.
    fn note(&self, layout: &Layout, bonds: Vec<Bond>, found: Worst) -> Worst {
        let key = (layout.clone(), bonds);
        let before = self.bounds.known(&key).map_or(found.margin, |before| before.margin);
        let Bracket { lower, upper } = found.margin;
        let upper = upper.min(before.upper);
        let worst = Worst { margin: Bracket::new(lower.max(before.lower).min(upper), upper), ..found };
        self.bounds.set(key, worst);
        worst
    }
}
