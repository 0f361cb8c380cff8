//! `Question::Full`: the utilisation as before, proved, in the state with the least sum
//! of strengths and of contact pressures.

#[path = "support/paper.rs"]
mod paper;
#[path = "support/random.rs"]
mod random;
#[path = "support/recheck.rs"]
mod recheck;

use nalgebra::Rotation3;
use random::{Kind, Recipe, structure};
use recheck::recheck;
use steadfast::io::{SourceFile, read_structure};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{
    Anchor, Assessment, Body, Bracket, Connection, Connector, Contact, Distribution, Model, Question, Structure,
    Verdict, assess,
};

/// By how much of the larger of it and 1 the upper end may differ from the one that
/// [`Question::VALUE`] gives, whose own promise is twice this.
const ROOM: f64 = 5e-8;

fn full(structure: &Structure) -> Assessment {
    let answer = assess(structure, Question::Full).expect("a valid structure");
    if let Err(fault) = recheck(structure, &answer) {
        panic!("{fault}\n{:?} {:?}", answer.verdict, answer.utilisation);
    }
    answer
}

fn pressure(structure: &Structure, answer: &Assessment, contact: usize) -> f64 {
    answer.contacts[contact].dot(&structure.contacts[contact].normal.normalize())
}

/// What is minimised, from the shown state alone, in N.
fn sum(structure: &Structure, answer: &Assessment) -> f64 {
    let strengths = answer.connections.iter().map(|state| state.strength).sum::<f64>();
    strengths + (0..answer.contacts.len()).map(|k| pressure(structure, answer, k)).sum::<f64>()
}

/// Random structures of one kind that stand with some strength and that something was
/// solved for, with their plain answers.
fn solved(kind: Kind, seeds: std::ops::Range<u64>) -> impl Iterator<Item = (Recipe, Structure, Assessment)> {
    seeds.filter_map(move |seed| {
        let recipe = Recipe { kind, bodies: 2 + seed as usize % 11, seed };
        let structure = structure(&recipe);
        let value = assess(&structure, Question::VALUE).expect("the generator makes valid structures");
        let stands = value.utilisation.upper.is_finite() && value.left_out.solved_blocks > 0;
        stands.then_some((recipe, structure, value))
    })
}

#[test]
fn the_utilisation_stays_and_the_sum_does_not_grow() {
    let (mut all, mut kept, mut wider, mut less) = (0, 0, 0, 0);
    for kind in Kind::ALL {
        for (recipe, s, value) in solved(kind, 0..16) {
            let full = full(&s);
            let Bracket { lower, upper } = value.utilisation;
            assert_eq!((full.utilisation.lower, full.verdict), (lower, value.verdict), "{recipe:?}");
            let more = full.utilisation.upper - upper;
            assert!((0.0..=ROOM * upper.max(1.0)).contains(&more), "{recipe:?}: wider by {more}");
            let narrow = |bracket| Question::VALUE.is_answered_by(bracket);
            assert!(!narrow(&value.utilisation) || narrow(&full.utilisation), "{recipe:?}");
            let (before, after) = (sum(&s, &value), sum(&s, &full));
            assert!(after <= before * (1.0 + 1e-7), "{recipe:?}: {after} is more than {before}");
            for (a, b) in value.connections.iter().zip(&full.connections) {
                assert_eq!(a.critical, b.critical, "{recipe:?}");
            }
            assert_ne!(full.distribution, Distribution::Proof, "{recipe:?}");
            all += 1;
            kept += usize::from(full.distribution != Distribution::Least);
            wider += usize::from(more > 1e-8 * upper.max(1.0));
            less += usize::from(after < before * 0.99);
        }
    }
    assert!(kept * 12 <= all, "{kept} of {all} could not be proved");
    assert!(wider * 12 <= all, "{wider} of {all} are wider by 1e-8");
    assert!(less * 3 >= all, "only {less} of {all} have a lesser sum");
}

