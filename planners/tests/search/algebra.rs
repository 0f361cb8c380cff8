//! Laws of the path values, and the order that breaks them.

use planners::algebra::{Additive, Bottleneck, Lexicographic, PathValue};
use planners::toy::Toy;
use planners::{Options, Search};
use proptest::prelude::*;

fn widths() -> impl Strategy<Value = Bottleneck> {
    prop_oneof![
        (-3..4_i32).prop_map(|width| Bottleneck::new(f64::from(width))),
        prop::num::f64::ANY.prop_map(Bottleneck::new),
    ]
}

fn costs() -> impl Strategy<Value = Additive> {
    prop_oneof![(0..4_u32).prop_map(Additive), any::<u32>().prop_map(Additive)]
}

fn monoid_and_monotone<V: PathValue + std::fmt::Debug>(a: V, b: V, c: V) {
    assert_eq!(a.then(b).then(c), a.then(b.then(c)));
    assert_eq!(a.then(V::IDENTITY), a);
    assert_eq!(V::IDENTITY.then(a), a);
    assert!(a.then(b) <= a, "going on never improves a path");
}

fn is_isotone<V: PathValue>(a: V, b: V, c: V) -> bool {
    let (better, worse) = (a.max(b), a.min(b));
    better.then(c) >= worse.then(c)
}

/// Additive costs whose sums do not saturate.
fn small_costs() -> impl Strategy<Value = Additive> {
    (0..1000_u32).prop_map(Additive)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn width_is_lawful(a in widths(), b in widths(), c in widths()) {
        monoid_and_monotone(a, b, c);
        prop_assert!(is_isotone(a, b, c));
    }

    #[test]
    fn cost_is_lawful(a in costs(), b in costs(), c in costs()) {
        monoid_and_monotone(a, b, c);
        prop_assert!(is_isotone(a, b, c));
    }

    #[test]
    fn cost_then_width_is_lawful(
        a in (small_costs(), widths()), b in (small_costs(), widths()), c in (small_costs(), widths()),
    ) {
        let [a, b, c] = [a, b, c].map(|(cost, width)| Lexicographic(cost, width));
        monoid_and_monotone(a, b, c);
        prop_assert!(is_isotone(a, b, c));
    }
}

fn wide_then_cheap(width: f64, cost: u32) -> Lexicographic<Bottleneck, Additive> {
    Lexicographic(Bottleneck::new(width), Additive(cost))
}

#[test]
fn width_then_cost_is_not_isotone() {
    let (a, b, c) = (wide_then_cheap(5.0, 10), wide_then_cheap(4.0, 1), wide_then_cheap(3.0, 1));
    assert!(a > b && a.then(c) < b.then(c));
    assert!(!is_isotone(a, b, c));
}

/// Dijkstra with one label a state: right for lawful values only.
fn one_label(graph: &Toy<&str>) -> Lexicographic<Bottleneck, Additive> {
    let mut labels = vec![None; graph.arcs.len()];
    let mut open = vec![(Lexicographic::IDENTITY, graph.start)];
    while let Some(best) = (0..open.len()).max_by_key(|&place| open[place].0) {
        let (value, node): (Lexicographic<Bottleneck, Additive>, usize) = open.swap_remove(best);
        if labels[node].is_none() {
            labels[node] = Some(value);
            let onwards = graph.arcs[node].iter();
            open.extend(onwards.map(|arc| (value.then(wide_then_cheap(arc.width.lower, arc.cost)), arc.to)));
        }
    }
    let values = (0..labels.len()).filter(|&node| graph.is_goal[node]).filter_map(|node| labels[node]);
    values.max().expect("the goal is reached")
}

/// A wide detour to a place from which the only way on is narrow anyway.
#[test]
fn one_label_a_state_gets_the_margin_wrong() {
    let graph = Toy::new(4, 0, &[3])
        .arc(0, 1, "wide", 5, 5.0)
        .arc(1, 2, "detour", 5, 5.0)
        .arc(0, 2, "short cut", 1, 4.0)
        .arc(2, 3, "gate", 1, 3.0);
    assert_eq!(one_label(&graph), wide_then_cheap(3.0, 11), "the trap is real");
    let mut search = Search::new(&graph, Options::default());
    let best = search.margin(f64::NEG_INFINITY);
    let actions: Vec<_> = best.solved().unwrap().steps.iter().map(|step| step.action).collect();
    assert_eq!(actions, ["short cut", "gate"]);
    assert_eq!(search.statistics().certified, 4, "the second pass certifies nothing again");
}
