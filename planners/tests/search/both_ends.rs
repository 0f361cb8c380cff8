//! The search from both ends agrees with the one from the start, and with Dijkstra.

use planners::{Outcome, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, check_shortest, options};
use crate::reference;
use crate::sample::{blurred, exact};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn both_ends_agree_with_dijkstra(graph in exact(9, 24), floor in 0..12_u32) {
        let floor = f64::from(floor);
        check_shortest(&graph, floor, Search::new(&graph, options()).from_both_ends(floor))?;
    }

    #[test]
    fn intervals_prove_no_more_than_they_hold(graph in blurred(9, 24), floor in 0..12_u32) {
        let floor = f64::from(floor);
        let surely = reference::shortest(&graph, floor, |width| width.lower);
        let maybe = reference::shortest(&graph, floor, |width| width.upper);
        match Search::new(&graph, options()).from_both_ends(floor) {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert_eq!(Some(found.cost), surely);
                prop_assert!(maybe.is_some_and(|maybe| proof.cost_at_least <= maybe));
            }
            Outcome::Impossible => prop_assert_eq!(maybe, None),
            // A transition that could not be decided may lead nowhere.
            Outcome::OutOfBudget { best, proof, .. } => {
                prop_assert!(maybe.is_none_or(|maybe| proof.cost_at_least <= maybe));
                prop_assert_eq!(best.map(|path| path.cost), surely);
            }
        }
    }

    #[test]
    fn what_follows_is_as_good_as_if_it_had_not_been_searched(graph in exact(9, 24), floor in 0..12_u32) {
        let floor = f64::from(floor);
        let mut search = Search::new(&graph, options());
        let both = search.from_both_ends(floor);
        prop_assert_eq!(both.solved().map(|path| path.cost), search.shortest(floor).solved().map(|path| path.cost));
        // Of paths that are equally good either may come.
        let (after, alone) = (search.margin(floor), Search::new(&graph, options()).margin(floor));
        prop_assert_eq!(after.best().map(|path| (path.cost, path.width)), alone.best().map(|path| (path.cost, path.width)));
        prop_assert_eq!(after.proof(), alone.proof());
    }

    #[test]
    fn finding_nothing_bounds_all_widths(graph in blurred(9, 24), floor in 0..12_u32) {
        let widest = reference::widest(&graph, |width| width.upper);
        if let Outcome::OutOfBudget { best: None, proof, .. } = Search::new(&graph, options()).from_both_ends(f64::from(floor)) {
            prop_assert!(widest.is_none_or(|widest| widest <= proof.width_at_most));
        }
    }
}
