//! The order in which connections would give way: closed forms, and the oracle itself on
//! structures whose strengths make every level the first.

#[path = "support/random.rs"]
mod random;

use random::{Kind, Recipe, structure};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{
    Anchor, Body, Bracket, Connection, Connector, FailureOrder, Model, Question, Structure, Verdict, assess,
    failure_order,
};

fn order(structure: &Structure, most: usize) -> FailureOrder {
    failure_order(structure, most).expect("sound").expect("it can stand")
}

fn is(bracket: Bracket, value: f64) -> bool {
    (bracket.lower - value).abs() <= 2e-6 * value && (bracket.upper - value).abs() <= 2e-6 * value
}

/// A beam of 3 kg and 1 m under a ceiling, on pins that only pull, at `places` along it, centred
/// at 0.
fn hung_beam(places: &[f64]) -> Structure {
    let none = f64::INFINITY;
    let model = Model::Box { shear: [none; 2], tension: 30.0, compression: none, bending: [0.0; 2], torsion: 0.0 };
    let down = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
    let pin = |x: &f64| Connection {
        parent: Anchor::World,
        child: Anchor::Body(0),
        connector: 0,
        frame: Pose::from_parts(Vec3::new(*x, 0.0, 0.0).into(), down),
    };
    Structure {
        gravity: Vec3::new(0.0, 0.0, -10.0),
        bodies: vec![Body { mass: 3.0, com: Vec3::new(0.0, 0.0, -0.1), fixed: false }],
        connectors: vec![Connector { name: "pin".into(), strength: 30.0, model }],
        connections: places.iter().map(pin).collect(),
        ..Structure::default()
    }
}

#[test]
fn the_nearer_of_two_pins_gives_way_first() {
    let found = order(&hung_beam(&[-0.4, 0.2]), 10);
    let levels: Vec<_> = found.levels.iter().map(|level| &level.connections[..]).collect();
    assert_eq!(levels, [[1], [0]], "{found:?}");
    assert!(is(found.levels[0].utilisation, 2.0 / 3.0) && is(found.levels[1].utilisation, 1.0 / 3.0), "{found:?}");
    assert!(found.idle.is_empty() && found.open.is_empty());
}

#[test]
fn equal_pins_give_way_together() {
    let found = order(&hung_beam(&[-0.3, 0.0, 0.3]), 10);
    assert_eq!(found.levels.len(), 1, "{found:?}");
    assert!(is(found.levels[0].utilisation, 1.0 / 3.0) && found.levels[0].connections == [0, 1, 2], "{found:?}");
}

#[test]
fn what_is_not_asked_for_stays_open() {
    let found = order(&hung_beam(&[-0.4, 0.2]), 1);
    assert_eq!((found.levels.len(), &found.open[..]), (1, &[0][..]), "{found:?}");
}

/// Masses that hang on one magnet each, from another: the order is that of weight over strength.
#[test]
fn a_chain_gives_way_from_the_top() {
    let down = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
    let model = Model::Cone { friction: [0.5; 2], radius: [0.1; 3] };
    let mut s = Structure { gravity: Vec3::new(0.0, 0.0, -10.0), ..Structure::default() };
    s.connectors.push(Connector { name: "magnet".into(), strength: 100.0, model });
    for i in 0..4 {
        s.bodies.push(Body { mass: 1.0, com: Vec3::new(0.0, 0.0, -0.1 - 0.2 * i as f64), fixed: false });
        s.connections.push(Connection {
            parent: if i == 0 { Anchor::World } else { Anchor::Body(i - 1) },
            child: Anchor::Body(i),
            connector: 0,
            frame: Pose::from_parts(Vec3::new(0.0, 0.0, -0.2 * i as f64).into(), down),
        });
    }
    let found = order(&s, 10);
    let levels: Vec<_> = found.levels.iter().map(|level| level.connections[0]).collect();
    assert_eq!(levels, [0, 1, 2, 3]);
    assert!((0..4).all(|i| is(found.levels[i].utilisation, 0.1 * (4 - i) as f64)), "{found:?}");
}

#[test]
fn without_gravity_nothing_gives_way() {
    let s = Structure { gravity: Vec3::zeros(), ..hung_beam(&[-0.3, 0.0, 0.3]) };
    assert_eq!(order(&s, 10), FailureOrder { idle: vec![0, 1, 2], ..FailureOrder::default() });
}

#[test]
fn what_falls_as_a_whole_has_no_order() {
    let mut s = hung_beam(&[-0.4, 0.2]);
    s.bodies.push(Body { mass: 1.0, com: Vec3::zeros(), fixed: false });
    assert_eq!(failure_order(&s, 10).expect("sound"), None);
}

/// With every level's strengths scaled so that all before it need no more than it, the oracle's
/// utilisation is that of the level: a lower one would be better for those before and for the rest.
#[test]
fn every_level_is_the_utilisation_of_a_structure_of_its_own() {
    let (mut levels, mut open, mut all) = (0, 0, 0);
    // Supports nearly in a line multiply what data are meant to by as much as they are narrow.
    for kind in Kind::ALL.into_iter().filter(|kind| *kind != Kind::Collinear) {
        for seed in 0..3 {
            let s = structure(&Recipe { kind, bodies: 4 + 4 * seed as usize, seed });
            let first = assess(&s, Question::VALUE).expect("sound");
            let Some(found) = failure_order(&s, 5).expect("sound") else {
                assert!(first.verdict == Verdict::WholeBodyUnstable || first.utilisation.upper.is_infinite());
                continue;
            };
            let mut listed: Vec<usize> = found.levels.iter().flat_map(|level| level.connections.clone()).collect();
            listed.extend(found.idle.iter().chain(&found.open));
            listed.sort_unstable();
            assert_eq!(listed, (0..s.connections.len()).collect::<Vec<_>>(), "{kind:?} {seed}: {found:?}");
            all += s.connections.len();
            open += if found.levels.len() < 5 { found.open.len() } else { 0 };
            for (k, level) in found.levels.iter().enumerate() {
                let t = level.utilisation;
                assert!(t.lower <= t.upper, "{kind:?} {seed}: {found:?}");
                if k > 0 {
                    let before = found.levels[k - 1].utilisation;
                    assert!(t.upper <= before.upper * (1.0 + 1e-9), "{kind:?} {seed}: {found:?}");
                }
                let mut scaled = s.clone();
                for earlier in &found.levels[..k] {
                    for &connection in &earlier.connections {
                        strengthen(&mut scaled, connection, earlier.utilisation.upper / t.upper);
                    }
                }
                let answer = assess(&scaled, Question::VALUE).expect("sound").utilisation;
                let room = 1e-4 * first.utilisation.upper;
                assert!(
                    answer.lower <= t.upper + room && answer.upper >= t.lower - room,
                    "{kind:?} {seed} level {k}: {answer:?} {t:?}"
                );
                levels += 1;
            }
        }
    }
    assert!(levels >= 40 && open * 5 <= all, "{levels} {open} {all}");
}

/// Gives one connection a connector of its own, `factor` times as strong.
fn strengthen(s: &mut Structure, connection: usize, factor: f64) {
    let mut connector = s.connectors[s.connections[connection].connector].clone();
    connector.strength *= factor;
    if let Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
        for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
            *limit *= factor;
        }
    }
    s.connections[connection].connector = s.connectors.len();
    s.connectors.push(connector);
}
