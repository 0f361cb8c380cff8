//! Which actions are legal in a state of a linkage, from their definitions, and where they lead.

use nalgebra::Unit;
use petgraph::unionfind::UnionFind;

use crate::geometry::Motion;
use crate::robot::linkage::{Code, Connection, Linkage, Spot};
use crate::spatial::{Pose, Vec3};

use super::super::action::{Action, Half};
use super::super::assembly::BodyOf;
use super::super::joined::Joined;
use super::Fault;

/// A legal action: the state after it, and the way of what moves.
#[derive(Clone, Debug)]
pub struct Transition {
    pub after: Linkage,
    pub path: Option<Path>,
}

/// The way of one side of a joint or connection.
#[derive(Clone, Debug)]
pub struct Path {
    /// The bodies that move.
    pub carried: Vec<BodyOf>,
    pub motion: Motion,
    /// Equal steps in which the way is checked.
    pub steps: u32,
}

/// Angle in degrees between the phases at which a turn is checked.
const CHECKED_DEGREES: f64 = 3.0;

/// How far the angle of a roll may be from its step, in degrees: what rounding three angles to micro-degrees
/// at either end can make, ten times over.
const STEP_DEGREES: f64 = 3e-5;

/// Where an action leads from a state.
pub fn transition(before: &Linkage, action: &Action) -> Result<Transition, Fault> {
    match *action {
        Action::Attach(connection) => attach(before, connection),
        Action::Detach(connection) => detach(before, connection),
        Action::Roll { connection, to, carried } => roll(before, connection, to, carried),
        Action::Rotate { module, joint, to, carried } => rotate(before, module, joint, to, carried),
    }
}

fn known(before: &Linkage, connection: Connection) -> Result<(), Fault> {
    let is_known = connection
        .ports
        .iter()
        .all(|port| port.module < before.modules.len() && port.port < before.module_type(port.module).ports.len());
    if is_known { Ok(()) } else { Err(Fault::UnknownModule) }
}

fn attach(before: &Linkage, connection: Connection) -> Result<Transition, Fault> {
    known(before, connection)?;
    if before.connections.contains(&connection) {
        return Err(Fault::AlreadyEngaged);
    }
    let [a, b] = connection.modules();
    if a == b || before.engagement(&connection).is_none() {
        return Err(Fault::FacesApart);
    }
    let mut after = before.clone();
    after.connections.push(connection);
    after.connections.sort_unstable();
    Ok(Transition { after, path: None })
}

fn detach(before: &Linkage, connection: Connection) -> Result<Transition, Fault> {
    known(before, connection)?;
    if !before.connections.contains(&connection) {
        return Err(Fault::NotEngaged);
    }
    let mut after = before.clone();
    after.connections.retain(|engaged| *engaged != connection);
    Ok(Transition { after, path: None })
}

fn roll(before: &Linkage, connection: Connection, to: Spot, carried: usize) -> Result<Transition, Fault> {
    known(before, connection)?;
    let Some(side) = connection.ports.iter().find(|port| port.module == carried) else {
        return Err(Fault::UnknownModule);
    };
    if !before.connections.contains(&connection) {
        return Err(Fault::NotHeld);
    }
    let Code::OnSurface(from) = before.code(&connection) else { return Err(Fault::Unable) };
    let is_point = |module: usize, port: usize| before.module_type(module).ports[port].is_point();
    let [a, b] = connection.ports;
    let (point, ball) = if is_point(a.module, a.port) { (a, b) } else { (b, a) };
    let step = before.module_type(point.module).roll_step_degrees.ok_or(Fault::Unable)?;

    // The connection's rotation in the ball's frame goes from one spot to the other by a turn about a line
    // through the ball's centre.
    let turn = to.rotation() * from.rotation().inverse();
    let (axis, angle) = turn.axis_angle().ok_or(Fault::NoSuchMotion)?;
    if !((angle.to_degrees() - step).abs() <= STEP_DEGREES) {
        return Err(Fault::NoSuchMotion);
    }
    let ball_body = before.module_type(ball.module).ports[ball.port].body;
    let frame = before.body_of(ball);
    let centre = frame * before.module_type(ball.module).bodies[ball_body].shape_pose;
    // A unit vector again: what rounding takes off a rotation would come back twice in every pose it makes.
    let in_world = Unit::new_normalize(frame.rotation * axis.into_inner());
    // Carrying the ball's side turns it the other way about the port.
    let signed = if side.module == point.module { angle } else { -angle };
    let motion = Motion::Rotation { centre: centre.translation.vector, axis: in_world, angle: signed };
    let own = before.module_type(side.module).ports[side.port].body;
    let held = |joined: &Joined| joined.without_connection(before, connection);
    carry(before, held, BodyOf { module: side.module, body: own }, motion, |_| {}, connection.modules())
}

