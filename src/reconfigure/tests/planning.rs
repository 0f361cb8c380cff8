//! Plans: the saturated search against the primitive one, determinism, every
//! plan replayed, proofs of impossibility.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use proptest::prelude::*;

use crate::reconfigure::domain::Domain;
use crate::reconfigure::layout::displaced;
use crate::reconfigure::local::Neighbourhood;
use crate::reconfigure::moves::{Motion, Move};
use crate::reconfigure::plan::{Limit, Objective, Outcome, Plan, Report};
use crate::reconfigure::problem::{Problem, bonds, cells};
use crate::reconfigure::refusal::{Impossible, Refusal, Which};
use crate::reconfigure::replay::{Fault, replay};
use crate::reconfigure::saturated::kept;
use crate::reconfigure::solve::{MARGIN_TOLERANCE, Options, Reduction, solve};
use crate::reconfigure::step::Step;
use crate::reconfigure::trace::Trace;
use crate::robot::{
    Cell, Configuration, Face, Fault as UnsoundFault, Goal, Matching, ModuleLoad, Obstacle, Part, Shape,
};
use crate::spatial::{Pose, Vec3};

use super::{cubes, goal, moves_of, polycube};

/// Plans, and replays every plan that comes back.
pub fn plan(start: &Configuration, goal: &Goal, options: &Options) -> Report {
    let report = solve(start, goal, options, &mut |_| {}).unwrap();
    for plan in report.plan.iter().chain(&report.alternatives) {
        let required = report.required.unwrap_or(f64::NEG_INFINITY);
        let replayed = replay(start, goal, plan, required).unwrap();
        if !options.ignore_stability {
            assert_eq!(replayed.failures, [], "{plan:#?}");
        }
    }
    report
}

pub fn solved(report: &Report) -> &Plan {
    assert_eq!(report.outcome, Outcome::Solved, "{report:#?}");
    report.plan.as_ref().unwrap()
}

/// Problems of at most five modules with a plan: start, goal, and how many modules are held.
const SMALL: &[(&[Cell], &[Cell], usize)] = &[
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
        if full.upper < floor || full.upper == f64::NEG_INFINITY {
            prop_assert!(decided.upper < floor);
        } else {
            prop_assert_eq!(decided, full);
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

#[test]
fn plans_do_not_depend_on_the_number_of_threads() {
    let (start, target) = tower_to_row();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut report = pool.install(|| plan(&start, &target, &Options { plans: 3, ..Options::default() }));
        report.statistics.seconds = 0.0;
        report
    };
    let one = with(1);
    solved(&one);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}

/// Four cubes, the first one held: a tower becomes a row.
pub fn tower_to_row() -> (Configuration, Goal) {
    let start = cubes(&[[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 0]], 1);
    (start, goal(cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], 1)))
}

/// Under 2.5 times the gravity a hinge cannot lift a cube, though faces hold it.
fn heavy(mut configuration: Configuration) -> Configuration {
    configuration.gravity *= 2.5;
    configuration
}

#[test]
fn geometry_alone_plans_what_breaks_and_the_replay_says_where() {
    let start = heavy(cubes(&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [0, 0, 1]], 3));
    let target = goal(heavy(cubes(&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [2, 0, 3]], 3)));
    let proved = plan(&start, &target, &Options::default());
    assert_eq!(proved.outcome, Outcome::Impossible(Impossible::Exhausted { required: 0.0 }));

    let options = Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() };
    let report = plan(&start, &target, &options);
    let blind = solved(&report);
    assert_eq!((blind.margin, blind.bottleneck.as_ref()), (None, None));
    let replayed = replay(&start, &target, blind, 0.0).unwrap();
    let first = &replayed.failures[0];
    assert!(matches!(first.fault, Fault::Unstable { .. }), "{first:?}");
    assert!(blind.actions[first.action.unwrap()].action.is_move());
    assert!(first.connection.unwrap().modules().contains(&3), "the cube that pivots: {first:?}");
}

#[test]
fn what_cannot_be_reached_is_proved_so() {
    let outcome = |start: &Configuration, target: &Goal| plan(start, target, &Options::default()).outcome;
    let row = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 0);

    let fewer = goal(cubes(&[[0, 0, 0], [1, 0, 0]], 0));
    assert!(matches!(outcome(&row, &fewer), Outcome::Impossible(Impossible::ModulesDiffer { start: 3, goal: 2, .. })));

    let mut apart = row.clone();
    apart.connections.pop();
    let disconnected = Outcome::Impossible(Impossible::Disconnected(Which::Start));
    assert_eq!(outcome(&apart, &goal(row.clone())), disconnected);

    let held = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1);
    let moved = goal(cubes(&[[1, 0, 0], [2, 0, 0], [3, 0, 0]], 0));
    assert!(matches!(outcome(&held, &moved), Outcome::Impossible(Impossible::FixedModule { .. })));

    // Six cubes out from a held one: no face can carry that (0.056 n^2 > 1).
    let cantilever: Vec<Cell> = (0..7).map(|x| [x, 0, 5]).collect();
    let tower: Vec<Cell> = (0..7).map(|z| [0, 0, 5 + z]).collect();
    let (up, out) = (cubes(&tower, 1), cubes(&cantilever, 1));
    let unstable = outcome(&up, &goal(out));
    assert!(matches!(unstable, Outcome::Impossible(Impossible::Unstable { which: Which::Goal, .. })), "{unstable:?}");

    let tall = Options { min_margin: Some(0.999), ..Options::default() };
    let (start, target) = tower_to_row();
    let report = plan(&start, &target, &tall);
    assert!(matches!(report.outcome, Outcome::Impossible(_)), "{:?}", report.outcome);
}

