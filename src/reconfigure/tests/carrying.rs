//! Bounds carried over from neighbours against values, and the search from both ends against the one from the start.

use planners::{Reversible, Search, Space};
use proptest::prelude::*;

use crate::reconfigure::assembly::{Assembler, assemble};
use crate::reconfigure::baseline::Baseline;
use crate::reconfigure::carried::Carried;
use crate::reconfigure::course::Course;
use crate::reconfigure::domain::Domain;
use crate::reconfigure::held::Held;
use crate::reconfigure::moves::Move;
use crate::reconfigure::plan::{Objective, Outcome};
use crate::reconfigure::problem::Problem;
use crate::reconfigure::saturated::{Action, Saturated, kept};
use crate::reconfigure::shares::Slides;
use crate::reconfigure::{MARGIN_TOLERANCE, Options};
use crate::robot::Cell;
use crate::statics::{Bracket, Question, assess};

use super::{cubes, goal, plan, polycube};

/// Asks something about the saturated space of a robot that is where it has to be.
fn in_space<T>(filled: &[Cell], ask: impl FnOnce(&Saturated) -> T) -> T {
    let state = cubes(filled, 1);
    let problem = Problem::new(&state, &goal(state.clone())).unwrap();
    let domain = Domain::new(&problem, true);
    ask(&Saturated::new(&domain, planners::Width::UNLIMITED, f64::INFINITY))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Whatever was asked before, a decision is on the side of the floor on which the margin is, and no bound is beaten
    /// by a value.
    #[test]
    fn decisions_agree_with_values(filled in polycube(6), floors in proptest::collection::vec(0.0..1.0_f64, 3)) {
        in_space(&filled, |space| {
            let start = space.start();
            for transition in space.transitions(&start).into_iter().take(6) {
                let Action::Move(_) = transition.action else { continue };
                let value = space.certify(&start, &transition.action, &transition.to, f64::NEG_INFINITY);
                for &floor in &floors {
                    let seen = space.glance(&start, &transition.action, &transition.to, floor).expect("a move can be looked at");
                    let slack = MARGIN_TOLERANCE * value.lower.abs().max(1.0);
                    assert!(seen >= value.lower - slack, "{seen} at a glance, {value:?}");
                    let Some(bounds) = space.decide(&start, &transition.action, &transition.to, floor) else { continue };
                    assert!(bounds.lower >= floor || bounds.upper < floor, "{bounds:?} at {floor}");
                    let slack = MARGIN_TOLERANCE * value.lower.abs().max(1.0);
                    assert!(bounds.lower <= value.upper + slack, "{bounds:?} against {value:?}");
                    assert!(bounds.upper >= value.lower - slack, "{bounds:?} against {value:?}");
                }
            }
        });
    }

    /// What leads into a state leads out of the states that it comes from, and costs and holds as much.
    #[test]
    fn transitions_into_a_state_are_those_out_of_others(filled in polycube(6)) {
        in_space(&filled, |space| {
            let state = space.start();
            for into in space.transitions_into(&state) {
                let out = space.transitions(&into.to);
                let same = out.iter().find(|out| out.to == state && out.action == into.action);
                let same = same.expect("every action reverses");
                assert_eq!(same.cost, into.cost);
            }
            let (out, into) = (space.transitions(&state), space.transitions_into(&state));
            let moves = out.iter().filter(|out| matches!(out.action, Action::Move(_)));
            assert_eq!(moves.count(), into.len());
            if let Some(there) = out.iter().find(|out| matches!(out.action, Action::Move(_))) {
                let back = into.iter().find(|back| {
                    let (Action::Move(a), Action::Move(b)) = (there.action, back.action) else { return false };
                    back.to == there.to && a.inverse() == b
                });
                let back = back.expect("every move leads back");
                let there = space.certify(&state, &there.action, &there.to, f64::NEG_INFINITY);
                let back = space.certify(&back.to, &back.action, &state, f64::NEG_INFINITY);
                assert!((there.lower - back.lower).abs() <= 1e-5, "{there:?} there, {back:?} back");
            }
        });
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The moves of the space are those through which the robot holds together, by its connections one by one.
    #[test]
    fn pieces_tell_what_holds_together(filled in polycube(9)) {
        in_space(&filled, |space| {
            let start = space.start();
            let state = cubes(&filled, 1);
            let problem = Problem::new(&state, &goal(state.clone())).unwrap();
            let domain = Domain::new(&problem, true);
            let layout = start.layout();
            let holds = |step: &Move| {
                let bonds = kept(layout, *step);
                domain.is_connected(layout, &bonds) && domain.stays_connected(layout, &bonds, *step)
            };
            let together: Vec<Move> = domain.moves(layout).into_iter().filter(holds).collect();
            let moves = space.transitions(&start).into_iter().filter_map(|transition| match transition.action {
                Action::Move(step) => Some(step),
                Action::Finish(_) => None,
            });
            assert_eq!(moves.collect::<Vec<_>>(), together);
        });
    }
}

/// Slides over several modules hold as well as over one: what they share is all that one has.
#[test]
fn a_slide_is_as_strong_half_way() {
    // A cube on top of a row, one beneath it (held from above), and one at its side.
    for own in [[0, 0, 1], [0, 0, -1], [0, 1, 0]] {
        let along: Vec<Cell> = (0..3).map(|x| [x, 0, 5]).chain([[0, own[1], 5 + own[2]]]).collect();
        let state = cubes(&along, 1);
        let problem = Problem::new(&state, &goal(state.clone())).unwrap();
        let domain = Domain::new(&problem, true);
        let layout = problem.start_layout();
        let from = [0, own[1], 5 + own[2]];
        let class = layout.placed()[layout.at(from).unwrap()].class;
        let mut slides = Slides::default();
        let slid: Vec<_> = domain.moves(layout).into_iter().filter(|step| step.from == from).collect();
        let held: Vec<f64> =
            slid.iter().filter_map(|&step| slides.of(&problem, layout, class, step)).map(|held| held.margin).collect();
        assert_eq!(held.len(), 1, "one of its moves is a slide: {slid:?}");
        // Of the whole face of one module, by the oracle.
        let mut pair = cubes(&[[0, 0, 5], from], 1);
        pair.environment.ground = None;
        let whole = assess(&assemble(&pair).structure, Question::VALUE).unwrap().margin();
        assert!((held[0] - whole.lower).abs() <= 1e-5, "{held:?} against {whole:?}");
    }
}

/// Every move out of a robot's state with the margin of all its samples, by solves from nothing.
fn measured(domain: &Domain, ask: &mut dyn FnMut(Move, Bracket)) {
    let layout = domain.problem.start_layout();
    let space = Saturated::new(domain, planners::Width::UNLIMITED, f64::INFINITY);
    for transition in space.transitions(&space.start()) {
        let Action::Move(step) = transition.action else { continue };
        let placements = domain.problem.placements(layout);
        ask(step, domain.oracle.of_move(placements, &kept(layout, step), step, f64::NEG_INFINITY).margin);
    }
}

/// Two layers of cubes with one on top: its moves are as strong as its hold, and the others carry it.
const SLAB: [Cell; 9] =
    [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1]];

