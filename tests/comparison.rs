//! The methods that benches compare the oracle with, held against each other: a
//! comparison with a wrong method says nothing.

#[path = "../benches/support/cone_program.rs"]
mod cone_program;
#[path = "../benches/error_against_time/double_double.rs"]
mod double_double;
#[path = "support/paper.rs"]
mod paper;
#[path = "../benches/error_against_time/pyramid.rs"]
mod pyramid;
#[path = "support/random.rs"]
mod random;
#[path = "../benches/error_against_time/reference.rs"]
mod reference;
#[path = "support/scenes.rs"]
mod scenes;
#[path = "../benches/support/standard.rs"]
mod standard;

use clarabel::solver::SolverStatus;
use cone_program::settings;
use double_double::DoubleDouble;
use num_traits::Float;
use pyramid::{Side, linear};
use random::{Kind, Recipe, structure};
use reference::{reference, solved, tree};
use steadfast::statics::Structure;

fn wide(value: f64) -> DoubleDouble {
    value.into()
}

#[test]
fn double_double_has_thirty_digits() {
    let third = wide(1.0) / wide(3.0);
    let root = wide(2.0).sqrt();
    let lost = (wide(1e16) + third) - wide(1e16) - third;
    for error in [third * wide(3.0) - wide(1.0), root * root - wide(2.0), lost * wide(1e-16)] {
        assert!(f64::from(error.abs()) < 1e-30, "{error:e}");
    }
    assert!(third * wide(3.0) > wide(1.0) - wide(1e-30) && (third - third.trunc()) == third);
    assert_eq!(f64::from((wide(1.0) + wide(1e-25)) - wide(1.0)), 1e-25);
}

/// Random structures with the paper's utilisation, where it has one.
fn solvable(kind: Kind, bodies: usize) -> impl Iterator<Item = (u64, Structure, f64)> {
    (1..25).filter_map(move |seed| {
        let structure = structure(&Recipe { kind, bodies, seed });
        match paper::solve(&structure, 1e-9) {
            paper::Answer::Utilisation(t) => Some((seed, structure, t)),
            paper::Answer::Infeasible | paper::Answer::GaveUp(_) => None,
        }
    })
}

#[test]
fn the_standard_form_is_the_papers_problem() {
    let mut compared = 0;
    // On stiffer kinds a general solver may itself be wrong.
    let mild = |kind: &Kind| matches!(kind, Kind::Ordinary | Kind::Redundant | Kind::Hinged);
    for kind in Kind::ALL.into_iter().filter(mild) {
        for (seed, structure, t) in solvable(kind, 10) {
            let solution = standard::program::<f64>(&structure).solve(settings(1e-9)).unwrap();
            if solution.status == SolverStatus::Solved {
                let apart = (solution.value - t).abs() / t.max(1.0);
                assert!(apart < 1e-6, "{kind:?} {seed}: {} and {t}", solution.value);
                compared += 1;
            }
        }
    }
    assert!(compared > 20, "{compared} compared");
}

#[test]
fn pyramids_enclose_the_cones_and_close_in() {
    let mut compared = 0;
    for (seed, structure, t) in solvable(Kind::Ordinary, 8).filter(|case| case.2 > 1e-3) {
        let program = standard::program(&structure);
        let value = |side, sides| {
            let solution = linear(&program, side, sides).solve(settings(1e-9)).unwrap();
            (solution.status == SolverStatus::Solved).then_some(solution.value)
        };
        let outer = [4, 32].map(|sides| value(Side::Outer, sides));
        let inner = [32, 4].map(|sides| value(Side::Inner, sides));
        if let ([Some(a), Some(b)], [Some(c), Some(d)]) = (outer, inner) {
            let ladder = [a, b, t, c, d];
            let climbs = ladder.windows(2).all(|pair| pair[0] <= pair[1] * (1.0 + 1e-6) + 1e-7);
            assert!(climbs, "{seed}: {ladder:?}");
            assert!(c - b < 0.5 * (d - a) + 1e-6, "{seed}: no closer with more sides: {ladder:?}");
            compared += 1;
        }
    }
    assert!(compared > 5, "{compared} compared");
}

#[test]
fn the_closed_form_of_trees_solves_their_program() {
    let structure = scenes::tree(30);
    let closed = f64::from(tree(&structure).unwrap());
    let solved = solved(&structure).unwrap();
    assert!((solved.value - closed).abs() <= 1e-15 * closed, "{} and {closed}", solved.value);
    assert_eq!(reference(&structure).unwrap().value, closed);
}

#[test]
fn references_have_more_digits_than_the_methods() {
    for structure in [scenes::truss([2, 2, 2]), scenes::wall(3, 3)] {
        let reference = reference(&structure).unwrap();
        assert!(reference.uncertainty <= 1e-14, "{reference:?}");
    }
}
