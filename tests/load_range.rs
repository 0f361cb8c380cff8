//! The range of a force that a structure withstands: closed forms, the oracle itself on both
//! sides of every end, and the laws of a convex function.

#[path = "support/random.rs"]
mod random;
#[path = "support/recheck.rs"]
mod recheck;

use random::{Kind, Random, Recipe, moved, structure};
use recheck::recheck;
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{
    Anchor, Assessment, Body, Connection, Connector, Contact, Load, LoadRange, Model, Question, RangeEnd, Structure,
    UnitForce, Verdict, assess, load_range,
};

const G: f64 = 9.81;

fn range(structure: &Structure, force: &UnitForce, limit: f64) -> LoadRange {
    load_range(structure, force, limit).expect("sound")
}

fn ends(range: LoadRange) -> [RangeEnd; 2] {
    match range {
        LoadRange::Between { lowest, highest } => [lowest, highest],
        other => panic!("{other:?}"),
    }
}

fn is(end: &RangeEnd, value: f64) -> bool {
    let room = 1e-6 * value.abs().max(1e-2);
    end.force.lower == value
        || (end.force.lower - value).abs() <= room && (end.force.upper - value).abs() <= room && end.is_decided()
}

fn between(structure: &Structure, force: &UnitForce, limit: f64, lowest: f64, highest: f64) -> [RangeEnd; 2] {
    let found = ends(range(structure, force, limit));
    assert!(is(&found[0], lowest) && is(&found[1], highest), "{lowest} {highest}: {found:?}");
    found
}

fn body(mass: f64, com: [f64; 3]) -> Body {
    Body { mass, com: com.into(), fixed: false }
}

fn at_com(direction: [f64; 3]) -> UnitForce {
    UnitForce { body: 0, direction: direction.into(), at: None }
}

fn downwards() -> Rotation {
    Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI)
}

/// A kilogram below a magnet of 100 N at the origin.
fn hanging() -> Structure {
    let model = Model::Cone { friction: [0.8, 0.5], radius: [0.02; 3] };
    Structure {
        gravity: Vec3::new(0.0, 0.0, -G),
        bodies: vec![body(1.0, [0.0, 0.0, -0.1])],
        connectors: vec![Connector { name: "magnet".into(), strength: 100.0, model }],
        connections: vec![Connection {
            parent: Anchor::World,
            child: Anchor::Body(0),
            connector: 0,
            frame: Pose::from_parts(Vec3::zeros().into(), downwards()),
        }],
        ..Structure::default()
    }
}

/// A block of 2 kg on four feet on a slope along x, which rises with x.
fn on_slope(friction: f64, angle: f64) -> Structure {
    let turn = Rotation::from_axis_angle(&Vec3::y_axis(), -angle);
    let foot = |x: f64, y: f64| Contact {
        body: 0,
        against: Anchor::World,
        position: turn * Vec3::new(x, y, 0.0),
        normal: turn * Vec3::z(),
        friction,
    };
    Structure {
        gravity: Vec3::new(0.0, 0.0, -G),
        bodies: vec![Body { mass: 2.0, com: turn * Vec3::new(0.0, 0.0, 0.02), fixed: false }],
        contacts: vec![foot(0.1, 0.1), foot(0.1, -0.1), foot(-0.1, 0.1), foot(-0.1, -0.1)],
        ..Structure::default()
    }
}

/// `count` bodies of 1 kg in a row from the wall along x, 0.1 m apart, joined by latches.
fn cantilever(count: usize, bending: f64) -> Structure {
    let none = f64::INFINITY;
    let model = Model::Box { shear: [none; 2], tension: none, compression: none, bending: [bending; 2], torsion: none };
    let along = Rotation::rotation_between(&Vec3::z(), &Vec3::x()).unwrap();
    let joint = |i: usize| Connection {
        parent: if i == 0 { Anchor::World } else { Anchor::Body(i - 1) },
        child: Anchor::Body(i),
        connector: 0,
        frame: Pose::from_parts(Vec3::new(0.1 * i as f64, 0.0, 0.0).into(), along),
    };
    Structure {
        gravity: Vec3::new(0.0, 0.0, -G),
        bodies: (0..count).map(|i| body(1.0, [0.1 * i as f64 + 0.05, 0.0, 0.0])).collect(),
        connectors: vec![Connector { name: "latch".into(), strength: 1.0, model }],
        connections: (0..count).map(joint).collect(),
        ..Structure::default()
    }
}

