//! From a linkage at one moment to the structure that the oracle assesses.
//!
//! Knows which ports hold, which bodies touch and where; knows neither actions nor what the oracle
//! makes of the structure.

use std::fmt;

use crate::geometry::{BroadPhase, ContactPatch, Solid, Surrounding, Surroundings, TOUCH, contact};
use crate::robot::ModuleType;
use crate::robot::linkage::{Connection, Linkage, Port, frame_between};
use crate::spatial::{Point, Pose};
use crate::statics::{Anchor, Body, Connector, Contact, Load, Model, Structure};

use super::super::surface::{Surface, full_face};

/// Distance relative to the size of the largest module up to which bodies touch: ten times [`TOUCH`], since
/// loops close in whole micro-degrees, and far below the play of any connector.
const CONTACT: f64 = 10.0 * TOUCH;

/// A linkage at one moment, at rest or on its way.
#[derive(Clone, Copy, Debug)]
pub struct Transient<'a> {
    /// Poses in W of every module's bodies.
    pub bodies: &'a [Vec<Pose>],
    /// The connections that hold.
    pub engaged: &'a [Connection],
}

/// A body of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyOf {
    /// Index of the module.
    pub module: usize,
    /// Index of the body in its type.
    pub body: usize,
}

/// What holds two bodies together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Held {
    /// A connection between ports.
    Ports(Connection),
    /// A joint of a module, by its index in the module's type.
    Joint {
        /// Index of the module.
        module: usize,
        /// Index of the joint.
        joint: usize,
    },
}

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// A body of another module.
    Body(BodyOf),
    /// The ground.
    Ground,
    /// The obstacle with this index.
    Obstacle(usize),
}

impl From<Surrounding> for Touched {
    fn from(what: Surrounding) -> Self {
        match what {
            Surrounding::Ground => Self::Ground,
            Surrounding::Obstacle(index) => Self::Obstacle(index),
        }
    }
}

/// A structure with the way back to the linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// The oracle's input.
    pub structure: Structure,
    /// What each of its bodies is.
    pub bodies: Vec<BodyOf>,
    /// What each of its connections is.
    pub connections: Vec<Held>,
    /// What each of its contacts is between: the body that the normal points into, and what it touches.
    pub contacts: Vec<(BodyOf, Touched)>,
}

/// The structure of a linkage as it stands.
pub fn assemble(linkage: &Linkage) -> Assembly {
    let bodies: Vec<Vec<Pose>> = (0..linkage.modules.len()).map(|module| linkage.body_poses(module)).collect();
    Assembler::new(linkage).assemble(&Transient { bodies: &bodies, engaged: &linkage.connections })
}

/// Assembles structures of one linkage, over and over.
#[derive(Clone, Debug)]
pub struct Assembler<'a> {
    linkage: &'a Linkage,
    /// Index of each module's first body.
    first: Vec<usize>,
    bodies: Vec<BodyOf>,
    /// The catalogue's connectors, then one for every joint of every module type.
    connectors: Vec<Connector>,
    /// Index of the connector of each module type's first joint.
    motors: Vec<usize>,
    surroundings: Surroundings,
    tolerance: f64,
}

impl<'a> Assembler<'a> {
    /// Prepares for states of `linkage`'s modules in its environment and under its loads; its poses, joints and
    /// connections play no part. `linkage` must be sound (have no [`Linkage::problems`]).
    pub fn new(linkage: &'a Linkage) -> Self {
        let catalogue = &linkage.catalogue;
        let mut first = Vec::with_capacity(linkage.modules.len());
        let mut bodies = Vec::new();
        for module in 0..linkage.modules.len() {
            first.push(bodies.len());
            bodies.extend((0..linkage.module_type(module).bodies.len()).map(|body| BodyOf { module, body }));
        }
        let pitches = catalogue.module_types.iter().filter_map(|module_type| Some(module_type.lattice.as_ref()?.pitch));
        // Of cells of several sizes the smallest: a face never gets more of a lever than it has.
        let pitch = pitches.reduce(f64::min).unwrap_or(1.0);
        let mut connectors: Vec<Connector> = catalogue.connectors.iter().map(|c| full_face(c, pitch)).collect();
        let mut motors = Vec::with_capacity(catalogue.module_types.len());
        for module_type in &catalogue.module_types {
            motors.push(connectors.len());
            connectors.extend((0..module_type.joints.len()).map(|joint| motor(module_type, joint)));
        }
        // An object may have no ports to measure it by.
        let extent = |kind: &ModuleType| {
            let bodies = kind.bodies.iter().map(|body| Solid::new(body.shape.clone(), body.shape_pose).size());
            bodies.fold(kind.size(), f64::max)
        };
        let size = (0..linkage.modules.len()).map(|m| extent(linkage.module_type(m))).fold(0.0, f64::max);
        let surroundings = Surroundings::new(&linkage.environment);
        Self { linkage, first, bodies, connectors, motors, surroundings, tolerance: CONTACT * size }
    }

