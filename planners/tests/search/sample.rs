//! Random explicit graphs with everything that a domain may do to an engine:
//! loops, parallel and free transitions, dead ends, several goals, optimistic
//! bounds, inconsistent estimates.

use planners::Width;
use planners::toy::{Arc, Toy};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::reference;

/// Actions are few, so that plans share them.
pub type Graph = Toy<u8>;

/// What is random about a transition: ends, cost, width, optimism of its bound,
/// half the length of its interval below and above.
type Draw = (usize, usize, u32, u32, u32, (u32, u32));

/// Graphs whose widths are known exactly once they are certified.
pub fn exact(nodes: usize, arcs: usize) -> impl Strategy<Value = Graph> {
    graphs(nodes, arcs, false)
}

/// Graphs whose widths are known to an interval at best.
pub fn blurred(nodes: usize, arcs: usize) -> impl Strategy<Value = Graph> {
    graphs(nodes, arcs, true)
}

fn graphs(nodes: usize, arcs: usize, blurred: bool) -> impl Strategy<Value = Graph> {
    (1..=nodes).prop_flat_map(move |nodes| {
        let blur = if blurred { 0..4_u32 } else { 0..1 };
        let draw = (0..nodes, 0..nodes, 0..5_u32, 0..12_u32, 0..6_u32, (blur.clone(), blur));
        (vec(draw, 0..=arcs), vec(0..nodes, 1..=2), vec(0..=4_u32, nodes), prop::bool::weighted(0.2))
            .prop_map(move |(draws, goals, fractions, capped)| build(nodes, &draws, &goals, &fractions, capped))
    })
}

fn build(nodes: usize, draws: &[Draw], goals: &[usize], fractions: &[u32], capped: bool) -> Graph {
    let mut graph = Toy::new(nodes, 0, goals);
    for (number, &(from, to, cost, width, optimism, (below, above))) in draws.iter().enumerate() {
        // Width 0 stands for a transition that is impossible.
        let (lower, upper) = match width {
            0 => (f64::NEG_INFINITY, f64::NEG_INFINITY),
            width => (f64::from(width) - f64::from(below), f64::from(width) + f64::from(above)),
        };
        let width_at_most = if optimism == 5 { f64::INFINITY } else { upper.max(0.0) + f64::from(optimism) };
        let action = (number % 3) as u8;
        let parallel = graph.arcs[from].iter().any(|arc| arc.to == to && arc.action == action);
        if !parallel {
            graph.arcs[from].push(Arc { action, to, cost, width_at_most, width: Width { lower, upper } });
        }
    }
    let distance = reference::distance_to_goal(&graph);
    // Any fraction of the distance is admissible; different ones are inconsistent.
    graph.remaining = distance.iter().zip(fractions).map(|(d, fraction)| d.map(|d| d * fraction / 4)).collect();
    let from_start = reference::distance_from_start(&graph);
    let fractions = fractions.iter().rev();
    graph.spent = from_start.iter().zip(fractions).map(|(d, fraction)| d.map(|d| d * fraction / 4)).collect();
    if capped && let Some(width) = reference::widest(&graph, |width| width.upper) {
        graph.width_at_most = width;
    }
    graph
}
