//! From a robot at one moment to the structure that the oracle assesses.
//!
//! Knows which faces hold, which touch and where; knows neither actions nor
//! what the oracle makes of the structure.

use nalgebra::Translation3;

use crate::geometry::{ContactPatch, Solid, Surrounding, Surroundings, TOUCH, contact};
use crate::robot::{Configuration, Face, FaceConnection, Occupancy, Placement};
use crate::spatial::{Pose, Vec3};
use crate::statics::{Anchor, Body, Connection, Connector, Contact, Load, Structure};

use super::surface::{Surface, full_face, scaled};

/// Share of a face's edge below which two faces do not overlap at all.
const NO_OVERLAP: f64 = 1e-9;

/// A robot at one moment: all modules at rest in the lattice, but for at most
/// one that is on its way.
#[derive(Clone, Debug)]
pub struct Transient<'a> {
    /// Where each module is; the moving module's entry is not used.
    pub placements: &'a [Placement],
    /// The module on its way.
    pub moving: Option<Moving>,
    /// What holds the modules together.
    pub engaged: &'a [Engagement],
}

/// A robot at one moment, with any number of modules on their way at once.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Where each module is; those of moving modules are not used.
    pub placements: &'a [Placement],
    /// The modules on their way.
    pub moving: &'a [Moving],
    /// What holds the modules together.
    pub engaged: &'a [Engagement],
}

impl<'a> From<&'a Transient<'a>> for Moment<'a> {
    fn from(state: &'a Transient<'a>) -> Self {
        Self { placements: state.placements, moving: state.moving.as_slice(), engaged: state.engaged }
    }
}

/// A module that is anywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    /// Its index.
    pub module: usize,
    /// Pose of its frame in W.
    pub pose: Pose,
}

/// One connection that holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Engagement {
    /// Two faces, as far as they overlap: wholly in the lattice, partly while
    /// one slides over the other.
    Face {
        /// The two modules, parent first.
        modules: [usize; 2],
        /// World direction from the first to the second.
        towards: Face,
    },
    /// A module that pivots about an edge.
    Hinge {
        /// The module that stays.
        parent: usize,
        /// The module that pivots.
        child: usize,
        /// Centre of the edge, z along it, in W.
        frame: Pose,
    },
}

impl Engagement {
    /// A configuration's connection.
    pub fn face(configuration: &Configuration, connection: &FaceConnection) -> Self {
        let towards = configuration.direction(connection.ports[0]);
        Self::Face { modules: connection.modules(), towards }
    }

    /// The two modules, parent first.
    pub const fn modules(&self) -> [usize; 2] {
        match *self {
            Self::Face { modules, .. } => modules,
            Self::Hinge { parent, child, .. } => [parent, child],
        }
    }
}

/// What a module touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// The module with this index.
    Module(usize),
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

/// A structure with the way back to the robot. Body i is module i.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// The oracle's input.
    pub structure: Structure,
    /// What each of the structure's connections is, as an index into
    /// [`Transient::engaged`].
    pub connections: Vec<usize>,
    /// What each of the structure's contacts is between: the module that the
    /// normal points into, and what it touches.
    pub contacts: Vec<(usize, Touched)>,
}

/// Assembles structures of one robot, over and over: everything that does not
/// depend on where the modules are is prepared once.
#[derive(Clone, Debug)]
pub struct Assembler<'a> {
    configuration: &'a Configuration,
    pitch: f64,
    /// The catalogue's connectors, as they are on a full face.
    connectors: Vec<Connector>,
    /// How two module types meet, by first times the number of types plus second.
    surfaces: Vec<Surface>,
    surroundings: Surroundings,
}

/// The structure of a configuration as it stands.
pub fn assemble(configuration: &Configuration) -> Assembly {
    let placements: Vec<_> = configuration.modules.iter().map(|m| m.placement).collect();
    let engaged: Vec<_> = configuration.connections.iter().map(|c| Engagement::face(configuration, c)).collect();
    Assembler::new(configuration).assemble(&Transient { placements: &placements, moving: None, engaged: &engaged })
}

impl<'a> Assembler<'a> {
    /// Prepares for states of `configuration`'s modules in its environment and
    /// under its loads; its placements and connections play no part.
    /// `configuration` must be sound (have no [`Configuration::problems`]).
    pub fn new(configuration: &'a Configuration) -> Self {
        let catalogue = &configuration.catalogue;
        let pitch = configuration.pitch();
        let types = catalogue.module_types.len();
        let surfaces = (0..types * types)
            .map(|i| Surface::between(catalogue, i / types, i % types, configuration.environment.module_friction))
            .collect();
        Self {
            configuration,
            pitch,
            connectors: catalogue.connectors.iter().map(|c| full_face(c, pitch)).collect(),
            surfaces,
            surroundings: Surroundings::new(&configuration.environment),
        }
    }

