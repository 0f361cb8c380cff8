//! The cheapest paths against the enumeration of all of them.

use std::collections::BTreeMap;

use planners::{Limit, Outcome, Search};
use proptest::prelude::*;

use crate::optimality::{check_path, options};
use crate::reference::{self, Plan};
use crate::sample::{Graph, blurred, exact};

/// Side of a [`counters`] graph.
const SIDE: usize = 4;

/// Two counters that count up on their own (actions 0 and 1 have their place in the key, up to order) from nothing to 3,
/// now and then by two at once (10 and 11), and by jumps of both that depend on each other (20).
fn counters() -> impl Strategy<Value = Graph> {
    let draws = proptest::collection::vec((0..5_u32, 1..7_u32), 5 * SIDE * SIDE);
    draws.prop_map(|draws| {
        let mut graph = planners::toy::Toy::new(SIDE * SIDE, 0, &[SIDE * SIDE - 1]);
        let steps = [(1, 0, 0_u8), (0, 1, 1), (2, 0, 10), (0, 2, 11), (1, 1, 20)];
        let all = (0..SIDE * SIDE).flat_map(|from| steps.map(|step| (from, step)));
        for ((from, (right, up, action)), (chance, width)) in all.zip(draws) {
            let (x, y) = (from % SIDE + right, from / SIDE + up);
            // Steps by one are always there, as independent actions are; the others here and there.
            if x < SIDE && y < SIDE && (action < 10 || chance == 0) {
                let width = if action < 10 { 4.0 } else { f64::from(width) };
                graph = graph.arc(from, y * SIDE + x, action, (right + up) as u32, width);
            }
        }
        graph
    })
}

/// The actions, those of the second counter before those of the first wherever they are next to each other.
fn normal(actions: &[u8]) -> Vec<u8> {
    let mut runs: Vec<Vec<u8>> = Vec::new();
    for run in actions.split_inclusive(|&action| action == 20) {
        let mut run = run.to_vec();
        run.sort_by_key(|action| (*action == 20, action % 10));
        runs.push(run);
    }
    runs.concat()
}

/// Two runs of so many independent actions.
#[test]
fn orders_are_not_gone_through_one_by_one() {
    let side = 9;
    let mut graph = planners::toy::Toy::new(side * side + 1, 0, &[side * side - 1]);
    for from in 0..side * side {
        let (x, y) = (from % side, from / side);
        if x + 1 < side {
            graph = graph.arc(from, from + 1, 0, 1, 1.0);
        }
        if y + 1 < side {
            graph = graph.arc(from, from + side, 1, 1, 1.0);
        }
    }
    // The second plan: 12870 orders of the first cost less.
    graph = graph.arc(0, side * side, 20, 17, 1.0).arc(side * side, side * side - 1, 20, 1, 1.0);
    let mut search = Search::new(&graph, options());
    let outcome = search.k_best(3, 0.5, normal);
    let costs: Vec<u32> = outcome.solved().unwrap().iter().map(|path| path.cost).collect();
    assert_eq!(costs, [16, 18], "there are two plans");
    assert!(search.statistics().expanded < 20_000, "{}", search.statistics().expanded);
}

/// Once the first plan is known, nothing but a corridor leads on from its middle. In earnest such a corridor may have no end.
#[test]
fn parts_without_a_plan_are_not_gone_through() {
    let (length, goal) = (10_000, 3);
    let mut graph = planners::toy::Toy::new(length, 0, &[goal]);
    graph = graph.arc(0, 1, 0, 1, 1.0).arc(1, goal, 0, 1, 1.0).arc(0, 2, 1, 1, 1.0).arc(2, goal, 1, 4, 1.0);
    graph = graph.arc(1, 4, 2, 1, 1.0);
    for node in 4..length - 1 {
        graph = graph.arc(node, node + 1, 2, 1, 1.0);
    }
    let mut search = Search::new(&graph, options());
    let outcome = search.k_best(2, 0.5, <[u8]>::to_vec);
    let costs: Vec<u32> = outcome.solved().unwrap().iter().map(|path| path.cost).collect();
    assert_eq!(costs, [2, 5]);
    assert!(search.statistics().expanded < 50, "{}", search.statistics().expanded);
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
        // Actions that are all different tell all paths apart.
        let mut named = graph.clone();
        named.arcs.iter_mut().flatten().zip(0..).for_each(|(arc, name)| arc.action = name);
        let mut costs: Vec<u32> = plans.iter().map(|plan| plan.cost).collect();
        costs.sort_unstable();
        check(&named, k, floor, <[u8]>::to_vec, &costs);
        check(&graph, k, floor, <[u8]>::to_vec, &least_costs(&plans, |plan| plan.actions.clone()));
    }

    #[test]
    fn orders_of_independent_actions_are_one_plan(grid in counters(), k in 1..8_usize, floor in 0..4_u32) {
        let floor = f64::from(floor);
        let truth = least_costs(&reference::all_paths(&grid, floor), |plan| normal(&plan.actions));
        check(&grid, k, floor, normal, &truth);
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
