//! The entry for planners and schedulers: a start, a goal and what is wanted
//! in, plans with proofs out.

use std::time::Instant;

use planners::{Reversible, Shortest, Space, Width};

use crate::robot::{Configuration, FaceConnection, Goal};
use crate::statics::Bracket;

use super::action::Action;
use super::baseline::{Baseline, Blind, Eager};
use super::compose::{compose, expand, ports};
use super::domain::{Domain, width};
use super::engines::{Task, Translation};
use super::large::{self, decompose, exact_modules};
use super::open_ground::OpenGround;
use super::options::{Event, Method, Options, Reduction};
use super::oracle::Worst;
use super::plan::{Plan, Report};
use super::primitive::Primitive;
use super::problem::Problem;
use super::refusal::{Impossible, Refusal, Rejection, Which};
use super::saturated::{self, Saturated};
use super::sealed::sealed;
use super::step::Step;
use super::symmetry::Symmetry;
use super::trace::Trace;

/// Plans how to get from `start` to `goal` with every transient state proved stable.
/// What the start requires holds for the whole plan; what the goal requires is not looked at.
///
/// # Guarantees
/// - Every plan returned has been proved stable in all sampled transient states, with
///   at least the required margin.
/// - [`Outcome::Solved`](super::Outcome::Solved): no plan of this action set is better, by more than [`MARGIN_TOLERANCE`](super::MARGIN_TOLERANCE).
/// - [`Outcome::Impossible`](super::Outcome::Impossible): there is no plan in this action set.
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
        Err(Rejection::Impossible(reason)) => return Ok(Report::impossible(options.objective, required, reason)),
    };
    let domain = Domain::new(&problem, !options.ignore_stability).timed_by(options.clock);
    let domain = if options.baseline == Some(Baseline::Eager) { domain.forgetting() } else { domain };
    let ends = Ends::new(&domain);
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    let solves = || domain.oracle.solves();
    let task = Task { options, required, began, solves: &solves };
    let reason = ends.reason(&domain, goal, required).or_else(|| sealed(&problem));
    let mut report = match reason {
        Some(reason) => Report::impossible(options.objective, required, reason),
        None if is_for_decomposition(&problem, options) => {
            let ends = large::Ends { start: ends.start, goal: ends.goal };
            decompose(&domain, options, (required, ends), began, on_event)
        }
        None => match options.reduction {
            Reduction::Saturated => {
                let space = Saturated::new(&domain, ends.start_width(), ends.at_most());
                let steps = |path: &[saturated::Action]| expand(&problem, path);
                let plans = Plans { domain: &domain, steps };
                // Where it is known what the goal looks like, the search comes from there as well.
                match options.baseline {
                    None if space.goals().is_empty() => task.run(&space, &plans, on_event),
                    None if let Some(symmetry) = symmetry(&domain) => {
                        let space = OpenGround::new(&domain, space, symmetry);
                        task.run_with(&space, &plans, &|search, floor| search.from_both_ends_by_class(floor), on_event)
                    }
                    None => task.run_with(&space, &plans, &|search, floor| search.from_both_ends(floor), on_event),
                    Some(Baseline::Blind) => task.run(&Blind(&space), &plans, on_event),
                    Some(Baseline::Eager) => {
                        let steps = |path: &[(saturated::Action, [f64; 2])]| {
                            expand(&problem, &path.iter().map(|(action, _)| *action).collect::<Vec<_>>())
                        };
                        task.run(&Eager(&space), &Plans { domain: &domain, steps }, on_event)
                    }
                }
            }
            Reduction::Primitive => {
                let space = Primitive::new(&domain, ends.start_width(), ends.at_most());
                task.run(&space, &Plans { domain: &domain, steps: <[Step]>::to_vec }, on_event)
            }
        },
    };
    if is_for_decomposition(&problem, options) {
        return finished(report, &domain, began);
    }
    let space = Saturated::new(&domain, ends.start_width(), ends.at_most());
    let steps = |path: &[saturated::Action]| expand(&problem, path);
    let plans = Plans { domain: &domain, steps };
    let unmoved = |reached: &[&saturated::State]| {
        Some(problem.unmoved(&reached.iter().map(|state| state.layout()).collect::<Vec<_>>()))
    };
    report.in_the_way = match symmetry(&domain) {
        Some(symmetry) => {
            let space = OpenGround::new(&domain, space, symmetry);
            let shortest: Shortest<'_, OpenGround> = &|search, floor| search.from_both_ends_by_class(floor);
            task.in_the_way(&space, &plans, &report, shortest, &unmoved)
        }
        None => task.in_the_way(&space, &plans, &report, &|search, floor| search.shortest(floor), &unmoved),
    };
    finished(report, &domain, began)
}

/// The symmetries of a problem that leave few states of it and know its goal. What need not hold together can drift apart for ever,
/// and what need not stand can leave the ground.
fn symmetry(domain: &Domain) -> Option<Symmetry> {
    let problem = domain.problem;
    let is_finite = domain.stability && problem.must_stay_connected();
    let is_known = !problem.goal().is_free() && !problem.turns();
    Symmetry::of(problem).filter(|_| is_finite && is_known)
}

/// The report with what it took.
fn finished(mut report: Report, domain: &Domain, began: Instant) -> Result<Report, Refusal> {
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    report.statistics.oracle_solves += domain.oracle.solves();
    report.statistics.decided_by = domain.oracle.tally();
    report.statistics.oracle_seconds = domain.oracle.taken().as_secs_f64();
    report.statistics.seconds = began.elapsed().as_secs_f64();
    Ok(report)
}

/// Whether a problem is decomposed rather than searched.
fn is_for_decomposition(problem: &Problem, options: &Options) -> bool {
    match options.method {
        Method::Exact => false,
        Method::Decompose => true,
        Method::Auto => {
            let movable = problem.start().modules.iter().filter(|module| !module.fixed).count();
            movable > exact_modules(options) && options.reduction == Reduction::Saturated
        }
    }
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

/// How paths of a space of cubes become plans, by way of primitive steps.
struct Plans<'a, F> {
    domain: &'a Domain<'a>,
    steps: F,
}

impl<S: Space, F: Fn(&[S::Action]) -> Vec<Step>> Translation<S> for Plans<'_, F> {
    type Action = Action;
    type Connection = FaceConnection;
    type Key = Trace;

    /// The moves of a plan, up to the order of independent ones.
    fn key(&self, path: &[S::Action]) -> Trace {
        let steps = (self.steps)(path);
        let moves = steps.iter().filter_map(|step| match step {
            Step::Move(step) => Some(*step),
            Step::Attach(_) | Step::Detach(_) => None,
        });
        Trace::new(moves, |step| self.domain.problem.needs(step))
    }

    fn plan(&self, path: &[S::Action]) -> Plan {
        compose(self.domain, &(self.steps)(path))
    }
}
