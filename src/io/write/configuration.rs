//! A configuration or a goal to `configuration/1`.

use super::super::wire::{self, NonNegative, Real};
use super::catalogue::{referred, shape};
use super::{vector, xyzw};
use crate::robot::{Configuration, Environment, FaceConnection, Goal, Module, Orientation, Port};
use crate::spatial::Rotation;

/// A configuration that stands on its own.
pub(super) fn start(configuration: &Configuration) -> wire::Configuration {
    let require = &configuration.require;
    let loads = configuration.loads.iter().map(|load| wire::ModuleLoad {
        module: configuration.modules[load.module].id.clone(),
        force_n: vector(load.force),
        torque_nm: Some(vector(load.torque)),
        at_m: load.at.map(vector),
    });
    wire::Configuration {
        catalogue: Some(referred(&configuration.catalogue)),
        gravity_m_s2: Some(vector(configuration.gravity)),
        environment: Some(environment(&configuration.environment)),
        loads: Some(loads.collect()),
        require: Some(wire::Require { margin: Some(Real(require.margin)), connected: Some(require.connected) }),
        ..robot(configuration)
    }
}

/// A goal, which takes everything else from its start.
pub(super) fn goal(goal: &Goal) -> wire::Configuration {
    let matching = wire::Match {
        modules: Some(match goal.matching.labelled {
            true => wire::ModuleMatch::Labelled,
            false => wire::ModuleMatch::Interchangeable,
        }),
        frame: Some(match goal.matching.free_frame {
            true => wire::FrameMatch::Free,
            false => wire::FrameMatch::World,
        }),
    };
    wire::Configuration { matching: Some(matching), ..robot(&goal.configuration) }
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

fn environment(environment: &Environment) -> wire::Environment {
    let obstacles = environment.obstacles.iter().map(|obstacle| wire::Obstacle {
        shape: shape(&obstacle.shape),
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
