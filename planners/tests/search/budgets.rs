//! Searches that are cut short: bounds hold, nothing is called impossible.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use planners::toy::Toy;
use planners::{Budget, Limit, Options, Outcome, Pass, Progress, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference;
use crate::sample::{Graph, blurred, exact};

fn expansions(most: u64) -> Options {
    Options { budget: Budget { max_expansions: Some(most), ..Budget::default() }, ..options() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn bounds_hold_after_any_number_of_expansions(graph in blurred(9, 24), floor in 0..6_u32) {
        let floor = f64::from(floor);
        let widest = reference::widest(&graph, |width| width.upper).filter(|&width| width >= floor);
        for most in 0..12 {
            for engine in [Search::<Graph>::widest, Search::<Graph>::shortest, Search::<Graph>::margin] {
                let outcome = engine(&mut Search::new(&graph, expansions(most)), floor);
                if let Some(path) = outcome.best() {
                    check_path(&graph, path);
                    prop_assert!(path.width.lower >= floor);
                }
                match outcome.proof() {
                    Some(proof) => {
                        prop_assert!(Some(proof.width_at_most) >= widest);
                        let least = reference::shortest(&graph, proof.floor, |width| width.upper);
                        prop_assert!(least.is_none_or(|cost| proof.cost_at_least <= cost));
                    }
                    None => prop_assert_eq!(widest, None),
                }
            }
        }
    }

    #[test]
    fn a_list_cut_short_is_a_prefix(graph in exact(6, 16), floor in 0..6_u32) {
        let floor = f64::from(floor);
        let whole = Search::new(&graph, options()).k_best(5, floor, <[u8]>::to_vec);
        let whole: &[_] = whole.solved().map_or(&[], Vec::as_slice);
        for most in 0..20 {
            let part = Search::new(&graph, expansions(most)).k_best(5, floor, <[u8]>::to_vec);
            let listed: &[_] = part.best().map_or(&[], Vec::as_slice);
            prop_assert_eq!(listed, &whole[..listed.len()]);
            if let Some(next) = whole.get(listed.len()) {
                prop_assert!(part.proof().is_some_and(|proof| proof.cost_at_least <= next.cost));
            }
        }
    }

    #[test]
    fn progress_reports_hold(graph in blurred(9, 24)) {
        let width = reference::widest(&graph, |width| width.upper);
        let mut reports = Vec::new();
        let mut report = |progress: &Progress| reports.push(*progress);
        let mut search = Search::new(&graph, Options { report_every: 1, ..options() }).on_progress(&mut report);
        let outcome = search.margin(f64::NEG_INFINITY);
        let spent = search.statistics();
        prop_assert_eq!(reports.last().map(|report| report.statistics.expanded), Some(spent.expanded));
        for report in &reports {
            prop_assert!(Some(report.width_at_most) >= width);
            prop_assert!(report.best_width.is_none_or(|best| best <= report.width_at_most));
            if let (Pass::Shortest, Some(proof)) = (report.pass, outcome.proof()) {
                let least = reference::shortest(&graph, proof.floor, |width| width.upper);
                prop_assert!(least.is_none_or(|cost| report.cost_at_least <= cost));
            }
        }
        for pair in reports.windows(2).filter(|pair| pair[0].pass == pair[1].pass) {
            prop_assert!(pair[0].width_at_most >= pair[1].width_at_most, "bounds only improve");
            prop_assert!(pair[0].cost_at_least <= pair[1].cost_at_least);
        }
    }
}

/// A long corridor: one way, `length` transitions.
fn corridor(length: usize) -> Graph {
    (0..length).fold(Toy::new(length + 1, 0, &[length]), |graph, node| graph.arc(node, node + 1, 0, 1, 1.0))
}

fn limit_of(options: Options) -> Limit {
    match Search::new(&corridor(100), options).shortest(0.0) {
        Outcome::OutOfBudget { limit, best: None, .. } => limit,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_limit_is_named() {
    let budget = |budget| Options { budget, ..options() };
    let past = Instant::now() - Duration::from_millis(1);
    assert_eq!(limit_of(budget(Budget { deadline: Some(past), ..Budget::default() })), Limit::Deadline);
    assert_eq!(limit_of(budget(Budget { max_bytes: Some(5000), ..Budget::default() })), Limit::Memory);
    assert_eq!(limit_of(expansions(50)), Limit::Expansions);
    let cancel = Some(Arc::new(AtomicBool::new(true)));
    assert_eq!(limit_of(budget(Budget { cancel, ..Budget::default() })), Limit::Cancelled);
}

#[test]
fn a_generous_budget_is_not_felt() {
    let budget = Budget {
        deadline: Some(Instant::now() + Duration::from_secs(3600)),
        max_expansions: Some(1000),
        max_bytes: Some(1_000_000),
        cancel: Some(Arc::new(AtomicBool::new(false))),
        ..Budget::default()
    };
    let graph = corridor(100);
    let mut search = Search::new(&graph, Options { budget, ..options() });
    assert_eq!(search.shortest(0.0).solved().map(|path| path.cost), Some(100));
    assert_eq!(search.statistics().expanded, 100, "the goal is not expanded");
}

#[test]
fn a_search_can_be_cancelled_from_its_progress_callback() {
    let flag = Arc::new(AtomicBool::new(false));
    let mut report = |progress: &Progress| {
        if progress.statistics.expanded >= 30 {
            flag.store(true, Ordering::Relaxed);
        }
    };
    let budget = Budget { cancel: Some(Arc::clone(&flag)), ..Budget::default() };
    let graph = corridor(100);
    let mut search = Search::new(&graph, Options { budget, report_every: 10, ..options() }).on_progress(&mut report);
    let outcome = search.widest(0.0);
    assert!(matches!(outcome, Outcome::OutOfBudget { limit: Limit::Cancelled, best: None, .. }));
    assert!((30..=40).contains(&search.statistics().expanded));
}

/// Two equally wide ways; the first pass finds the dear one, since its end is nearer.
#[test]
fn the_first_pass_is_kept_when_the_second_is_cut_short() {
    let mut graph = Toy::new(12, 0, &[11]).arc(0, 1, 0, 50, 2.0).arc(1, 11, 0, 50, 2.0).arc(0, 2, 1, 1, 2.0);
    for node in 2..11 {
        graph = graph.arc(node, node + 1, 1, 1, 2.0);
    }
    graph.remaining = vec![Some(1); 12];
    graph.remaining[1] = Some(0);
    let whole = Search::new(&graph, options()).margin(0.0);
    assert_eq!(whole.solved().map(|path| path.cost), Some(10));
    let cut = Search::new(&graph, expansions(5)).margin(0.0);
    let Outcome::OutOfBudget { limit: Limit::Expansions, best: Some(path), proof } = cut else { panic!("{cut:?}") };
    assert_eq!((path.cost, path.width.lower), (100, 2.0));
    assert!(proof.width_optimal && !proof.cost_optimal);
    assert!(proof.cost_at_least > 1 && proof.cost_at_least <= 10);
}

#[test]
fn memory_is_accounted_for() {
    let bytes = |length| {
        let graph = corridor(length);
        let mut search = Search::new(&graph, options());
        search.shortest(0.0);
        search.statistics().bytes as f64
    };
    let ratio = bytes(4000) / bytes(1000);
    assert!((3.9..4.1).contains(&ratio), "memory grows with the states: {ratio}");
    // At least the state, its hash slot, its label and its transition.
    assert!(bytes(1000) > 1000.0 * 64.0);
}
