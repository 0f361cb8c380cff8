//! The moves of a linkage: every roll and every rotation by one step, with every way to split the robot for it.
//!
//! Knows what holds together and where it turns; knows neither collision nor forces.

use std::sync::Arc;

use nalgebra::Unit;

use crate::geometry::Motion;
use crate::robot::linkage::{Connection, MICRO, Port, Spot, mated};
use crate::robot::{JointType, ModuleType, PortPlace};
use crate::spatial::{Point, Pose, Rotation, Vec3};

use super::action::{Action, Half};
use super::places::Place;
use super::problem::Class;
use super::sides::Graph;

/// One less the cosine of the angle up to which two axes are one: far above how nearly loops close, and far
/// below the angle between axes of different moves.
const SAME_LINE: f64 = 1e-6;

/// A robot in some description: modules, and the connections between them that are engaged.
#[derive(Clone, Debug)]
pub struct View {
    /// The classes of the modules.
    pub classes: Arc<[Class]>,
    /// The modules.
    pub modules: Vec<Arc<Place>>,
    /// The engaged connections, sorted; modules are indices into `modules`.
    pub connections: Vec<Connection>,
}

/// A move of a robot in some description.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What turns, by how much, and which side of it moves.
    pub action: Action,
    /// Whether each module moves as a whole. A module whose joint turns does not.
    pub carried: Vec<bool>,
    /// How they move.
    pub motion: Motion,
}

/// What may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Whether the robot must hold together on both sides of what turns.
    pub connected: bool,
    /// Whether it is the same which side moves; then the one without the first module's first body does.
    pub either_side: bool,
}

impl View {
    /// The type of a module.
    pub fn kind(&self, module: usize) -> &ModuleType {
        &self.classes[self.modules[module].class].kind
    }

    /// The body that a port sits on.
    pub fn body_of(&self, port: Port) -> usize {
        self.kind(port.module).ports[port.port].body
    }

    /// All moves by these rules, in a fixed order.
    pub fn steps(&self, rules: Rules) -> Vec<Step> {
        let mut steps = Vec::new();
        for &connection in &self.connections {
            self.rolls(connection, rules, &mut steps);
        }
        for module in 0..self.modules.len() {
            if self.kind(module).rotates {
                for joint in 0..self.kind(module).joints.len() {
                    self.rotations(module, joint, rules, &mut steps);
                }
            }
        }
        steps
    }

    /// A move of the robot as it was before connections between its sides were released, now that they are.
    ///
    /// What turns is now all that the one side's place follows from, and where a loop was closed only nearly, it is
    /// not quite where it was measured to be before.
    pub fn once_released(&self, step: &Step, rules: Rules) -> Option<Step> {
        let turning = |action: &Action| match *action {
            Action::Roll { connection, carried, .. } => (Some(connection), carried, None),
            Action::Rotate { module, joint, carried, .. } => (None, module, Some((joint, carried))),
            Action::Attach(connection) | Action::Detach(connection) => (Some(connection), usize::MAX, None),
        };
        let is_same = |other: &Step| {
            turning(&other.action) == turning(&step.action)
                && other.carried == step.carried
                && are_near(&other.motion, &step.motion)
        };
        self.steps(rules).into_iter().find(is_same)
    }

    /// Whether a body moves.
    pub fn moves(&self, step: &Step, module: usize, body: usize) -> bool {
        match step.action {
            Action::Rotate { module: turning, joint, carried, .. } if turning == module => {
                self.classes[self.modules[module].class].is_beyond(joint, body) == (carried == Half::Child)
            }
            _ => step.carried[module],
        }
    }

    /// The connections that stay engaged through a move.
    pub fn kept(&self, step: &Step) -> Vec<Connection> {
        let moves = |port: Port| self.moves(step, port.module, self.body_of(port));
        let rolls =
            |connection: &Connection| matches!(step.action, Action::Roll { connection: c, .. } if c == *connection);
        let is_kept = |connection: &&Connection| {
            let [a, b] = connection.ports;
            moves(a) == moves(b) || rolls(connection)
        };
        self.connections.iter().filter(is_kept).copied().collect()
    }

