//! The saturated search against the primitive one, and the laws that the search builds on.

use proptest::prelude::*;

use crate::reconfigure::domain::Domain;
use crate::reconfigure::layout::displaced;
use crate::reconfigure::local::Neighbourhood;
use crate::reconfigure::moves::Move;
use crate::reconfigure::plan::{Objective, Outcome};
use crate::reconfigure::problem::{Problem, cells};
use crate::reconfigure::saturated::kept;
use crate::reconfigure::step::Step;
use crate::reconfigure::{MARGIN_TOLERANCE, Options, Reduction};
use crate::robot::{Cell, Configuration};

use super::{cubes, goal, moves_of, plan, polycube, solved};

/// Problems of at most five modules with a plan: start, goal, and how many modules are held.
pub const SMALL: &[(&[Cell], &[Cell], usize)] = &[
    // A slide along a row on the ground.
    (&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], &[[0, 0, 0], [1, 0, 0], [1, 0, 1]], 0),
    // Off the end of a row: half a turn down to the ground.
    (&[[0, 0, 0], [1, 0, 0], [1, 0, 1]], &[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1),
    // A tower comes down on its other side.
    (&[[0, 0, 0], [0, 0, 1], [1, 0, 0]], &[[0, 0, 0], [-1, 0, 0], [0, 0, 1]], 1),
    // Along a held wall, out over nothing.
    (&[[0, 0, 3], [0, 0, 4], [0, 0, 5], [1, 0, 5]], &[[0, 0, 3], [0, 0, 4], [0, 0, 5], [1, 0, 3]], 3),
    // Along a held beam, below or above it.
    (&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [0, 0, 1]], &[[0, 0, 2], [1, 0, 2], [2, 0, 2], [2, 0, 3]], 3),
];

#[test]
fn saturated_and_primitive_search_agree() {
    for &(from, to, fixed) in SMALL {
        let (start, target) = (cubes(from, fixed), goal(cubes(to, fixed)));
        for objective in [Objective::Margin, Objective::Moves] {
            let of = |reduction| plan(&start, &target, &Options { objective, reduction, ..Options::default() });
            let (saturated, primitive) = (of(Reduction::Saturated), of(Reduction::Primitive));
            let (a, b) = (solved(&saturated), solved(&primitive));
            assert_eq!(a.moves, b.moves, "{from:?} to {to:?}");
            if objective == Objective::Margin {
                let (a, b) = (a.margin.unwrap().lower, b.margin.unwrap().lower);
                assert!((a - b).abs() <= 2.0 * MARGIN_TOLERANCE, "{from:?} to {to:?}: {a} against {b}");
            }
        }
    }
}

/// A start, and a goal some random moves away, both with random connected subsets of connections.
fn related() -> impl Strategy<Value = (Configuration, Configuration)> {
    let parts = (polycube(4), proptest::collection::vec(any::<usize>(), 1..4), any::<u32>(), any::<u32>());
    parts.prop_map(|(filled, choices, keep, keep_goal)| {
        let mut start = cubes(&filled, 1);
        let mut end = start.clone();
        for choice in choices {
            let (layout, held) = (cells(&end), [0, 0, 0]);
            let moves: Vec<_> = moves_of(&layout).into_iter().filter(|m| m.from != held && m.to()[2] >= 0).collect();
            if let Some(&step) = moves.get(choice % moves.len().max(1)) {
                Step::Move(step).apply(&mut end);
            }
        }
        end.connections = end.touching_connections();
        thin(&mut start, keep);
        thin(&mut end, keep_goal);
        (start, end)
    })
}

