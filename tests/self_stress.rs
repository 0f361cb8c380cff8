//! Which assemblies stand only by squeeze that nothing produces.

#[path = "support/random.rs"]
mod random;

use random::{Kind, Recipe, structure};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{
    Anchor, Body, Connection, Connector, Contact, Load, Model, Question, SelfStress, Structure, Verdict, assess,
    contact_self_stress,
};

/// A hexahedron from a plane quadrilateral in x and z, 0.1 m deep along y: mass and centre of its own.
fn block(s: &mut Structure, corners: [[f64; 2]; 4], density: f64) -> usize {
    let (mut area, mut centre) = (0.0, [0.0; 2]);
    for i in 0..4 {
        let ([ax, az], [bx, bz]) = (corners[i], corners[(i + 1) % 4]);
        let cross = ax * bz - bx * az;
        area += cross / 2.0;
        centre = [centre[0] + (ax + bx) * cross / 6.0, centre[1] + (az + bz) * cross / 6.0];
    }
    let com = Vec3::new(centre[0] / area, 0.0, centre[1] / area);
    s.bodies.push(Body { mass: density * area.abs(), com, fixed: false });
    s.bodies.len() - 1
}

/// A face between two points in x and z, 0.1 m deep: four contact points, the normal into `body`,
/// which lies to the left of the way from `from` to `to`.
fn face(s: &mut Structure, body: usize, against: Anchor, from: [f64; 2], to: [f64; 2], friction: f64) {
    let way = Vec3::new(to[0] - from[0], 0.0, to[1] - from[1]).normalize();
    let normal = Vec3::new(-way.z, 0.0, way.x);
    for [x, z] in [from, to] {
        for y in [-0.05, 0.05] {
            s.contacts.push(Contact { body, against, position: Vec3::new(x, y, z), normal, friction });
        }
    }
}

fn empty() -> Structure {
    Structure { gravity: Vec3::new(0.0, 0.0, -9.81), ..Structure::default() }
}

/// The answer for what stands.
fn stress(s: &Structure) -> SelfStress {
    assert_eq!(assess(s, Question::VALUE).expect("sound").verdict, Verdict::Stable);
    contact_self_stress(s).expect("sound")
}

const SQUARE: [[f64; 2]; 4] = [[-0.1, 0.0], [0.1, 0.0], [0.1, 0.2], [-0.1, 0.2]];

/// A block between two immovable walls that lean outwards by `taper` radians towards the top.
fn between_walls(taper: f64, friction: f64, on_ground: bool) -> Structure {
    let mut s = empty();
    let top = 0.1 + 0.2 * taper.tan();
    block(&mut s, [[-0.1, 0.0], [0.1, 0.0], [top, 0.2], [-top, 0.2]], 50.0);
    face(&mut s, 0, Anchor::World, [-top, 0.2], [-0.1, 0.0], friction);
    face(&mut s, 0, Anchor::World, [0.1, 0.0], [top, 0.2], friction);
    if on_ground {
        face(&mut s, 0, Anchor::World, [-0.1, 0.0], [0.1, 0.0], friction);
    }
    s
}

#[test]
fn a_block_between_two_walls_relies_on_squeeze() {
    for friction in [0.2, 0.5, 0.9] {
        assert_eq!(stress(&between_walls(0.0, friction, false)), SelfStress::ReliedOn, "{friction}");
    }
    // Walls that give way downwards are worse still.
    assert_eq!(stress(&between_walls(-0.1, 0.5, false)), SelfStress::ReliedOn);
    // On the ground it does not need them.
    assert_eq!(stress(&between_walls(0.0, 0.5, true)), SelfStress::NotNeeded);
}

/// The law of sliding is Coulomb's: a wedge sinks until its own weight presses it.
#[test]
fn a_wedge_is_pressed_by_its_own_weight() {
    for taper in [0.05, 0.2, 0.6] {
        assert_eq!(stress(&between_walls(taper, 0.5, false)).is_relied_on(), Some(false), "{taper}");
    }
}

