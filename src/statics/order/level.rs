//! One level: the least utilisation of the connections that are not held, as a bracket.

use crate::spatial::Twist;

use super::super::assessment::Bracket;
use super::super::attempts::ATTEMPTS;
use super::super::balance::{restore, wrenches};
use super::super::blocks::{Block, Link};
use super::super::bracket::Problem;
use super::super::conic::{self, Attempt};
use super::super::loads::BodyLoad;
use super::super::program::Program;
use super::super::reductions::Reductions;
use super::super::solve_block::converged;
use super::super::structure::Structure;

/// Width of a level's bracket, as a share of the level before, that is enough.
const ENOUGH: f64 = 1e-6;

/// Width beyond which a level counts as not proved.
const PROVED: f64 = 1e-2;

/// Relative room above a level for those that are held there: without it no state lies inside all
/// their cones.
const ROOM: f64 = 1e-6;

/// Insets with which the block's own method is asked, see [`Attempt`].
const INSETS: [f64; 2] = [1e-8, 1e-6];

/// How a motion is asked for that opens every contact and connection clearly.
const SAFE: Attempt = Attempt { tolerance: 1e-9, inset: 1e-2, regularization: 1e-8 };

/// Shares of it that are mixed into a tight motion which does not quite, tried in turn.
const MIXES: [f64; 6] = [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4];

/// What the links of a block are held at.
pub(super) struct Held {
    levels: Vec<Option<f64>>,
    /// The lowest so far.
    last: f64,
}

impl Held {
    pub(super) fn new(links: usize) -> Self {
        Self { levels: vec![None; links], last: f64::INFINITY }
    }

    pub(super) fn is_free(&self, link: usize) -> bool {
        self.levels[link].is_none()
    }

    pub(super) fn hold(&mut self, link: usize, level: f64) {
        self.levels[link] = Some(level * (1.0 + ROOM));
        self.last = self.last.min(level);
    }
}

/// The bracket on the least utilisation of all connections that are not held, and every link's
/// share in the dissipation of those. `None` when that cannot be proved.
pub(super) fn next(
    structure: &Structure,
    block: &Block,
    loads: &[BodyLoad],
    held: &Held,
) -> Option<(Bracket, Vec<f64>)> {
    let program = Program::with_held(structure, block, loads, &held.levels);
    let problem = Problem { structure, block, loads, program: &program };
    let mut found = Bracket::new(0.0, f64::INFINITY);
    let mut shares = vec![0.0; block.links.len()];
    // Ties of held boxes have right-hand sides, which the block's own method does not know.
    let own = INSETS.iter().filter(|_| program.groups.iter().all(|group| group.tie_row.is_none()));
    let own = own.map(|inset| converged(&program, *inset, Reductions::ALL).map(|(iterate, _)| iterate));
    let safe = std::cell::LazyCell::new(|| conic::solve(&program, &SAFE).map(|iterate| program.twists(&iterate.v)));
    for iterate in own.chain(ATTEMPTS.iter().map(|attempt| conic::solve(&program, attempt))).flatten() {
        let twists = program.twists(&iterate.v);
        let best = MIXES.iter().filter_map(|share| match (*share > 0.0, safe.as_deref()) {
            (false, _) => at_least(&problem, &twists, held),
            (true, Some(safe)) => at_least(&problem, &mixed(&twists, safe, *share), held),
            (true, None) => None,
        });
        if let Some((lower, by_link)) = best.max_by(|a, b| a.0.total_cmp(&b.0))
            && lower > found.lower
        {
            (found.lower, shares) = (lower, by_link);
        }
        let mut field = wrenches(&program, &iterate);
        restore(&problem, &iterate, &mut field, &vec![false; block.links.len()], true);
        if let Some((_, demands)) = problem.upper_bound(&field, None, 0.0) {
            found.upper = found.upper.min(at_most(block, &demands, held));
        }
        if found.width() <= ENOUGH * held.last {
            break;
        }
    }
    // Both are proved up to the tolerance on balance.
    if found.lower > found.upper {
        found = Bracket::new(found.upper, found.lower);
    }
    (found.width() <= PROVED * held.last).then_some((found, shares))
}

/// A motion with a share of another.
fn mixed(twists: &[Twist], other: &[Twist], share: f64) -> Vec<Twist> {
    let mix = |(a, b): (&Twist, &Twist)| Twist::new(a.linear + b.linear * share, a.angular + b.angular * share);
    twists.iter().zip(other).map(mix).collect()
}

/// The largest demand of a connection that is not held, where all others hold.
fn at_most(block: &Block, demands: &[f64], held: &Held) -> f64 {
    let mut largest = 0.0_f64;
    for ((link, demand), level) in block.links.iter().zip(demands).zip(&held.levels) {
        match (link, level) {
            (Link::Contact(_), _) => {}
            (Link::Connection(_), None) => largest = largest.max(*demand),
            (Link::Connection(_), Some(level)) if *demand <= level * (1.0 + ROOM) => {}
            (Link::Connection(_), Some(_)) => return f64::INFINITY,
        }
    }
    largest
}

/// What a motion proves of the connections that are not held, and their shares in it.
fn at_least(problem: &Problem<'_>, twists: &[Twist], held: &Held) -> Option<(f64, Vec<f64>)> {
    let (_, dissipated) = problem.dissipation(twists)?;
    let (power, error) = problem.power(problem.loads, twists);
    let (mut taken, mut free) = (0.0, 0.0);
    for (dissipated, level) in dissipated.iter().zip(&held.levels) {
        match level {
            Some(level) => taken += level * (1.0 + ROOM) * dissipated,
            None => free += dissipated,
        }
    }
    let rounding = (dissipated.len() as f64 + 16.0) * f64::EPSILON;
    let (power, free) = (power - error - taken * (1.0 + rounding), free * (1.0 + rounding));
    if !(power > 0.0 && free > 0.0) {
        return None;
    }
    let share = |(dissipated, level): (&f64, &Option<f64>)| if level.is_some() { 0.0 } else { dissipated / free };
    Some((power / free, dissipated.iter().zip(&held.levels).map(share).collect()))
}