#[test]
fn attaching_and_detaching_alone_is_a_plan_of_no_moves() {
    let square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let (mut start, mut end) = (cubes(&square, 0), cubes(&square, 0));
    start.connections.remove(0);
    end.connections.remove(3);
    for reduction in [Reduction::Saturated, Reduction::Primitive] {
        let report = plan(&start, &goal(end.clone()), &Options { reduction, ..Options::default() });
        let kinds: Vec<_> = solved(&report).actions.iter().map(|planned| planned.action.kind()).collect();
        assert_eq!(kinds, ["attach", "detach"]);
    }
}

#[test]
fn obstacles_are_gone_round_or_not_at_all() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 2);
    let target = goal(cubes(&[[0, 0, 0], [1, 0, 0], [1, 0, 1]], 2));
    let options = Options { objective: Objective::Moves, ..Options::default() };
    assert_eq!(solved(&plan(&start, &target, &options)).moves, 1);
    // A plate just above the target leaves room to slide, none to pivot.
    let pitch = start.pitch();
    let plate = |gap: f64| Obstacle {
        shape: Shape::Cuboid { half_extents: Vec3::new(2.0, 2.0, 0.01) },
        pose: Pose::translation(0.0, 0.0, 2.0 * pitch + gap + 0.01),
        friction: 0.5,
    };
    let under = |gap: f64, mut configuration: Configuration| {
        configuration.environment.obstacles.push(plate(gap));
        configuration
    };
    let target = |gap| goal(under(gap, target.configuration.clone()));
    assert_eq!(solved(&plan(&under(0.001, start.clone()), &target(0.001), &options)).moves, 1);
    let refused = solve(&under(-0.01, start.clone()), &target(-0.01), &options, &mut |_| {});
    let Err(Refusal::Unsound { which: Which::Start, problems }) = refused else { panic!("{refused:?}") };
    let on_top = Part::Module(2);
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!((problems[0].part, problems[0].fault), (on_top, UnsoundFault::InsideObstacle { obstacle: 0 }));
    let down = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 2);
    let from = cubes(&[[0, 0, 0], [1, 0, 0], [1, 0, 1]], 2);
    let free = plan(&from, &goal(down.clone()), &options);
    assert_eq!(solved(&free).moves, 1);
    let low = plan(&under(0.001, from), &goal(under(0.001, down)), &options);
    assert!(matches!(low.outcome, Outcome::Impossible(Impossible::Exhausted { .. })), "{:?}", low.outcome);
}

#[test]
fn labelled_modules_go_to_their_own_places() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let end = cubes(&[[0, 0, 0], [0, 0, 1], [1, 0, 0]], 0);
    let target = |labelled| Goal { configuration: end.clone(), matching: Matching { labelled, free_frame: false } };
    let moves = |labelled| {
        let options = Options { objective: Objective::Moves, ..Options::default() };
        solved(&plan(&start, &target(labelled), &options)).moves
    };
    assert_eq!(moves(false), 0);
    assert!(moves(true) > 0);
}

#[test]
fn a_loaded_module_keeps_its_load_and_its_place() {
    let mut start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let at = Some(Vec3::new(0.0, 0.0, 0.02));
    start.loads.push(ModuleLoad { module: 2, force: Vec3::new(0.0, 0.0, -0.2), torque: Vec3::zeros(), at });
    let end = cubes(&[[0, 0, 0], [0, 0, 1], [1, 0, 0]], 0);
    let report = plan(&start, &goal(end), &Options { objective: Objective::Moves, ..Options::default() });
    let best = solved(&report);
    assert!(best.moves > 0, "module c must come down");
    let without = goal(cubes(&[[0, 0, 0], [0, 0, 1]], 0));
    let refused = solve(&start, &without, &Options::default(), &mut |_| {});
    assert_eq!(refused, Err(Refusal::LoadedModuleMissing { module: "c".into() }));
}

