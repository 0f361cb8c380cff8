//! What is written reads back equal, bit for bit, whatever the numbers.

use proptest::prelude::*;
use steadfast::io::{NamedStructure, SourceFile, read_structure, write_structure};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Load, Model, Structure};

fn number() -> impl Strategy<Value = f64> {
    use prop::num::f64;
    f64::NORMAL | f64::SUBNORMAL | f64::ZERO
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from)
}

fn rotation() -> impl Strategy<Value = Rotation> {
    [-3.2..3.2, -1.6..1.6, -3.2..3.2].prop_map(|[r, p, y]| Rotation::from_euler_angles(r, p, y))
}

fn limit() -> impl Strategy<Value = f64> {
    prop_oneof![number().prop_map(f64::abs), Just(f64::INFINITY)]
}

fn positive() -> impl Strategy<Value = f64> {
    prop::num::f64::POSITIVE.prop_filter("a number", |x| x.is_finite() && *x > 0.0)
}

fn model() -> impl Strategy<Value = Model> {
    let cone = ([positive(), positive()], [positive(), positive(), positive()]);
    let limits = ([limit(), limit()], limit(), limit(), [limit(), limit()], limit());
    prop_oneof![
        cone.prop_map(|(friction, radius)| Model::Cone { friction, radius }),
        limits.prop_map(|(shear, tension, compression, bending, torsion)| Model::Box {
            shear,
            tension,
            compression,
            bending,
            torsion
        }),
        (number(), number(), number()).prop_map(|(x, y, friction)| Model::Patch {
            friction: friction.abs(),
            points: vec![[x, y], [-x, -y], [y, -x]],
        }),
    ]
}

prop_compose! {
    fn structures()(
        model in model(), strength in positive(), gravity in vector(), frame in (vector(), rotation()),
        com in [vector(), vector()], mass in number(), fixed: bool, contact in (vector(), rotation(), number()),
        load in (vector(), vector(), prop::option::of(vector())), name in "\\PC*",
    ) -> NamedStructure {
        let body = |com, fixed| Body { mass: mass.abs(), com, fixed };
        let connection = Connection {
            parent: Anchor::World,
            child: Anchor::Body(1),
            connector: 0,
            frame: Pose::from_parts(frame.0.into(), frame.1),
        };
        let (position, tilt, friction) = contact;
        let contact = Contact {
            body: 0,
            against: Anchor::Body(1),
            position,
            normal: (tilt * Vec3::z()).normalize(),
            friction: friction.abs(),
        };
        NamedStructure {
            structure: Structure {
                gravity,
                bodies: vec![body(com[0], fixed), body(com[1], !fixed)],
                connectors: vec![Connector { name: name.clone(), strength, model }],
                connections: vec![connection],
                contacts: vec![contact],
                loads: vec![Load { body: 1, force: load.0, torque: load.1, at: load.2 }],
            },
            bodies: vec![format!("{name} 1"), format!("{name} 2")],
            connections: vec![name.clone()],
            contacts: vec![name],
        }
    }
}

/// All numbers as bits: `==` alone would take -0 for 0.
fn bits(named: &NamedStructure) -> Vec<u64> {
    let structure = &named.structure;
    let mut all: Vec<f64> = structure.gravity.iter().copied().collect();
    all.extend(structure.bodies.iter().flat_map(|body| body.com.iter().copied().chain([body.mass])));
    for connection in &structure.connections {
        all.extend(connection.frame.translation.vector.iter().chain(connection.frame.rotation.coords.iter()));
    }
    all.extend(structure.contacts.iter().flat_map(|c| c.position.iter().chain(c.normal.iter()).copied()));
    all.extend(structure.loads.iter().flat_map(|load| load.force.iter().chain(load.torque.iter()).copied()));
    all.into_iter().map(f64::to_bits).collect()
}

proptest! {
    #[test]
    fn structures_come_back(named in structures()) {
        let text = write_structure(&named).unwrap();
        match read_structure(&SourceFile::new("written", text)) {
            Ok(read) => {
                prop_assert_eq!(bits(&read), bits(&named));
                prop_assert_eq!(read, named);
            }
            Err(diagnostics) => prop_assert!(false, "{}", diagnostics),
        }
    }

    #[test]
    fn what_json_cannot_say_is_refused(mut named in structures(), bad in prop::sample::select(vec![f64::NAN, f64::INFINITY])) {
        named.structure.gravity.y = bad;
        prop_assert!(write_structure(&named).is_err());
    }
}

#[test]
fn a_false_turn_is_kept_and_found() {
    use steadfast::io::{AxisAngle, PlanDocument, read_plan, write_plan};
    use steadfast::reconfigure::Turn;
    use steadfast::robot::Face;
    let read = |text: String| read_plan(&SourceFile::new("plan.json", text)).unwrap();
    let text = std::fs::read_to_string(problems::root().join("valid/plan.json")).unwrap();
    let sound = read(text.clone());
    assert!(sound.contradictions.is_empty());
    assert_eq!(sound, PlanDocument::new(sound.problem.clone(), &sound.report));

    let given = AxisAngle { axis: Face::PosY, turn: Turn::Half };
    let actual = Some(AxisAngle { axis: Face::NegY, turn: Turn::Half });
    let altered = read(text.replace("\"axis\": \"-y\"", "\"axis\": \"+y\""));
    let [contradiction] = altered.contradictions[..] else { panic!("one contradiction") };
    assert_eq!((contradiction.plan, contradiction.action), (0, 0));
    assert_eq!((contradiction.given, contradiction.actual), (given, actual));
    assert_eq!(altered.report, sound.report);
    assert_eq!(read(write_plan(&altered).unwrap()), altered);
}
