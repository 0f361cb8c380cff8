//! Ever higher floors lead to what thresholds and Dijkstra find, by either engine.

use planners::toy::Toy;
use planners::{Options, Outcome, PathOf, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference;
use crate::sample::{Graph, blurred, exact};

/// The outcome by one of the engines for cheapest paths, and the widths of the paths on the way there.
fn ascend(graph: &Graph, options: Options, floor: f64, engine: usize) -> (Outcome<PathOf<Graph>>, Vec<f64>) {
    let mut widths = Vec::new();
    let mut note = |path: &PathOf<Graph>| widths.push(path.width.lower);
    let mut search = Search::new(graph, options);
    let outcome = match engine {
        0 => search.anytime_margin(floor, &|search, floor| search.shortest(floor), &mut note),
        _ => search.anytime_margin(floor, &|search, floor| search.from_both_ends(floor), &mut note),
    };
    (outcome, widths)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_widest_and_of_those_the_cheapest_is_found(graph in exact(9, 24), floor in 0..12_u32, engine in 0..2_usize) {
        let floor = f64::from(floor);
        let width = reference::widest(&graph, |width| width.upper).filter(|&width| width >= floor);
        let truth = width.map(|width| (width, reference::shortest(&graph, width, |width| width.upper).unwrap()));
        let (outcome, widths) = ascend(&graph, options(), floor, engine);
        match outcome {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert!(widths.contains(&found.width.lower));
                prop_assert_eq!(Some((found.width.lower, found.cost)), truth);
                prop_assert_eq!(Some((proof.width_at_most, proof.cost_at_least)), truth);
                prop_assert!(proof.width_optimal && proof.cost_optimal);
            }
            Outcome::Impossible => prop_assert_eq!(truth, None),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    #[test]
    fn intervals_prove_no_more_than_they_hold(graph in blurred(9, 24), engine in 0..2_usize) {
        let floor = f64::NEG_INFINITY;
        let (surely, maybe) =
            (reference::widest(&graph, |width| width.lower), reference::widest(&graph, |width| width.upper));
        let (outcome, _) = ascend(&graph, options(), floor, engine);
        prop_assert_eq!(outcome.best().map(|path| path.width.lower), surely);
        match outcome {
            Outcome::Solved { proof, .. } | Outcome::OutOfBudget { proof, .. } => {
                prop_assert!(maybe.is_none_or(|maybe| maybe <= proof.width_at_most));
                let least = reference::shortest(&graph, proof.floor, |width| width.upper);
                prop_assert!(least.is_none_or(|least| proof.cost_at_least <= least));
            }
            Outcome::Impossible => prop_assert_eq!(maybe, None),
        }
    }

    /// Widths within the tolerance of each other count as equal, and then the cheaper path wins.
    #[test]
    fn within_the_tolerance_it_answers_as_two_passes_do(graph in exact(9, 24), engine in 0..2_usize) {
        let options = Options { tolerance: 0.3, ..Options::default() };
        let (outcome, _) = ascend(&graph, options.clone(), f64::NEG_INFINITY, engine);
        let widest = reference::widest(&graph, |width| width.upper);
        prop_assert_eq!(outcome.solved().is_some(), widest.is_some());
        if let (Outcome::Solved { found, proof }, Some(widest)) = (outcome, widest) {
            let tie = Search::new(&graph, options).tie(proof.width_at_most);
            prop_assert!(proof.width_at_most >= widest && found.width.lower >= tie);
            let as_wide = reference::shortest(&graph, proof.floor, |width| width.upper);
            prop_assert!(proof.floor <= tie.min(found.width.lower).max(f64::NEG_INFINITY));
            prop_assert_eq!(Some(found.cost), as_wide);
        }
    }
}

/// A goal that only a narrow transition leads to, from a ring of wide ones that never ends: from the start alone,
/// all of the ring would have to be searched before anything is proved.
#[test]
fn one_end_in_the_open_does_not_matter_where_the_other_is_exhausted() {
    let ring = 1000;
    let mut graph = Toy::new(ring + 1, 0, &[ring]).arc(0, ring, 9, 1, 2.0);
    for node in 0..ring {
        graph = graph.arc(node, (node + 1) % ring, 0, 1, 5.0);
    }
    let mut search = Search::new(&graph, Options::default());
    let outcome = search.anytime_margin(0.0, &|search, floor| search.from_both_ends(floor), &mut |_| {});
    assert_eq!(outcome.solved().map(|path| path.width.lower), Some(2.0));
    assert!(search.statistics().expanded < 10, "{:?}", search.statistics());
}