/// Drops connections that are not needed to stay connected, as the bits say.
fn thin(configuration: &mut Configuration, keep: u32) {
    for (bit, connection) in configuration.connections.clone().into_iter().enumerate() {
        let before = configuration.connections.clone();
        configuration.connections.retain(|engaged| keep >> (bit % 32) & 1 == 1 || *engaged != connection);
        if !configuration.is_connected() {
            configuration.connections = before;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// On random small problems both searches give the same outcome, best margin
    /// and fewest moves, and every plan is verified.
    #[test]
    fn the_searches_agree_on_random_problems((start, end) in related()) {
        let target = goal(end);
        for objective in [Objective::Margin, Objective::Moves] {
            let of = |reduction| {
                let options = Options { objective, reduction, max_expansions: Some(1500), ..Options::default() };
                plan(&start, &target, &options)
            };
            let (saturated, primitive) = (of(Reduction::Saturated), of(Reduction::Primitive));
            if matches!(primitive.outcome, Outcome::OutOfBudget(_)) {
                continue;
            }
            prop_assert_eq!(&saturated.outcome, &primitive.outcome);
            let (Some(a), Some(b)) = (&saturated.plan, &primitive.plan) else { continue };
            prop_assert_eq!(a.moves, b.moves);
            if objective == Objective::Margin {
                let (a, b) = (a.margin.unwrap().lower, b.margin.unwrap().lower);
                prop_assert!((a - b).abs() <= 2.0 * MARGIN_TOLERANCE, "{} against {}", a, b);
            }
        }
    }

    /// Stopping early never changes on which side of a floor a move is.
    #[test]
    fn a_floor_decides_as_the_full_margin_does(filled in polycube(6), choice in any::<usize>(), floor in 0.0..1.0_f64) {
        let state = cubes(&filled, 1);
        let problem = Problem::new(&state, &goal(state.clone())).unwrap();
        let domain = Domain::new(&problem, true);
        let moves = domain.moves(problem.start_layout());
        let Some(&step) = moves.get(choice % moves.len().max(1)) else { return Ok(()) };
        let of = |floor| domain.of_move(problem.start_layout(), &kept(problem.start_layout(), step), step, floor).margin;
        let (full, decided) = (of(f64::NEG_INFINITY), of(floor));
        // One may come from the module's own hold, which refines another of two samples that are as bad.
        let other_samples = 0.05 * (1.0 - full.lower).abs() + MARGIN_TOLERANCE;
        if full.upper < floor - other_samples || full.upper == f64::NEG_INFINITY {
            prop_assert!(decided.upper < floor);
        } else if full.lower > floor + other_samples {
            prop_assert!((decided.lower - full.lower).abs() <= other_samples, "{:?} for {:?}", decided, full);
        }
    }

    /// The bound from the moving module alone is above the whole robot's
    /// margin, and the same wherever the neighbourhood is, whatever is far away.
    #[test]
    fn the_moving_module_alone_bounds_the_margin(filled in polycube(6), choice in any::<usize>(), by in -3..3_i32) {
        let state = cubes(&filled, 1);
        let problem = Problem::new(&state, &goal(state.clone())).unwrap();
        let domain = Domain::new(&problem, true);
        let layout = problem.start_layout();
        let moves = domain.moves(layout);
        let Some(&step) = moves.get(choice % moves.len().max(1)) else { return Ok(()) };
        let bound = domain.at_most(layout, step);
        let margin = domain.of_move(layout, &kept(layout, step), step, f64::NEG_INFINITY).margin;
        prop_assert!(margin.lower <= bound, "{:?} above {}", margin, bound);

        // Elsewhere on the ground, with one more module out of reach.
        let shift = [by, -by, 0];
        let far = Cell::from([20, 20, 0]);
        let moved: Vec<Cell> = filled.iter().map(|&cell| displaced(cell, shift)).chain([far]).collect();
        let other = Problem::new(&cubes(&moved, 1), &goal(cubes(&moved, 1))).unwrap();
        let there = Move { from: displaced(step.from, shift), ..step };
        let hood = Neighbourhood::new(&problem, layout, step);
        prop_assert_eq!(&hood, &Neighbourhood::new(&other, other.start_layout(), there));
        let again = Domain::new(&other, true).at_most(other.start_layout(), there);
        prop_assert!(bound == again || (bound - again).abs() <= MARGIN_TOLERANCE * (1.0 - bound).abs().max(1.0));
    }

    /// Engaging one more connection never lowers the margin of a state.
    #[test]
    fn attaching_is_never_a_loss(filled in polycube(7), keep in any::<u32>(), latched in any::<bool>()) {
        let mut state = cubes(&filled, 0);
        if latched {
            for module in &mut state.modules {
                module.module_type = 1;
            }
        }
        state.connections = state.touching_connections();
        thin(&mut state, keep);
        let margin = |state: &Configuration| {
            let structure = crate::reconfigure::assembly::assemble(state).structure;
            crate::statics::assess(&structure, crate::statics::Question::VALUE).unwrap().margin()
        };
        let before = margin(&state);
        for open in cells(&state).touching() {
            let mut after = state.clone();
            Step::Attach(open).apply(&mut after);
            prop_assert!(margin(&after).upper >= before.lower, "{:?} lowers {:?}", open, before);
        }
    }
}
