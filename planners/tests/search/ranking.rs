//! The front of width against cost, and rankings by width and cost, against the enumeration of all paths.

use planners::{Budget, Outcome, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference;
use crate::sample::{Graph, exact};

/// Width and cost.
type Worth = (f64, u32);

/// Actions that are all different tell all paths apart.
fn named(mut graph: Graph) -> Graph {
    graph.arcs.iter_mut().flatten().zip(0..).for_each(|(arc, name)| arc.action = name);
    graph
}

/// What every simple path is worth, by the lower ends of widths.
fn all(graph: &Graph, floor: f64) -> Vec<Worth> {
    let named = named(graph.clone());
    let width = |name: u8| named.arcs.iter().flatten().find(|arc| arc.action == name).unwrap().width.lower;
    let paths = reference::all_paths(&named, floor);
    let worth = |plan: &reference::Plan| {
        (plan.actions.iter().map(|&name| width(name)).fold(f64::INFINITY, f64::min), plan.cost)
    };
    paths.iter().map(worth).collect()
}

/// Those that no other beats, cheapest first.
fn front(all: &[Worth]) -> Vec<Worth> {
    let beats = |a: &Worth, b: &Worth| a.0 >= b.0 && a.1 <= b.1 && a != b;
    let mut front: Vec<Worth> = all.iter().filter(|b| !all.iter().any(|a| beats(a, b))).copied().collect();
    front.sort_by_key(|worth| worth.1);
    front.dedup();
    front
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_front_is_complete_and_nothing_on_it_is_beaten(graph in exact(7, 18), floor in 0..6_u32) {
        let floor = f64::from(floor);
        let truth = front(&all(&graph, floor));
        match Search::new(&graph, options()).pareto(floor, &|search, floor| search.shortest(floor), &mut |_| {}) {
            Outcome::Solved { found, .. } => {
                found.iter().for_each(|path| check_path(&graph, path));
                let worths: Vec<Worth> = found.iter().map(|path| (path.width.lower, path.cost)).collect();
                prop_assert_eq!(worths, truth);
            }
            Outcome::Impossible => prop_assert_eq!(truth, []),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    #[test]
    fn a_front_cut_short_says_what_may_be_missing(graph in exact(9, 30), floor in 0..6_u32, most in 0..30_u64) {
        let floor = f64::from(floor);
        let budget = Budget { max_expansions: Some(most), ..Budget::default() };
        let options = planners::Options { budget, ..options() };
        let outcome = Search::new(&graph, options).pareto(floor, &|search, floor| search.shortest(floor), &mut |_| {});
        let found: Vec<Worth> =
            outcome.best().into_iter().flatten().map(|path| (path.width.lower, path.cost)).collect();
        for pair in found.windows(2) {
            prop_assert!(pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1);
        }
        for (width, cost) in all(&graph, floor) {
            let is_matched = found.iter().any(|other| other.0 >= width && other.1 <= cost);
            let is_open = outcome.proof().is_some_and(|proof| {
                outcome.solved().is_none() && width <= proof.width_at_most && cost >= proof.cost_at_least
            });
            prop_assert!(is_matched || is_open, "{width} for {cost} is ruled out: {outcome:?}");
        }
    }

    #[test]
    fn rankings_agree_with_enumeration(graph in exact(6, 16), k in 1..12_usize, floor in 0..6_u32) {
        let floor = f64::from(floor);
        let graph = named(graph);
        let mut truth = all(&graph, floor);
        truth.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut search = Search::new(&graph, options());
        let Some(best) = search.margin(floor).solved().cloned() else {
            prop_assert_eq!(truth, []);
            return Ok(());
        };
        match search.ranked(k, floor, best.width.lower, <[u8]>::to_vec) {
            Outcome::Solved { found, .. } => {
                found.iter().for_each(|path| check_path(&graph, path));
                let worths: Vec<Worth> = found.iter().map(|path| (path.width.lower, path.cost)).collect();
                prop_assert_eq!(&worths, &truth[..k.min(truth.len())]);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }
}
