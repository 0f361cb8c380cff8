//! How much is certified.

use std::collections::HashMap;
use std::sync::Mutex;

use planners::toy::{Arc, Toy};
use planners::{Options, Search, Space, Transition, Width};
use proptest::prelude::*;

use crate::optimality::options;
use crate::sample::{Graph, blurred, exact};

/// The same graph with every width known as soon as the transition is
/// generated: what a search without bounds certifies is what it generates.
fn eager(graph: &Graph) -> Graph {
    let mut graph = graph.clone();
    graph.arcs.iter_mut().flatten().for_each(|arc| arc.width_at_most = arc.width.upper);
    graph
}

/// What an engine asks of a space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Question {
    Transitions(usize),
    Certify(usize, u8, usize),
}

/// A graph that counts what it is asked.
struct Counting<'a> {
    graph: &'a Graph,
    asked: Mutex<HashMap<Question, u32>>,
}

impl<'a> Counting<'a> {
    fn new(graph: &'a Graph) -> Self {
        Counting { graph, asked: Mutex::new(HashMap::new()) }
    }

    fn count(&self, question: Question) {
        *self.asked.lock().unwrap().entry(question).or_insert(0) += 1;
    }
}

impl Space for Counting<'_> {
    type State = usize;
    type Action = u8;

    fn start(&self) -> usize {
        self.graph.start()
    }

    fn is_goal(&self, state: &usize) -> bool {
        self.graph.is_goal(state)
    }

    fn transitions(&self, from: &usize) -> Vec<Transition<usize, u8>> {
        self.count(Question::Transitions(*from));
        self.graph.transitions(from)
    }

    fn certify(&self, from: &usize, action: &u8, to: &usize, floor: f64) -> Width {
        self.count(Question::Certify(*from, *action, *to));
        self.graph.certify(from, action, to, floor)
    }

    fn remaining_cost(&self, state: &usize) -> Option<u32> {
        self.graph.remaining_cost(state)
    }
}

type Engine = fn(&mut Search<'_, Graph>, f64);

/// Calls of `certify`: by the lazy engine, and by one that certifies all that it generates.
fn counts(graph: &Graph, floor: f64, engine: Engine) -> (u64, u64) {
    let mut lazy = Search::new(graph, options());
    engine(&mut lazy, floor);
    let known = eager(graph);
    let mut eager = Search::new(&known, options());
    engine(&mut eager, floor);
    (lazy.statistics().certified, eager.statistics().generated)
}

const SHORTEST: Engine = |search, floor| drop(search.shortest(floor));
const WIDEST: Engine = |search, floor| drop(search.widest(floor));

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn lazy_never_certifies_more_than_eager(graph in exact(9, 30), floor in 0..10_u32) {
        for engine in [SHORTEST, WIDEST] {
            let (lazy, eager) = counts(&graph, f64::from(floor), engine);
            prop_assert!(lazy <= eager, "{} > {}", lazy, eager);
        }
    }

    #[test]
    fn margin_asks_for_everything_at_most_once(graph in blurred(9, 30), tolerance in 0.0..0.9) {
        let counting = Counting::new(&graph);
        let mut search = Search::new(&counting, Options { tolerance, ..options() });
        search.margin(f64::NEG_INFINITY);
        let (certified, generated) = (search.statistics().certified, search.statistics().generated);
        prop_assert!(certified <= generated);
        let asked = counting.asked.lock().unwrap();
        prop_assert!(asked.values().all(|&times| times == 1), "{:?}", asked);
        let certifications = asked.keys().filter(|question| matches!(question, Question::Certify(..))).count();
        prop_assert_eq!(certifications as u64, certified);
    }

    /// What was certified loosely for one floor must not answer for another.
    #[test]
    fn a_search_can_be_asked_again(graph in blurred(8, 24), floors in prop::collection::vec(0..10_u32, 1..6)) {
        let mut search = Search::new(&graph, options());
        for floor in floors.into_iter().map(f64::from) {
            let fresh = || Search::new(&graph, options());
            let (again, first) = (search.shortest(floor), fresh().shortest(floor));
            prop_assert_eq!(again.best().map(|path| path.cost), first.best().map(|path| path.cost));
            let (again, first) = (search.widest(floor), fresh().widest(floor));
            prop_assert_eq!(again.best().map(|path| path.width.lower), first.best().map(|path| path.width.lower));
            prop_assert_eq!(three_costs(&mut search, floor), three_costs(&mut fresh(), floor));
        }
    }
}

fn three_costs(search: &mut Search<'_, Graph>, floor: f64) -> Option<Vec<u32>> {
    let list = search.k_best(3, floor, <[u8]>::to_vec);
    list.best().map(|paths| paths.iter().map(|path| path.cost).collect())
}

/// An open grid of unequal widths from corner to corner, Manhattan distance as estimate.
fn grid(side: usize, optimism: f64) -> Graph {
    let mut graph = Toy::new(side * side, 0, &[side * side - 1]);
    for node in 0..side * side {
        let (x, y) = (node % side, node / side);
        graph.remaining[node] = Some((2 * (side - 1) - x - y) as u32);
        let steps = [(x + 1 < side, 1), (y + 1 < side, side as isize), (x > 0, -1), (y > 0, -(side as isize))];
        for (action, (_, step)) in steps.into_iter().enumerate().filter(|(_, (inside, _))| *inside) {
            let to = node.wrapping_add_signed(step);
            let width = 1.0 + ((node * 7919 + to * 104_729) % 101) as f64 / 100.0;
            let arc =
                Arc { action: action as u8, to, cost: 1, width_at_most: width + optimism, width: Width::exact(width) };
            graph.arcs[node].push(arc);
        }
    }
    graph
}

#[test]
fn on_a_grid_most_transitions_are_never_certified() {
    // Where every way is wide enough, only the path itself is certified: no
    // engine that answers with a proof can do with less.
    let (lazy, eager) = counts(&grid(30, 1.0), 0.0, SHORTEST);
    assert_eq!(lazy, 58);
    assert!(eager > 2 * lazy, "{eager}");
    // Where a third of the transitions is too narrow, and bounds do not show it.
    let (lazy, eager) = counts(&grid(30, 1.0), 1.33, SHORTEST);
    assert!(2 * lazy < eager, "shortest: {lazy} against {eager}");
    let (lazy, eager) = counts(&grid(30, 0.05), 0.0, WIDEST);
    assert!(2 * lazy < eager, "widest: {lazy} against {eager}");
}

#[test]
fn a_shared_bound_ends_the_search_for_the_widest() {
    let mut graph = grid(30, 1.0);
    let blind = counts(&graph, 0.0, WIDEST).0;
    let widest = Search::new(&graph, options()).widest(0.0).solved().unwrap().width.lower;
    graph.width_at_most = widest;
    let capped = counts(&graph, 0.0, WIDEST).0;
    assert!(2 * capped < blind, "{capped} against {blind}");
}