#[test]
fn what_a_load_presses_is_not_relied_on() {
    // The right wall is a plate on smooth rails that a force pushes to the left.
    let pushed = |force: f64| {
        let mut s = empty();
        block(&mut s, SQUARE, 50.0);
        let plate = block(&mut s, [[0.1, 0.0], [0.2, 0.0], [0.2, 0.2], [0.1, 0.2]], 50.0);
        face(&mut s, 0, Anchor::World, [-0.1, 0.2], [-0.1, 0.0], 0.5);
        face(&mut s, 0, Anchor::Body(plate), [0.1, 0.0], [0.1, 0.2], 0.5);
        face(&mut s, plate, Anchor::World, [0.1, 0.0], [0.2, 0.0], 0.0);
        face(&mut s, plate, Anchor::World, [0.2, 0.2], [0.1, 0.2], 0.0);
        let push = Vec3::new(-force, 0.0, 0.0);
        s.loads.push(Load { body: plate, force: push, torque: Vec3::zeros(), at: None });
        s
    };
    let weight = 50.0 * 0.04 * 9.81;
    assert_eq!(stress(&pushed(1.2 * weight)).is_relied_on(), Some(false));
    assert_eq!(assess(&pushed(0.8 * weight), Question::VALUE).unwrap().verdict, Verdict::WholeBodyUnstable);
}

#[test]
fn what_stands_on_the_ground_relies_on_nothing() {
    let mut s = empty();
    let (mut below, mut z) = (Anchor::World, 0.0);
    for i in 0..4 {
        let x = 0.02 * f64::from(i);
        let body = block(&mut s, SQUARE.map(|[px, pz]| [px + x, pz + z]), 50.0);
        face(&mut s, body, below, [x - 0.08, z], [x + 0.1, z], 0.6);
        (below, z) = (Anchor::Body(body), z + 0.2);
    }
    assert_eq!(stress(&s), SelfStress::Impossible);
    // Two towers side by side touch all the way up.
    let mut s = empty();
    for x in [0.0, 0.2] {
        let (mut below, mut z) = (Anchor::World, 0.0);
        for level in 0..3 {
            let body = block(&mut s, SQUARE.map(|[px, pz]| [px + x, pz + z]), 50.0);
            face(&mut s, body, below, [x - 0.1, z], [x + 0.1, z], 0.6);
            if x > 0.0 {
                face(&mut s, body, Anchor::Body(level), [x - 0.1, z + 0.2], [x - 0.1, z], 0.6);
            }
            (below, z) = (Anchor::Body(body), z + 0.2);
        }
    }
    assert_eq!(stress(&s), SelfStress::NotNeeded);
}

/// Two pillars on the ground with a bar between them that touches nothing else.
#[test]
fn the_bar_of_an_h_relies_on_squeeze() {
    let mut s = empty();
    let left = block(&mut s, [[-0.4, 0.0], [-0.1, 0.0], [-0.1, 0.5], [-0.4, 0.5]], 2000.0);
    let right = block(&mut s, [[0.1, 0.0], [0.4, 0.0], [0.4, 0.5], [0.1, 0.5]], 2000.0);
    let (mut s, pillars) = (s, [left, right].map(Anchor::Body));
    face(&mut s, left, Anchor::World, [-0.4, 0.0], [-0.1, 0.0], 0.6);
    face(&mut s, right, Anchor::World, [0.1, 0.0], [0.4, 0.0], 0.6);
    for low in [0.1, 0.2] {
        let mut s = s.clone();
        let bar = block(&mut s, [[-0.1, low], [0.1, low], [0.1, low + 0.1], [-0.1, low + 0.1]], 50.0);
        face(&mut s, bar, pillars[0], [-0.1, low + 0.1], [-0.1, low], 0.6);
        face(&mut s, bar, pillars[1], [0.1, low], [0.1, low + 0.1], 0.6);
        assert_eq!(stress(&s), SelfStress::ReliedOn, "{low}");
    }
}

/// A bar between two legs that lean towards each other by `lean` radians, so that the way down
/// widens; the legs are immovable. Upside down it is a wedge.
fn a_shape(lean: f64, friction: f64) -> Structure {
    let mut s = empty();
    let (low, high) = (0.1 + 0.05 * lean.tan(), 0.1 - 0.05 * lean.tan());
    let bar = block(&mut s, [[-low, 0.0], [low, 0.0], [high, 0.1], [-high, 0.1]], 50.0);
    face(&mut s, bar, Anchor::World, [-high, 0.1], [-low, 0.0], friction);
    face(&mut s, bar, Anchor::World, [low, 0.0], [high, 0.1], friction);
    s
}