fn rotate(before: &Linkage, module: usize, joint: usize, to: i32, carried: Half) -> Result<Transition, Fault> {
    if module >= before.modules.len() {
        return Err(Fault::UnknownModule);
    }
    let module_type = before.module_type(module);
    let kind = module_type.joints.get(joint).ok_or(Fault::UnknownModule)?;
    if !module_type.rotates {
        return Err(Fault::Unable);
    }
    if !kind.allows(to) {
        return Err(Fault::BeyondRange);
    }
    let from = before.modules[module].joints[joint];
    let step = [1, -1].into_iter().find(|step| kind.canonical(from.wrapping_add(*step)) == kind.canonical(to));
    let step = step.filter(|_| kind.canonical(to) == to).ok_or(Fault::NoSuchMotion)?;

    let body = match carried {
        Half::Parent => kind.parent,
        Half::Child => kind.child,
    };
    let parent = before.body_poses(module)[kind.parent];
    let angle = (f64::from(step) * kind.step_degrees).to_radians();
    let signed = match carried {
        Half::Parent => -angle,
        Half::Child => angle,
    };
    let axis = Unit::new_normalize(parent.rotation * kind.axis.into_inner());
    let origin: Vec3 = (parent * nalgebra::Point3::from(kind.origin)).coords;
    let motion = Motion::Rotation { centre: origin, axis, angle: signed };
    let held = |joined: &Joined| joined.without_joint(before, module, joint);
    carry(before, held, BodyOf { module, body }, motion, |after| after.modules[module].joints[joint] = to, [module; 2])
}

/// Turns what holds together with one body once a joint or connection is left out. The two modules (or the
/// one) that meet there must be on different sides.
fn carry(
    before: &Linkage,
    held: impl Fn(&Joined) -> UnionFind<usize>,
    body: BodyOf,
    motion: Motion,
    turn: impl Fn(&mut Linkage),
    meeting: [usize; 2],
) -> Result<Transition, Fault> {
    let joined = Joined::new(before);
    let sides = held(&joined);
    let whole = joined.whole(before);
    let here = joined.index(body);
    let moves = |body: BodyOf| sides.equiv(joined.index(body), here);
    // If leaving it out does not part what it joins, it is no bridge.
    let parted = joined
        .bodies
        .iter()
        .any(|&other| meeting.contains(&other.module) && whole.equiv(joined.index(other), here) && !moves(other));
    if !parted {
        return Err(Fault::NotABridge);
    }
    let carried: Vec<BodyOf> = joined.bodies.iter().copied().filter(|&body| moves(body)).collect();
    if carried.iter().any(|body| body.body == 0 && before.modules[body.module].fixed) {
        return Err(Fault::FixedModule);
    }
    if carried.iter().any(|body| before.require.stay.contains(&body.module)) {
        return Err(Fault::MustStay);
    }
    let mut after = before.clone();
    for body in carried.iter().filter(|body| body.body == 0) {
        after.modules[body.module].pose = motion.pose(&before.modules[body.module].pose, 1.0);
    }
    turn(&mut after);
    let Motion::Rotation { angle, .. } = motion else { unreachable!("a linkage turns") };
    let steps = (angle.abs().to_degrees() / CHECKED_DEGREES).ceil().max(1.0) as u32;
    Ok(Transition { after, path: Some(Path { carried, motion, steps }) })
}

/// Poses of all bodies at a phase of a way.
pub(super) fn poses_at(before: &Linkage, path: &Path, phase: f64) -> Vec<Vec<Pose>> {
    let mut poses: Vec<Vec<Pose>> = (0..before.modules.len()).map(|module| before.body_poses(module)).collect();
    let displacement = path.motion.at(phase);
    for body in &path.carried {
        let pose = &mut poses[body.module][body.body];
        *pose = displacement * *pose;
    }
    poses
}
