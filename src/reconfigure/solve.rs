//! The entry for planners and schedulers: a start, a goal and what is wanted
//! in, plans with proofs out.

use std::hash::Hash;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use planners::{Budget, Limit, PathOf, Progress, Search, Space, Width};

use crate::robot::{Configuration, Goal};
use crate::statics::Bracket;

use super::compose::{compose, expand, ports};
use super::domain::{Domain, width};
use super::oracle::Worst;
use super::plan::{Objective, Outcome, Plan, Proof, Report, Statistics};
use super::primitive::Primitive;
use super::problem::Problem;
use super::refusal::{Impossible, Refusal, Rejection, Which};
use super::saturated::{self, Saturated};
use super::step::Step;
use super::trace::Trace;

/// Two margins this close, relative to the larger of 1 and the margin, are
/// equally good: what the oracle's brackets are guaranteed to resolve.
pub const MARGIN_TOLERANCE: f64 = 1e-6;

/// Which transitions a search goes by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Reduction {
    /// Whole moves between states with every possible connection engaged.
    #[default]
    Saturated,
    /// Every attach, detach and move on its own: the reference, for small problems.
    Primitive,
}

/// What is wanted and what may be spent. The default asks for the one plan of
/// the largest margin, without a limit.
///
/// The oracle's work is spread over the rayon pool that [`solve`] is called in;
/// the plans do not depend on its size.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What makes a plan better.
    pub objective: Objective,
    /// Margin that every transient state must have, where it is more than the start requires.
    pub min_margin: Option<f64>,
    /// How many plans; 0 counts as 1. With [`Objective::Margin`] further plans have
    /// the best margin too, with [`Objective::Moves`] the required one.
    pub plans: usize,
    /// Time to stop after; plans in the middle of a check finish it.
    pub time_limit: Option<Duration>,
    /// Expansions to stop after.
    pub max_expansions: Option<u64>,
    /// Approximate memory of the search in bytes to stop at.
    pub max_bytes: Option<usize>,
    /// Set it from any thread to stop.
    pub cancel: Option<Arc<AtomicBool>>,
    /// Plan by geometry and connectedness alone, for comparison.
    pub ignore_stability: bool,
    /// What the search goes by.
    pub reduction: Reduction,
}

/// What a caller sees of a running search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// The search itself; widths are margins, costs are moves.
    pub progress: Progress,
    /// Structures that the oracle has assessed.
    pub oracle_solves: u64,
}

/// Plans how to get from `start` to `goal` with every transient state proved stable.
/// What the start requires holds for the whole plan; what the goal requires is not looked at.
///
/// # Guarantees
/// - Every plan returned has been proved stable in all sampled transient states, with
///   at least the required margin.
/// - [`Outcome::Solved`]: no plan of this action set is better, by more than [`MARGIN_TOLERANCE`].
/// - [`Outcome::Impossible`]: there is no plan in this action set.
/// - The result depends neither on threads nor on time, unless a time limit or a
///   cancellation ended the search.
///
/// # Errors
/// [`Refusal`] for bad input.
pub fn solve(
    start: &Configuration,
    goal: &Goal,
    options: &Options,
    on_event: &mut dyn FnMut(&Event),
) -> Result<Report, Refusal> {
    let began = Instant::now();
    let required = options.min_margin.map_or(start.require.margin, |least| least.max(start.require.margin));
    let required = (!options.ignore_stability).then_some(required);
    let problem = match Problem::new(start, goal) {
        Ok(problem) => problem,
        Err(Rejection::Refused(refusal)) => return Err(refusal),
        Err(Rejection::Impossible(reason)) => return Ok(impossible(options, required, reason)),
    };
    let domain = Domain::new(&problem, !options.ignore_stability);
    let ends = Ends::new(&domain);
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    let mut report = match ends.reason(&domain, goal, required) {
        Some(reason) => impossible(options, required, reason),
        None => match options.reduction {
            Reduction::Saturated => {
                let space = Saturated::new(&domain, ends.start_width(), ends.at_most());
                let steps = |path: &[saturated::Action]| expand(&problem, path);
                Task { domain: &domain, options, required, began }.run(&space, steps, on_event)
            }
            Reduction::Primitive => {
                let space = Primitive::new(&domain, ends.start_width(), ends.at_most());
                Task { domain: &domain, options, required, began }.run(&space, <[Step]>::to_vec, on_event)
            }
        },
    };
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    report.statistics.oracle_solves = domain.oracle.solves();
    report.statistics.seconds = began.elapsed().as_secs_f64();
    Ok(report)
}