#[test]
fn the_bar_of_an_a_relies_on_squeeze_and_that_of_a_v_does_not() {
    assert_eq!(stress(&a_shape(0.2, 0.5)), SelfStress::ReliedOn);
    assert_eq!(stress(&a_shape(-0.2, 0.5)), SelfStress::NotNeeded);
    // The legs of a real A stand on the ground, lean on each other and on the bar.
    let mut s = empty();
    let lean = 0.15_f64.tan();
    let leg = |side: f64| {
        let at = |z: f64, out: f64| [side * (0.3 - z * lean + out), z];
        [at(0.0, 0.0), at(0.0, 0.15), at(1.0, 0.15), at(1.0, 0.0)]
    };
    let left = block(&mut s, leg(-1.0), 200.0);
    let right = block(&mut s, leg(1.0), 200.0);
    let inner = |z: f64| 0.3 - z * lean;
    let bar = block(&mut s, [[-inner(0.3), 0.3], [inner(0.3), 0.3], [inner(0.4), 0.4], [-inner(0.4), 0.4]], 20.0);
    face(&mut s, left, Anchor::World, [-0.45, 0.0], [-0.3, 0.0], 0.9);
    face(&mut s, right, Anchor::World, [0.3, 0.0], [0.45, 0.0], 0.9);
    face(&mut s, bar, Anchor::Body(left), [-inner(0.4), 0.4], [-inner(0.3), 0.3], 0.9);
    face(&mut s, bar, Anchor::Body(right), [inner(0.3), 0.3], [inner(0.4), 0.4], 0.9);
    // Leaning in over their feet, the legs press on the bar by their own weight.
    assert_eq!(stress(&s), SelfStress::NotNeeded);
}

/// A round arch of `count` stones between immovable abutments.
fn arch(count: usize, thickness: f64, friction: f64) -> Structure {
    let mut s = empty();
    let at = |i: usize, radius: f64| {
        let angle = std::f64::consts::PI * i as f64 / count as f64;
        [-radius * angle.cos(), radius * angle.sin()]
    };
    let (inner, outer) = (1.0, 1.0 + thickness);
    for i in 0..count {
        let stone = block(&mut s, [at(i, inner), at(i, outer), at(i + 1, outer), at(i + 1, inner)], 100.0);
        let before = if i == 0 { Anchor::World } else { Anchor::Body(stone - 1) };
        face(&mut s, stone, before, at(i, outer), at(i, inner), friction);
        if i + 1 == count {
            face(&mut s, stone, Anchor::World, at(count, inner), at(count, outer), friction);
        }
    }
    s
}

#[test]
fn a_real_arch_relies_on_nothing_but_its_weight() {
    for (count, thickness) in [(5, 0.3), (9, 0.25), (12, 0.2)] {
        let answer = stress(&arch(count, thickness, 0.8));
        assert_eq!(answer.is_relied_on(), Some(false), "{count} {thickness}: {answer:?}");
    }
}

/// Blocks in a row between two walls can be a flat arch, if they are high enough and rough enough;
/// each presses on the next as it turns down.
#[test]
fn two_blocks_between_walls_are_a_flat_arch() {
    let mut s = empty();
    for x in [-0.2, 0.0] {
        block(&mut s, [[x, 0.0], [x + 0.2, 0.0], [x + 0.2, 0.05], [x, 0.05]], 50.0);
    }
    face(&mut s, 0, Anchor::World, [-0.2, 0.05], [-0.2, 0.0], 1.0);
    face(&mut s, 1, Anchor::Body(0), [0.0, 0.05], [0.0, 0.0], 1.0);
    face(&mut s, 1, Anchor::World, [0.2, 0.0], [0.2, 0.05], 1.0);
    assert_eq!(stress(&s), SelfStress::NotNeeded);
}

