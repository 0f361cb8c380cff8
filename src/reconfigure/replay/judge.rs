//! States that were assessed, and the judgement on them: what every replay keeps books on.

use crate::reconfigure::plan::Moment;
use crate::statics::Bracket;

use super::State;
use super::claims;
use super::failure::{Failure, Fault};

/// A state that the oracle assessed.
#[derive(Clone, Debug)]
pub(in crate::reconfigure) struct Sample<C> {
    /// Phase of the action; 1 at rest after it.
    pub phase: f64,
    pub margin: Bracket,
    /// The connections that limit it: critical ones, and those at their limit.
    pub limiting: Vec<C>,
    pub weakest: Option<C>,
    pub connected: bool,
}

/// The margins found for the start or one action.
#[derive(Clone, Debug)]
pub(in crate::reconfigure) struct Found<C> {
    pub margin: Bracket,
    pub samples: Vec<Sample<C>>,
    /// Whether all of it is one state at rest, so that margins compare exactly.
    pub exact: bool,
}

impl<C> Found<C> {
    /// One state at rest.
    pub fn at_rest(sample: Sample<C>) -> Self {
        Self { margin: sample.margin, samples: vec![sample], exact: true }
    }

    /// The states of a move.
    pub fn on_the_way(samples: Vec<Sample<C>>) -> Self {
        let margin = samples.iter().map(|sample| sample.margin).reduce(Bracket::min);
        Self { margin: margin.expect("a grid has phases"), samples, exact: false }
    }

    /// A move and the rest after it.
    pub fn followed_by(mut self, rest: Self) -> Self {
        self.margin = self.margin.min(rest.margin);
        self.samples.extend(rest.samples);
        self
    }

    /// The samples at a phase.
    pub fn at(&self, phase: f64) -> impl Iterator<Item = &Sample<C>> {
        self.samples.iter().filter(move |sample| sample.phase == phase)
    }
}

/// All samples of the start and of every action, in their order.
pub(in crate::reconfigure) fn states<C: Copy>(found: &[Found<C>]) -> Vec<State<C>> {
    let of_action = |(place, found): (usize, &Found<C>)| -> Vec<State<C>> {
        let state = |sample: &Sample<C>| State {
            moment: Moment { action: place.checked_sub(1), phase: sample.phase, margin: sample.margin },
            weakest: sample.weakest,
        };
        found.samples.iter().map(state).collect()
    };
    found.iter().enumerate().flat_map(of_action).collect()
}

/// Collects what is wrong.
pub(in crate::reconfigure) struct Judge<C, T> {
    /// The margin that every transient state must have.
    pub required: f64,
    /// Whether all modules must stay connected.
    pub connected: bool,
    pub failures: Vec<Failure<C, T>>,
    pub solves: u64,
}

impl<C: Copy, T> Judge<C, T> {
    pub fn new(required: f64, connected: bool) -> Self {
        Self { required, connected, failures: Vec::new(), solves: 0 }
    }

    pub fn fail(&mut self, action: Option<usize>, phase: Option<f64>, fault: Fault<T>, weakest: Option<C>) {
        self.failures.push(Failure { action, phase, fault, connection: weakest });
    }

    /// Books a state at rest.
    pub fn rest(&mut self, action: Option<usize>, sample: Sample<C>) -> Found<C> {
        self.solves += 1;
        self.book(action, None, &[&sample], self.required);
        Found::at_rest(sample)
    }

    /// The margin that every state of a move must have.
    pub fn required_on_the_way(&self) -> f64 {
        if self.required > 0.0 { (self.required - claims::tolerance(self.required)).max(0.0) } else { self.required }
    }

    /// Books the states of a move.
    pub fn transit(&mut self, action: usize, samples: Vec<Sample<C>>) -> Found<C> {
        self.solves += samples.len() as u64;
        let least = self.required_on_the_way();
        self.book(Some(action), Some(()), &samples.iter().collect::<Vec<_>>(), least);
        Found::on_the_way(samples)
    }

    /// Books the first disconnected and the first unstable of some samples.
    fn book(&mut self, action: Option<usize>, moving: Option<()>, samples: &[&Sample<C>], least: f64) {
        let phase = |sample: &Sample<C>| moving.map(|()| sample.phase);
        if self.connected
            && let Some(apart) = samples.iter().find(|sample| !sample.connected)
        {
            self.fail(action, phase(apart), Fault::Disconnected, None);
        }
        let weak = |sample: &&&Sample<C>| !(sample.margin.lower >= least) || sample.margin.upper == f64::NEG_INFINITY;
        if let Some(weak) = samples.iter().find(weak) {
            let fault = Fault::Unstable { margin: weak.margin, required: self.required };
            self.fail(action, phase(weak), fault, weak.weakest);
        }
    }
}

/// The phases at which a way is checked: so many equal steps, and those claimed.
pub(in crate::reconfigure) fn phases(steps: u32, claimed: &[f64]) -> Vec<f64> {
    let grid = (0..=steps).map(|i| f64::from(i) / f64::from(steps));
    let mut phases: Vec<f64> = grid.chain(claimed.iter().copied().filter(|p| (0.0..=1.0).contains(p))).collect();
    phases.sort_unstable_by(f64::total_cmp);
    phases.dedup();
    phases
}