#[test]
fn a_hanging_mass_can_be_pulled_as_far_as_its_magnet_holds() {
    let s = hanging();
    let [up, down] = between(&s, &at_com([0.0, 0.0, -2.0]), 1.0, f64::NEG_INFINITY, 100.0 - G);
    assert!(up.is_unlimited() && up.beyond.is_none());
    let beyond = down.beyond.expect("it breaks");
    assert!(beyond.verdict == Verdict::InternallyUnstable && beyond.connections[0].critical);
    // Sideways at the magnet, friction carries what tension leaves.
    for (direction, mu) in [(Vec3::x(), 0.8), (-Vec3::y(), 0.5)] {
        let sideways = UnitForce { body: 0, direction, at: Some(Vec3::zeros()) };
        let most = mu * (100.0 - G);
        between(&s, &sideways, 1.0, -most, most);
    }
    // A margin that is to be left lowers what may be used.
    between(&s, &at_com([0.0, 0.0, -1.0]), 0.6, f64::NEG_INFINITY, 60.0 - G);
}

#[test]
fn a_block_on_a_slope_slides_either_way() {
    for (friction, angle) in [(0.5, 0.2_f64), (0.3, 0.6), (0.1, 0.0), (0.7, 0.6)] {
        let s = on_slope(friction, angle);
        let (weight, up) = (2.0 * G, Rotation::from_axis_angle(&Vec3::y_axis(), -angle) * Vec3::x());
        let push = UnitForce { body: 0, direction: up * 3.0, at: Some(Vec3::zeros()) };
        let (down, hold) = (weight * angle.sin(), friction * weight * angle.cos());
        let found = between(&s, &push, 1.0, down - hold, down + hold);
        for end in found {
            assert_eq!(end.beyond.expect("it slides").verdict, Verdict::WholeBodyUnstable, "{friction} {angle}");
        }
    }
}

#[test]
fn a_cantilever_carries_at_its_tip_what_bending_leaves() {
    for count in [1, 3, 20] {
        let length = 0.1 * count as f64;
        let own = G * count as f64 * length / 2.0;
        let s = cantilever(count, 2.0 * own);
        let tip = UnitForce { body: count - 1, direction: -Vec3::z(), at: Some(Vec3::new(length, 0.0, 0.0)) };
        let [_, down] = between(&s, &tip, 1.0, -3.0 * own / length, own / length);
        let beyond = down.beyond.expect("it breaks");
        assert_eq!(beyond.weakest_connection(), Some(0));
        // Overloaded by its own weight, it has to be lifted, by so much and not more.
        let s = cantilever(count, 0.5 * own);
        // Lifted too much, some joint on the way breaks upwards, at a share xi of the length
        // from the tip: f xi - xi^2 = 1/2 in units of its own moment.
        let joints = (1..=count).map(|k| k as f64 / count as f64);
        let most = joints.map(|xi| (0.5 + xi * xi) / xi).fold(f64::INFINITY, f64::min);
        between(&s, &tip, 1.0, -most * own / length, -0.5 * own / length);
    }
}

#[test]
fn what_no_force_along_the_line_helps_is_said() {
    let s = cantilever(3, 0.1);
    let across = UnitForce { body: 2, direction: Vec3::y(), at: None };
    let LoadRange::Nowhere { best } = range(&s, &across, 1.0) else { panic!("it cannot stand") };
    assert!(best.utilisation.lower > 1.0 && best.connections[0].critical);
}

#[test]
fn a_single_force_may_be_all_that_is_withstood() {
    let s = on_slope(0.0, 0.0);
    between(&s, &UnitForce { body: 0, direction: Vec3::x(), at: Some(Vec3::zeros()) }, 1.0, 0.0, 0.0);
    // In the air, only its weight keeps it there.
    let s = Structure {
        gravity: Vec3::new(0.0, 0.0, -G),
        bodies: vec![body(3.0, [1.0, 2.0, 3.0])],
        ..Structure::default()
    };
    between(&s, &at_com([0.0, 0.0, 1.0]), 1.0, 3.0 * G, 3.0 * G);
    assert!(matches!(range(&s, &at_com([0.0, 1.0, 1.0]), 1.0), LoadRange::Nowhere { .. }));
}

