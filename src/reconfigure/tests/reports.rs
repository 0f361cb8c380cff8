//! What a report says: further plans, limits, progress, and the same for any number of threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use crate::reconfigure::moves::Move;
use crate::reconfigure::plan::{Limit, Objective, Outcome, Plan};
use crate::reconfigure::replay::replay;
use crate::reconfigure::trace::Trace;
use crate::reconfigure::{Event, News, Options, solve};
use crate::robot::{Cell, Face};

use super::{cubes, goal, plan, solved, tower_to_row};

#[test]
fn plans_do_not_depend_on_the_number_of_threads() {
    let (start, target) = tower_to_row();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut report = pool.install(|| plan(&start, &target, &Options { plans: 3, ..Options::default() }));
        report.statistics.seconds = 0.0;
        report
    };
    let one = with(1);
    solved(&one);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}

#[test]
fn further_plans_differ_in_more_than_the_order_of_independent_moves() {
    // Two cubes, far apart on a held bar, each move one step: one plan, in two orders.
    let bar: Vec<Cell> = (0..8).map(|x| [x, 0, 0]).collect();
    let with = |ends: [Cell; 2]| cubes(&[&bar[..], &ends].concat(), 8);
    let (start, target) = (with([[0, 0, 1], [7, 0, 1]]), goal(with([[1, 0, 1], [6, 0, 1]])));
    let options = Options { objective: Objective::Moves, plans: 2, max_expansions: Some(60), ..Options::default() };
    let report = solve(&start, &target, &options, &mut |_| {}).unwrap();
    let best = report.plan.as_ref().unwrap();
    assert_eq!(best.moves, 2);
    for other in &report.alternatives {
        assert!(replay(&start, &target, other, 0.0).unwrap().is_verified());
        let moved = |plan: &Plan| {
            let mut moves: Vec<_> = plan.actions.iter().filter(|p| p.action.is_move()).map(|p| p.action).collect();
            moves.sort_by_key(|action| format!("{action:?}"));
            moves
        };
        assert_ne!(moved(best), moved(other), "the same moves in another order");
    }
}

#[test]
fn a_report_says_when_further_plans_were_not_looked_for_to_the_end() {
    let (start, target) = tower_to_row();
    let of = |max_expansions| {
        let options = Options { objective: Objective::Moves, plans: 1000, max_expansions, ..Options::default() };
        plan(&start, &target, &options)
    };
    let best = solve(&start, &target, &Options { objective: Objective::Moves, ..Options::default() }, &mut |_| {});
    let best = best.unwrap();
    assert_eq!(best.alternatives_cut_by, None, "one plan was asked for, and there it is");
    let cut = of(Some(best.statistics.expanded + 5));
    assert_eq!(cut.plan, best.plan);
    assert!(cut.alternatives.len() < 999);
    assert_eq!((cut.outcome, cut.alternatives_cut_by), (Outcome::Solved, Some(Limit::Expansions)));
}

#[test]
fn limits_and_cancellation_end_the_search_honestly() {
    let (start, target) = tower_to_row();
    let few = plan(&start, &target, &Options { max_expansions: Some(1), ..Options::default() });
    assert_eq!(few.outcome, Outcome::OutOfBudget(Limit::Expansions));
    assert!(!few.proof.optimal && few.proof.margin_at_most > 0.0);
    let cancel = Arc::new(AtomicBool::new(false));
    cancel.store(true, Ordering::Relaxed);
    let cancelled = plan(&start, &target, &Options { cancel: Some(cancel), ..Options::default() });
    assert_eq!(cancelled.outcome, Outcome::OutOfBudget(Limit::Cancelled));
}

#[test]
fn events_tell_better_and_better_plans_and_tighter_and_tighter_bounds() {
    let (start, target) = tower_to_row();
    for objective in [Objective::Margin, Objective::Moves] {
        let mut events: Vec<Event> = Vec::new();
        let options = Options { objective, ..Options::default() };
        let report = solve(&start, &target, &options, &mut |event| events.push(event.clone())).unwrap();
        for pair in events.windows(2) {
            let [before, after] = [pair[0].known, pair[1].known];
            assert!(before.oracle_solves <= after.oracle_solves);
            assert!(before.margin_at_most >= after.margin_at_most && before.moves_at_least <= after.moves_at_least);
            let is_tighter =
                before.margin_at_most > after.margin_at_most || before.moves_at_least < after.moves_at_least;
            assert!(is_tighter || pair[1].news != News::Bound, "a bound that is none");
        }
        let mut plans = Vec::new();
        for event in &events {
            if let News::Plan(plan) = &event.news {
                assert!(replay(&start, &target, plan, 0.0).unwrap().is_verified());
                assert_eq!((event.known.margin, event.known.moves), (plan.margin.map(|m| m.lower), Some(plan.moves)));
                plans.push(plan);
            }
        }
        let best = solved(&report);
        assert_eq!(plans.last(), Some(&best), "the best plan is the last that was told");
        let last = events.last().unwrap().known;
        assert!(last.margin_at_most >= best.margin.unwrap().lower && last.moves_at_least <= best.moves);
    }
}

#[test]
fn a_search_stops_below_its_memory_limit_with_what_it_has() {
    let (start, target) = tower_to_row();
    let whole = plan(&start, &target, &Options::default());
    let limit = whole.statistics.bytes as usize / 2;
    let cut = plan(&start, &target, &Options { max_bytes: Some(limit), ..Options::default() });
    assert_eq!(cut.outcome, Outcome::OutOfBudget(Limit::Memory));
    assert!(cut.statistics.bytes as usize <= limit, "{} of {limit}", cut.statistics.bytes);
    assert!(cut.proof.margin_at_most >= solved(&whole).margin.unwrap().lower);
    // What the caller measures counts, whatever was counted.
    let measured = Options { max_bytes: Some(1 << 40), measure_bytes: Some(|| Some(1 << 41)), ..Options::default() };
    assert_eq!(plan(&start, &target, &measured).outcome, Outcome::OutOfBudget(Limit::Memory));
}

#[test]
fn a_trace_forgets_the_order_of_independent_moves_only() {
    let slide = |from, direction: Face| Move {
        from,
        motion: crate::robot::Motion::Translation { by: direction.step() },
        kind: 0,
    };
    let trace = |moves: &[Move]| Trace::new(moves.iter().copied(), |_| Vec::new());
    let (near, far) = (slide([0, 0, 1], Face::PosX), slide([7, 0, 1], Face::NegX));
    let next = slide([1, 0, 1], Face::PosX);
    assert_eq!(trace(&[near, far]), trace(&[far, near]));
    assert_eq!(trace(&[near, next, far]), trace(&[far, near, next]));
    assert_ne!(trace(&[near, next]), trace(&[next, near]));
}

/// A clock that ticks when it is looked at: what the time is changes nothing but what was measured.
#[test]
fn the_oracle_is_timed_by_the_clock_that_is_given() {
    static LOOKS: AtomicU64 = AtomicU64::new(0);
    let clock: fn() -> Duration = || Duration::from_secs(LOOKS.fetch_add(1, Ordering::Relaxed));
    let (start, goal) = tower_to_row();
    let options = Options { objective: Objective::Moves, ..Options::default() };
    let untimed = plan(&start, &goal, &options);
    let timed = plan(&start, &goal, &Options { clock: Some(clock), ..options });
    assert_eq!(untimed.statistics.oracle_seconds, 0.0);
    assert_eq!(2.0 * timed.statistics.oracle_seconds, LOOKS.load(Ordering::Relaxed) as f64);
    assert_eq!(timed.plan, untimed.plan);
}
