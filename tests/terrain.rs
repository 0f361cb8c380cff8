//! A block on a slope, whichever way the slope is given, against the closed form: it stays while
//! the tangent of the slope's angle is at most the friction coefficient. And meshes from files.

use std::sync::Arc;

use steadfast::io::{SourceFile, read_configuration};
use steadfast::reconfigure::linkage::assembly::assemble;
use steadfast::robot::linkage::{Linkage, Module};
use steadfast::robot::{
    BodyType, Catalogue, Configuration, Environment, HeightField, Hull, Mesh, ModuleType, Obstacle, Requirement, Shape,
    Terrain,
};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Question, Verdict, assess};

const HALF: [f64; 3] = [0.1, 0.06, 0.03];

/// A free body of this shape.
fn block(shape: Shape, pose: Pose, obstacle: Obstacle) -> Linkage {
    let body = BodyType { name: "block".into(), mass: 2.0, com: Vec3::zeros(), shape, shape_pose: Pose::identity() };
    let module_type = ModuleType {
        name: "block".into(),
        bodies: vec![body],
        joints: Vec::new(),
        ports: Vec::new(),
        rotates: false,
        roll_step_degrees: None,
        lattice: None,
    };
    Linkage {
        catalogue: Arc::new(Catalogue {
            name: "test".into(),
            connectors: Vec::new(),
            motions: Vec::new(),
            module_types: vec![module_type],
        }),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        environment: Environment { obstacles: vec![obstacle], ..Environment::default() },
        modules: vec![Module { id: "a".into(), module_type: 0, pose, joints: Vec::new(), fixed: false }],
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}

fn verdict(linkage: &Linkage) -> Verdict {
    assess(&assemble(linkage).structure, Question::VALUE).unwrap().verdict
}

/// A slope that rises along x by `angle` through the origin: as a half-space, as a mesh in the slope's
/// frame, and as a height field in the world's.
fn slopes(angle: f64, friction: f64) -> Vec<(&'static str, Obstacle, Rotation)> {
    let tilt = Rotation::from_axis_angle(&Vec3::y_axis(), -angle);
    let tilted = Pose::from_parts(Vec3::zeros().into(), tilt);
    let corners = [[-1.0, -1.0], [0.013, -1.0], [1.0, -1.0], [1.0, 1.0], [0.02, 1.0], [-1.0, 1.0]];
    let vertices = corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
    let sheet = Mesh::new(vertices, vec![[0, 1, 4], [0, 4, 5], [1, 2, 4], [2, 3, 4]]).unwrap();
    let row: Vec<f64> = (0..21).map(|i| f64::from(i) * 0.1 * angle.tan()).collect();
    let field = HeightField::new([0.1, 0.07], vec![row; 30]).unwrap();
    let corner = Pose::translation(-1.0, -1.0, -angle.tan());
    [
        ("half-space", Terrain::HalfSpace, tilted),
        ("mesh", Terrain::Mesh(Arc::new(sheet)), tilted),
        ("height field", Terrain::HeightField(Arc::new(field)), corner),
    ]
    .into_iter()
    .map(|(kind, shape, pose)| (kind, Obstacle { shape, pose, friction }, tilt))
    .collect()
}

#[test]
fn a_block_on_a_slope_slides_beyond_the_angle_of_friction() {
    let friction = 0.5f64;
    let limit = friction.atan().to_degrees();
    let half = Vec3::from(HALF);
    let corner = |i: usize| {
        let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
        half.component_mul(&Vec3::new(sign(1), sign(2), sign(4)))
    };
    let shapes = [
        Shape::Cuboid { half_extents: half },
        Shape::Cylinder { radius: HALF[0], height: 2.0 * HALF[2] },
        Shape::Convex(Arc::new(Hull::new((0..8).map(corner).collect()).unwrap())),
    ];
    for shape in shapes {
        for (off, expected) in [(-0.01, Verdict::Stable), (0.01, Verdict::WholeBodyUnstable)] {
            let angle = (limit + off).to_radians();
            for turn in [0.0, 0.3, 1.1] {
                for (kind, obstacle, tilt) in slopes(angle, friction) {
                    let spin = Rotation::from_axis_angle(&Vec3::z_axis(), turn);
                    let at = tilt * Vec3::new(0.031, 0.017, HALF[2]);
                    let pose = Pose::from_parts(at.into(), tilt * spin);
                    let found = verdict(&block(shape.clone(), pose, obstacle));
                    assert_eq!(found, expected, "{shape:?} on a {kind} at {off}, turned by {turn}");
                }
            }
        }
    }
}

#[test]
fn a_cylinder_on_its_side_rolls_and_a_ball_rolls_too() {
    for (_, obstacle, tilt) in slopes(0.1, 0.9) {
        let ball = Shape::Ball { radius: 0.05 };
        let lying = Shape::Cylinder { radius: 0.05, height: 0.2 };
        let pose = |turn: Rotation| Pose::from_parts((tilt * Vec3::new(0.2, 0.1, 0.05)).into(), tilt * turn);
        let across = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::FRAC_PI_2);
        let along = Rotation::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_2);
        let rolls = Verdict::WholeBodyUnstable;
        assert_eq!(verdict(&block(ball, pose(across), obstacle.clone())), rolls);
        assert_eq!(verdict(&block(lying.clone(), pose(across), obstacle.clone())), rolls);
        // With its axis up the slope it does not roll.
        assert_eq!(verdict(&block(lying, pose(along), obstacle)), Verdict::Stable);
    }
}