    /// The modules after a move: class, pose and joint positions of each.
    pub fn after(&self, step: &Step) -> Vec<(usize, Pose, Arc<[i32]>)> {
        let displacement = step.motion.at(1.0);
        let module = |(index, place): (usize, &Arc<Place>)| {
            let pose = if self.moves(step, index, 0) { displacement * place.pose } else { place.pose };
            let joints = match step.action {
                Action::Rotate { module, joint, to, .. } if module == index => {
                    let mut joints = place.joints.to_vec();
                    joints[joint] = to;
                    joints.into()
                }
                _ => Arc::clone(&place.joints),
            };
            (place.class, pose, joints)
        };
        self.modules.iter().enumerate().map(module).collect()
    }

    fn rotations(&self, module: usize, joint: usize, rules: Rules, steps: &mut Vec<Step>) {
        let class = &self.classes[self.modules[module].class];
        let kind = &class.kind.joints[joint];
        // The child half of the turning module is one more vertex.
        let count = self.modules.len();
        let vertex = |port: Port| {
            let is_child = port.module == module && class.is_beyond(joint, self.body_of(port));
            if is_child { count } else { port.module }
        };
        let graph = Graph::new(count + 1, self.connections.iter().map(|connection| connection.ports.map(vertex)));
        let parent = self.modules[module].bodies[kind.parent];
        let centre = (parent * Point::from(kind.origin)).coords;
        let axis = turned(&parent, &kind.axis);
        let targets = targets(kind, self.modules[module].joints[joint]);
        for (carried, side) in graph.both_sides([count, module], rules.connected) {
            let half = if carried == 0 { Half::Child } else { Half::Parent };
            let mut side = side[..count].to_vec();
            side[module] = false;
            for &(to, sign) in &targets {
                let degrees = f64::from(sign) * kind.step_degrees;
                let angle = if half == Half::Child { degrees } else { -degrees }.to_radians();
                let action = Action::Rotate { module, joint, to, carried: half };
                let motion = Motion::Rotation { centre, axis, angle };
                self.add(Step { action, carried: side.clone(), motion }, rules, steps);
            }
        }
    }

    fn rolls(&self, connection: Connection, rules: Rules, steps: &mut Vec<Step>) {
        let [a, b] = connection.ports;
        let place = |port: Port| &self.kind(port.module).ports[port.port].place;
        let (point, ball, frame) = match (place(a), place(b)) {
            (PortPlace::Point { frame, .. }, PortPlace::Surface) => (a, b, frame),
            (PortPlace::Surface, PortPlace::Point { frame, .. }) => (b, a, frame),
            _ => return,
        };
        let Some(step) = self.kind(point.module).roll_step_degrees else { return };
        let body = self.body_of(ball);
        let ball_pose = self.modules[ball.module].bodies[body];
        let centre = ball_pose * self.kind(ball.module).bodies[body].shape_pose;
        let port_pose = self.modules[point.module].bodies[self.body_of(point)] * frame;
        let from = Spot::of(&(ball_pose.rotation.inverse() * mated(&port_pose, 0.0).rotation));
        let others = self.connections.iter().filter(|other| **other != connection).map(Connection::modules);
        let graph = Graph::new(self.modules.len(), others);
        let turns = turns(from, step);
        let ends = [point.module, ball.module];
        for (moving, side) in graph.both_sides(ends, rules.connected) {
            for turn in &turns {
                let degrees = if moving == 0 { turn.degrees } else { -turn.degrees };
                let motion = Motion::Rotation {
                    centre: centre.translation.vector,
                    axis: turned(&ball_pose, &turn.axis),
                    angle: degrees.to_radians(),
                };
                let action = Action::Roll { connection, to: turn.to, carried: ends[moving] };
                self.add(Step { action, carried: side.clone(), motion }, rules, steps);
            }
        }
    }