/// The two ends of every plan.
struct Ends {
    start: Option<Worst>,
    goal: Option<Worst>,
}

impl Ends {
    fn new(domain: &Domain) -> Self {
        let problem = domain.problem;
        let start = domain.stability.then(|| domain.of_state(problem.start_layout(), problem.start_bonds()));
        // Elsewhere the goal's margin is not quite that of the goal as it is written, and
        // it leaves open how loaded modules are turned.
        let is_known = !problem.goal().is_free() && !problem.turns();
        let goal = problem.goal();
        let goal = (domain.stability && is_known).then(|| domain.of_state(goal.layout(), goal.listed()));
        Self { start, goal }
    }

    fn start_width(&self) -> Width {
        self.start.map_or(Width::UNLIMITED, |worst| width(worst.margin))
    }

    /// No plan has a larger margin.
    fn at_most(&self) -> f64 {
        let uppers = [self.start, self.goal].into_iter().flatten().map(|worst| worst.margin.upper);
        uppers.fold(f64::INFINITY, f64::min)
    }

    /// Why the ends alone rule out every plan, if they do.
    fn reason(&self, domain: &Domain, goal: &Goal, required: Option<f64>) -> Option<Impossible> {
        let problem = domain.problem;
        let ends = [
            (Which::Start, problem.start_layout(), problem.start_bonds(), self.start, problem.start()),
            (Which::Goal, problem.goal().layout(), problem.goal().listed(), self.goal, &goal.configuration),
        ];
        ends.into_iter().find_map(|(which, layout, bonds, worst, configuration)| {
            if !domain.is_connected(layout, bonds) {
                return Some(Impossible::Disconnected(which));
            }
            let (worst, required) = (worst?, required?);
            let Bracket { upper, .. } = worst.margin;
            (upper < required || upper == f64::NEG_INFINITY).then(|| Impossible::Unstable {
                which,
                margin: worst.margin,
                required,
                connection: worst.weakest.and_then(|seam| ports(configuration, seam)),
            })
        })
    }
}

/// One search.
struct Task<'a> {
    domain: &'a Domain<'a>,
    options: &'a Options,
    required: Option<f64>,
    began: Instant,
}

impl Task<'_> {
    /// Searches a space whose paths `steps` translates.
    fn run<S: Space>(
        &self,
        space: &S,
        steps: impl Fn(&[S::Action]) -> Vec<Step>,
        on_event: &mut dyn FnMut(&Event),
    ) -> Report {
        let floor = self.required.unwrap_or(f64::NEG_INFINITY);
        let mut on_progress = |progress: &Progress| {
            on_event(&Event { progress: *progress, oracle_solves: self.domain.oracle.solves() });
        };
        let mut search = Search::new(space, self.search_options()).on_progress(&mut on_progress);
        let outcome = match self.options.objective {
            Objective::Margin => best_margin(&mut search, floor),
            Objective::Moves => search.shortest(floor),
        };
        let actions = |path: &planners::Path<S::State, S::Action>| -> Vec<Step> {
            steps(&path.steps.iter().map(|step| step.action.clone()).collect::<Vec<_>>())
        };
        let mut found: Vec<Vec<Step>> = outcome.best().map(&actions).into_iter().collect();
        let mut cut_by = outcome.limit();
        if let planners::Outcome::Solved { found: best, .. } = &outcome
            && self.options.plans > 1
        {
            let as_good = match self.options.objective {
                Objective::Margin => search.tie(best.width.lower).max(floor),
                Objective::Moves => floor,
            };
            let key = |path: &[S::Action]| trace(&steps(path));
            let further = search.k_best(self.options.plans, as_good, key);
            further_plans(&mut found, further.best().into_iter().flatten().map(&actions), trace);
            found.truncate(self.options.plans);
            cut_by = further.limit();
        }
        let wants_more = self.options.plans > 1 && found.len() < self.options.plans;
        let statistics = search.statistics();
        drop(search);
        let mut plans = found.iter().map(|steps| compose(self.domain, steps));
        let plan = plans.next();
        let (ending, proof) = self.conclude(&outcome, plan.as_ref());
        Report {
            outcome: ending,
            objective: self.options.objective,
            required: self.required,
            plan,
            alternatives: plans.collect(),
            alternatives_cut_by: cut_by.filter(|_| wants_more),
            proof,
            statistics: Statistics {
                expanded: statistics.expanded,
                states: statistics.states as u64,
                generated: statistics.generated,
                certified: statistics.certified,
                bytes: statistics.bytes as u64,
                ..Statistics::default()
            },
        }
    }

    fn search_options(&self) -> planners::Options {
        let budget = Budget {
            deadline: self.options.time_limit.and_then(|limit| self.began.checked_add(limit)),
            max_expansions: self.options.max_expansions,
            max_bytes: self.options.max_bytes,
            cancel: self.options.cancel.clone(),
        };
        planners::Options { tolerance: MARGIN_TOLERANCE, budget, ..planners::Options::default() }
    }

    fn conclude<P>(&self, outcome: &planners::Outcome<P>, plan: Option<&Plan>) -> (Outcome, Proof) {
        let optimal = |proof: &planners::Proof| match self.options.objective {
            Objective::Margin => proof.cost_optimal && (proof.width_optimal || !self.domain.stability),
            Objective::Moves => proof.cost_optimal,
        };
        let ending = match outcome {
            planners::Outcome::Solved { .. } => Outcome::Solved,
            planners::Outcome::Impossible => {
                let required = self.required.unwrap_or(f64::NEG_INFINITY);
                Outcome::Impossible(Impossible::Exhausted { required })
            }
            planners::Outcome::OutOfBudget { limit, .. } => Outcome::OutOfBudget(*limit),
        };
        let proof = outcome.proof().map_or(NOTHING_TO_FIND, |proof| Proof {
            optimal: plan.is_some() && optimal(proof),
            margin_at_most: proof.width_at_most,
            moves_at_least: proof.cost_at_least,
        });
        (ending, proof)
    }
}