/// One cube above a mesh from a file of this name and content.
fn with_mesh(name: &str, bytes: &[u8]) -> Configuration {
    let text = format!(
        r#"{{"format": "configuration/1", "catalogue": "cube", "gravity_m_s2": [0, 0, -9.81],
        "environment": {{"obstacles": [{{"shape": {{"mesh": {{"file": "{name}", "scale": 0.1}}}}, "position_m": [0, 0, 0],
        "friction": 0.5}}]}}, "modules": [{{"id": "a", "type": "cube", "cell": [0, 0, 9]}}], "connections": "touching"}}"#
    );
    let resolve = |_: &str, asked: &str| {
        assert_eq!(asked, name);
        Ok(SourceFile::new(name, bytes))
    };
    read_configuration(&SourceFile::new("start.json", text), &resolve).unwrap()
}

#[test]
fn text_and_binary_stl_and_obj_say_the_same_to_the_last_digit() {
    let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0.3 0 0\nvertex 1.7 0.1 0\nvertex 0.2 0.9 0.05\nendloop\nendfacet\nendsolid a\n";
    let mut binary = b"solid, but binary".to_vec();
    binary.resize(80, 0);
    binary.extend(1u32.to_le_bytes());
    let numbers: [f32; 12] = [0.0, 0.0, 1.0, 0.3, 0.0, 0.0, 1.7, 0.1, 0.0, 0.2, 0.9, 0.05];
    binary.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    binary.extend([0, 0]);
    let obj = "# the same\nv 0.3 0 0\nv 1.7 0.1 0\nv 0.2 0.9 0.05\nf 1 2 3\n";
    let read = [with_mesh("a.stl", text.as_bytes()), with_mesh("a.STL", &binary), with_mesh("a.obj", obj.as_bytes())];
    let mesh = |configuration: &Configuration| match &configuration.environment.obstacles[0].shape {
        Terrain::Mesh(mesh) => Arc::clone(mesh),
        other => panic!("{other:?}"),
    };
    let expected = [[0.3, 0.0, 0.0], [1.7, 0.1, 0.0], [0.2, 0.9, 0.05]].map(|p| Vec3::from(p) * 0.1);
    for configuration in &read {
        assert_eq!(mesh(configuration).vertices(), expected);
        assert_eq!(mesh(configuration).triangles(), [[0, 1, 2]]);
    }
}

#[test]
fn damaged_meshes_never_make_the_reader_panic() {
    let stl = std::fs::read(problems::root().join("cubes/step_stl/step.stl")).unwrap();
    let obj = std::fs::read(problems::root().join("cubes/low_friction_obj/slope.obj")).unwrap();
    let mut state = 0x2545_f491_4f6c_dd1du64;
    let mut next = |bound: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % bound as u64) as usize
    };
    let mut refused = 0;
    for round in 0..4000 {
        let (name, mut bytes) = if round % 2 == 0 { ("a.stl", stl.clone()) } else { ("a.obj", obj.clone()) };
        for _ in 0..=next(3) {
            let at = next(bytes.len());
            match next(4) {
                0 => bytes.truncate(at.max(1)),
                1 => bytes[at] = next(256) as u8,
                2 => drop(bytes.splice(at..at, b"-1e39 ".iter().copied())),
                _ => drop(bytes.drain(at..(at + 9).min(bytes.len() - 1).max(at))),
            }
        }
        let text = format!(
            r#"{{"format": "configuration/1", "catalogue": "cube", "gravity_m_s2": [0, 0, 0],
            "environment": {{"obstacles": [{{"shape": {{"mesh": {{"file": "{name}"}}}}, "position_m": [0, 0, -900],
            "friction": 0.5}}]}}, "modules": [{{"id": "a", "type": "cube", "cell": [0, 0, 9]}}], "connections": "touching"}}"#
        );
        let resolve = |_: &str, _: &str| Ok(SourceFile::new(name, bytes.clone()));
        if let Err(diagnostics) = read_configuration(&SourceFile::new("start.json", text), &resolve) {
            assert!(diagnostics.items().iter().all(|item| item.hint.is_some()), "{diagnostics}");
            refused += 1;
        }
    }
    assert!(refused > 1000, "the damage is too slight: {refused}");
}
