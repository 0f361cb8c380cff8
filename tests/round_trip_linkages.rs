//! Linkages and plans for them come back equal, written and read, bit for bit.

use std::sync::Arc;

use nalgebra::Unit;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::Index;
use steadfast::geometry::linkage_problems;
use steadfast::io::{
    LinkagePlanDocument, LinkageProblem, PlanDocument, SourceFile, no_references, read_linkage, read_linkage_plan,
    write_linkage, write_linkage_plan,
};
use steadfast::reconfigure::linkage::assembly::Held;
use steadfast::reconfigure::linkage::{Action, Half};
use steadfast::reconfigure::{
    Bottleneck, IfStronger, Impossible, InTheWay, Limit, Moment, Nearest, Objective, Outcome, Plan, PlannedAction,
    Proof, Report, Statistics, Which,
};
use steadfast::robot::linkage::{Code, Connection, Goal, Linkage, Module, Port, Spot};
use steadfast::robot::{
    BodyType, Catalogue, Environment, JointType, Matching, ModuleLoad, ModuleType, PortPlace, PortType, Requirement,
    Shape,
};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Bracket, Connector, Model};

fn vector(size: f64) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from)
}

fn rotation() -> impl Strategy<Value = Rotation> {
    prop_oneof![
        Just(Rotation::identity()),
        (-3.2..3.2, -1.6..1.6, -3.2..3.2).prop_map(|(r, p, y): (f64, f64, f64)| Rotation::from_euler_angles(r, p, y)),
    ]
}

fn body(name: &str, mass: f64, shape: Shape, shape_pose: Pose, com: Vec3) -> BodyType {
    BodyType { name: name.into(), mass, com, shape, shape_pose }
}

fn at(name: &str, body: usize, frame: Pose, orientations: u32) -> PortType {
    PortType { name: name.into(), body, place: PortPlace::Point { frame, orientations }, connector: Some(0) }
}

prop_compose! {
    /// Balls, and elbows with ports that look anywhere and a joint about any line.
    fn catalogues()(
        mass in 0.0..3.0, radius in 0.01..0.1, com in vector(0.1), off in vector(0.05), turn in rotation(),
        frames in [(vector(0.3), rotation()), (vector(0.3), rotation())], orientations in 1..9_u32,
        axis in vector(1.0).prop_filter("a direction", |v| v.norm() > 0.1), origin in vector(0.1),
        range in option::of((-4..=0, 0..=4)), step in prop_oneof![Just(90.0), Just(360.0 / 7.0), 1e-3..180.0],
        roll in option::of(prop_oneof![Just(90.0), Just(22.5), Just(60.0)]), rotates: bool, name in "\\PC{0,9}",
    ) -> Catalogue {
        let ball = body("shell", mass, Shape::Ball { radius }, Pose::from_parts(off.into(), turn), com);
        let small = || Shape::Cuboid { half_extents: Vec3::repeat(0.01) };
        let frame = |i: usize| Pose::from_parts(frames[i].0.into(), frames[i].1);
        let module_type = |name: &str, bodies, joints, ports| ModuleType {
            name: name.into(), bodies, joints, ports, rotates: false, roll_step_degrees: None, lattice: None,
        };
        let surface = PortType { name: "surface".into(), body: 0, place: PortPlace::Surface, connector: None };
        let joint = JointType {
            name: "bend".into(), parent: 0, child: 1, axis: Unit::new_normalize(axis), origin,
            range: range.map(|(low, high)| [low, high]), step_degrees: step, torque: 2.5,
        };
        let bodies = vec![
            body("upper", 0.5, small(), Pose::identity(), Vec3::zeros()),
            body("lower", mass, Shape::Cylinder { radius: 0.01, height: 0.02 }, frame(0), com),
        ];
        let ports = vec![at("in", 0, frame(0), orientations), at("out", 1, frame(1), 4)];
        let elbow = ModuleType { rotates, roll_step_degrees: roll, ..module_type("elbow", bodies, vec![joint], ports) };
        let model = Model::Cone { friction: [0.8, 0.5], radius: [0.02, 0.02, 0.01] };
        Catalogue {
            name,
            connectors: vec![Connector { name: "magnet".into(), strength: 100.0, model }],
            motions: Vec::new(),
            module_types: vec![module_type("node", vec![ball], Vec::new(), vec![surface]), elbow],
        }
    }
}