    /// The structure of a state: a body for each body of every module, a connection for each joint and each
    /// engaged connection whose connectors fit, and contacts wherever else something touches.
    ///
    /// A joint is a `box` that carries everything but a torque about its axis beyond the holding torque; its
    /// frame is at the joint's origin, z along the axis. Bodies of one module carry no contact between them, nor do
    /// two fixed bodies, nor a fixed body and its environment.
    pub fn assemble(&self, state: &Transient) -> Assembly {
        let mut assembly = Assembly {
            structure: Structure {
                gravity: self.linkage.gravity,
                connectors: self.connectors.clone(),
                ..Structure::default()
            },
            bodies: self.bodies.clone(),
            connections: Vec::new(),
            contacts: Vec::new(),
        };
        self.add_bodies(&mut assembly.structure, state);
        for module in 0..self.linkage.modules.len() {
            self.add_joints(&mut assembly, state, module);
        }
        for &connection in state.engaged {
            self.add_connection(&mut assembly, state, connection);
        }
        let solids: Vec<Solid> = self.bodies.iter().map(|&body| self.solid(state, body)).collect();
        self.add_body_contacts(&mut assembly, state, &solids);
        self.add_environment_contacts(&mut assembly, &solids);
        assembly
    }

    fn add_bodies(&self, structure: &mut Structure, state: &Transient) {
        structure.bodies.extend(self.bodies.iter().map(|&BodyOf { module, body }| {
            let kind = &self.linkage.module_type(module).bodies[body];
            let com = (state.bodies[module][body] * Point::from(kind.com)).coords;
            Body { mass: kind.mass, com, fixed: self.is_fixed(BodyOf { module, body }) }
        }));
        structure.loads.extend(self.linkage.loads.iter().map(|load| Load {
            body: self.first[load.module],
            force: load.force,
            torque: load.torque,
            at: load.at.map(|at| (state.bodies[load.module][0] * Point::from(at)).coords),
        }));
    }

