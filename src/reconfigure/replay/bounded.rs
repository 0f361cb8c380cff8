//! States of large robots, checked by bounds where a plan claims no more than a bound.
//!
//! A claim that is a wide bracket says that a margin is at least its lower end. Whether that is so is
//! often proved by a state with fewer connections, in which one module hangs on the others
//! ([`hanging`](crate::reconfigure::hanging)); whatever that leaves open is assessed as always.

use std::collections::BTreeMap;

use crate::reconfigure::assembly::{Engagement, Moving, Transient};
use crate::reconfigure::hanging::{Reach, Rest, Rests, best_grip};
use crate::robot::{Configuration, FaceConnection, Placement};
use crate::statics::Bracket;

use petgraph::unionfind::UnionFind;

use super::judge::Sample;
use super::legality::Path;

/// All modules but one, as they were asked about last.
struct Asked {
    module: usize,
    placements: Vec<Placement>,
    others: Vec<Engagement>,
    are_connected: bool,
    rest: Rest,
}

/// Bounds on the states of one robot, with what was found of the last ones.
pub(super) struct Bounds<'a> {
    start: &'a Configuration,
    rests: Rests<'a>,
    /// The last two that were asked about, the last one first.
    asked: Vec<Asked>,
}

impl<'a> Bounds<'a> {
    pub fn new(start: &'a Configuration) -> Self {
        Self { start, rests: Rests::new(start), asked: Vec::new() }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.rests.solves()
    }

    /// The states of a move at these phases, if all are proved to have at least a margin.
    pub fn of_move(
        &mut self,
        before: &Configuration,
        path: &Path,
        phases: &[f64],
        least: f64,
    ) -> Option<Vec<Sample<FaceConnection>>> {
        let placements: Vec<Placement> = before.modules.iter().map(|module| module.placement).collect();
        let start = before.pose(path.module);
        let states: Vec<Transient> = phases
            .iter()
            .map(|&phase| {
                let moving = Moving { module: path.module, pose: path.motion.pose(&start, phase) };
                Transient { placements: &placements, moving: Some(moving), engaged: &path.engaged }
            })
            .collect();
        self.of_states(path.module, &states, phases, least)
    }

    /// A state at rest, if it is proved to have at least a margin with one of these modules hanging on the others.
    pub fn at_rest(
        &mut self,
        state: &Configuration,
        hanging: impl IntoIterator<Item = usize>,
        least: f64,
    ) -> Option<Sample<FaceConnection>> {
        let placements: Vec<Placement> = state.modules.iter().map(|module| module.placement).collect();
        let engaged: Vec<_> = state.connections.iter().map(|c| Engagement::face(state, c)).collect();
        let at_rest = Transient { placements: &placements, moving: None, engaged: &engaged };
        let states = [at_rest];
        hanging.into_iter().find_map(|module| self.of_states(module, &states, &[1.0], least)?.pop())
    }

    fn of_states(
        &mut self,
        module: usize,
        states: &[Transient],
        phases: &[f64],
        least: f64,
    ) -> Option<Vec<Sample<FaceConnection>>> {
        let level = 1.0 - least;
        let mut reaches: BTreeMap<usize, Reach> = BTreeMap::new();
        let mut grips = Vec::with_capacity(states.len());
        for state in states {
            let grip = best_grip(self.start, state, module)?;
            if !(grip.utilisation.upper <= level) {
                return None;
            }
            let reach = Reach::point(grip.weight_at);
            reaches.entry(grip.support).and_modify(|known| *known = known.joined(reach)).or_insert(reach);
            grips.push(grip);
        }
        self.find(module, states.first()?);
        let asked = self.asked.first_mut()?;
        if !asked.are_connected {
            return None;
        }
        let supports: Vec<(usize, Reach)> = reaches.into_iter().collect();
        let most = self.rests.utilisations(&mut asked.rest, &supports, level).ok()?;
        let carried: BTreeMap<usize, f64> = supports.iter().map(|&(support, _)| support).zip(most).collect();
        let sample = |(grip, &phase): (crate::reconfigure::hanging::Grip, &f64)| {
            let most = grip.utilisation.upper.max(carried[&grip.support]);
            Sample {
                phase,
                // At most `level` is at least `least`, but for the rounding of differences from 1.
                margin: Bracket::new((1.0 - most).max(least), 1.0),
                limiting: Vec::new(),
                weakest: None,
                connected: true,
            }
        };
        Some(grips.into_iter().zip(phases).map(sample).collect())
    }

    /// Puts all modules but one of a state to the front of those asked about.
    fn find(&mut self, module: usize, state: &Transient) {
        let others = state.engaged.iter().copied().filter(|held| !held.modules().contains(&module));
        let others: Vec<Engagement> = others.collect();
        let same_place = |(m, (a, b)): (usize, (&Placement, &Placement))| m == module || a == b;
        let is_same = |asked: &Asked| {
            asked.module == module
                && asked.others == others
                && asked.placements.iter().zip(state.placements).enumerate().all(same_place)
        };
        if let Some(at) = self.asked.iter().position(is_same) {
            self.asked.swap(0, at);
            return;
        }
        let mut components = UnionFind::<usize>::new(state.placements.len());
        let joined = others.iter().map(Engagement::modules).filter(|&[a, b]| components.union(a, b)).count();
        let rest = self.rests.without(module, state.placements, &others);
        let are_connected = joined + 2 >= state.placements.len();
        let placements = state.placements.to_vec();
        self.asked.insert(0, Asked { module, placements, others, are_connected, rest });
        self.asked.truncate(2);
    }
}