/// The cheapest of the widest paths, with a path in hand early.
///
/// A search for the fewest moves is guided by the bound on the moves that are left, one for the
/// largest margin is not. So a path of fewest moves comes first, and then the
/// question is only whether a path is wider *by more than the tolerance*, which far
/// fewer transitions are open to. If none is, the first path is also the
/// cheapest of the widest: no path that the floor admits is cheaper.
fn best_margin<S: Space>(search: &mut Search<'_, S>, floor: f64) -> planners::Outcome<PathOf<S>> {
    let cheapest = search.shortest(floor);
    let planners::Outcome::Solved { found, proof } = cheapest else { return cheapest };
    let width = found.width.lower;
    if width >= search.tie(proof.width_at_most) {
        let proof = planners::Proof { width_optimal: true, ..proof };
        return planners::Outcome::Solved { found, proof };
    }
    let wider = width + MARGIN_TOLERANCE * width.abs().max(1.0);
    match search.margin(wider) {
        planners::Outcome::Impossible => {
            let proof = planners::Proof { width_at_most: wider, width_optimal: true, ..proof };
            planners::Outcome::Solved { found, proof }
        }
        // Brackets straddle the edge of the tolerance: the engine's own passes tell what they allow.
        planners::Outcome::OutOfBudget { limit: Limit::Precision, .. } => search.margin(floor),
        planners::Outcome::OutOfBudget { limit, best: None, proof } => {
            let proof = planners::Proof { width_optimal: false, cost_optimal: false, ..proof };
            planners::Outcome::OutOfBudget { limit, best: Some(found), proof }
        }
        better => better,
    }
}

/// What holds for all plans when there are none.
const NOTHING_TO_FIND: Proof = Proof { optimal: false, margin_at_most: f64::NEG_INFINITY, moves_at_least: u32::MAX };

/// Adds the plans that are not among those found by their key.
fn further_plans<K: Eq + Hash>(
    found: &mut Vec<Vec<Step>>,
    further: impl Iterator<Item = Vec<Step>>,
    key: impl Fn(&[Step]) -> K,
) {
    for steps in further {
        if found.iter().all(|known| key(known) != key(&steps)) {
            found.push(steps);
        }
    }
}

/// The moves of a plan, up to the order of independent ones.
fn trace(steps: &[Step]) -> Trace {
    Trace::new(steps.iter().filter_map(|step| match step {
        Step::Move(step) => Some(*step),
        Step::Attach(_) | Step::Detach(_) => None,
    }))
}

fn impossible(options: &Options, required: Option<f64>, reason: Impossible) -> Report {
    Report {
        outcome: Outcome::Impossible(reason),
        objective: options.objective,
        required,
        plan: None,
        alternatives: Vec::new(),
        alternatives_cut_by: None,
        proof: NOTHING_TO_FIND,
        statistics: Statistics::default(),
    }
}