/// What the others carry is proved for whole moves: of most of those that hold, and never more than their margin.
#[test]
fn what_is_carried_holds() {
    let state = cubes(&SLAB, 0);
    let problem = Problem::new(&state, &goal(state.clone())).unwrap();
    let domain = Domain::new(&problem, true);
    let mut carried = Carried::new(&domain);
    let (mut hold, mut proved) = (0, 0);
    measured(&domain, &mut |step, margin| {
        let layout = problem.start_layout();
        let found = carried.margin(layout, step, 0.0);
        assert!(
            found.is_none_or(|found| 0.0 <= found && found <= margin.upper + MARGIN_TOLERANCE),
            "{found:?}, {margin:?}"
        );
        assert_eq!(carried.margin(layout, step, margin.upper + 1e-3), None, "{step:?}");
        hold += usize::from(margin.lower >= 0.0);
        proved += usize::from(found.is_some());
    });
    assert!(2 * proved > hold && hold > 5, "{proved} of {hold}");
}

/// Where a module's own hold is what limits a move, that is the margin of the whole robot at that moment, and of the
/// move.
#[test]
fn a_hold_that_limits_is_the_margin() {
    for fixed in [0, 1] {
        let state = cubes(&SLAB, fixed);
        let problem = Problem::new(&state, &goal(state.clone())).unwrap();
        let domain = Domain::new(&problem, true);
        let mut held = Held::default();
        let mut found = 0;
        measured(&domain, &mut |step, margin| {
            let layout = problem.start_layout();
            let is_along = domain.is_beside_environment(step);
            let own = held.margin((&problem, &domain.oracle), layout, &kept(layout, step), step, is_along);
            let Some(own) = own else { return };
            found += 1;
            let placements = problem.placements(layout);
            let course = Course::new(placements, &kept(layout, step), step, state.pitch()).unwrap();
            let structure = Assembler::new(&state).assemble(&course.at(own.instant.phase())).structure;
            let there = assess(&structure, Question::VALUE).unwrap().margin();
            assert!((own.margin.lower - there.lower).abs() <= MARGIN_TOLERANCE, "{own:?}, {there:?} of {step:?}");
            assert!((own.margin.upper - there.upper).abs() <= MARGIN_TOLERANCE, "{own:?}, {there:?} of {step:?}");
            // Of two samples that are as bad, another may have been refined.
            let other_samples = 0.05 * (1.0 - margin.lower).abs() + MARGIN_TOLERANCE;
            assert!((own.margin.lower - margin.lower).abs() <= other_samples, "{own:?}, {margin:?} of {step:?}");
        });
        assert!(found > 5, "{found}");
    }
}