/// How a module joins those there are: onto which, by which of its ports, and how.
type Growth = (Index, bool, bool, [i32; 3], i32, bool);

fn growth() -> impl Strategy<Value = Growth> {
    (any::<Index>(), any::<bool>(), any::<bool>(), any::<[i32; 3]>(), -2..=2, any::<bool>())
}

fn module(catalogue: &Catalogue, index: usize, module_type: usize, joint: i32, fixed: bool) -> Module {
    let joints = &catalogue.module_types[module_type].joints;
    let joints = joints.iter().map(|kind| if kind.allows(joint) { joint } else { 0 }).collect();
    Module { id: format!("m{index}"), module_type, pose: Pose::identity(), joints, fixed }
}

/// Adds a module where it overlaps nothing.
fn grow(linkage: &mut Linkage, codes: &mut Vec<Code>, (onto, elbow, far, spot, joint, fixed): Growth) {
    let index = linkage.modules.len();
    let catalogue = Arc::clone(&linkage.catalogue);
    let onto = onto.index(index);
    linkage.modules.push(module(&catalogue, index, usize::from(elbow), joint, fixed));
    let port = |module: usize, kind: usize| Port { module, port: if kind == 0 { 0 } else { usize::from(far) } };
    let kind = |module: usize| linkage.modules[module].module_type;
    let connection = Connection::new(port(onto, kind(onto)), port(index, kind(index)));
    let fits = catalogue
        .connector_between([kind(onto), port(onto, kind(onto)).port], [kind(index), port(index, kind(index)).port]);
    if fits.is_none() {
        linkage.modules.pop();
        return;
    }
    linkage.connections.push(connection);
    codes.push(match kind(onto) * kind(index) {
        1 => Code::Docked { roll: spot[0].rem_euclid(linkage.orientations(&connection)) },
        _ => Code::OnSurface(Spot::new(spot[0], spot[1], spot[2])),
    });
    let poses = linkage.placed_by(codes);
    for (module, pose) in linkage.modules.iter_mut().zip(poses) {
        module.pose = pose;
    }
    if !(linkage.problems().is_empty() && linkage_problems(linkage).is_empty()) {
        linkage.modules.pop();
        linkage.connections.pop();
        codes.pop();
    }
}

prop_compose! {
    fn linkages()(
        catalogue in catalogues(), seed: bool, pose in (vector(3.0), rotation()), joint in -2..=2, fixed: bool,
        growths in vec(growth(), 0..6), gravity in vector(10.0), margin in -1.0..1.0, connected: bool,
        friction in 0.0..1.0, loads in vec((any::<Index>(), vector(9.0), vector(1.0), option::of(vector(1.0))), 0..3),
    ) -> Linkage {
        let catalogue = Arc::new(catalogue);
        let mut first = module(&catalogue, 0, usize::from(seed), joint, fixed);
        first.pose = Pose::from_parts(pose.0.into(), pose.1);
        let mut linkage = Linkage {
            catalogue, gravity, environment: Environment { module_friction: friction, ..Environment::default() },
            modules: vec![first], connections: Vec::new(), loads: Vec::new(),
            require: Requirement { margin, connected, ..Requirement::default() },
        };
        let mut codes = Vec::new();
        for growth in growths {
            grow(&mut linkage, &mut codes, growth);
        }
        linkage.connections.sort_unstable();
        let count = linkage.modules.len();
        let load = |(module, force, torque, at): (Index, Vec3, Vec3, Option<Vec3>)| ModuleLoad {
            module: module.index(count), force, torque, at,
        };
        linkage.loads = loads.into_iter().map(load).collect();
        linkage
    }
}

/// An action on any modules, sensible or not.
type Draft = (u8, [Index; 2], [i32; 3], bool, Option<f64>);

fn drafts() -> impl Strategy<Value = Draft> {
    (0..4u8, any::<[Index; 2]>(), any::<[i32; 3]>(), any::<bool>(), option::of(0.0..=1.0))
}