/// A book on the shelf leans with its upper edge on a neighbour and stands on its foot; another that touches only the
/// two neighbours, tilted a little, would slip down between them.
#[test]
fn a_leaning_book_stands_and_a_jammed_one_relies_on_squeeze() {
    let mut s = empty();
    let (lean, height) = (0.3_f64, 0.25);
    let top = [-height * lean.sin(), height * lean.cos()];
    s.bodies.push(Body { mass: 0.5, com: Vec3::new(top[0] / 2.0, 0.0, top[1] / 2.0), fixed: false });
    let touch = |s: &mut Structure, [x, z]: [f64; 2], normal: Vec3, friction: f64| {
        for y in [-0.05, 0.05] {
            s.contacts.push(Contact {
                body: 0,
                against: Anchor::World,
                position: Vec3::new(x, y, z),
                normal,
                friction,
            });
        }
    };
    touch(&mut s, top, Vec3::x(), 0.5);
    touch(&mut s, [0.0, 0.0], Vec3::z(), 0.5);
    assert_eq!(stress(&s).is_relied_on(), Some(false));
    let mut s = empty();
    let (tilt, length) = (0.15_f64, 0.3);
    let end = [length * tilt.cos(), length * tilt.sin()];
    s.bodies.push(Body { mass: 0.5, com: Vec3::new(end[0] / 2.0, 0.0, end[1] / 2.0), fixed: false });
    touch(&mut s, [0.0, 0.0], Vec3::x(), 0.5);
    touch(&mut s, end, -Vec3::x(), 0.5);
    assert_eq!(stress(&s), SelfStress::ReliedOn);
}

/// What magnets hold needs no squeeze, though its modules touch all round.
#[test]
fn connected_modules_rely_on_their_connections() {
    let model = Model::Cone { friction: [0.8; 2], radius: [0.03; 3] };
    let mut s = empty();
    s.connectors.push(Connector { name: "magnet".into(), strength: 200.0, model });
    for [x, z] in [[0.0, 0.0], [0.1, 0.0], [0.0, -0.1], [0.1, -0.1]] {
        s.bodies.push(Body { mass: 0.3, com: Vec3::new(x, 0.0, z), fixed: false });
    }
    let mut join = |parent: Anchor, child: usize, at: [f64; 2], along: Vec3| {
        let turn = Rotation::rotation_between(&Vec3::z(), &along)
            .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
        let frame = Pose::from_parts(Vec3::new(at[0], 0.0, at[1]).into(), turn);
        s.connections.push(Connection { parent, child: Anchor::Body(child), connector: 0, frame });
    };
    join(Anchor::World, 0, [0.0, 0.05], -Vec3::z());
    join(Anchor::Body(0), 1, [0.05, 0.0], Vec3::x());
    join(Anchor::Body(0), 2, [0.0, -0.05], -Vec3::z());
    join(Anchor::Body(1), 3, [0.1, -0.05], -Vec3::z());
    face(&mut s, 3, Anchor::Body(2), [0.05, -0.05], [0.05, -0.15], 0.4);
    assert_eq!(stress(&s).is_relied_on(), Some(false));
}

/// Scaling all loads changes nothing, nor does another system of units.
#[test]
fn the_answer_does_not_depend_on_units() {
    for (s, expected) in [
        (between_walls(0.0, 0.5, false), SelfStress::ReliedOn),
        (between_walls(0.2, 0.5, false), SelfStress::NotNeeded),
        (arch(7, 0.25, 0.8), stress(&arch(7, 0.25, 0.8))),
    ] {
        for factor in [1e-6, 1e6] {
            let mut scaled = s.clone();
            scaled.gravity *= factor;
            assert_eq!(stress(&scaled), expected, "{factor}");
            let mut sized = s.clone();
            for body in &mut sized.bodies {
                body.com *= factor;
            }
            for contact in &mut sized.contacts {
                contact.position *= factor;
            }
            assert_eq!(stress(&sized), expected, "{factor}");
        }
    }
}

/// Whatever the structure, an answer comes, and without friction no squeeze can be relied on: what
/// presses, pushes along.
#[test]
fn without_friction_nothing_is_relied_on() {
    let mut known = [0, 0];
    for kind in Kind::ALL {
        for seed in 0..3 {
            let mut s = structure(&Recipe { kind, bodies: 1 + seed as usize % 5, seed });
            for contact in &mut s.contacts {
                contact.friction = 0.0;
            }
            if assess(&s, Question::VALUE).expect("sound").verdict != Verdict::Stable {
                continue;
            }
            let answer = contact_self_stress(&s).expect("sound");
            assert_ne!(answer, SelfStress::ReliedOn, "{kind:?} {seed}");
            known[usize::from(answer != SelfStress::Undecided)] += 1;
        }
    }
    assert!(known[1] >= 5 && known[0] <= known[1] / 5, "{known:?}");
}
