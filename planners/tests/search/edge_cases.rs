//! Small cases, each for one reason.

use planners::toy::Toy;
use planners::{Limit, Options, Outcome, Search, Space, Transition, Width};

use crate::optimality::options;

#[test]
fn a_start_that_is_a_goal_needs_nothing() {
    let graph = Toy::new(2, 0, &[0, 1]).arc(0, 1, "on", 1, 1.0);
    let mut search = Search::new(&graph, options());
    for outcome in [search.widest(9.0), search.shortest(9.0), search.margin(9.0)] {
        let Outcome::Solved { found, proof } = outcome else { panic!("{outcome:?}") };
        assert!(found.steps.is_empty());
        assert_eq!((found.cost, found.width), (0, Width::UNLIMITED));
        assert!(proof.width_optimal && proof.cost_optimal);
    }
    let all = search.k_best(3, 0.0, <[_]>::to_vec);
    assert_eq!(all.solved().map(Vec::len), Some(1), "paths end at their first goal");
    assert_eq!(search.statistics().certified, 0);
}

#[test]
fn impossible_at_any_demand_is_not_a_way() {
    let graph = Toy::new(2, 0, &[1]).arc(0, 1, "never", 1, f64::NEG_INFINITY);
    let mut search = Search::new(&graph, options());
    assert_eq!(search.widest(f64::NEG_INFINITY), Outcome::Impossible);
    assert_eq!(search.shortest(f64::NEG_INFINITY), Outcome::Impossible);
    assert_eq!(search.margin(f64::NEG_INFINITY), Outcome::Impossible);
    assert_eq!(search.k_best(1, f64::NEG_INFINITY, <[_]>::to_vec), Outcome::Impossible);
}

#[test]
fn a_start_without_hope_is_not_expanded() {
    let mut graph = Toy::new(3, 0, &[2]).arc(0, 1, "on", 1, 1.0).arc(1, 0, "back", 1, 1.0);
    graph.remaining = vec![None, None, Some(0)];
    let mut search = Search::new(&graph, options());
    assert_eq!(search.margin(0.0), Outcome::Impossible);
    assert_eq!(search.shortest(0.0), Outcome::Impossible);
    assert_eq!(search.statistics().expanded, 0);
}

#[test]
fn widths_that_nobody_knows_prove_nothing() {
    let mut graph = Toy::new(2, 0, &[1]).arc(0, 1, "somehow", 1, 0.0);
    graph.arcs[0][0].width = Width::exact(f64::NAN);
    let mut search = Search::new(&graph, options());
    for outcome in [search.widest(0.0), search.shortest(0.0), search.margin(0.0)] {
        assert!(matches!(outcome, Outcome::OutOfBudget { limit: Limit::Precision, best: None, .. }), "{outcome:?}");
    }
}

/// The sure way is narrower than the unsure one may be.
#[test]
fn a_wide_interval_does_not_hide_a_sure_way() {
    let mut graph = Toy::new(2, 0, &[1]).arc(0, 1, "unsure", 1, 0.0).arc(0, 1, "sure", 3, 5.0);
    graph.arcs[0][0].width = Width { lower: 0.0, upper: 10.0 };
    let outcome = Search::new(&graph, options()).margin(f64::NEG_INFINITY);
    let Outcome::OutOfBudget { limit: Limit::Precision, best: Some(path), proof } = outcome else {
        panic!("{outcome:?}")
    };
    assert_eq!((path.steps[0].action, path.width.lower), ("sure", 5.0));
    assert_eq!(proof.width_at_most, 10.0);
    assert!(!proof.width_optimal && !proof.cost_optimal);
}

/// Equal margins never come out of a solver with equal digits.
#[test]
fn widths_within_the_tolerance_are_ties() {
    let mut graph = Toy::new(3, 0, &[2]).arc(0, 1, "a", 1, 1.0).arc(1, 2, "a", 1, 1.0).arc(0, 2, "b", 1, 1.0);
    graph.arcs[0][1].width = Width { lower: 1.0 - 3e-7, upper: 1.0 + 1e-7 };
    let outcome = Search::new(&graph, Options::default()).margin(0.0);
    let Outcome::Solved { found, .. } = outcome else { panic!("{outcome:?}") };
    assert_eq!(found.steps.len(), 1);
    let strict = Search::new(&graph, options()).margin(0.0);
    assert_eq!(strict.solved(), None);
    assert_eq!(strict.best().map(|path| path.steps.len()), Some(2));
}

#[test]
fn two_orders_of_one_plan_are_one_plan() {
    // A square: two independent moves in either order, or one dear diagonal.
    let graph = Toy::new(4, 0, &[3])
        .arc(0, 1, 'x', 1, 1.0)
        .arc(0, 2, 'y', 1, 1.0)
        .arc(1, 3, 'y', 1, 1.0)
        .arc(2, 3, 'x', 1, 1.0)
        .arc(0, 3, 'd', 5, 1.0);
    let plans = |same_plan: fn(&[char]) -> Vec<char>| -> Vec<String> {
        let outcome = Search::new(&graph, options()).k_best(5, 0.0, same_plan);
        let found = outcome.solved().expect("five are not there, and that is proved");
        found.iter().map(|path| path.steps.iter().map(|step| step.action).collect()).collect()
    };
    let in_any_order = |actions: &[char]| {
        let mut actions = actions.to_vec();
        actions.sort_unstable();
        actions
    };
    assert_eq!(plans(|actions| actions.to_vec()), ["xy", "yx", "d"]);
    assert_eq!(plans(in_any_order), ["xy", "d"]);
}

#[test]
fn ties_go_to_what_was_generated_first() {
    let names: Vec<usize> = (0..20).collect();
    let graph = names.iter().fold(Toy::new(2, 0, &[1]), |graph, &name| graph.arc(0, 1, name, 1, 1.0));
    let mut search = Search::new(&graph, options());
    for outcome in [search.widest(0.0), search.shortest(0.0), search.margin(0.0)] {
        assert_eq!(outcome.solved().map(|path| path.steps[0].action), Some(0));
    }
    let all = search.k_best(20, 0.0, <[_]>::to_vec);
    let listed: Vec<usize> = all.solved().unwrap().iter().map(|path| path.steps[0].action).collect();
    assert_eq!(listed, names);
}

/// An infinite line of states, each of which owns a kilobyte.
struct Line;

impl Space for Line {
    type State = i64;
    type Action = i64;

    fn start(&self) -> i64 {
        0
    }

    fn is_goal(&self, &state: &i64) -> bool {
        state == 10
    }

    fn transitions(&self, &from: &i64) -> Vec<Transition<i64, i64>> {
        [-1, 1].map(|action| Transition { action, to: from + action, cost: 1, width_at_most: 1.0 }).to_vec()
    }

    fn certify(&self, _: &i64, _: &i64, _: &i64, _: f64) -> Width {
        Width::exact(1.0)
    }

    fn remaining_cost(&self, state: &i64) -> Option<u32> {
        u32::try_from((10 - state).abs()).ok()
    }

    fn heap_bytes(&self, _: &i64) -> usize {
        1024
    }
}

#[test]
fn an_infinite_space_is_searched_where_the_estimate_leads() {
    let mut search = Search::new(&Line, options());
    assert_eq!(search.margin(0.0).solved().map(|path| path.cost), Some(10));
    let spent = search.statistics();
    assert_eq!((spent.certified, spent.generated, spent.states), (10, 20, 12));
    assert!((12 * 1024..16 * 1024).contains(&spent.bytes), "the states' own memory counts: {}", spent.bytes);
}