/// Starts and goals of cubes on the ground, the first one held.
const PROBLEMS: &[(&[Cell], &[Cell])] = &[
    (&[[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 0]], &[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]),
    (&[[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], &[[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2]]),
    (
        &[[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 0, 1]],
        &[[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 0], [1, 0, 1]],
    ),
];

/// By eager evaluation with cold solves, without estimates, and lazily from both ends: the same answer.
#[test]
fn baselines_find_the_same() {
    let of = |index: usize, objective, baseline: Option<Baseline>| {
        let (from, to) = PROBLEMS[index];
        // From the start alone, a proof about the open ground may have no end.
        let max_expansions = baseline.map(|_| 300);
        let options = Options { objective, baseline, max_expansions, ..Options::default() };
        plan(&cubes(from, 1), &goal(cubes(to, 1)), &options)
    };
    for (index, objective, baseline) in [
        (0, Objective::Moves, Baseline::Eager),
        (0, Objective::Moves, Baseline::Blind),
        (0, Objective::Margin, Baseline::Blind),
        (1, Objective::Margin, Baseline::Blind),
        (2, Objective::Moves, Baseline::Blind),
    ] {
        let (best, other) = (of(index, objective, None), of(index, objective, Some(baseline)));
        assert_eq!(best.outcome, Outcome::Solved);
        if baseline == Baseline::Eager {
            let solves = [&best, &other].map(|report| report.statistics.oracle_solves);
            assert!(2 * solves[0] < solves[1], "{solves:?}");
        }
        let (Outcome::Solved, Some(best), Some(other)) = (&other.outcome, &best.plan, &other.plan) else { continue };
        assert_eq!(other.moves, best.moves, "problem {index} by {baseline:?}");
        if objective == Objective::Margin {
            let (a, b) = (other.margin.unwrap().lower, best.margin.unwrap().lower);
            assert!((a - b).abs() <= 2.0 * MARGIN_TOLERANCE, "{a} against {b} by {baseline:?}");
        }
    }
}

/// The fewest moves from either end alone and from both.
#[test]
fn both_ends_and_one_end_agree() {
    for (from, to) in PROBLEMS {
        let (start, target) = (cubes(from, 1), goal(cubes(to, 1)));
        let problem = Problem::new(&start, &target).unwrap();
        let domain = Domain::new(&problem, true);
        let space = Saturated::new(&domain, planners::Width::UNLIMITED, f64::INFINITY);
        for floor in [0.0, 0.2, 0.4] {
            let fresh = || Search::new(&space, planners::Options::default());
            let cost =
                |outcome: planners::Outcome<_>| outcome.solved().map(|path: &planners::PathOf<Saturated>| path.cost);
            assert_eq!(cost(fresh().from_both_ends(floor)), cost(fresh().shortest(floor)), "{from:?} to {to:?}");
        }
    }
}

#[test]
fn the_largest_margin_does_not_depend_on_the_number_of_threads() {
    let (from, to) = PROBLEMS[2];
    let (start, target) = (cubes(from, 1), goal(cubes(to, 1)));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut report = pool.install(|| plan(&start, &target, &Options::default()));
        report.statistics.seconds = 0.0;
        report
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}
