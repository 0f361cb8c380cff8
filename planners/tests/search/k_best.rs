//! The cheapest paths against the enumeration of all of them.

use std::collections::BTreeMap;

use planners::{Limit, Outcome, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference::{self, Plan};
use crate::sample::{Graph, blurred, exact};

fn sorted(actions: &[u8]) -> Vec<u8> {
    let mut actions = actions.to_vec();
    actions.sort_unstable();
    actions
}

/// Costs of the cheapest plan of each kind, ascending.
fn least_costs<K: Ord>(plans: &[Plan], key: impl Fn(&Plan) -> K) -> Vec<u32> {
    let mut least = BTreeMap::new();
    for plan in plans {
        let cost = least.entry(key(plan)).or_insert(plan.cost);
        *cost = plan.cost.min(*cost);
    }
    let mut costs: Vec<u32> = least.into_values().collect();
    costs.sort_unstable();
    costs
}

fn check<K: Eq + std::hash::Hash>(graph: &Graph, k: usize, floor: f64, key: impl Fn(&[u8]) -> K, truth: &[u32]) {
    match Search::new(graph, options()).k_best(k, floor, &key) {
        Outcome::Solved { found, proof } => {
            let costs: Vec<u32> = found.iter().map(|path| path.cost).collect();
            assert_eq!(costs, truth[..k.min(truth.len())]);
            assert!(proof.cost_optimal);
            assert_eq!(proof.cost_at_least, if found.len() < k { u32::MAX } else { costs[k - 1] });
            let mut keys = Vec::new();
            for path in &found {
                check_path(graph, path);
                assert!(path.width.lower >= floor);
                let actions: Vec<u8> = path.steps.iter().map(|step| step.action).collect();
                let key = key(&actions);
                assert!(!keys.contains(&key), "one plan of a kind");
                keys.push(key);
            }
        }
        Outcome::Impossible => assert!(truth.is_empty()),
        Outcome::OutOfBudget { limit, .. } => panic!("{limit:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn k_best_agrees_with_enumeration(graph in exact(6, 16), k in 1..12_usize, floor in 0..10_u32) {
        let floor = f64::from(floor);
        let plans = reference::all_paths(&graph, floor);
        // A counter as key tells all paths apart, even those with equal actions.
        let number = std::cell::Cell::new(0);
        let distinct = |_: &[u8]| number.replace(number.get() + 1);
        let mut costs: Vec<u32> = plans.iter().map(|plan| plan.cost).collect();
        costs.sort_unstable();
        let found = Search::new(&graph, options()).k_best(k, floor, distinct);
        let found: Vec<u32> = found.best().into_iter().flatten().map(|path| path.cost).collect();
        prop_assert_eq!(found, costs[..k.min(costs.len())].to_vec());
        check(&graph, k, floor, <[u8]>::to_vec, &least_costs(&plans, |plan| plan.actions.clone()));
        check(&graph, k, floor, sorted, &least_costs(&plans, |plan| sorted(&plan.actions)));
    }

    #[test]
    fn intervals_leave_an_honest_bound(graph in blurred(6, 14), k in 1..6_usize, floor in 0..8_u32) {
        let floor = f64::from(floor);
        let sure = least_costs(&reference::all_paths(&graph, floor), |plan| plan.actions.clone());
        let mut certain = graph.clone();
        certain.arcs.iter_mut().flatten().for_each(|arc| arc.width.lower = arc.width.upper);
        let thinkable = reference::all_paths(&certain, floor);
        let outcome = Search::new(&graph, options()).k_best(k, floor, <[u8]>::to_vec);
        let found: &[_] = outcome.best().map_or(&[], Vec::as_slice);
        let costs: Vec<u32> = found.iter().map(|path| path.cost).collect();
        prop_assert_eq!(&costs, &sure[..k.min(sure.len())]);
        let listed: Vec<Vec<u8>> =
            found.iter().map(|path| path.steps.iter().map(|step| step.action).collect()).collect();
        for plan in thinkable.iter().filter(|plan| !listed.contains(&plan.actions)) {
            let proof = outcome.proof();
            prop_assert!(proof.is_some_and(|proof| proof.cost_at_least <= plan.cost), "a plan was ruled out");
        }
        if let Outcome::OutOfBudget { limit, .. } = outcome {
            prop_assert_eq!(limit, Limit::Precision);
        }
    }
}