/// The paper adds the sum with a small weight, and gives up some of the utilisation for
/// it. Where that is no more than rounding, our sum is no more than the paper's; and the
/// paper's objective is no more at its state than at ours. Where our bracket is wider
/// than that, its upper end allows a lesser sum.
#[test]
fn the_papers_weighted_program_agrees() {
    let (mut compared, mut equal) = (0, 0);
    for kind in Kind::ALL {
        for (recipe, s, value) in solved(kind, 0..40).filter(|(recipe, ..)| recipe.bodies <= 8) {
            let weight = 1e-5 * value.utilisation.upper.clamp(1e-3, 1.0);
            let (paper::Answer::Utilisation(t), terms) = paper::solve_weighted(&s, 1e-11, weight) else { continue };
            let paper::Answer::Utilisation(alone) = paper::solve(&s, 1e-11) else { continue };
            assert!(alone <= t + 1e-8 * t.max(1.0), "{recipe:?}: {alone} is not the least, {t}");
            let full = full(&s);
            if full.distribution != Distribution::Least {
                continue;
            }
            let (found, least, upper) = (sum(&s, &full), terms.iter().sum::<f64>(), full.utilisation.upper);
            let (newton, rounding) = (weight / paper::typical_force(&s), 1e-9 * t.max(1.0));
            assert!(t + newton * least <= upper + newton * found + rounding, "{recipe:?}: {found} below {least}");
            if t <= upper + 1e-12 * upper.max(1.0) {
                let small = 1e-9 * paper::typical_force(&s);
                assert!(found <= least * (1.0 + 1e-6) + small, "{recipe:?}: {found} is more than {least}");
                compared += 1;
                equal += usize::from(found >= least * (1.0 - 1e-3) - small);
            }
        }
    }
    assert!(compared >= 150 && equal * 20 >= compared * 19, "{compared} compared, {equal} equal");
}

/// What flows through a body without weight counts like any other: the solver was once
/// asked in units of its own small loads, and returned 68.913 N for this structure.
#[test]
fn a_weightless_body_is_no_reason_for_more() {
    let s = structure(&Recipe { kind: Kind::Redundant, bodies: 8, seed: 17 });
    let (paper::Answer::Utilisation(t), terms) = paper::solve_weighted(&s, 1e-11, 1e-4) else { panic!("it stands") };
    let full = full(&s);
    assert!(s.bodies.iter().any(|body| body.mass == 0.0) && t <= full.utilisation.upper + 1e-12);
    let (found, least) = (sum(&s, &full), terms.iter().sum::<f64>());
    assert!((found - least).abs() <= 1e-6 * least, "{found} is not {least}");
}

#[test]
fn the_same_question_has_the_same_answer() {
    for kind in [Kind::Ordinary, Kind::Clamped, Kind::LogNormal, Kind::Standing] {
        for (recipe, s, _) in solved(kind, 0..6) {
            assert_eq!(assess(&s, Question::Full), assess(&s, Question::Full), "{recipe:?}");
        }
    }
}

fn body(mass: f64, com: Vec3) -> Body {
    Body { mass, com, fixed: false }
}

fn magnet(strength: f64) -> Connector {
    let model = Model::Cone { friction: [0.8, 0.5], radius: [0.025, 0.025, 0.02] };
    Connector { name: "magnet".to_owned(), strength, model }
}

/// A plate of `mass` that hangs from `count` magnets evenly around its middle.
fn chandelier(count: usize, mass: f64) -> Structure {
    let down = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
    let connections = (0..count).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let at = Rotation3::from_axis_angle(&Vec3::z_axis(), angle) * Vec3::new(0.1, 0.0, 0.05);
        Connection {
            parent: Anchor::World,
            child: Anchor::Body(0),
            connector: 0,
            frame: Pose::from_parts(at.into(), Rotation::from_axis_angle(&Vec3::z_axis(), angle) * down),
        }
    });
    Structure {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        bodies: vec![body(mass, Vec3::zeros())],
        connectors: vec![magnet(100.0)],
        connections: connections.collect(),
        ..Structure::default()
    }
}

#[test]
fn equal_magnets_share_equally() {
    for count in 2..9 {
        let s = chandelier(count, 3.0);
        let answer = full(&s);
        let share = 3.0 * 9.81 / count as f64;
        assert_eq!(answer.distribution, Distribution::Least);
        for (i, state) in answer.connections.iter().enumerate() {
            assert!((state.strength - share).abs() < 1e-4 * share, "{count}: {}", state.strength);
            assert!(state.critical || answer.is_at_limit(i), "{count}");
        }
    }
}

