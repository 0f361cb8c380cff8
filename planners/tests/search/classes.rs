//! Endless graphs that repeat themselves: exhausting classes against breadth-first search of a large box.

use std::collections::{HashMap, HashSet, VecDeque};
use std::sync::atomic::AtomicBool;

use planners::{
    Budget, Displacement, Limit, Options, Outcome, Path, Periodic, Progress, Reversible, Search, Space, Transition,
    Width,
};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::optimality::options;

/// A node in a cell, and whether it is the goal.
type State = (usize, Displacement, bool);

/// A transition from every cell: nodes, displacement, width.
type Arc = (usize, usize, Displacement, Width);

/// The same nodes and transitions in every cell of the plane.
#[derive(Clone, Debug)]
struct Tiles {
    /// Numbered in order; the action says which it is, and whether it is taken back.
    arcs: Vec<Arc>,
    /// Whether every transition can be taken back.
    reverses: bool,
    start: (usize, Displacement),
    goals: Vec<(usize, Displacement)>,
    /// Whether the mirror image of node n is its neighbour n ^ 1.
    is_mirrored: bool,
}

fn moved([x, y, z]: Displacement, by: Displacement, sign: i64) -> Displacement {
    [x + sign * by[0], y + sign * by[1], z + sign * by[2]]
}

impl Tiles {
    /// Transitions out of a state that is no goal, or into it, but for the last to a goal.
    fn steps(&self, (node, at, _): State, forwards: bool) -> Vec<Transition<State, (usize, bool)>> {
        let mut steps = Vec::new();
        for (index, &(from, to, by, _)) in self.arcs.iter().enumerate() {
            let mut step = |to: usize, by: Displacement, sign: i64, back: bool| {
                let to = (to, moved(at, by, sign), false);
                steps.push(Transition { action: (index, back), to, cost: 1, width_at_most: f64::INFINITY });
            };
            let [near, far] = if forwards { [from, to] } else { [to, from] };
            if near == node {
                step(far, by, if forwards { 1 } else { -1 }, false);
            }
            if self.reverses && far == node {
                step(near, by, if forwards { -1 } else { 1 }, true);
            }
        }
        steps
    }

    /// Fewest transitions at least as wide as `floor`, by `end` of their widths, within a box.
    fn fewest(&self, floor: f64, end: impl Fn(Width) -> f64) -> Option<u32> {
        const FAR: i64 = 30;
        let start = (self.start.0, self.start.1, false);
        let mut distance = HashMap::from([(start, 0)]);
        let mut open = VecDeque::from([start]);
        while let Some(state) = open.pop_front() {
            let spent = distance[&state];
            if self.goals.contains(&(state.0, state.1)) {
                return Some(spent);
            }
            for step in self.steps(state, true) {
                let is_near = step.to.1.iter().all(|c| c.abs() <= FAR);
                if is_near && end(self.arcs[step.action.0].3) >= floor && !distance.contains_key(&step.to) {
                    distance.insert(step.to, spent + 1);
                    open.push_back(step.to);
                }
            }
        }
        None
    }

    /// Largest floor for which there is a path, and how short one is.
    fn widest(&self, end: impl Fn(Width) -> f64 + Copy) -> Option<(f64, u32)> {
        let mut widths: Vec<f64> = self.arcs.iter().map(|arc| end(arc.3)).chain([f64::INFINITY]).collect();
        widths.sort_by(|a, b| b.total_cmp(a));
        widths.into_iter().find_map(|width| Some((width, self.fewest(width, end)?)))
    }
}

impl Space for Tiles {
    type State = State;
    type Action = (usize, bool);

    fn start(&self) -> State {
        (self.start.0, self.start.1, false)
    }

    fn is_goal(&self, state: &State) -> bool {
        state.2
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Self::Action>> {
        let mut steps = self.steps(*from, true);
        if self.goals.contains(&(from.0, from.1)) {
            let arrived = (from.0, from.1, true);
            steps.push(Transition { action: (usize::MAX, false), to: arrived, cost: 0, width_at_most: f64::INFINITY });
        }
        steps
    }

    fn certify(&self, _: &State, &(index, _): &Self::Action, _: &State, _: f64) -> Width {
        self.arcs.get(index).map_or(Width::UNLIMITED, |arc| arc.3)
    }

    /// Of every third transition all there is to know, of another third nothing; the others cannot be looked at in passing.
    fn glance(&self, _: &State, &(index, _): &Self::Action, _: &State, _: f64) -> Option<f64> {
        let width = self.arcs.get(index)?.3;
        [None, Some(f64::INFINITY), Some(width.upper)][index % 3]
    }

    fn remaining_cost(&self, _: &State) -> Option<u32> {
        Some(0)
    }
}

impl Reversible for Tiles {
    fn goals(&self) -> Vec<State> {
        self.goals.iter().map(|&(node, at)| (node, at, true)).collect()
    }

