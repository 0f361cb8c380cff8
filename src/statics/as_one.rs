//! Mechanisms of a block in which some of its bodies move as one.
//!
//! Where parts are clamped by their own stress, or where strengths are not needed, the
//! mechanism that proves the most has bodies at rest against each other, exactly; a
//! solver's twists there are noise of either sign. Guesses from an iterate which bodies
//! those are, and asks for the best mechanism of that kind (see `clusters` and `locked`).

use crate::spatial::Twist;

use super::assessment::Question;
use super::best::Best;
use super::bracket::Problem;
use super::clusters::Clusters;
use super::conic::{self, Attempt};
use super::locked::{AtRest, lock};
use super::lowered::Lowered;
use super::program::{Program, Purpose};
use super::solve_block::{NEAR, converged};

/// Rounds of lowering strengths that are not needed.
const LOWERINGS: usize = 6;

/// Inset with which a mechanism of fused clusters is asked for.
const FUSED_INSET: f64 = 1e-8;

/// Ways of asking the general solver for it.
const FUSED_ATTEMPTS: [Attempt; 2] = [
    Attempt { tolerance: 1e-9, inset: 1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-11, inset: 1e-9, regularization: 1e-9 },
];

/// Shares of the whole power below which the motion of a link counts as none
/// when bodies are fused into clusters.
const FUSED: [f64; 3] = [1e-7, 1e-5, 1e-3];

impl Best {
    /// Asks again with the strengths that are not needed lowered, and with the
    /// bodies that they join moving as one.
    pub(super) fn lower_strengths(&mut self, problem: &Problem<'_>, inset: f64, question: Question) {
        let Problem { structure, block, loads, program } = *problem;
        let mut lowered = Lowered::new(structure, block, program);
        for _ in 0..LOWERINGS {
            let t = self.upper.min(program.t_scale);
            let shares = lowered.shares(t);
            if shares.iter().all(|share| *share == 1.0) {
                return;
            }
            let program = Program::with_shares(structure, block, loads, shares.clone());
            let problem = Problem { program: &program, ..*problem };
            self.iterate(&problem, &program, inset, NEAR, question);
            if self.answers(question) || !self.upper.is_finite() {
                return;
            }
            let moving = vec![[false; 6]; block.links.len()];
            let idle = |link: usize| shares[link] < 1.0 && self.demands[link] < shares[link] * self.upper;
            self.move_as_one(&problem, Clusters::new(structure, block, |link, _| idle(link)), moving, question);
            if self.answers(question) || !(lowered.raise(&shares, &self.demands, self.upper) || self.upper < 0.5 * t) {
                return;
            }
        }
    }

    /// Lets bodies that hardly move against each other in `twists` move as one,
    /// and asks for the best mechanism of that kind. Parts that are clamped by
    /// their own stress have no admissible motion but rest: there the solver's
    /// twists are noise, which nothing else would make admissible.
    pub(super) fn fuse(&mut self, problem: &Problem<'_>, twists: &[Twist], question: Question) {
        let Problem { structure, block, loads, .. } = *problem;
        let powers = problem.link_powers(twists);
        let power: f64 = block.bodies.iter().zip(twists).map(|(&body, v)| v.power(&loads[body].wrench)).sum();
        for share in FUSED {
            let least = share * power;
            let at_rest = powers.iter().map(|link| link.map(|along| along <= least)).collect();
            let clusters = Clusters::new(structure, block, |link, _| powers[link].iter().sum::<f64>() <= least);
            self.move_as_one(problem, clusters, at_rest, question);
            if self.answers(question) {
                return;
            }
        }
    }

    /// Keeps the best mechanism in which each of `clusters` moves as one and what is
    /// `at_rest` between them is held.
    fn move_as_one(&mut self, problem: &Problem<'_>, clusters: Clusters, at_rest: AtRest, question: Question) {
        let restriction = (clusters, at_rest);
        if self.restrictions.contains(&restriction) {
            return;
        }
        let (clusters, at_rest) = &restriction;
        let Problem { structure, block, loads, .. } = *problem;
        let Some(mut reduced) = clusters.reduce(structure, block, loads) else { return };
        lock(&mut reduced, at_rest);
        let program = Program::new(&reduced.structure, &reduced.block, &reduced.loads, Purpose::Utilisation);
        let inner =
            Problem { structure: &reduced.structure, block: &reduced.block, loads: &reduced.loads, program: &program };
        let reductions = self.reductions;
        let own = std::iter::once_with(|| converged(&program, FUSED_INSET, reductions));
        let generally =
            FUSED_ATTEMPTS.iter().map(|attempt| conic::solve(&program, attempt).map(|iterate| (iterate, false)));
        for (iterate, last) in own.chain(generally).flatten() {
            let twists = program.twists(&iterate.v);
            let Some((lower, inner_shares)) = inner.lower_bound(&twists) else { continue };
            if lower > self.lower {
                self.lower = lower;
                self.mechanism = clusters.spread(structure, block, &reduced, &twists);
                self.shares = vec![0.0; block.links.len()];
                for (&origin, share) in reduced.origins.iter().zip(inner_shares) {
                    self.shares[origin] = share;
                }
                self.charge(problem);
            }
            if last || self.answers(question) {
                break;
            }
        }
        self.restrictions.push(restriction);
    }
}
