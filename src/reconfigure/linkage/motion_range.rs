//! Where a strut may stand over its node, or a joint in its range: a map of margins.
//!
//! Each position is a state at rest; whether a way leads there is for a plan to say.

use std::fmt;

use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use crate::geometry::{SKIN, Solid, Surroundings, overlap};
use crate::robot::linkage::{Code, Connection, Linkage, MICRO, Spot};
use crate::spatial::{Pose, Rotation};
use crate::statics::{Bracket, InvalidStructure, Question, Verdict, assess};

use super::action::Half;
use super::assembly::{Assembler, BodyOf, Transient};
use super::joined::Joined;

/// What turns, and which side of it moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// A port over the ball that it holds.
    Roll {
        /// The connection, between a port at a point and a surface.
        connection: Connection,
        /// The module of the connection whose side moves.
        carried: usize,
    },
    /// A joint.
    Rotate {
        /// The module whose joint it is.
        module: usize,
        /// Index of the joint in the module's type.
        joint: usize,
        /// The side that moves.
        carried: Half,
    },
}

/// A position and what it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Of a port over a ball its azimuth and polar angle in the ball's frame, of a joint its position and 0; in degrees.
    pub at: [f64; 2],
    /// Whether something overlaps: bodies of the moving side with others, the ground or an obstacle.
    pub overlaps: bool,
    /// Whether the robot stands there.
    pub verdict: Verdict,
    /// Its internal stability margin there; minus infinity where no strength helps.
    pub margin: Bracket,
}

/// The map of all positions on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionRange {
    /// Of a port by polar angle, then azimuth (at the poles one azimuth only); of a joint ascending.
    pub stands: Vec<Stand>,
    /// Where it is now, as [`Stand::at`].
    pub present: [f64; 2],
    /// Distance of neighbouring positions in degrees.
    pub step_degrees: f64,
}

/// Why there is no map.
#[derive(Clone, Debug, PartialEq)]
pub enum NotABridge {
    /// The connection is not engaged, or not one of a port over a ball.
    NoRoll,
    /// What is to move holds on to the rest by more than this connection or joint.
    HeldElsewhere,
    /// A fixed module is on the side that is to move.
    Fixed,
    /// The oracle refuses the structure.
    Structure(Vec<InvalidStructure>),
}

impl fmt::Display for NotABridge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoRoll => f.write_str("no strut's port engages with a surface there"),
            Self::HeldElsewhere => f.write_str("both sides hold on to each other elsewhere too: open that first"),
            Self::Fixed => f.write_str("both sides hold a fixed module, or the one that is to move does"),
            Self::Structure(problems) => {
                let all: Vec<String> = problems.iter().map(|p| format!("{}: {}", p.place, p.problem)).collect();
                f.write_str(&all.join("; "))
            }
        }
    }
}

impl std::error::Error for NotABridge {}

/// Maps the positions of a port over its ball on a grid of azimuths and polar angles, or of a joint over its
/// range (a whole turn where it has none), `step_degrees` apart. The spin of a port stays what it is.
///
/// `linkage` must be sound. The result does not depend on the number of threads.
///
/// # Errors
/// [`NotABridge`] when nothing can turn there.
pub fn motion_range(linkage: &Linkage, turning: Turning, step_degrees: f64) -> Result<MotionRange, NotABridge> {
    let carried = carried(linkage, turning)?;
    let (present, positions) = positions(linkage, turning, step_degrees)?;
    let assembler = Assembler::new(linkage);
    let surroundings = Surroundings::new(&linkage.environment);
    let stands = positions.par_iter().map(|position| {
        let mut bodies: Vec<Vec<Pose>> = (0..linkage.modules.len()).map(|module| linkage.body_poses(module)).collect();
        for body in &carried {
            let pose = &mut bodies[body.module][body.body];
            *pose = position.displacement * *pose;
        }
        let overlaps = overlaps(linkage, &surroundings, &carried, &bodies);
        let structure = assembler.assemble(&Transient { bodies: &bodies, engaged: &linkage.connections }).structure;
        let answer = assess(&structure, Question::VALUE).map_err(NotABridge::Structure)?;
        Ok(Stand { at: position.at, overlaps, verdict: answer.verdict, margin: answer.margin() })
    });
    Ok(MotionRange { stands: stands.collect::<Result<_, _>>()?, present, step_degrees })
}

/// A position, and the displacement of the moving side that leads there from where it is.
struct Position {
    at: [f64; 2],
    displacement: Pose,
}

