//! Slow methods that share nothing with the engines: thresholds, petgraph, enumeration.

use petgraph::algo::dijkstra;
use petgraph::graph::{DiGraph, NodeIndex};
use planners::Width;
use planners::toy::Arc;

use crate::sample::Graph;

/// Least cost to each node from `from` over the transitions that `keep` keeps.
fn distances(graph: &Graph, from: usize, reversed: bool, keep: impl Fn(&Arc<u8>) -> bool) -> Vec<Option<u32>> {
    let mut explicit = DiGraph::<(), u32>::new();
    let nodes: Vec<NodeIndex> = graph.arcs.iter().map(|_| explicit.add_node(())).collect();
    for (node, arcs) in graph.arcs.iter().enumerate() {
        for arc in arcs.iter().filter(|arc| keep(arc)) {
            let (a, b) = if reversed { (arc.to, node) } else { (node, arc.to) };
            explicit.add_edge(nodes[a], nodes[b], arc.cost);
        }
    }
    let found = dijkstra(&explicit, nodes[from], None, |edge| *edge.weight());
    nodes.iter().map(|node| found.get(node).copied()).collect()
}

/// Least cost from each node to a goal, whatever the widths.
pub fn distance_to_goal(graph: &Graph) -> Vec<Option<u32>> {
    let goals = (0..graph.arcs.len()).filter(|&node| graph.is_goal[node]);
    let each = goals.map(|goal| distances(graph, goal, true, |_| true));
    let nearer = |a: Option<u32>, b: Option<u32>| a.into_iter().chain(b).min();
    each.reduce(|a, b| a.into_iter().zip(b).map(|(a, b)| nearer(a, b)).collect()).expect("one goal at least")
}

/// Least cost from the start to each node, whatever the widths.
pub fn distance_from_start(graph: &Graph) -> Vec<Option<u32>> {
    distances(graph, graph.start, false, |_| true)
}

/// Least cost from start to goal over transitions of which `end` of the width is
/// at least `floor`.
pub fn shortest(graph: &Graph, floor: f64, end: impl Fn(Width) -> f64) -> Option<u32> {
    let wide = |arc: &Arc<u8>| end(arc.width) >= floor && end(arc.width) > f64::NEG_INFINITY;
    let found = distances(graph, graph.start, false, wide);
    (0..found.len()).filter(|&node| graph.is_goal[node]).filter_map(|node| found[node]).min()
}

/// The largest floor at which a goal can still be reached.
pub fn widest(graph: &Graph, end: impl Fn(Width) -> f64) -> Option<f64> {
    let widths = graph.arcs.iter().flatten().map(|arc| end(arc.width)).filter(|width| width.is_finite());
    let thresholds = widths.chain([f64::INFINITY]);
    thresholds.filter(|&floor| shortest(graph, floor, &end).is_some()).reduce(f64::max)
}

/// A path of [`all_paths`].
#[derive(Clone, Debug)]
pub struct Plan {
    pub cost: u32,
    pub actions: Vec<u8>,
}

/// All simple paths to a first goal over transitions that certify at least `floor`.
pub fn all_paths(graph: &Graph, floor: f64) -> Vec<Plan> {
    let mut plans = Vec::new();
    let empty = Plan { cost: 0, actions: Vec::new() };
    extend(graph, floor, &mut vec![graph.start], &empty, &mut plans);
    plans
}

fn extend(graph: &Graph, floor: f64, visited: &mut Vec<usize>, plan: &Plan, plans: &mut Vec<Plan>) {
    let node = *visited.last().expect("the start at least");
    if graph.is_goal[node] {
        plans.push(plan.clone());
        return;
    }
    for arc in &graph.arcs[node] {
        let wide = arc.width.lower >= floor && arc.width.lower > f64::NEG_INFINITY;
        if wide && !visited.contains(&arc.to) {
            visited.push(arc.to);
            let actions = [plan.actions.as_slice(), &[arc.action]].concat();
            extend(graph, floor, visited, &Plan { cost: plan.cost + arc.cost, actions }, plans);
            visited.pop();
        }
    }
}