    /// Adds a move unless it moves what is held, or is another one seen from the other side.
    fn add(&self, step: Step, rules: Rules, steps: &mut Vec<Step>) {
        let is_held = |module: usize| {
            let class = &self.classes[self.modules[module].class];
            let is_moved = |body| self.moves(&step, module, body);
            class.fixed && is_moved(0) || class.stays && (0..class.kind.bodies.len()).any(is_moved)
        };
        let is_other = rules.either_side && self.moves(&step, 0, 0);
        if !is_other && !(0..self.modules.len()).any(is_held) {
            steps.push(step);
        }
    }
}

/// A direction in a frame, in W: a unit vector whatever the frame's rotation has lost to rounding, since what it has
/// lost would come back twice in every pose that the turn makes.
fn turned(frame: &Pose, axis: &Unit<Vec3>) -> Unit<Vec3> {
    Unit::new_normalize(frame.rotation * axis.into_inner())
}

/// Whether two turns are by the same angle about nearly the same line.
fn are_near(a: &Motion, b: &Motion) -> bool {
    match (a, b) {
        (Motion::Rotation { axis: u, angle: a, .. }, Motion::Rotation { axis: v, angle: b, .. }) => {
            a == b && u.dot(v) > 1.0 - SAME_LINE
        }
        _ => false,
    }
}

/// The positions next to one, each with the sign of the turn that leads there.
fn targets(joint: &JointType, from: i32) -> Vec<(i32, i32)> {
    let next = [1, -1].map(|sign| (joint.canonical(from.saturating_add(sign)), sign));
    next.into_iter().filter(|(to, _)| joint.allows(*to) && *to != from).collect()
}

/// A turn of a port about a ball.
#[derive(Clone, Copy, Debug)]
struct Turn {
    to: Spot,
    /// In the frame of the ball's body.
    axis: Unit<Vec3>,
    degrees: f64,
}

/// All turns by one step out of a spot: about the ball's z axis, towards and from its poles, and in place.
fn turns(from: Spot, step: f64) -> Vec<Turn> {
    let micro = ((step * f64::from(MICRO)).round() as i32).max(1);
    let half = 180 * MICRO;
    let is_pole = from.polar() == 0 || from.polar() == half;
    let about = |axis: Vec3, azimuth: i32| {
        let turned = Rotation::from_axis_angle(&Vec3::z_axis(), (f64::from(azimuth) / f64::from(MICRO)).to_radians());
        turned * Unit::new_unchecked(axis)
    };
    let mut turns = Vec::new();
    for sign in [1, -1] {
        let degrees = f64::from(sign) * step;
        if !is_pole {
            let to = Spot::new(from.azimuth() + sign * micro, from.polar(), from.spin());
            turns.push(Turn { to, axis: Vec3::z_axis(), degrees });
        }
        let polar = from.polar() + sign * micro;
        if (0..=half).contains(&polar) {
            let azimuths = if is_pole { meridians(from, micro) } else { vec![from.azimuth()] };
            for azimuth in azimuths {
                // At a pole azimuth and spin turn about one axis: leaving it changes neither their sum (in the north)
                // nor their difference.
                let shift = match from.polar() {
                    0 => -azimuth,
                    pole if pole == half => azimuth,
                    _ => 0,
                };
                let to = Spot::new(azimuth, polar, from.spin() + shift);
                let arrives = polar == 0 || polar == half;
                if !arrives || is_pole || meridians(to, micro).contains(&azimuth) {
                    turns.push(Turn { to, axis: about(Vec3::y(), azimuth), degrees });
                }
            }
        }
        let to = Spot::new(from.azimuth(), from.polar(), from.spin() + sign * micro);
        turns.push(Turn { to, axis: Unit::new_normalize(from.direction()), degrees });
    }
    turns
}

/// The azimuths along which a port leaves a pole, and arrives at it: multiples of the step, counted from the ball's x
/// axis and from the port's own.
fn meridians(pole: Spot, step: i32) -> Vec<i32> {
    let turn = 360 * MICRO;
    let own = if pole.polar() == 0 { pole.spin() } else { -pole.spin() };
    let from = |first: i32| (0..(turn + step - 1) / step).map(move |i| (first + i * step).rem_euclid(turn));
    let mut azimuths: Vec<i32> = from(0).chain(from(own)).collect();
    azimuths.sort_unstable();
    azimuths.dedup();
    azimuths
}