fn plan(linkage: &Linkage, drafts: &[Draft], margin: Option<Bracket>) -> Plan<Action, Held> {
    let count = linkage.modules.len();
    let elbow = (0..count).find(|&module| linkage.modules[module].module_type == 1);
    let action = |&(kind, modules, spot, side, phase): &Draft| {
        let [a, b] = modules.map(|index| index.index(count));
        let connection = Connection::new(Port { module: a, port: 0 }, Port { module: b, port: 0 });
        let action = match (kind, elbow) {
            (0, _) => Action::Attach(connection),
            (1, _) => Action::Detach(connection),
            (2, Some(module)) => Action::Rotate {
                module,
                joint: 0,
                to: spot[0] % 1000,
                carried: if side { Half::Parent } else { Half::Child },
            },
            _ => {
                Action::Roll { connection, to: Spot::new(spot[0], spot[1], spot[2]), carried: if side { a } else { b } }
            }
        };
        PlannedAction { action, margin, phase }
    };
    let held = elbow.map(|module| Held::Joint { module, joint: 0 });
    Plan {
        margin,
        moves: drafts.len() as u32,
        bottleneck: Some(Bottleneck { action: Some(0), phase: 0.25, connection: held }),
        actions: drafts.iter().map(action).collect(),
        profile: margin.into_iter().map(|margin| Moment { action: Some(0), phase: 0.5, margin }).collect(),
        if_stronger: margin.map(|margin| IfStronger { factor: 2.0, margin }),
    }
}

prop_compose! {
    fn documents()(
        start in linkages(), labelled: bool, free_frame: bool, ways in vec(vec(drafts(), 0..5), 0..3),
        margin in option::of((-1.0..0.0, 0.0..1.0)),
    ) -> LinkagePlanDocument {
        let margin = margin.map(|(lower, upper)| Bracket::new(lower, upper));
        let mut plans = ways.iter().map(|drafts| plan(&start, drafts, margin));
        let first = plans.next();
        let in_the_way = first.is_none().then(|| InTheWay {
            margin: margin.unwrap_or(Bracket::exact(f64::NEG_INFINITY)),
            strength_factor: Bracket::new(1.5, if labelled { f64::INFINITY } else { 2.5 }),
            plan: (!labelled).then(|| plan(&start, &[], margin)),
            too_weak: start.connections.iter().map(|&held| (Held::Ports(held), Bracket::new(-2.0, -1.0))).collect(),
            never_move: labelled.then(|| (0..start.modules.len()).rev().collect()),
            nearest: Some(Nearest { modules: 7, in_place: 4, stuck: 2 }),
            cut_by: labelled.then_some(Limit::Memory),
        });
        let weakest = start.connections.first().map(|&connection| Held::Ports(connection));
        let reason = Impossible::Unstable {
            which: Which::Goal, margin: Bracket::exact(f64::NEG_INFINITY), required: 0.5, connection: weakest,
        };
        let (outcome, unproved) = match &first {
            Some(_) => (Outcome::Solved, (f64::INFINITY, 0)),
            None => (Outcome::Impossible(reason), (f64::NEG_INFINITY, u32::MAX)),
        };
        let report = Report {
            outcome,
            objective: Objective::Moves,
            required: Some(0.1),
            plan: first,
            alternatives: plans.collect(),
            alternatives_cut_by: None,
            in_the_way,
            proof: Proof { optimal: false, margin_at_most: unproved.0, moves_at_least: unproved.1 },
            statistics: Statistics::default(),
        };
        let goal = Goal { linkage: start.clone(), matching: Matching { labelled, free_frame } };
        PlanDocument::new(LinkageProblem { start, goal }, &report)
    }
}

proptest! {
    #[test]
    fn linkages_come_back(linkage in linkages()) {
        let text = write_linkage(&linkage).unwrap();
        match read_linkage(&SourceFile::new("written", text), &no_references) {
            Ok(read) => prop_assert_eq!(read, linkage),
            Err(diagnostics) => prop_assert!(false, "{}", diagnostics),
        }
    }

    #[test]
    fn plan_files_come_back(document in documents()) {
        let text = write_linkage_plan(&document).unwrap();
        match read_linkage_plan(&SourceFile::new("written", text)) {
            Ok(read) => prop_assert_eq!(read, document),
            Err(diagnostics) => prop_assert!(false, "{}", diagnostics),
        }
    }
}