#[test]
fn what_stands_on_the_ground_can_be_pressed_without_end_and_lifted_by_its_weight() {
    let s = on_slope(0.4, 0.1);
    let [lowest, highest] = ends(range(&s, &at_com([0.0, 0.0, -1.0]), 1.0));
    assert!(highest.is_unlimited(), "{highest:?}");
    assert!(is(&lowest, -2.0 * G), "{lowest:?}");
}

#[test]
fn a_fixed_body_withstands_everything() {
    let mut s = hanging();
    s.bodies.push(Body { fixed: true, ..body(1.0, [1.0, 0.0, 0.0]) });
    let on_it = UnitForce { body: 1, ..at_com([1.0, 0.3, 0.0]) };
    let found = ends(range(&s, &on_it, 1.0));
    assert!(found.iter().all(RangeEnd::is_unlimited), "{found:?}");
}

#[test]
fn nonsense_is_refused_all_at_once() {
    let nonsense = UnitForce { body: 7, direction: Vec3::zeros(), at: Some(Vec3::new(f64::NAN, 0.0, 0.0)) };
    let found = load_range(&hanging(), &nonsense, 0.0).expect_err("nonsense");
    let places: Vec<_> = found.iter().map(|problem| problem.place.as_str()).collect();
    assert_eq!(places, ["force.body", "force.direction", "force.at", "limit"]);
}

/// A random structure with a force on one of its bodies.
fn drawn(kind: Kind, seed: u64) -> (Structure, UnitForce) {
    let mut random = Random::new(seed ^ 0x10ad);
    let bodies = 1 + random.below(8);
    let s = structure(&Recipe { kind, bodies, seed });
    let body = random.below(s.bodies.len());
    let at = random.chance(0.5).then(|| s.bodies[body].com + random.vector() * 0.02);
    (s, UnitForce { body, direction: random.vector(), at })
}

fn under(s: &Structure, force: &UnitForce, newtons: f64) -> Structure {
    let mut loaded = s.clone();
    let (force_vector, at) = (force.direction.normalize() * newtons, force.at);
    loaded.loads.push(Load { body: force.body, force: force_vector, torque: Vec3::zeros(), at });
    loaded
}

fn judged(s: &Structure, force: &UnitForce, newtons: f64) -> Assessment {
    let loaded = under(s, force, newtons);
    let answer = assess(&loaded, Question::VALUE).expect("sound");
    recheck(&loaded, &answer).expect("proved");
    answer
}

/// What all of it weighs and carries, in N.
fn weight(s: &Structure) -> f64 {
    let loads: f64 = s.loads.iter().map(|load| load.force.norm()).sum();
    s.bodies.iter().map(|body| body.mass).sum::<f64>() * s.gravity.norm() + loads
}

/// What the oracle says a little inside and a little outside of every end; how many ends were decided.
fn hold_to_the_oracle(kind: Kind, seeds: std::ops::Range<u64>) -> [usize; 2] {
    let mut counts = [0, 0];
    for seed in seeds {
        let (s, force) = drawn(kind, seed);
        let name = format!("{kind:?} {seed}");
        match range(&s, &force, 1.0) {
            LoadRange::Between { lowest, highest } => {
                for (end, sign) in [(&lowest, -1.0), (&highest, 1.0)] {
                    counts[usize::from(end.is_decided())] += 1;
                    let (inner, outer) = if sign > 0.0 {
                        (end.force.lower, end.force.upper)
                    } else {
                        (end.force.upper, end.force.lower)
                    };
                    assert!(sign * (outer - inner) >= 0.0 || end.is_unlimited(), "{name}: {end:?}");
                    let width = highest.force.upper - lowest.force.lower;
                    let size = width.min(1e12).max(inner.abs().min(1e12)).max(1e-3 * weight(&s));
                    let inside = if inner.is_finite() { inner - sign * 1e-6 * size } else { sign * 1e6 };
                    if inside <= highest.force.lower && inside >= lowest.force.upper {
                        let answer = judged(&s, &force, inside);
                        assert!(answer.utilisation.lower <= 1.0, "{name}: {inside} of {end:?}: {answer:?}");
                    }
                    if outer.is_finite() {
                        let outside = outer + sign * 1e-6 * size;
                        let answer = judged(&s, &force, outside);
                        assert!(answer.utilisation.upper > 1.0, "{name}: {outside} of {end:?}: {answer:?}");
                    }
                }
            }
            LoadRange::Nowhere { .. } => {
                counts[1] += 1;
                for newtons in [-10.0, 0.0, 1.0, 30.0] {
                    assert!(judged(&s, &force, newtons).utilisation.upper > 1.0, "{name}: {newtons}");
                }
            }
            LoadRange::Undecided { .. } => counts[0] += 1,
        }
    }
    counts
}

