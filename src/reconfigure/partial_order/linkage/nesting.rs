//! Which moves under way carry which, and where that puts the bodies.
//!
//! Every move turns one side of a joint or connection about a line that is fixed in what rests at it. Two of them may
//! be under way at once if they carry nothing in common, neither what the other rests on, or if one carries all that
//! the other turns together with what that rests on. Then the sets that are carried are nested or apart, and a body
//! goes where the innermost turn takes it, then where the next one out takes that, and so on.
//!
//! Knows bodies and turns; knows no collision and no forces.

use std::cmp::Reverse;

use crate::geometry::Motion;
use crate::reconfigure::linkage::assembly::{BodyOf, Touched};
use crate::reconfigure::linkage::joined::Joined;
use crate::reconfigure::linkage::replay::legality::{Path, transition};
use crate::reconfigure::linkage::{Action, Half};
use crate::reconfigure::partial_order::Because;
use crate::reconfigure::replay::Fault;
use crate::robot::linkage::Linkage;
use crate::spatial::Pose;

/// A move under way.
#[derive(Clone, Debug)]
pub struct Turn {
    /// Its way out of a state.
    path: Path,
    /// The body at the joint or connection on the side that rests.
    rests_on: BodyOf,
}

impl Turn {
    /// What an action turns out of a state; `None` if it is no move.
    ///
    /// # Errors
    /// Why it is not legal there.
    pub fn of(state: &Linkage, action: &Action) -> Result<Option<Self>, Fault<Touched>> {
        let Some(path) = transition(state, action)?.path else { return Ok(None) };
        let rests_on = match *action {
            Action::Rotate { module, joint, carried, .. } => {
                let kind = &state.module_type(module).joints[joint];
                let body = match carried {
                    Half::Parent => kind.child,
                    Half::Child => kind.parent,
                };
                BodyOf { module, body }
            }
            Action::Roll { connection, carried, .. } => {
                let [a, b] = connection.ports;
                let port = if a.module == carried { b } else { a };
                BodyOf { module: port.module, body: state.module_type(port.module).ports[port.port].body }
            }
            Action::Attach(_) | Action::Detach(_) => return Ok(None),
        };
        Ok(Some(Self { path, rests_on }))
    }
}

/// Moves under way out of one state, and what carries each body.
pub struct Nesting<'t> {
    turns: &'t [Turn],
    joined: Joined,
    /// For each body the turns that carry it, outermost first.
    carriers: Vec<Vec<usize>>,
}

impl<'t> Nesting<'t> {
    /// Of moves out of a state.
    ///
    /// # Errors
    /// [`Because::Entangled`] where two of them are neither apart nor one within the other.
    pub fn of(state: &Linkage, turns: &'t [Turn]) -> Result<Self, Because<Touched>> {
        let joined = Joined::new(state);
        let mut carriers = vec![Vec::new(); joined.bodies.len()];
        let mut outermost_first: Vec<usize> = (0..turns.len()).collect();
        outermost_first.sort_by_key(|&turn| Reverse(turns[turn].path.carried.len()));
        for &turn in &outermost_first {
            for &body in &turns[turn].path.carried {
                carriers[joined.index(body)].push(turn);
            }
        }
        let nesting = Self { turns, joined, carriers };
        let fit = |a: usize, b: usize| nesting.are_apart(a, b) || nesting.is_within(a, b) || nesting.is_within(b, a);
        let all = (0..turns.len()).all(|b| (0..b).all(|a| fit(a, b)));
        if all { Ok(nesting) } else { Err(Because::Entangled) }
    }

    /// Whether a turn carries a body.
    fn carries(&self, turn: usize, body: BodyOf) -> bool {
        self.carriers(body).contains(&turn)
    }

    /// Whether neither of two turns carries what the other does, or what that rests on.
    fn are_apart(&self, a: usize, b: usize) -> bool {
        let misses = |a: usize, b: usize| {
            let Turn { path, rests_on } = &self.turns[b];
            !self.carries(a, *rests_on) && !path.carried.iter().any(|&body| self.carries(a, body))
        };
        misses(a, b) && misses(b, a)
    }

    /// Whether one turn carries all that another does, and what that rests on.
    fn is_within(&self, outer: usize, inner: usize) -> bool {
        let Turn { path, rests_on } = &self.turns[inner];
        self.carries(outer, *rests_on) && path.carried.iter().all(|&body| self.carries(outer, body))
    }

    /// The turns that carry a body, outermost first.
    pub fn carriers(&self, body: BodyOf) -> &[usize] {
        &self.carriers[self.joined.index(body)]
    }

    /// The turns that change how two bodies lie to each other: of each those that carry it alone, outermost first.
    /// What carries both is outside of these.
    pub fn between(&self, a: BodyOf, b: BodyOf) -> [&[usize]; 2] {
        let (a, b) = (self.carriers(a), self.carriers(b));
        let common = a.iter().zip(b).take_while(|(a, b)| a == b).count();
        [&a[common..], &b[common..]]
    }

    /// How many turns there are.
    pub fn turns(&self) -> usize {
        self.turns.len()
    }

    /// The motion of a turn, where nothing else is under way.
    pub fn motion(&self, turn: usize) -> &Motion {
        &self.turns[turn].path.motion
    }

    /// All bodies.
    pub fn bodies(&self) -> &[BodyOf] {
        &self.joined.bodies
    }

    /// Poses of all bodies, module by module, at these phases of the turns out of where they are before.
    pub fn poses(&self, before: &[Vec<Pose>], phases: &[f64]) -> Vec<Vec<Pose>> {
        let displacements: Vec<Pose> =
            phases.iter().enumerate().map(|(turn, &phase)| self.motion(turn).at(phase)).collect();
        let mut poses = before.to_vec();
        for (&BodyOf { module, body }, carriers) in self.joined.bodies.iter().zip(&self.carriers) {
            let pose = &mut poses[module][body];
            *pose = carriers.iter().rev().fold(*pose, |pose, &turn| displacements[turn] * pose);
        }
        poses
    }
}
