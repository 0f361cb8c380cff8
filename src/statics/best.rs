//! The best bounds on a block's utilisation so far, and the fields that prove them.
//!
//! Whatever a solver proposes is kept only as far as the bracket proves it. Knows
//! iterates, nothing of how they were found.

use crate::spatial::{Twist, Wrench};

use super::assessment::{Bracket, Question};
use super::balance::{idle_contacts, restore, wrenches};
use super::blocks::Block;
use super::bracket::Problem;
use super::clusters::Clusters;
use super::collapse::is_quick;
use super::conic::Iterate;
use super::locked::AtRest;
use super::reductions::Reductions;
use super::structure::Structure;

/// Shares of a safely admissible twist field that are mixed into a tight but
/// inadmissible one.
const MIXES: [f64; 4] = [1e-6, 1e-4, 1e-2, 1e-1];

/// Shares of the largest contact force below which a contact is left out, tried
/// in turn until the rest balances.
const IDLE: [f64; 4] = [0.0, 1e-6, 1e-4, 1e-2];

/// The best bounds so far and the fields that prove them.
pub(super) struct Best {
    pub lower: f64,
    pub upper: f64,
    pub wrenches: Vec<Wrench>,
    pub demands: Vec<f64>,
    pub mechanism: Vec<Twist>,
    pub shares: Vec<f64>,
    /// Both fields of the iterate that was enough, as they are.
    pub unproved: Option<(Vec<Wrench>, Vec<Twist>)>,
    /// What mechanisms were restricted to before.
    pub restrictions: Vec<(Clusters, AtRest)>,
    /// What may be left out on the way.
    pub reductions: Reductions,
    /// What another part of the structure needs at least.
    pub elsewhere: f64,
    /// Whether it is asked for at once if any strength helps: it costs next to nothing.
    pub may_fall: bool,
}

impl Best {
    pub(super) fn new(structure: &Structure, block: &Block, elsewhere: f64, reductions: Reductions) -> Self {
        Self {
            lower: 0.0,
            upper: f64::INFINITY,
            wrenches: vec![Wrench::ZERO; block.links.len()],
            demands: vec![0.0; block.links.len()],
            mechanism: vec![Twist::ZERO; block.bodies.len()],
            shares: vec![0.0; block.links.len()],
            unproved: None,
            restrictions: Vec::new(),
            reductions,
            elsewhere,
            may_fall: is_quick(structure, block),
        }
    }

    pub(super) fn answers(&self, question: Question) -> bool {
        self.upper <= self.elsewhere || question.is_answered_by(&Bracket::new(self.lower, self.upper))
    }

    /// Bounds from an iterate, and from what its motion says about clusters.
    pub(super) fn improve(&mut self, problem: &Problem<'_>, iterate: &Iterate, question: Question) {
        self.prove(problem, iterate);
        let twists = problem.program.twists(&iterate.v);
        if !self.answers(question) && self.upper.is_finite() {
            self.fuse(problem, &twists, question);
        }
        // Each is proved up to the tolerance on balance; where they cross by
        // that, the truth lies between them.
        if self.lower > self.upper {
            std::mem::swap(&mut self.lower, &mut self.upper);
        }
    }

    /// Bounds from an iterate.
    pub(super) fn prove(&mut self, problem: &Problem<'_>, iterate: &Iterate) {
        let twists = problem.program.twists(&iterate.v);
        if !self.keep_lower(problem, &twists) {
            self.mix(problem, &twists);
        }
        for share in IDLE {
            if self.keep_upper(problem, iterate, share) {
                break;
            }
        }
    }

    /// Keeps what the solver's wrenches prove once they balance, without the
    /// contacts that carry less than `share`; whether they balance.
    pub(super) fn keep_upper(&mut self, problem: &Problem<'_>, iterate: &Iterate, share: f64) -> bool {
        let mut field = wrenches(problem.program, iterate);
        let idle = idle_contacts(problem.block, &field, share);
        if share > 0.0 && !idle.contains(&true) {
            return false;
        }
        restore(problem, iterate, &mut field, &idle, self.reductions.chains);
        let Some((upper, demands)) = problem.upper_bound(&field, self.unit_mechanism(), 0.0) else { return false };
        if upper < self.upper {
            self.upper = upper;
            self.wrenches = field;
            self.demands = demands;
        }
        true
    }

    /// Charges the upper bound with its imbalance's power in the mechanism, which is new.
    pub(super) fn charge(&mut self, problem: &Problem<'_>) {
        if self.upper.is_finite()
            && let Some((upper, _)) = problem.upper_bound(&self.wrenches, self.unit_mechanism(), 0.0)
        {
            self.upper = upper;
        }
    }

    /// Mixes a share of the mechanism so far, which is admissible, into a twist
    /// field that is not, but may be tighter.
    fn mix(&mut self, problem: &Problem<'_>, twists: &[Twist]) {
        if self.lower == 0.0 {
            return;
        }
        let safe = self.mechanism.clone();
        for share in MIXES {
            let mix = |(a, b): (&Twist, &Twist)| Twist::new(a.linear + b.linear * share, a.angular + b.angular * share);
            let mixed: Vec<Twist> = twists.iter().zip(&safe).map(mix).collect();
            if self.keep_lower(problem, &mixed) {
                return;
            }
        }
    }

    /// Keeps what `twists` prove; whether they were admissible.
    pub(super) fn keep_lower(&mut self, problem: &Problem<'_>, twists: &[Twist]) -> bool {
        let Some((lower, shares)) = problem.lower_bound(twists) else { return false };
        if lower > self.lower {
            self.lower = lower;
            self.shares = shares;
            self.mechanism = twists.to_vec();
            self.charge(problem);
        }
        true
    }

    /// The mechanism, if it proves anything: its dissipation is about 1.
    fn unit_mechanism(&self) -> Option<&[Twist]> {
        (self.lower > 0.0).then_some(&self.mechanism[..])
    }
}