#[test]
fn the_oracle_agrees_on_both_sides_of_every_end() {
    let mut sum = [0, 0];
    for kind in Kind::ALL {
        let counts = hold_to_the_oracle(kind, 0..6);
        sum = [sum[0] + counts[0], sum[1] + counts[1]];
    }
    assert!(sum[0] * 20 <= sum[1], "{sum:?}");
}

/// Bisection by verdicts finds the same ends.
#[test]
fn bisection_finds_the_same_ends() {
    let mut compared = 0;
    for (kind, seed) in [Kind::Ordinary, Kind::Loaded, Kind::Standing, Kind::Uneven].into_iter().zip(40..) {
        for seed in seed * 10..seed * 10 + 4 {
            let (s, force) = drawn(kind, seed);
            let LoadRange::Between { lowest, highest } = range(&s, &force, 1.0) else { continue };
            if !(lowest.force.upper <= 0.0 && highest.force.lower >= 0.0 && highest.force.upper.is_finite()) {
                continue;
            }
            let stands = |newtons: f64| judged(&s, &force, newtons).utilisation.upper <= 1.0;
            let (mut inside, mut outside) = (0.0, 1.0);
            while stands(outside) {
                (inside, outside) = (outside, outside * 2.0);
            }
            while outside - inside > 1e-5 * outside && outside > 1e-9 {
                let middle = 0.5 * (inside + outside);
                if stands(middle) { inside = middle } else { outside = middle }
            }
            let room = 1e-4 * outside + 1e-9;
            let found = highest.force;
            assert!(
                found.lower <= outside + room && found.upper >= inside - room,
                "{kind:?} {seed}: {found:?} {inside}"
            );
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared}");
}

/// Loads, strengths and the force may be measured in other newtons; all may be seen from elsewhere.
#[test]
fn ends_scale_and_move_with_the_structure() {
    for seed in 0..10 {
        let (s, force) = drawn(Kind::Ordinary, seed);
        let before = range(&s, &force, 1.0);
        let mut scaled = s.clone();
        scaled.gravity *= 7.0;
        for load in &mut scaled.loads {
            load.force *= 7.0;
            load.torque *= 7.0;
        }
        for connector in &mut scaled.connectors {
            connector.strength *= 7.0;
            if let Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
                for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
                    *limit *= 7.0;
                }
            }
        }
        let mut random = Random::new(seed);
        let motion = Pose::from_parts((random.vector() * 3.0).into(), random.rotation());
        let seen = UnitForce {
            direction: motion.rotation * force.direction,
            at: force.at.map(|at| motion.transform_point(&at.into()).coords),
            ..force
        };
        for (after, factor) in [(range(&scaled, &force, 1.0), 7.0), (range(&moved(&s, &motion), &seen, 1.0), 1.0)] {
            match (&before, after) {
                (LoadRange::Between { lowest, highest }, LoadRange::Between { lowest: low, highest: high }) => {
                    for (a, b) in [(lowest, &low), (highest, &high)] {
                        let room = 1e-6 * b.force.upper.abs().max(b.force.lower.abs()).min(1e9) + 1e-9;
                        assert!(a.force.lower * factor <= b.force.upper + room, "{seed}: {a:?} {b:?}");
                        assert!(a.force.upper * factor >= b.force.lower - room, "{seed}: {a:?} {b:?}");
                    }
                }
                (LoadRange::Nowhere { .. }, LoadRange::Nowhere { .. }) => {}
                (before, after) => panic!("{seed}: {before:?} {after:?}"),
            }
        }
        // The opposite direction has the opposite ends.
        let back = range(&s, &UnitForce { direction: -force.direction, ..force }, 1.0);
        if let (LoadRange::Between { lowest, .. }, LoadRange::Between { highest, .. }) = (&before, back) {
            let room = 1e-6 * highest.force.upper.abs().min(1e9) + 1e-9;
            assert!(-lowest.force.upper <= highest.force.upper + room, "{seed}");
            assert!(-lowest.force.lower >= highest.force.lower - room, "{seed}");
        }
    }
}
