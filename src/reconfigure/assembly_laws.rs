//! Laws that states inherit from structures, through the oracle.

use std::sync::Arc;

use proptest::prelude::*;

use super::assembly::{Assembler, Engagement, Moving, Transient, assemble};
use super::assembly_tests::{connected, robot};
use crate::geometry::Motion;
use crate::robot::{Cell, Configuration, Face, Ground, ModuleLoad, neighbour};
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::{Bracket, Connector, Model, Question, assess};

fn utilisation(configuration: &Configuration) -> Bracket {
    assess(&assemble(configuration).structure, Question::VALUE).expect("a sound structure").utilisation
}

/// Connected robots: each further cube is put on a face of an earlier one.
fn any_cells() -> impl Strategy<Value = Vec<Cell>> {
    prop::collection::vec((any::<prop::sample::Index>(), 0usize..6), 1..6).prop_map(|steps| {
        let mut cells: Vec<Cell> = vec![[0, 0, 0]];
        for (host, face) in steps {
            let cell = neighbour(*host.get(&cells), Face::ALL[face]).unwrap();
            if !cells.contains(&cell) {
                cells.push(cell);
            }
        }
        cells
    })
}

fn scaled_strength(connector: &Connector, factor: f64) -> Connector {
    let mut scaled = connector.clone();
    scaled.strength *= factor;
    if let Model::Box { shear, tension, compression, bending, torsion } = &mut scaled.model {
        for limit in shear.iter_mut().chain(bending).chain([tension, compression, torsion]) {
            *limit *= factor;
        }
    }
    scaled
}

/// The utilisation of `count` cubes in a row from a held one, sideways.
fn cantilever(module_type: usize, count: i32) -> Bracket {
    let cells: Vec<Cell> = (0..=count).map(|x| [x, 0, 0]).collect();
    utilisation(&connected(module_type, &cells))
}

#[test]
fn a_cantilever_of_four_magnetic_or_five_latched_cubes_is_at_its_limit() {
    let weight = 0.143 * 9.81;
    let moment = |count: f64| count * count / 2.0 * weight * 0.05;
    for count in 1..=6 {
        // A magnet peels about its lower edge, or slips.
        let magnetic = cantilever(0, count);
        let count = f64::from(count);
        let expected = (moment(count) / (25.0 * 0.025)).max(count * weight / (0.4 * 25.0));
        assert!((magnetic.lower - expected).abs() < 1e-6, "{count}: {magnetic:?}");
        assert_eq!(magnetic.upper <= 1.0, count <= 4.0);
    }
    for count in 3..=6 {
        // A latch's pull about the lower edge, and its own bending limit.
        let latched = cantilever(1, count);
        let expected = moment(f64::from(count)) / (30.0 * 0.025 + 0.19);
        assert!((latched.lower - expected).abs() < 1e-6, "{count}: {latched:?}");
        assert_eq!(latched.upper <= 1.0, count <= 5);
    }
}

/// The greatest utilisation while a cube turns by half round a held one, from its
/// side `up` to its side `along`.
fn half_pivot(module_type: usize, up: Face, along: Face) -> f64 {
    let configuration = robot(module_type, &[[0, 0, 0], up.step()]);
    let assembler = Assembler::new(&configuration);
    let placements: Vec<_> = configuration.modules.iter().map(|m| m.placement).collect();
    let half = configuration.pitch() / 2.0;
    let edge = Vec3::repeat(half) + (up.normal() + along.normal()) * half;
    let side = nalgebra::Unit::new_normalize(up.normal().cross(&along.normal()));
    let frame = Pose::from_parts(
        edge.into(),
        Rotation::rotation_between(&Vec3::z(), &side)
            .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI)),
    );
    let motion = Motion::Rotation { centre: edge, axis: side, angle: std::f64::consts::PI };
    let engaged = [Engagement::Hinge { parent: 0, child: 1, frame }];
    let sample = |i: i32| {
        let pose = motion.pose(&placements[1].pose(2.0 * half), f64::from(i) / 24.0);
        let moving = Some(Moving { module: 1, pose });
        let state = Transient { placements: &placements, moving, engaged: &engaged };
        assess(&assembler.assemble(&state).structure, Question::VALUE).unwrap().utilisation.upper
    };
    (0..=24).map(sample).fold(0.0, f64::max)
}

#[test]
fn a_hinge_holds_and_drives_a_cube_and_its_margin_in_any_pose() {
    // Worst when the cube is level with the edge.
    let lever = 0.143 * 9.81 * 0.05 / 2f64.sqrt();
    for (module_type, drive) in [(0, 0.1), (1, 0.15)] {
        for up in Face::ALL {
            for along in Face::ALL.into_iter().filter(|along| along.axis() != up.axis()) {
                let worst = half_pivot(module_type, up, along);
                let level = up.axis() == 2 || along.axis() == 2;
                // About a vertical edge it hangs on the hinge's bending limit instead.
                let expected = if level { lever / drive } else { lever / 0.2 };
                assert!(worst <= expected + 1e-6, "{worst} {up:?} {along:?}");
                assert!(!level || worst >= expected - 1e-6, "{worst} {up:?} {along:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn attaching_never_raises_the_utilisation(
        module_type in 0usize..3, cells in any_cells(), engaged in prop::collection::vec(any::<bool>(), 16),
        held in any::<bool>(), grounded in any::<bool>(), weakness in 0.0f64..4.0, pull in prop::array::uniform3(-1.0..1.0),
        force in prop::array::uniform3(-1.0..1.0), at in prop::array::uniform3(-1.0..1.0),
    ) {
        let mut configuration = robot(module_type, &cells);
        configuration.modules[0].fixed = held;
        configuration.gravity += Vec3::from(pull) * 5.0;
        // A push on the last module, anywhere on it, mostly against a neighbour.
        let last = cells.len() - 1;
        let occupancy = configuration.occupancy();
        let against = Face::ALL.into_iter().find(|face| occupancy.beyond(cells[last], *face).is_some());
        let press = against.map_or(Vec3::zeros(), |face| face.normal() * 20.0);
        configuration.loads = vec![ModuleLoad {
            module: last,
            force: Vec3::from(force) * 5.0 + press,
            torque: Vec3::zeros(),
            at: Some(Vec3::from(at) * configuration.pitch() / 2.0),
        }];
        // Where connectors are weak, what touching carries decides.
        for connector in &mut Arc::make_mut(&mut configuration.catalogue).connectors {
            *connector = scaled_strength(connector, 10f64.powf(-weakness));
        }
        if grounded {
            let lowest = cells.iter().map(|c| c[2]).min().unwrap();
            configuration.environment.ground =
                Some(Ground { height: f64::from(lowest) * configuration.pitch(), friction: 0.5 });
        }
        let mut before = f64::INFINITY;
        let touching = configuration.touching_connections();
        let (first, later): (Vec<_>, Vec<_>) =
            touching.into_iter().enumerate().partition(|(i, _)| *engaged.get(*i).unwrap_or(&true));
        configuration.connections = first.into_iter().map(|(_, c)| c).collect();
        for next in [None].into_iter().chain(later.into_iter().map(|(_, c)| Some(c))) {
            configuration.connections.extend(next);
            let now = utilisation(&configuration);
            prop_assert!(now.lower <= before, "{now:?} after at most {before}, {next:?}");
            before = now.upper;
        }
    }
}
