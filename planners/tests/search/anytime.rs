//! Better and better paths: each is one, and the last is what the engine without them finds.

use planners::toy::{Arc, Toy};
use planners::{Budget, Limit, Options, Outcome, Path, Progress, Search, Width};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference;
use crate::sample::{Graph, blurred, exact};

type Found = Path<usize, u8>;

/// The engine with everything that it told: paths and reports.
fn run(graph: &Graph, floor: f64, options: Options) -> (Outcome<Found>, Vec<Found>, Vec<Progress>) {
    let (mut paths, mut reports) = (Vec::new(), Vec::new());
    let mut report = |progress: &Progress| reports.push(*progress);
    let mut search = Search::new(graph, Options { report_every: 1, ..options }).on_progress(&mut report);
    let mut on_path = |path: &Found| paths.push(path.clone());
    let outcome = search.anytime_margin(floor, &|search, floor| search.shortest(floor), &mut on_path);
    (outcome, paths, reports)
}

/// Every path told is one, and better than those before it; the last is the answer.
fn check_paths(graph: &Graph, floor: f64, outcome: &Outcome<Found>, paths: &[Found]) -> Result<(), TestCaseError> {
    for path in paths {
        check_path(graph, path);
        prop_assert!(path.width.lower >= floor);
    }
    for pair in paths.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        prop_assert!(b.width.lower > a.width.lower || b.cost < a.cost, "no better: {pair:?}");
    }
    if let Some(best) = outcome.best() {
        prop_assert!(paths.iter().any(|path| path == best), "the answer was not told");
        prop_assert!(paths.iter().all(|path| path.width.lower <= best.width.lower + 1e-6 || path.cost > best.cost));
    }
    Ok(())
}

/// Like a chessboard of rooms with doors of random widths to all four sides; estimates are distances.
fn rooms(side: usize, draws: &[u32]) -> Graph {
    let mut graph = Toy::new(side * side, 0, &[side * side - 1]);
    let mut draw =
        draws.iter().cycle().zip(1_u32..).map(|(d, n)| f64::from((d.wrapping_mul(n * n + 7) >> 3) % 997 + 1));
    for room in 0..side * side {
        let (x, y) = (room % side, room / side);
        let doors = [(x + 1 < side).then(|| room + 1), (y + 1 < side).then(|| room + side)];
        for (action, to) in doors.into_iter().enumerate().filter_map(|(i, to)| Some((i as u8, to?))) {
            let width = draw.next().unwrap_or(1.0);
            for (from, to, action) in [(room, to, action), (to, room, action + 2)] {
                let width = Width::exact(width);
                graph.arcs[from].push(Arc { action, to, cost: 1, width_at_most: f64::INFINITY, width });
            }
        }
        graph.remaining[room] = Some((2 * (side - 1) - x - y) as u32);
    }
    graph
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn it_ends_with_what_the_margin_engine_finds(graph in exact(9, 24), floor in 0..6_u32) {
        let floor = f64::from(floor);
        let (outcome, paths, _) = run(&graph, floor, options());
        let truth = Search::new(&graph, options()).margin(floor);
        let worth = |outcome: &Outcome<Found>| outcome.solved().map(|path| (path.width.lower, path.cost));
        prop_assert_eq!(worth(&outcome), worth(&truth));
        prop_assert_eq!(outcome == Outcome::Impossible, truth == Outcome::Impossible);
        check_paths(&graph, floor, &outcome, &paths)?;
    }

    #[test]
    fn bounds_hold_whatever_the_intervals_and_the_budget(graph in blurred(9, 24), floor in 0..6_u32, most in 0..30_u64) {
        let floor = f64::from(floor);
        let budget = Budget { max_expansions: Some(most), ..Budget::default() };
        let (outcome, paths, _) = run(&graph, floor, Options { budget, ..options() });
        check_paths(&graph, floor, &outcome, &paths)?;
        let widest = reference::widest(&graph, |width| width.upper).filter(|&width| width >= floor);
        match outcome.proof() {
            Some(proof) => {
                prop_assert!(Some(proof.width_at_most + 1e-6) >= widest);
                let least = reference::shortest(&graph, proof.floor, |width| width.upper);
                prop_assert!(least.is_none_or(|cost| proof.cost_at_least <= cost));
            }
            None => prop_assert_eq!(widest, None),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn in_large_graphs_the_gap_closes_from_both_sides(draws in proptest::collection::vec(1_u32..100_000, 40)) {
        let graph = rooms(40, &draws);
        let (outcome, paths, reports) = run(&graph, 0.0, options());
        check_paths(&graph, 0.0, &outcome, &paths)?;
        let best = outcome.solved().expect("every room can be reached");
        let truth = Search::new(&graph, options()).margin(0.0);
        prop_assert_eq!(truth.solved().map(|path| (path.width, path.cost)), Some((best.width, best.cost)));
        prop_assert!(paths.len() > 2, "attempts between the cheapest and the widest path are worth it");
        for report in &reports {
            prop_assert!(report.width_at_most >= best.width.lower);
        }
        // Cut short anywhere, it returns the last path that was told.
        for most in [1, 40, 200, 400, 800, 1600] {
            let budget = Budget { max_expansions: Some(most), ..Budget::default() };
            let (cut, told, _) = run(&graph, 0.0, Options { budget, ..options() });
            check_paths(&graph, 0.0, &cut, &told)?;
            prop_assert_eq!(cut.best().is_some(), !told.is_empty());
            prop_assert!(cut.solved().is_some() || cut.limit() == Some(Limit::Expansions));
        }
    }
}