/// The bodies of the side that moves.
fn carried(linkage: &Linkage, turning: Turning) -> Result<Vec<BodyOf>, NotABridge> {
    let joined = Joined::new(linkage);
    let (sides, here, there): (UnionFind<usize>, BodyOf, BodyOf) = match turning {
        Turning::Roll { connection, carried } => {
            if !linkage.connections.contains(&connection) {
                return Err(NotABridge::NoRoll);
            }
            let body = |module: usize| {
                let port = connection.ports.into_iter().find(|port| port.module == module).ok_or(NotABridge::NoRoll)?;
                Ok(BodyOf { module, body: linkage.module_type(module).ports[port.port].body })
            };
            let other = connection.modules().into_iter().find(|&module| module != carried);
            let other = other.ok_or(NotABridge::NoRoll)?;
            (joined.without_connection(linkage, connection), body(carried)?, body(other)?)
        }
        Turning::Rotate { module, joint, carried } => {
            let kind = &linkage.module_type(module).joints[joint];
            let [parent, child] = [kind.parent, kind.child].map(|body| BodyOf { module, body });
            let (here, there) = if carried == Half::Child { (child, parent) } else { (parent, child) };
            (joined.without_joint(linkage, module, joint), here, there)
        }
    };
    let here = joined.index(here);
    if sides.equiv(here, joined.index(there)) {
        return Err(NotABridge::HeldElsewhere);
    }
    let carried: Vec<BodyOf> =
        joined.bodies.iter().copied().filter(|&body| sides.equiv(joined.index(body), here)).collect();
    if carried.iter().any(|body| body.body == 0 && linkage.modules[body.module].fixed) {
        return Err(NotABridge::Fixed);
    }
    Ok(carried)
}

fn positions(linkage: &Linkage, turning: Turning, step: f64) -> Result<([f64; 2], Vec<Position>), NotABridge> {
    match turning {
        Turning::Roll { connection, carried } => {
            let Code::OnSurface(from) = linkage.code(&connection) else { return Err(NotABridge::NoRoll) };
            let [a, b] = connection.ports;
            let (point, ball) = if linkage.port_frame(a).is_some() { (a, b) } else { (b, a) };
            let body = linkage.body_of(ball);
            let kind = linkage.module_type(ball.module);
            let centre = (body * kind.bodies[kind.ports[ball.port].body].shape_pose).translation.vector;
            let moves_point = carried == point.module;
            let position = |azimuth: f64, polar: f64| {
                let to = Spot::new(micro(azimuth), micro(polar), from.spin());
                let turn = body.rotation * to.rotation() * from.rotation().inverse() * body.rotation.inverse();
                let turn = if moves_point { turn } else { turn.inverse() };
                Position { at: [azimuth, polar], displacement: Pose::rotation_wrt_point(turn, centre.into()) }
            };
            let grid = multiples(step, 180.0).into_iter().flat_map(|polar| {
                let is_pole = polar == 0.0 || polar == 180.0;
                let azimuths = multiples(step, 360.0).into_iter().filter(|&azimuth| azimuth < 360.0);
                azimuths.take(if is_pole { 1 } else { usize::MAX }).map(move |azimuth| [azimuth, polar])
            });
            let present = [from.azimuth(), from.polar()].map(|angle| f64::from(angle) / f64::from(MICRO));
            Ok((present, grid.map(|[azimuth, polar]| position(azimuth, polar)).collect()))
        }
        Turning::Rotate { module, joint, carried } => {
            let kind = &linkage.module_type(module).joints[joint];
            let parent = linkage.body_poses(module)[kind.parent];
            let present = f64::from(linkage.modules[module].joints[joint]) * kind.step_degrees;
            let position = |at: f64| {
                let angle = (at - present).to_radians() * if carried == Half::Child { 1.0 } else { -1.0 };
                let axis = parent.rotation * kind.axis;
                let origin = parent * nalgebra::Point3::from(kind.origin);
                let turn = Rotation::from_axis_angle(&axis, angle);
                Position { at: [at, 0.0], displacement: Pose::rotation_wrt_point(turn, origin) }
            };
            let [low, high] = match kind.range {
                Some(range) => range.map(|steps| f64::from(steps) * kind.step_degrees),
                None => [0.0, 360.0],
            };
            let grid = multiples(step, high - low).into_iter().map(|offset| low + offset);
            let grid = grid.filter(|&at| kind.range.is_some() || at < 360.0);
            Ok(([present, 0.0], grid.map(position).collect()))
        }
    }
}

/// An angle in micro-degrees.
fn micro(degrees: f64) -> i32 {
    (degrees * f64::from(MICRO)).round() as i32
}

/// 0, `step`, ... up to `last`, which is always one of them.
fn multiples(step: f64, last: f64) -> Vec<f64> {
    let whole = (last / step * (1.0 - 1e-12)).floor() as usize;
    (0..=whole).map(|i| i as f64 * step).filter(|&angle| angle < last).chain([last]).collect()
}

/// Whether a body that moved overlaps another one or its surroundings.
fn overlaps(linkage: &Linkage, surroundings: &Surroundings, carried: &[BodyOf], bodies: &[Vec<Pose>]) -> bool {
    let solid = |BodyOf { module, body }: BodyOf| {
        let kind = &linkage.module_type(module).bodies[body];
        Solid::new(kind.shape.clone(), bodies[module][body] * kind.shape_pose)
    };
    let all = Joined::new(linkage).bodies;
    let moving: Vec<Solid> = carried.iter().map(|&body| solid(body)).collect();
    let resting: Vec<BodyOf> = all.into_iter().filter(|body| !carried.contains(body)).collect();
    carried.iter().zip(&moving).any(|(body, mover)| {
        let skin = SKIN * mover.size();
        let hits = |&other: &BodyOf| other.module != body.module && overlap(mover, &solid(other), skin);
        resting.iter().any(hits) || !surroundings.overlaps(mover, skin).is_empty()
    })
}