    /// The structure of a state: a body for each module, a connection for each
    /// engagement, and contacts wherever else something touches.
    ///
    /// The frame of a face's connection is at the centre of the overlap, z from
    /// parent to child, as [`Face::outward_frame`] says, whatever the modules' orientations. A partly overlapped face holds with its
    /// share of the connector's strength and limits. Engagements that hold nothing are left out:
    /// faces without overlap or whose connectors do not fit, hinges of modules that have none.
    ///
    /// Two fixed modules carry no contact between them, nor does a fixed module
    /// with its environment.
    pub fn assemble(&self, state: &Transient) -> Assembly {
        self.assemble_moment(&state.into())
    }

    /// The structure of a state with any number of modules on their way, as [`Self::assemble`] makes it of one.
    ///
    /// Two modules on their way carry no contact between them. With it the structure would be no weaker, since
    /// another contact never is a loss.
    pub fn assemble_moment(&self, state: &Moment) -> Assembly {
        let poses = self.poses(state);
        let mut assembly = self.held_together(state, &poses);
        let held = self.held_pairs(&assembly, state);
        self.add_resting_contacts(&mut assembly, state, &held, &poses);
        self.add_moving_contacts(&mut assembly, state, &held, &poses);
        self.add_environment_contacts(&mut assembly, 0..poses.len(), &poses);
        assembly
    }

    /// The structure of a state with all modules held immovably but the one on its way, without the contacts that then
    /// carry nothing: of the others among themselves and with their environment.
    pub fn assemble_alone(&self, state: &Transient) -> Assembly {
        let moment = state.into();
        let poses = self.poses(&moment);
        let mut assembly = self.held_together(&moment, &poses);
        let held = self.held_pairs(&assembly, &moment);
        self.add_moving_contacts(&mut assembly, &moment, &held, &poses);
        let moving = state.moving.map(|moving| moving.module);
        self.add_environment_contacts(&mut assembly, moving.into_iter(), &poses);
        for (module, body) in assembly.structure.bodies.iter_mut().enumerate() {
            body.fixed |= Some(module) != moving;
        }
        assembly
    }

    fn poses(&self, state: &Moment) -> Vec<Pose> {
        (0..self.configuration.modules.len()).map(|module| self.pose(state, module)).collect()
    }

    /// The bodies of a state with what holds them together.
    fn held_together(&self, state: &Moment, poses: &[Pose]) -> Assembly {
        let mut assembly = Assembly {
            structure: Structure {
                gravity: self.configuration.gravity,
                connectors: self.connectors.clone(),
                ..Structure::default()
            },
            connections: Vec::new(),
            contacts: Vec::new(),
        };
        self.add_bodies(&mut assembly, poses);
        for (index, engagement) in state.engaged.iter().enumerate() {
            if let Some(connection) = self.connection(&mut assembly.structure, poses, engagement) {
                assembly.structure.connections.push(connection);
                assembly.connections.push(index);
            }
        }
        assembly
    }

    fn pose(&self, state: &Moment, module: usize) -> Pose {
        let moving = state.moving.iter().find(|moving| moving.module == module);
        moving.map_or_else(|| state.placements[module].pose(self.pitch), |moving| moving.pose)
    }

    fn add_bodies(&self, assembly: &mut Assembly, poses: &[Pose]) {
        let structure = &mut assembly.structure;
        structure.bodies.extend(self.configuration.modules.iter().zip(poses).enumerate().map(|(i, (module, pose))| {
            let body = &self.configuration.module_type(i).body();
            Body { mass: body.mass, com: (pose * nalgebra::Point3::from(body.com)).coords, fixed: module.fixed }
        }));
        structure.loads.extend(self.configuration.loads.iter().map(|load| Load {
            body: load.module,
            force: load.force,
            torque: load.torque,
            at: load.at.map(|at| (poses[load.module] * nalgebra::Point3::from(at)).coords),
        }));
    }

    fn connection(&self, structure: &mut Structure, poses: &[Pose], engagement: &Engagement) -> Option<Connection> {
        let [parent, child] = engagement.modules();
        let (connector, frame) = match engagement {
            Engagement::Face { towards, .. } => {
                let connector = self.surface(parent, child).connector?;
                let rotation = towards.outward_frame();
                let offset = rotation.inverse_transform_vector(&(centre(poses, child) - centre(poses, parent)));
                let extent = [offset.x, offset.y].map(|o| (1.0 - o.abs() / self.pitch).min(1.0));
                if !(extent[0] > NO_OVERLAP && extent[1] > NO_OVERLAP) {
                    return None;
                }
                let to_overlap = rotation * Vec3::new(offset.x / 2.0, offset.y / 2.0, self.pitch / 2.0);
                let frame = Pose::from_parts(Translation3::from(centre(poses, parent) + to_overlap), rotation);
                (scaled_connector(structure, connector, extent), frame)
            }
            Engagement::Hinge { frame, .. } => {
                let types = [child, parent].map(|m| self.configuration.modules[m].module_type);
                (self.configuration.catalogue.hinge(types[0], types[1])?, *frame)
            }
        };
        Some(Connection { parent: Anchor::Body(parent), child: Anchor::Body(child), connector, frame })
    }

