//! The entry for linkages: a start, a goal and what is wanted in, plans with proofs out.

use std::time::Instant;

use planners::Width;

use crate::reconfigure::engines::{Task, Translation};
use crate::reconfigure::options::{Event, Method, Options, Reduction};
use crate::reconfigure::plan::{Plan, Report};
use crate::reconfigure::refusal::{Impossible, Refusal, Rejection, Which};
use crate::reconfigure::worst::Worst;
use crate::robot::linkage::{Goal, Linkage};

use super::action::Action;
use super::arrangement::{Arrangement, Frame};
use super::assembly::Held;
use super::compose::compose;
use super::domain::{Domain, width};
use super::places::PlaceId;
use super::problem::Problem;
use super::saturated::{self, Saturated};

/// Plans how to get from `start` to `goal`, like [`solve`](crate::reconfigure::solve()) does for lattices: with the same
/// guarantees, by moves that turn one side of a joint or of a connection on a ball.
///
/// What is proved is about the goal as it is told apart here: up to the symmetries of modules, of loaded ones those that keep
/// the loads' points, and up to those turns of balls that keep their grid of directions, which are all 24 of a cube where
/// everything is turned by quarters. Other turns of a ball count, and fixed modules as they are described. The
/// [`replay`](super::replay::replay) takes a goal as met wherever masses and ports are alike, which may take fewer moves.
///
/// # Errors
/// [`Refusal`] for bad input, and for methods that only lattices have.
pub fn solve(
    start: &Linkage,
    goal: &Goal,
    options: &Options,
    on_event: &mut dyn FnMut(&Event<Action, Held>),
) -> Result<Report<Action, Held>, Refusal> {
    let began = Instant::now();
    match (options.reduction, options.method) {
        (Reduction::Primitive, _) => return Err(Refusal::LatticesOnly { what: "searches over single actions" }),
        (_, Method::Decompose) => return Err(Refusal::LatticesOnly { what: "decompositions" }),
        (Reduction::Saturated, Method::Auto | Method::Exact) => {}
    }
    let required = options.min_margin.map_or(start.require.margin, |least| least.max(start.require.margin));
    let required = (!options.ignore_stability).then_some(required);
    let problem = match Problem::new(start, goal) {
        Ok(problem) => problem,
        Err(Rejection::Refused(refusal)) => return Err(refusal),
        Err(Rejection::Impossible(reason)) => return Ok(Report::impossible(options.objective, required, reason)),
    };
    let domain = Domain::new(&problem, !options.ignore_stability);
    let ends = Ends::new(&domain);
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    let solves = || domain.oracle.solves();
    let task = Task { options, required, began, solves: &solves };
    let mut report = match ends.reason(required) {
        Some(reason) => Report::impossible(options.objective, required, reason),
        None => {
            let space = Saturated::new(&domain, ends.width(), ends.at_most());
            task.run_with(&space, &Plans(&domain), &|search, floor| search.from_both_ends(floor), on_event)
        }
    };
    let space = Saturated::new(&domain, ends.width(), ends.at_most());
    let unmoved = |reached: &[&saturated::State]| unmoved(&domain, reached);
    let plans = Plans(&domain);
    report.in_the_way = task.in_the_way(&space, &plans, &report, &|search, floor| search.shortest(floor), &unmoved);
    if let Some(fault) = domain.oracle.fault() {
        return Err(Refusal::Structure(fault));
    }
    report.statistics.oracle_solves = domain.oracle.solves();
    report.statistics.decided_by = domain.oracle.tally();
    report.statistics.seconds = began.elapsed().as_secs_f64();
    Ok(report)
}

/// The modules of the start, not fixed, whose places are taken by the like of them in all of these states; `None` where
/// places do not tell, since robots are the same anywhere.
fn unmoved(domain: &Domain, states: &[&saturated::State]) -> Option<Vec<usize>> {
    let problem = domain.problem;
    let places = domain.arrangements.of(&problem.described(&problem.start)).of_module;
    let stays = |place: &PlaceId| states.iter().all(|state| state.arrangement.0.contains(place));
    let unmoved =
        places.iter().enumerate().filter(|(module, place)| !problem.start.modules[*module].fixed && stays(place));
    (problem.frame == Frame::World).then(|| unmoved.map(|(module, _)| module).collect())
}

/// The two ends of every plan.
struct Ends {
    ends: [End; 2],
}

struct End {
    which: Which,
    is_connected: bool,
    worst: Option<Worst<Held>>,
}

impl Ends {
    fn new(domain: &Domain) -> Self {
        let problem = domain.problem;
        let start = problem.view(&problem.described(&problem.start), problem.start.connections.clone());
        let goal = problem.view(&problem.wanted(), problem.goal.connections.clone());
        let own: Vec<usize> = (0..problem.start.modules.len()).collect();
        // Those modules of the start that the goal's stand for: of each class in their order.
        let mut of_goal: Vec<usize> = (0..own.len()).collect();
        of_goal.sort_by_key(|&module| problem.wanted[module]);
        let mut slots = vec![0; own.len()];
        for (&module, &slot) in of_goal.iter().zip(&problem.slots) {
            slots[module] = slot;
        }
        let end = |which, view: &super::moves::View, slots: &[usize]| End {
            which,
            is_connected: domain.is_connected(view, &view.connections),
            worst: domain.stability.then(|| domain.oracle.of_state(view, slots, &view.connections)),
        };
        Self { ends: [end(Which::Start, &start, &own), end(Which::Goal, &goal, &slots)] }
    }

    /// Width of the start: no path is wider.
    fn width(&self) -> Width {
        self.ends[0].worst.map_or(Width::UNLIMITED, |worst| width(worst.margin))
    }

    /// No plan has a larger margin.
    fn at_most(&self) -> f64 {
        let uppers = self.ends.iter().filter_map(|end| Some(end.worst?.margin.upper));
        uppers.fold(f64::INFINITY, f64::min)
    }

    /// Why the ends alone rule out every plan, if they do.
    fn reason(&self, required: Option<f64>) -> Option<Impossible<Held>> {
        self.ends.iter().find_map(|end| {
            if !end.is_connected {
                return Some(Impossible::Disconnected(end.which));
            }
            let (worst, required) = (end.worst?, required?);
            let upper = worst.margin.upper;
            (upper < required || upper == f64::NEG_INFINITY).then_some(Impossible::Unstable {
                which: end.which,
                margin: worst.margin,
                required,
                connection: worst.weakest,
            })
        })
    }
}

/// How paths become plans.
struct Plans<'a>(&'a Domain<'a>);

impl Translation<Saturated<'_>> for Plans<'_> {
    type Action = Action;
    type Connection = Held;
    type Key = Vec<Arrangement>;

    /// The arrangements that the plan passes.
    fn key(&self, path: &[saturated::Action]) -> Vec<Arrangement> {
        path.iter().map(|action| action.to.arrangement.clone()).collect()
    }

    fn plan(&self, path: &[saturated::Action]) -> Plan<Action, Held> {
        compose(self.0, path)
    }
}
