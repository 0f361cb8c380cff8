//! Error against time: every method with every setting on every scene.

use std::time::Duration;

use crate::cone_program::Cone;
use crate::methods::{Answer, Claim, Method};
use crate::pyramid::Side;
use crate::scenes::Scene;
use crate::standard;
use crate::timing::{medians, timed};

/// What one method with one setting did on one scene.
pub struct Row {
    pub family: &'static str,
    pub scene: String,
    pub bodies: usize,
    pub method: Method,
    pub answer: Answer,
    pub reference: f64,
    pub uncertainty: f64,
    /// Largest distance of the answer from the reference; `None` without a finite answer.
    pub error: Option<f64>,
    /// Median time.
    pub milliseconds: f64,
    pub runs: usize,
}

/// How long to measure.
#[derive(Clone, Copy)]
pub struct Effort {
    /// Time for one method with one setting on one scene.
    pub budget: Duration,
    /// Most repetitions.
    pub most: usize,
}

/// What a general solver's tolerance of 1e-8 leaves of an error, generously.
const PROMISED: f64 = 1e-5;

/// Answers first, checked against the reference; then the times, in turns.
///
/// # Panics
/// Where something that is called proved is wrong.
pub fn study(scene: &Scene, methods: &[Method], effort: Effort) -> Vec<Row> {
    let methods: Vec<Method> = methods.iter().copied().filter(|method| applies(*method, scene)).collect();
    let mut rows: Vec<Row> = methods.iter().map(|&method| first(scene, method)).collect();
    let budget = effort.budget.as_secs_f64() * 1e3;
    let again: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].milliseconds < budget).collect();
    let mut ways: Vec<Box<dyn FnMut()>> = again
        .iter()
        .map(|&i| -> Box<dyn FnMut()> {
            let method = methods[i];
            Box::new(move || {
                std::hint::black_box(method.run(&scene.structure, scene.neighbour.as_ref()));
            })
        })
        .collect();
    let times = medians(&mut ways, effort.budget, effort.most);
    for (&i, (milliseconds, runs)) in again.iter().zip(times) {
        (rows[i].milliseconds, rows[i].runs) = (milliseconds, runs);
    }
    rows
}

/// Pyramids only where there are cones to replace, carried-over bounds only where there is a neighbour,
/// and reductions are switched off only where they have something to leave out.
fn applies(method: Method, scene: &Scene) -> bool {
    match method {
        Method::Pyramid(..) => {
            standard::program::<f64>(&scene.structure).groups.iter().any(|group| group.0 == Cone::Lorentz)
        }
        Method::CarriedOver => scene.neighbour.is_some(),
        Method::Unreduced(left_in, _) => left_in.is_found_in(&scene.structure),
        Method::Paper(_) | Method::Standard(_) | Method::ToGap(_) | Method::Decide => true,
    }
}

/// The first run: the answer, and what is wrong with it.
fn first(scene: &Scene, method: Method) -> Row {
    let (mut answer, milliseconds) = timed(|| method.run(&scene.structure, scene.neighbour.as_ref()));
    let (value, uncertainty) = (scene.reference.value, scene.reference.uncertainty);
    // The oracle takes data as meant up to 1e-12.
    let slack = uncertainty + 1e-12;
    let holds = answer.lower - slack <= value && value <= answer.upper + slack;
    assert!(answer.claim != Claim::Proved || holds, "{}: {method:?} does not hold {value}: {answer:?}", scene.name);
    let misplaced = match method {
        Method::Pyramid(Side::Inner, _) => answer.upper < value - PROMISED,
        Method::Pyramid(Side::Outer, _) => answer.lower > value + PROMISED,
        _ => false,
    };
    if misplaced && answer.claim == Claim::Solved {
        answer.claim = Claim::Misplaced;
    }
    Row {
        family: scene.family,
        scene: scene.name.clone(),
        bodies: scene.structure.bodies.len(),
        method,
        answer,
        reference: value,
        uncertainty,
        error: answer.error(value),
        milliseconds,
        runs: 1,
    }
}
