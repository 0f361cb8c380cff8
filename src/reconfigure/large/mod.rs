//! Plans for robots of hundreds of modules, far beyond exact search: one module after another leaves where it is
//! not wanted, walks over the others, and stays where one is wanted.
//!
//! - `journey` says from where to where: from the start to the goal, or back, since every move reverses;
//! - `shape` says which modules are where none is wanted, and which cells must stay open to the outside;
//! - `order` says in which order to free and to fill cells, and learns from dead ends;
//! - `walk` finds where one module can get to, by moves whose own margins (`ways`) are large enough;
//! - `builder` chooses the module and its place, asks whether the others carry the walk
//!   ([`hanging`](super::hanging)), uncovers what is buried, and undoes carries on dead ends;
//! - `levels` says which margins to try for, and `effort` how much work each is worth;
//! - `found` keeps the plans that are wanted;
//! - `script` turns carries into a plan with what was proved of every action.
//!
//! Every transient state of the plan is proved to have the margin that the plan claims. Nothing is proved about
//! other plans but what start and goal alone say. Modules that carry loads of their own stay where they are.

mod builder;
#[cfg(test)]
mod dead_end_tests;
mod effort;
mod found;
mod journey;
mod levels;
mod order;
mod script;
mod shape;
mod walk;
mod ways;

use std::sync::atomic::Ordering;
use std::time::Instant;

use planners::Limit;

use super::domain::Domain;
use super::engines::budget;
use super::hanging::Rests;
use super::in_the_way::{InTheWay, Nearest};
use super::options::{Event, Known, News, Options, Pass};
use super::plan::{Objective, Outcome, Plan, Proof, Report, Statistics};
use crate::statics::Bracket;
use builder::{Attempt, Builder};
use effort::Effort;
use found::Found;
use journey::{Direction, Journey};
use levels::Levels;
use order::{First, Lessons, Order};
pub use script::Ends;
use script::write;
pub use ways::{Ways, shift};

/// Most modules for which all is searched unless asked otherwise, where the margin counts first. On random pairs of 8 cubes
/// the exact search proved one of five margins in ten seconds; of 12 and 16 it found plans by then whose margins were
/// below those that the decomposition found in one (0.06 against 0.50, 0.47 against 0.52, 0.02 against 0.58).
const EXACT_FOR_MARGIN: usize = 8;

/// The same where moves count: of pairs of 12 that differ in four, the exact search proved three of four in a second. A
/// decomposition does not look for short plans.
const EXACT_FOR_MOVES: usize = 12;

/// Most modules for which all is searched unless asked otherwise.
pub fn exact_modules(options: &Options) -> usize {
    let by_margin = options.objective == Objective::Margin && !options.ignore_stability;
    if by_margin { EXACT_FOR_MARGIN } else { EXACT_FOR_MOVES }
}

/// In which way modules are carried, and what counts first.
type Manner = (Direction, First);

/// One attempt at one margin.
#[derive(Clone, Copy)]
struct Try {
    manner: Manner,
    /// Dead ends that are put up with.
    patience: usize,
    /// Work that it may take before there is a plan, for every module that is not in place.
    effort: u64,
}

/// Attempts at the required margin, each with another seed: both ways in turn, then both in the other order with more patience.
fn at_required(natural: First) -> [Try; 4] {
    let attempt =
        |manner: Manner, times: u32| Try { manner, patience: 10 * times as usize, effort: 400 * u64::from(times) };
    let (on, back, other) = (Direction::Forwards, Direction::Backwards, natural.other());
    [attempt((on, natural), 1), attempt((back, natural), 1), attempt((on, other), 3), attempt((back, other), 3)]
}

/// Attempts at a larger margin: in the manner that led to plans, and in the other order.
fn at_larger((direction, first): Manner) -> [Try; 2] {
    [first, first.other()].map(|first| Try { manner: (direction, first), patience: 4, effort: 75 })
}