    fn add_joints(&self, assembly: &mut Assembly, state: &Transient, module: usize) {
        let kind = self.linkage.modules[module].module_type;
        for (index, joint) in self.linkage.module_type(module).joints.iter().enumerate() {
            let along = nalgebra::UnitQuaternion::rotation_between_axis(&nalgebra::Vector3::z_axis(), &joint.axis)
                .unwrap_or_else(|| {
                    nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::x_axis(), std::f64::consts::PI)
                });
            let frame = state.bodies[module][joint.parent] * Pose::from_parts(joint.origin.into(), along);
            let anchor = |body: usize| Anchor::Body(self.first[module] + body);
            assembly.structure.connections.push(crate::statics::Connection {
                parent: anchor(joint.parent),
                child: anchor(joint.child),
                connector: self.motors[kind] + index,
                frame,
            });
            assembly.connections.push(Held::Joint { module, joint: index });
        }
    }

    fn add_connection(&self, assembly: &mut Assembly, state: &Transient, connection: Connection) {
        let [a, b] = connection.ports;
        let Some(connector) = self.connector(connection) else { return };
        let [parent, child] = [a, b].map(|port| Anchor::Body(self.index(self.body_of(port))));
        let frame = frame_between([a, b].map(|port| self.placed(state, port)));
        let Some(frame) = frame else { return };
        assembly.structure.connections.push(crate::statics::Connection { parent, child, connector, frame });
        assembly.connections.push(Held::Ports(connection));
    }

    fn add_body_contacts(&self, assembly: &mut Assembly, state: &Transient, solids: &[Solid]) {
        let mut held: Vec<[usize; 2]> = Vec::with_capacity(state.engaged.len());
        for connection in state.engaged {
            // A cone and a patch contain the contact of what they hold; a box stands beside it.
            let contains = self
                .connector(*connection)
                .is_some_and(|connector| !matches!(self.connectors[connector].model, Model::Box { .. }));
            if contains {
                let mut pair = connection.ports.map(|port| self.index(self.body_of(port)));
                pair.sort_unstable();
                held.push(pair);
            }
        }
        held.sort_unstable();
        let all = BroadPhase::new(solids.to_vec());
        for (first, solid) in solids.iter().enumerate() {
            for (second, other) in all.near(solid, self.tolerance) {
                let [a, b] = [first, second].map(|index| self.bodies[index]);
                if second <= first
                    || a.module == b.module
                    || (self.is_fixed(a) && self.is_fixed(b))
                    || held.binary_search(&[first, second]).is_ok()
                {
                    continue;
                }
                if let Some(mut patch) = contact(solid, other, self.tolerance) {
                    let friction = self.friction_between(a, b, &mut patch);
                    add_contacts(assembly, first, Anchor::Body(second), Touched::Body(b), friction, patch);
                }
            }
        }
    }

    fn add_environment_contacts(&self, assembly: &mut Assembly, solids: &[Solid]) {
        let environment = &self.linkage.environment;
        for (index, solid) in solids.iter().enumerate() {
            if self.is_fixed(self.bodies[index]) {
                continue;
            }
            for (what, patch) in self.surroundings.contacts(solid, self.tolerance) {
                add_contacts(assembly, index, Anchor::World, what.into(), what.friction(environment), patch);
            }
        }
    }

    /// Friction of two bodies that touch without being connected. Attaching must not lose: where a cone
    /// or a patch could hold them, they carry no more than it does without strength.
    fn friction_between(&self, a: BodyOf, b: BodyOf, patch: &mut ContactPatch) -> f64 {
        let own = self.linkage.environment.module_friction;
        let catalogue = &self.linkage.catalogue;
        let types = [a, b].map(|body| self.linkage.modules[body.module].module_type);
        if types.iter().all(|&kind| catalogue.module_types[kind].lattice.is_some()) {
            let surface = Surface::between(catalogue, types[0], types[1], own);
            surface.shrink(&mut patch.points);
            return surface.friction;
        }
        let ports = |kind: usize, body: usize| {
            let all = catalogue.module_types[kind].ports.iter().enumerate();
            all.filter(move |(_, port)| port.body == body).map(move |(port, _)| [kind, port])
        };
        let pairs =
            ports(types[0], a.body).flat_map(|first| ports(types[1], b.body).map(move |second| [first, second]));
        let holding = pairs.filter_map(|[first, second]| catalogue.connector_between(first, second));
        holding.fold(own, |friction, connector| match &catalogue.connectors[connector].model {
            Model::Cone { friction: [x, y], .. } => friction.min(*x).min(*y),
            Model::Patch { friction: within, .. } => friction.min(*within),
            Model::Box { .. } => friction,
        })
    }

    fn connector(&self, connection: Connection) -> Option<usize> {
        let [a, b] = connection.ports.map(|port| [self.linkage.modules[port.module].module_type, port.port]);
        self.linkage.catalogue.connector_between(a, b)
    }

    fn placed<'s>(&'s self, state: &Transient, port: Port) -> (&'s ModuleType, usize, Pose) {
        let BodyOf { module, body } = self.body_of(port);
        (self.linkage.module_type(module), port.port, state.bodies[module][body])
    }

    fn body_of(&self, port: Port) -> BodyOf {
        BodyOf { module: port.module, body: self.linkage.module_type(port.module).ports[port.port].body }
    }

    fn index(&self, body: BodyOf) -> usize {
        self.first[body.module] + body.body
    }

    fn is_fixed(&self, body: BodyOf) -> bool {
        body.body == 0 && self.linkage.modules[body.module].fixed
    }

    fn solid(&self, state: &Transient, BodyOf { module, body }: BodyOf) -> Solid {
        let kind = &self.linkage.module_type(module).bodies[body];
        Solid::new(kind.shape.clone(), state.bodies[module][body] * kind.shape_pose)
    }
}

/// The connector that a joint is: it carries everything but torque about its axis, z, beyond the holding
/// torque. Its strength, which only scales what is reported, is the force of that torque at one metre.
fn motor(module_type: &ModuleType, joint: usize) -> Connector {
    let joint = &module_type.joints[joint];
    Connector {
        name: format!("{}.{}", module_type.name, joint.name),
        strength: joint.torque,
        model: Model::Box {
            shear: [f64::INFINITY; 2],
            tension: f64::INFINITY,
            compression: f64::INFINITY,
            bending: [f64::INFINITY; 2],
            torsion: joint.torque,
        },
    }
}

fn add_contacts(
    assembly: &mut Assembly,
    body: usize,
    against: Anchor,
    touched: Touched,
    friction: f64,
    patch: ContactPatch,
) {
    for position in patch.points {
        assembly.structure.contacts.push(Contact { body, against, position, normal: patch.normal, friction });
        assembly.contacts.push((assembly.bodies[body], touched));
    }
}

impl fmt::Display for Touched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Body(body) => write!(f, "body {} of module number {}", body.body, body.module),
            Self::Obstacle(index) => write!(f, "obstacle number {index}"),
            Self::Ground => f.write_str("the ground"),
        }
    }
}
