//! Widths known only to an interval: what is proved holds for every width in it.

use planners::{Limit, Options, Outcome, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference;
use crate::sample::blurred;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn widest_ranks_by_lower_ends_and_proves_with_upper_ends(graph in blurred(8, 20), floor in prop::option::of(0..8_u32)) {
        let floor = floor.map_or(f64::NEG_INFINITY, f64::from);
        let surest = reference::widest(&graph, |width| width.lower).filter(|&width| width >= floor);
        let thinkable = reference::widest(&graph, |width| width.upper);
        let outcome = Search::new(&graph, options()).widest(floor);
        prop_assert_eq!(outcome.best().map(|path| path.width.lower), surest);
        if let Some(path) = outcome.best() {
            check_path(&graph, path);
        }
        match outcome {
            Outcome::Solved { proof, .. } => {
                prop_assert!(proof.width_optimal);
                prop_assert!(Some(proof.width_at_most) >= thinkable);
                prop_assert_eq!(thinkable, surest, "with no tolerance nothing else is proved");
            }
            Outcome::OutOfBudget { limit, best, proof } => {
                prop_assert_eq!(limit, Limit::Precision);
                prop_assert!(!proof.width_optimal);
                prop_assert!(Some(proof.width_at_most) >= thinkable);
                prop_assert!(best.is_none_or(|path| path.width.lower < proof.width_at_most));
            }
            Outcome::Impossible => prop_assert!(thinkable.is_none_or(|width| width < floor)),
        }
    }

    #[test]
    fn shortest_counts_on_lower_ends_and_proves_with_upper_ends(graph in blurred(8, 20), floor in 0..10_u32) {
        let floor = f64::from(floor);
        let surest = reference::shortest(&graph, floor, |width| width.lower);
        let thinkable = reference::shortest(&graph, floor, |width| width.upper);
        let outcome = Search::new(&graph, options()).shortest(floor);
        prop_assert_eq!(outcome.best().map(|path| path.cost), surest);
        match outcome {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert_eq!(thinkable, surest);
                prop_assert!(proof.cost_optimal);
            }
            Outcome::OutOfBudget { limit, proof, .. } => {
                prop_assert_eq!(limit, Limit::Precision);
                prop_assert!(!proof.cost_optimal);
                prop_assert!(thinkable.is_none_or(|cost| proof.cost_at_least <= cost));
            }
            Outcome::Impossible => prop_assert_eq!(thinkable, None),
        }
    }

    #[test]
    fn margin_is_within_the_tolerance(graph in blurred(8, 20), tolerance in 0.0..0.9) {
        let mut search = Search::new(&graph, Options { tolerance, ..Options::default() });
        let outcome = search.margin(f64::NEG_INFINITY);
        let thinkable = reference::widest(&graph, |width| width.upper);
        if let Some(proof) = outcome.proof() {
            prop_assert!(Some(proof.width_at_most) >= thinkable);
            let least = reference::shortest(&graph, proof.floor, |width| width.upper);
            prop_assert!(least.is_none_or(|cost| proof.cost_at_least <= cost));
            if let Some(path) = outcome.best() {
                let surest = reference::widest(&graph, |width| width.lower);
                prop_assert!(path.width.lower >= proof.floor && Some(proof.floor) <= surest);
                // Proved or not, both passes run to their end.
                let cheapest = reference::shortest(&graph, proof.floor, |width| width.lower);
                prop_assert_eq!(Some(path.cost), cheapest);
            }
        }
        match outcome {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert!(found.width.lower >= search.tie(proof.width_at_most));
                prop_assert!(proof.width_optimal && proof.cost_optimal);
            }
            Outcome::OutOfBudget { limit, best, proof } => {
                prop_assert_eq!(limit, Limit::Precision);
                prop_assert!(best.is_none() || !(proof.width_optimal && proof.cost_optimal));
            }
            Outcome::Impossible => prop_assert_eq!(thinkable, None),
        }
    }
}