/// Decomposes a problem whose start and goal are known to be connected and stable enough.
pub fn decompose(
    domain: &Domain,
    options: &Options,
    (required, ends): (Option<f64>, Ends),
    began: Instant,
    on_event: &mut dyn FnMut(&Event),
) -> Report {
    let problem = domain.problem;
    let goal = problem.goal().placed_best(problem.start_layout());
    let journeys = Journey::both(problem, &goal);
    let surplus = shape::surplus(problem.start_layout(), &shape::targets(&goal)).len();
    let mut ways = Ways::new(domain);
    let mut rests = Rests::new(problem.start());
    let budget = budget(options, began);
    // Every module that is not where the goal wants one moves at least once. In a free frame others might stay.
    let fewest = if problem.goal().is_free() { 0 } else { u32::try_from(surplus).unwrap_or(u32::MAX) };
    let mut effort = Effort::new(surplus);
    let needs = |step| problem.needs(step);
    let mut plans = Found::new(options, &needs);
    let mut nearest: Option<Nearest> = None;
    let mut stopped = None;
    let mut statistics = Statistics::default();
    let asked = rests.counter();
    let known = |plan: Option<&Plan>, expanded: u64| Known {
        pass: Pass::Greedy,
        margin: plan.and_then(|plan| plan.margin).map(|margin| margin.lower),
        moves: plan.map(|plan| plan.moves),
        margin_at_most: ends.at_most(),
        moves_at_least: fewest,
        statistics: planners::Statistics { expanded, ..planners::Statistics::default() },
        oracle_solves: domain.oracle.solves() + asked.load(Ordering::Relaxed),
    };
    let mut levels = Levels::new(domain, required, ends.at_most());
    let at_required = at_required(First::natural(&problem.start().environment));
    let mut manner = at_required[0].manner;
    while let Some(floor) = levels.next(&ways) {
        let larger = at_larger(manner);
        let tries = if levels.is_required() { &at_required[..] } else { &larger };
        let mut is_attained = false;
        // What one way found, the other one uses.
        let mut lessons = Lessons::default();
        for (attempt, Try { manner: tried, patience, effort: each }) in (0..).zip(tries.iter().copied()) {
            let (way, first) = tried;
            let Some(journey) = journeys.iter().find(|journey| journey.direction == way) else { continue };
            let order = Order::new(first, &problem.start().gravity, options.seed.wrapping_add(attempt));
            let Some(limit) = effort.limit(each) else { break };
            let mut work = 0;
            let mut watch = |done: u64| {
                work = done;
                if work > limit {
                    return false;
                }
                statistics.expanded += 1;
                on_event(&Event { news: News::Progress, known: known(plans.best(), statistics.expanded) });
                let bytes = options.measure_bytes.and_then(|measure| measure()).unwrap_or(0);
                statistics.bytes = statistics.bytes.max(bytes as u64);
                let expanded = statistics.expanded;
                stopped = budget.exceeded(&planners::Statistics { expanded, bytes, ..planners::Statistics::default() });
                stopped.is_none()
            };
            let mut own = lessons.seen(way);
            let builder = Builder::new(domain, journey, &mut own, (floor, order), patience);
            let found = builder.run(&mut ways, &mut rests, &mut watch);
            lessons = own.seen(way);
            effort.note(work, matches!(found, Attempt::Done(_)));
            match found {
                Attempt::Done(carries) => {
                    is_attained = true;
                    if manner != tried {
                        manner = tried;
                        levels.reopen();
                    }
                    let written = write(domain, &mut ways, &carries, &ends);
                    let moves = carries.iter().flat_map(|carry| carry.path.iter().copied()).collect();
                    let is_enough = |margin: Bracket| required.is_none_or(|required| margin.lower >= required);
                    if written.margin.is_none_or(is_enough) && plans.add(written.clone(), moves) {
                        let news = News::Plan(written);
                        on_event(&Event { news, known: known(plans.best(), statistics.expanded) });
                    }
                }
                // How close it came to the start says nothing of what is in the way.
                Attempt::Stopped(_) | Attempt::Stuck(_) if way == Direction::Backwards => {}
                Attempt::Stopped(reached) | Attempt::Stuck(reached) => {
                    nearest = nearest.into_iter().chain([reached]).max_by_key(|nearest| nearest.in_place);
                }
            }
            if is_attained || stopped.is_some() {
                break;
            }
        }
        levels.note(is_attained);
        if effort.limit(0).is_none() || stopped.is_some() {
            break;
        }
    }
    statistics.oracle_solves = rests.solves();
    let nearest = nearest.filter(|_| options.explain && plans.best().is_none());
    let in_the_way = nearest
        .map(|nearest| InTheWay::of_decomposition(nearest, ends.at_most(), required.unwrap_or(f64::NEG_INFINITY)));
    let ended_by = stopped.unwrap_or(Limit::Incomplete);
    let is_cut = plans.best().is_some() && !plans.is_enough();
    let (plan, alternatives) = plans.into_plans();
    Report {
        outcome: Outcome::OutOfBudget(ended_by),
        objective: options.objective,
        required,
        plan,
        alternatives,
        alternatives_cut_by: is_cut.then_some(ended_by),
        in_the_way,
        proof: Proof { optimal: false, margin_at_most: ends.at_most(), moves_at_least: fewest },
        statistics,
    }
}