/// As above, but an overloaded magnet beside it sets the utilisation: nothing forces
/// the plate's magnets to share, any split of the weight has the same sum.
#[test]
fn equal_magnets_share_equally_below_the_limit() {
    let mut s = chandelier(4, 3.0);
    s.bodies.push(body(20.0, Vec3::new(1.0, 0.0, -0.1)));
    let lone = s.connections[0].frame.rotation;
    let frame = Pose::from_parts(Vec3::new(1.0, 0.0, 0.0).into(), lone);
    s.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(1), connector: 0, frame });
    let answer = full(&s);
    assert_eq!(answer.verdict, Verdict::InternallyUnstable);
    let share = 3.0 * 9.81 / 4.0;
    for (i, state) in answer.connections.iter().enumerate().take(4) {
        assert!((state.strength - share).abs() < 1e-3 * share, "{}", state.strength);
        assert!(!state.critical && !answer.is_at_limit(i));
    }
    assert!(answer.connections[4].critical && !answer.is_at_limit(4));
    assert!((answer.connections[4].utilisation - 20.0 * 9.81 / 100.0).abs() < 1e-9);
}

/// A block between floor and ceiling may be wedged as tightly as one likes; the least
/// sum is its weight on the floor and nothing at the ceiling, in equal quarters.
#[test]
fn nothing_is_wedged_without_need() {
    let corner = |x: f64, y: f64, z: f64, normal: Vec3| Contact {
        body: 0,
        against: Anchor::World,
        position: Vec3::new(x, y, z),
        normal,
        friction: 0.6,
    };
    let corners = [(0.1, 0.1), (0.1, -0.1), (-0.1, 0.1), (-0.1, -0.1)];
    let floor = corners.map(|(x, y)| corner(x, y, -0.1, Vec3::z()));
    let ceiling = corners.map(|(x, y)| corner(x, y, 0.1, -Vec3::z()));
    let s = Structure {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        bodies: vec![body(2.0, Vec3::zeros())],
        contacts: floor.into_iter().chain(ceiling).collect(),
        ..Structure::default()
    };
    let answer = full(&s);
    let weight = 2.0 * 9.81;
    assert_eq!((answer.verdict, answer.distribution), (Verdict::Stable, Distribution::Least));
    assert!((sum(&s, &answer) - weight).abs() < 1e-6 * weight, "{}", sum(&s, &answer));
    for k in 0..8 {
        let expected = if k < 4 { weight / 4.0 } else { 0.0 };
        let found = pressure(&s, &answer, k);
        assert!((found - expected).abs() < 1e-4 * weight, "{k}: {found}");
    }
}

/// At the utilisation of an overloaded neighbour the magnets could bend against each
/// other; the least sum is the weight, since tension is all that is needed.
#[test]
fn tension_is_all_that_hanging_needs() {
    let s = chandelier(6, 5.0);
    let mut with_lone = s.clone();
    with_lone.connectors.push(magnet(1.0));
    with_lone.bodies.push(body(1.0, Vec3::new(1.0, 0.0, -0.1)));
    let frame = Pose::from_parts(Vec3::new(1.0, 0.0, 0.0).into(), s.connections[0].frame.rotation);
    with_lone.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(1), connector: 1, frame });
    let answer = full(&with_lone);
    let total = (5.0 + 1.0) * 9.81;
    assert!((sum(&with_lone, &answer) - total).abs() < 1e-6 * total, "{}", sum(&with_lone, &answer));
}

#[test]
fn the_papers_suspension() {
    let path = problems::root().join("structures/suspension_76.json");
    let s = read_structure(&SourceFile::new("suspension_76", std::fs::read(path).unwrap())).unwrap().structure;
    let value = assess(&s, Question::VALUE).unwrap();
    let answer = full(&s);
    assert_eq!((answer.verdict, answer.distribution), (Verdict::Stable, Distribution::Least));
    assert!((answer.utilisation.upper * 109.2 - 76.5).abs() < 0.05, "{:?}", answer.utilisation);
    let (before, after) = (sum(&s, &value), sum(&s, &answer));
    assert!(after <= before, "{after} is more than {before}");
    // What the four fixed bodies hold up must pass through their connections.
    let critical = answer.connections.iter().filter(|state| state.critical);
    assert!(critical.clone().count() >= 4 && critical.clone().all(|state| (state.strength - 76.5).abs() < 0.05));
    let mild = answer.connections.iter().filter(|state| state.utilisation < 0.5 * answer.utilisation.upper);
    assert!(mild.count() * 2 > answer.connections.len(), "most connections carry little");
}