    /// Pairs of modules whose connectors contain the contact between them, ascending.
    fn held_pairs(&self, assembly: &Assembly, state: &Moment) -> Vec<[usize; 2]> {
        let mut held: Vec<[usize; 2]> = Vec::with_capacity(state.engaged.len());
        for &index in &assembly.connections {
            if let Engagement::Face { modules: [a, b], .. } = state.engaged[index]
                && self.surface(a, b).contained
            {
                held.push([a.min(b), a.max(b)]);
            }
        }
        held.sort_unstable();
        held
    }

    /// Whether contact between two modules carries anything beside what holds them.
    fn carries(&self, held: &[[usize; 2]], a: usize, b: usize) -> bool {
        !self.both_fixed(a, b) && held.binary_search(&[a.min(b), a.max(b)]).is_err()
    }

    fn add_resting_contacts(&self, assembly: &mut Assembly, state: &Moment, held: &[[usize; 2]], poses: &[Pose]) {
        for (a, towards, b) in resting(state).touching_pairs() {
            if self.carries(held, a, b) {
                let points = self.surface(a, b).face_points(self.pitch);
                let frame = towards.outward_frame();
                let origin = centre(poses, a) + towards.normal() * (self.pitch / 2.0);
                let points = points.iter().map(|[x, y]| origin + frame * Vec3::new(*x, *y, 0.0)).collect();
                self.add_pair(assembly, a, b, ContactPatch { normal: -towards.normal(), points });
            }
        }
    }

    fn add_moving_contacts(&self, assembly: &mut Assembly, state: &Moment, held: &[[usize; 2]], poses: &[Pose]) {
        let occupancy = resting(state);
        // Beyond the diagonal of a cube nothing can touch.
        let near = 1.8 * self.pitch;
        for m in state.moving.iter().map(|moving| moving.module) {
            let solid = self.solid(m, poses);
            for (_, other) in occupancy.iter() {
                if (centre(poses, other) - centre(poses, m)).amax() > near || !self.carries(held, m, other) {
                    continue;
                }
                if let Some(mut patch) = contact(&solid, &self.solid(other, poses), TOUCH * self.pitch) {
                    self.surface(m, other).shrink(&mut patch.points);
                    self.add_pair(assembly, m, other, patch);
                }
            }
        }
    }

    fn add_pair(&self, assembly: &mut Assembly, body: usize, against: usize, patch: ContactPatch) {
        let friction = self.surface(body, against).friction;
        add_contacts(assembly, body, Touched::Module(against), friction, patch);
    }

    fn add_environment_contacts(&self, assembly: &mut Assembly, modules: impl Iterator<Item = usize>, poses: &[Pose]) {
        let tolerance = TOUCH * self.pitch;
        for module in modules.filter(|&module| !self.configuration.modules[module].fixed) {
            let solid = self.solid(module, poses);
            for (what, patch) in self.surroundings.contacts(&solid, tolerance) {
                let friction = what.friction(&self.configuration.environment);
                add_contacts(assembly, module, what.into(), friction, patch);
            }
        }
    }

    fn surface(&self, a: usize, b: usize) -> &Surface {
        let modules = &self.configuration.modules;
        &self.surfaces
            [modules[a].module_type * self.configuration.catalogue.module_types.len() + modules[b].module_type]
    }

    fn both_fixed(&self, a: usize, b: usize) -> bool {
        self.configuration.modules[a].fixed && self.configuration.modules[b].fixed
    }

    fn solid(&self, module: usize, poses: &[Pose]) -> Solid {
        Solid::new(self.configuration.module_type(module).body().shape.clone(), poses[module])
    }
}

/// Where the modules are that are not on their way.
fn resting(state: &Moment) -> Occupancy {
    let is_moving = |m: usize| state.moving.iter().any(|moving| moving.module == m);
    let resting = state.placements.iter().enumerate().filter(|(m, _)| !is_moving(*m));
    Occupancy::new(resting.map(|(m, placement)| (placement.cell, m)))
}

fn centre(poses: &[Pose], module: usize) -> Vec3 {
    poses[module].translation.vector
}

/// The index of the connector scaled to a partly overlapped face, added to the structure.
fn scaled_connector(structure: &mut Structure, connector: usize, extent: [f64; 2]) -> usize {
    if extent == [1.0, 1.0] {
        return connector;
    }
    let part = scaled(&structure.connectors[connector], extent);
    structure.connectors.push(part);
    structure.connectors.len() - 1
}

fn add_contacts(assembly: &mut Assembly, body: usize, touched: Touched, friction: f64, patch: ContactPatch) {
    let against = match touched {
        Touched::Module(other) => Anchor::Body(other),
        Touched::Ground | Touched::Obstacle(_) => Anchor::World,
    };
    for position in patch.points {
        assembly.structure.contacts.push(Contact { body, against, position, normal: patch.normal, friction });
        assembly.contacts.push((body, touched));
    }
}