    fn transitions_into(&self, to: &State) -> Vec<Transition<State, Self::Action>> {
        if to.2 {
            let last = (to.0, to.1, false);
            return vec![Transition { action: (usize::MAX, false), to: last, cost: 0, width_at_most: f64::INFINITY }];
        }
        self.steps(*to, false)
    }
}

impl Periodic for Tiles {
    fn class(&self, &(node, at, _): &State) -> (State, Displacement) {
        ((node, [0; 3], false), at)
    }

    fn kind(&self, &(node, _, _): &State) -> State {
        (if self.is_mirrored { node & !1 } else { node }, [0; 3], false)
    }
}

/// How many axes displace, what is random about transitions, and about where start and goals are.
fn tiles(blurred: bool, reverses: bool) -> impl Strategy<Value = Tiles> {
    let blur = if blurred { 0..3_u32 } else { 0..1 };
    let arc = (0..4_usize, 0..4_usize, vec(-2..=2_i64, 3), 1..6_u32, blur.clone(), blur);
    let place = || (0..4_usize, vec(-4..=4_i64, 3));
    (vec(arc, 1..7), place(), vec(place(), 1..3), 1..3_usize, any::<bool>()).prop_map(
        move |(drawn, start, goals, axes, is_mirrored)| {
            let at = |drawn: &[i64]| -> Displacement { std::array::from_fn(|i| if i < axes { drawn[i] } else { 0 }) };
            let mut arcs = Vec::new();
            for (from, to, by, width, below, above) in drawn {
                let width = f64::from(width);
                let width = Width { lower: width - f64::from(below), upper: width + f64::from(above) };
                let [x, y, z] = at(&by);
                arcs.push((from, to, [x, y, z], width));
                if is_mirrored {
                    arcs.push((from ^ 1, to ^ 1, [-x, y, z], width));
                }
            }
            let goals = goals.iter().map(|(node, drawn)| (*node, at(drawn))).collect();
            Tiles { arcs, reverses, start: (start.0, at(&start.1)), goals, is_mirrored }
        },
    )
}

fn check_path(tiles: &Tiles, path: &Path<State, (usize, bool)>) {
    let mut state = tiles.start();
    for step in &path.steps {
        let out = tiles.transitions(&state);
        assert!(out.iter().any(|transition| (transition.action, transition.to) == (step.action, step.to)));
        state = step.to;
    }
    assert!(state.2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Where nothing is in reach a search of the states would never end. With one goal the classes decide exactly.
    #[test]
    fn what_is_out_of_reach_is_found_to_be_and_what_is_not_is_reached(tiles in tiles(false, true), floor in 1..6_u32) {
        let floor = f64::from(floor);
        let tiles = Tiles { goals: tiles.goals[..1].to_vec(), ..tiles };
        let truth = tiles.fewest(floor, |width| width.upper);
        match Search::new(&tiles, options()).from_both_ends_by_class(floor) {
            Outcome::Solved { found, proof } => {
                check_path(&tiles, &found);
                prop_assert!(found.width.lower >= floor);
                prop_assert_eq!(Some(found.cost), truth);
                prop_assert!(proof.cost_optimal);
            }
            Outcome::Impossible => prop_assert_eq!(truth, None),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    /// The widest path, and of those the shortest, is proved although there is no end of states as wide.
    #[test]
    fn the_widest_path_is_proved(tiles in tiles(false, true)) {
        let tiles = Tiles { goals: tiles.goals[..1].to_vec(), ..tiles };
        let (mut reports, mut told) = (Vec::new(), Vec::new());
        let mut report = |progress: &Progress| reports.push(progress.width_at_most);
        let options = Options { report_every: 1, ..options() };
        let outcome = Search::new(&tiles, options).on_progress(&mut report).anytime_margin(
            f64::NEG_INFINITY,
            &|search, floor| search.from_both_ends_by_class(floor),
            &mut |path| told.push(path.width.lower),
        );
        let truth = tiles.widest(|width| width.upper);
        match &outcome {
            Outcome::Solved { found, proof } => {
                check_path(&tiles, found);
                prop_assert_eq!(Some((found.width.lower, found.cost)), truth);
                prop_assert!(proof.width_optimal && proof.cost_optimal);
                prop_assert!(told.contains(&found.width.lower));
                prop_assert!(reports.iter().all(|&bound| bound >= found.width.lower));
            }
            Outcome::Impossible => prop_assert_eq!(truth, None),
            Outcome::OutOfBudget { limit, .. } => prop_assert!(false, "{:?}", limit),
        }
    }

    /// Whatever intervals leave open, whether transitions can be taken back or not, with several goals and within any budget:
    /// nothing is called impossible that is not.
    #[test]
    fn what_is_proved_is_so(
        (tiles, floor) in (any::<bool>(), any::<bool>()).prop_flat_map(|(a, b)| (tiles(a, b), 1..6_u32)), most in 1..400_u64,
    ) {
        let floor = f64::from(floor);
        let budget = Budget { max_expansions: Some(most), ..Budget::default() };
        match Search::new(&tiles, Options { budget, ..options() }).from_both_ends_by_class(floor) {
            Outcome::Solved { found, .. } => {
                check_path(&tiles, &found);
                prop_assert!(found.width.lower >= floor);
                prop_assert!(tiles.fewest(floor, |width| width.lower).is_none_or(|fewest| found.cost <= fewest));
            }
            Outcome::Impossible => prop_assert_eq!(tiles.fewest(floor, |width| width.upper), None),
            Outcome::OutOfBudget { proof, .. } => {
                let least = tiles.fewest(proof.floor, |width| width.upper);
                prop_assert!(least.is_none_or(|least| proof.cost_at_least <= least));
                let widest = tiles.widest(|width| width.upper);
                prop_assert!(widest.is_none_or(|(width, _)| width < floor || width <= proof.width_at_most));
            }
        }
    }
}

/// One node that can be displaced by two steps of a knight: the goal is out of reach in half of all places.
fn knight(goal: Displacement) -> Tiles {
    let width = Width::exact(1.0);
    let arcs = vec![(0, 0, [1, 2, 0], width), (0, 0, [3, 0, 0], width)];
    Tiles { arcs, reverses: true, start: (0, [0; 3]), goals: vec![(0, goal)], is_mirrored: false }
}

#[test]
fn displacements_decide_where_classes_do_not() {
    for (x, y) in (-4..=4).flat_map(|x| (-4..=4).map(move |y| (x, y))) {
        let tiles = knight([x, y, 0]);
        // x and y count the two steps if y is even and the rest of x is divisible by three.
        let is_reached = y % 2 == 0 && (x - y / 2) % 3 == 0;
        let outcome = Search::new(&tiles, options()).from_both_ends_by_class(1.0);
        assert_eq!(outcome.solved().is_some(), is_reached, "{x}, {y}");
        assert_eq!(outcome == Outcome::Impossible, !is_reached, "{x}, {y}");
    }
}

#[test]
fn a_search_of_the_states_never_ends_there() {
    let budget = Budget { max_expansions: Some(5000), ..Budget::default() };
    let outcome = Search::new(&knight([1, 0, 0]), Options { budget, ..options() }).from_both_ends(1.0);
    assert_eq!(outcome.limit(), Some(Limit::Expansions), "or else the engine proves nothing that was not known");
}

/// Many classes in a row, and a goal that is in none of them.
fn corridor(length: usize) -> Tiles {
    let arcs = (0..length).map(|node| (node, node + 1, [1, 0, 0], Width::exact(1.0))).collect();
    let apart = (length + 2, length + 3, [1, 0, 0], Width::exact(1.0));
    let mut tiles =
        Tiles { arcs, reverses: true, start: (0, [0; 3]), goals: vec![(length + 2, [0; 3])], is_mirrored: false };
    tiles.arcs.push(apart);
    tiles.arcs.extend((0..length).map(|node| (length + 3 + node, length + 4 + node, [1, 0, 0], Width::exact(1.0))));
    tiles
}

#[test]
fn limits_and_cancellation_end_it() {
    let tiles = corridor(2000);
    let with = |budget: Budget| Search::new(&tiles, Options { budget, ..options() }).from_both_ends_by_class(1.0);
    assert_eq!(with(Budget::default()), Outcome::Impossible);
    let few = Budget { max_expansions: Some(300), ..Budget::default() };
    assert_eq!(with(few).limit(), Some(Limit::Expansions));
    let small = Budget { max_bytes: Some(100_000), ..Budget::default() };
    assert_eq!(with(small).limit(), Some(Limit::Memory));
    let cancelled = Budget { cancel: Some(std::sync::Arc::new(AtomicBool::new(true))), ..Budget::default() };
    assert_eq!(with(cancelled).limit(), Some(Limit::Cancelled));
}

#[test]
fn what_was_found_once_is_not_looked_for_again() {
    let tiles = corridor(500);
    let mut search = Search::new(&tiles, options());
    assert_eq!(search.from_both_ends_by_class(1.0), Outcome::Impossible);
    let before = search.statistics();
    assert_eq!(search.from_both_ends_by_class(1.5), Outcome::Impossible, "what is apart is so for every larger floor");
    assert_eq!(search.statistics(), before);
    let states: HashSet<usize> = tiles.arcs.iter().flat_map(|arc| [arc.0, arc.1]).collect();
    assert!(before.states <= 8 * states.len(), "classes are explored, not cells: {}", before.states);
}
