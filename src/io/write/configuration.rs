//! A configuration or a goal to `configuration/1`.

use super::super::wire::{self, NonNegative, Positive, Real};
use super::catalogue::{positive, referred};
use super::{vector, xyzw};
use crate::robot::{
    Configuration, Environment, FaceConnection, Goal, Matching, Module, ModuleLoad, Orientation, Port, Region,
    Requirement, Shape, Terrain,
};
use crate::spatial::Rotation;

/// A configuration that stands on its own.
pub(super) fn start(configuration: &Configuration) -> wire::Configuration {
    let loads = configuration.loads.iter().map(|load| module_load(&configuration.modules[load.module].id, load));
    wire::Configuration {
        catalogue: Some(referred(&configuration.catalogue)),
        gravity_m_s2: Some(vector(configuration.gravity)),
        environment: Some(environment(&configuration.environment)),
        loads: Some(loads.collect()),
        require: Some(require(&configuration.require, |module| configuration.modules[module].id.as_str())),
        ..robot(configuration)
    }
}

/// A goal, which takes everything else from its start.
pub(super) fn goal(goal: &Goal) -> wire::Configuration {
    wire::Configuration { matching: Some(matching(goal.matching)), ..robot(&goal.configuration) }
}

/// A load on the module with this id.
pub(super) fn module_load(id: &str, load: &ModuleLoad) -> wire::ModuleLoad {
    wire::ModuleLoad {
        module: id.to_string(),
        force_n: vector(load.force),
        torque_nm: Some(vector(load.torque)),
        at_m: load.at.map(vector),
    }
}

pub(super) fn require<'a>(require: &Requirement, id: impl Fn(usize) -> &'a str) -> wire::Require {
    let region = |region: &Region| wire::Region { low_m: vector(region.low), high_m: vector(region.high) };
    wire::Require {
        margin: Some(Real(require.margin)),
        connected: Some(require.connected),
        stay: require.stay.iter().map(|&module| id(module).to_owned()).collect(),
        keep_out: require.keep_out.iter().map(region).collect(),
    }
}

pub(super) fn matching(matching: Matching) -> wire::Match {
    wire::Match {
        modules: Some(match matching.labelled {
            true => wire::ModuleMatch::Labelled,
            false => wire::ModuleMatch::Interchangeable,
        }),
        frame: Some(match matching.free_frame {
            true => wire::FrameMatch::Free,
            false => wire::FrameMatch::World,
        }),
    }
}

fn robot(configuration: &Configuration) -> wire::Configuration {
    let pair =
        |connection: &FaceConnection| wire::PairConnection::Pair(connection.ports.map(|p| port(configuration, p)));
    wire::Configuration {
        format: wire::ConfigurationFormat::V1,
        catalogue: None,
        gravity_m_s2: None,
        environment: None,
        modules: configuration.modules.iter().map(|m| module(configuration, m)).collect(),
        connections: wire::Connections::List(configuration.connections.iter().map(pair).collect()),
        loads: None,
        require: None,
        matching: None,
    }
}

/// A port as files write it, e.g. `a:+z`.
pub(super) fn port(configuration: &Configuration, port: Port) -> String {
    format!("{}:{}", configuration.modules[port.module].id, port.face.name())
}

fn module(configuration: &Configuration, module: &Module) -> wire::Module {
    let orientation = module.placement.orientation;
    wire::Module {
        id: module.id.clone(),
        module_type: configuration.catalogue.module_types[module.module_type].name.clone(),
        cell: Some(module.placement.cell),
        position_m: None,
        rotation_xyzw: (orientation != Orientation::IDENTITY).then(|| xyzw(&orientation.rotation())),
        joints_deg: None,
        fixed: module.fixed,
    }
}

pub(super) fn environment(environment: &Environment) -> wire::Environment {
    let obstacles = environment.obstacles.iter().map(|obstacle| wire::Obstacle {
        shape: terrain(&obstacle.shape),
        position_m: vector(obstacle.pose.translation.vector),
        rotation_xyzw: (obstacle.pose.rotation != Rotation::identity()).then(|| xyzw(&obstacle.pose.rotation)),
        friction: NonNegative(obstacle.friction),
    });
    wire::Environment {
        ground: environment
            .ground
            .as_ref()
            .map(|ground| wire::Ground { height_m: Real(ground.height), friction: NonNegative(ground.friction) }),
        obstacles: obstacles.collect(),
        module_friction: Some(NonNegative(environment.module_friction)),
    }
}

/// The shape of an obstacle, with a mesh in full, so that the file stands on its own.
fn terrain(terrain: &Terrain) -> wire::Terrain {
    match terrain {
        Terrain::Solid(Shape::Cuboid { half_extents }) => {
            wire::Terrain::Cuboid { half_extents_m: positive(half_extents) }
        }
        Terrain::Solid(Shape::Cylinder { radius, height }) => {
            wire::Terrain::Cylinder { radius_m: Positive(*radius), height_m: Positive(*height) }
        }
        Terrain::Solid(Shape::Ball { radius }) => wire::Terrain::Ball { radius_m: Positive(*radius) },
        Terrain::Solid(Shape::Convex(hull)) => {
            wire::Terrain::Convex { points_m: hull.points().iter().copied().map(vector).collect() }
        }
        Terrain::HalfSpace => wire::Terrain::Plane {},
        Terrain::HeightField(field) => wire::Terrain::HeightField {
            cell_m: field.cell().map(Positive),
            heights_m: field.heights().iter().map(|row| row.iter().copied().map(Real).collect()).collect(),
        },
        Terrain::Mesh(mesh) => wire::Terrain::Mesh(wire::Mesh {
            vertices_m: Some(mesh.vertices().iter().copied().map(vector).collect()),
            triangles: Some(mesh.triangles().to_vec()),
            ..wire::Mesh::default()
        }),
    }
}