#[test]
fn a_free_goal_is_met_anywhere_on_the_ground() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let end = cubes(&[[7, 3, 0], [7, 4, 0], [7, 4, 1]], 0);
    let free = Goal { configuration: end, matching: Matching { labelled: false, free_frame: true } };
    for reduction in [Reduction::Saturated, Reduction::Primitive] {
        let options = Options { objective: Objective::Moves, reduction, ..Options::default() };
        assert_eq!(solved(&plan(&start, &free, &options)).moves, 0, "turned by a half, it is there");
        let row = Goal { configuration: cubes(&[[0, 5, 0], [0, 6, 0], [0, 7, 0]], 0), ..free.clone() };
        assert_eq!(solved(&plan(&start, &row, &options)).moves, 1);
    }
    let mut held = start.clone();
    held.modules[0].fixed = true;
    let refused = solve(&held, &free, &Options::default(), &mut |_| {});
    assert!(matches!(refused, Err(Refusal::NoFreeFrame { .. })), "{refused:?}");
}

#[test]
fn further_plans_differ_in_more_than_the_order_of_independent_moves() {
    // Two cubes, far apart on a held bar, each move one step: one plan, in two orders.
    let bar: Vec<Cell> = (0..8).map(|x| [x, 0, 0]).collect();
    let with = |ends: [Cell; 2]| cubes(&[&bar[..], &ends].concat(), 8);
    let (start, target) = (with([[0, 0, 1], [7, 0, 1]]), goal(with([[1, 0, 1], [6, 0, 1]])));
    let options = Options { objective: Objective::Moves, plans: 2, max_expansions: Some(60), ..Options::default() };
    let report = solve(&start, &target, &options, &mut |_| {}).unwrap();
    let best = report.plan.as_ref().unwrap();
    assert_eq!(best.moves, 2);
    for other in &report.alternatives {
        assert!(replay(&start, &target, other, 0.0).unwrap().is_verified());
        let moved = |plan: &Plan| {
            let mut moves: Vec<_> = plan.actions.iter().filter(|p| p.action.is_move()).map(|p| p.action).collect();
            moves.sort_by_key(|action| format!("{action:?}"));
            moves
        };
        assert_ne!(moved(best), moved(other), "the same moves in another order");
    }
}

#[test]
fn a_report_says_when_further_plans_were_not_looked_for_to_the_end() {
    let (start, target) = tower_to_row();
    let of = |max_expansions| {
        let options = Options { objective: Objective::Moves, plans: 1000, max_expansions, ..Options::default() };
        plan(&start, &target, &options)
    };
    let best = solve(&start, &target, &Options { objective: Objective::Moves, ..Options::default() }, &mut |_| {});
    let best = best.unwrap();
    assert_eq!(best.alternatives_cut_by, None, "one plan was asked for, and there it is");
    let cut = of(Some(best.statistics.expanded + 5));
    assert_eq!(cut.plan, best.plan);
    assert!(cut.alternatives.len() < 999);
    assert_eq!((cut.outcome, cut.alternatives_cut_by), (Outcome::Solved, Some(Limit::Expansions)));
}

#[test]
fn limits_and_cancellation_end_the_search_honestly() {
    let (start, target) = tower_to_row();
    let few = plan(&start, &target, &Options { max_expansions: Some(1), ..Options::default() });
    assert_eq!(few.outcome, Outcome::OutOfBudget(Limit::Expansions));
    assert!(!few.proof.optimal && few.proof.margin_at_most > 0.0);
    let cancel = Arc::new(AtomicBool::new(false));
    cancel.store(true, Ordering::Relaxed);
    let cancelled = plan(&start, &target, &Options { cancel: Some(cancel), ..Options::default() });
    assert_eq!(cancelled.outcome, Outcome::OutOfBudget(Limit::Cancelled));
}

#[test]
fn progress_is_reported() {
    let (start, target) = tower_to_row();
    let mut events = Vec::new();
    solve(&start, &target, &Options::default(), &mut |event| events.push(*event)).unwrap();
    assert!(!events.is_empty());
    assert!(events.windows(2).all(|pair| pair[0].oracle_solves <= pair[1].oracle_solves));
}

#[test]
fn bonds_and_connections_name_the_same_faces() {
    let state = cubes(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 1]], 0);
    assert_eq!(bonds(&state), cells(&state).touching());
}

#[test]
fn a_trace_forgets_the_order_of_independent_moves_only() {
    let slide = |from, direction| Move { from, motion: Motion::Slide { direction } };
    let (near, far) = (slide([0, 0, 1], Face::PosX), slide([7, 0, 1], Face::NegX));
    let next = slide([1, 0, 1], Face::PosX);
    assert_eq!(Trace::new([near, far]), Trace::new([far, near]));
    assert_eq!(Trace::new([near, next, far]), Trace::new([far, near, next]));
    assert_ne!(Trace::new([near, next]), Trace::new([next, near]));
}
