//! Exact widths: what is found is optimal, and what is not found does not exist.

use petgraph::algo::min_spanning_tree;
use petgraph::data::FromElements;
use petgraph::graph::{NodeIndex, UnGraph};
use planners::toy::{Arc, Toy};
use planners::{Options, Outcome, Path, Search, Width};
use proptest::prelude::*;

use crate::sample::{self, Graph};
use crate::{reference, sample::exact};

pub fn options() -> Options {
    Options { tolerance: 0.0, ..Options::default() }
}

/// Checks that a path is one of the graph's, and that its totals are right.
pub fn check_path(graph: &Graph, path: &Path<usize, u8>) {
    let (mut node, mut cost, mut width) = (graph.start, 0, Width::UNLIMITED);
    for step in &path.steps {
        assert!(!graph.is_goal[node], "a path ends at its first goal");
        let arc = graph.arcs[node].iter().find(|arc| arc.action == step.action && arc.to == step.to);
        let arc = arc.expect("every step is a transition");
        assert_eq!((arc.cost, arc.width), (step.cost, step.width));
        (node, cost, width) = (step.to, cost + step.cost, width.in_series(step.width));
    }
    assert!(graph.is_goal[node]);
    assert_eq!((cost, width), (path.cost, path.width));
}

/// Checks that what is said to be shortest, with a proof, has the cost that Dijkstra finds.
pub fn check_shortest(graph: &Graph, floor: f64, outcome: Outcome<Path<usize, u8>>) -> Result<(), TestCaseError> {
    let truth = reference::shortest(graph, floor, |width| width.upper);
    match outcome {
        Outcome::Solved { found, proof } => {
            check_path(graph, &found);
            prop_assert!(found.width.lower >= floor);
            prop_assert_eq!(Some(found.cost), truth);
            prop_assert_eq!(Some(proof.cost_at_least), truth);
            prop_assert!(proof.cost_optimal);
        }
        Outcome::Impossible => prop_assert_eq!(truth, None),
        Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn widest_agrees_with_thresholds(graph in exact(9, 24), floor in prop::option::of(0..12_u32)) {
        let floor = floor.map_or(f64::NEG_INFINITY, f64::from);
        let truth = reference::widest(&graph, |width| width.upper).filter(|&width| width >= floor);
        match Search::new(&graph, options()).widest(floor) {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert_eq!(Some(found.width.lower), truth);
                prop_assert_eq!(Some(proof.width_at_most), truth);
                prop_assert!(proof.width_optimal);
            }
            Outcome::Impossible => prop_assert_eq!(truth, None),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    #[test]
    fn shortest_agrees_with_dijkstra(graph in exact(9, 24), floor in 0..12_u32) {
        let floor = f64::from(floor);
        check_shortest(&graph, floor, Search::new(&graph, options()).shortest(floor))?;
    }

    #[test]
    fn margin_is_widest_then_shortest(graph in exact(9, 24)) {
        let width = reference::widest(&graph, |width| width.upper);
        let truth = width.map(|width| (width, reference::shortest(&graph, width, |width| width.upper).unwrap()));
        match Search::new(&graph, options()).margin(f64::NEG_INFINITY) {
            Outcome::Solved { found, proof } => {
                check_path(&graph, &found);
                prop_assert_eq!(Some((found.width.lower, found.cost)), truth);
                prop_assert_eq!(Some((proof.width_at_most, proof.cost_at_least)), truth);
                prop_assert!(proof.width_optimal && proof.cost_optimal);
            }
            Outcome::Impossible => prop_assert_eq!(truth, None),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    /// The path between two nodes of a maximum spanning tree is a widest one.
    #[test]
    fn widest_agrees_with_the_maximum_spanning_tree(
        edges in prop::collection::vec((0..12_usize, 0..12_usize, 1..1000_u32, 0..300_u32), 1..60),
        goal in 0..12_usize,
    ) {
        let mut graph = Toy::new(12, 0, &[goal]);
        let mut explicit = UnGraph::<(), i64>::with_capacity(12, edges.len());
        let nodes: Vec<NodeIndex> = (0..12).map(|_| explicit.add_node(())).collect();
        for (number, &(a, b, width, optimism)) in edges.iter().enumerate() {
            let exact = Width::exact(f64::from(width));
            let width_at_most = f64::from(width + optimism);
            for (from, to) in [(a, b), (b, a)] {
                graph.arcs[from].push(Arc { action: number, to, cost: 1, width_at_most, width: exact });
            }
            explicit.add_edge(nodes[a], nodes[b], -i64::from(width));
        }
        let tree = UnGraph::<(), i64>::from_elements(min_spanning_tree(&explicit));
        let truth = narrowest(&tree, nodes[0], nodes[goal], None);
        let found = Search::new(&graph, options()).widest(f64::NEG_INFINITY);
        prop_assert_eq!(found.solved().map(|path| path.width.lower), truth);
    }

    #[test]
    fn a_search_repeats_itself(graph in sample::blurred(9, 24)) {
        let run = || {
            let mut reports = Vec::new();
            let mut report = |progress: &planners::Progress| reports.push(*progress);
            let mut search = Search::new(&graph, Options { report_every: 1, ..options() }).on_progress(&mut report);
            let answers = (search.margin(1.0), search.k_best(3, 1.0, <[u8]>::to_vec));
            (answers, search.statistics(), reports)
        };
        prop_assert_eq!(run(), run());
    }
}

/// Width of the only path between two nodes of a forest.
fn narrowest(tree: &UnGraph<(), i64>, from: NodeIndex, to: NodeIndex, last: Option<NodeIndex>) -> Option<f64> {
    if from == to {
        return Some(f64::INFINITY);
    }
    tree.neighbors(from).filter(|&next| Some(next) != last).find_map(|next| {
        let edge = tree.find_edge(from, next).expect("neighbours are joined");
        narrowest(tree, next, to, Some(from)).map(|rest| rest.min(-tree[edge] as f64))
    })
}
