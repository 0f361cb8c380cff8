//! Connections in integers, and the poses that follow from them.
//!
//! A linkage is placed by where its anchors are, by the positions of its joints and by how its ports
//! engage: all but the first are integers. Poses derived from them do not depend on the way by which a state
//! was reached, so a plan that runs backwards returns the identical state, however long it is.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use crate::robot::module_type::{ModuleType, PortPlace};
use crate::spatial::{Pose, Vec3};

use super::engagement::orientations_between;
use super::spot::Spot;
use super::{Connection, Linkage, Port, mated};

/// How two ports engage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Code {
    /// Two ports at points: the second one's x axis is that of the first turned by this many of their
    /// angles of engagement, right-handed about the first one's outward axis.
    Docked {
        /// From 0 to one below the number of angles.
        roll: i32,
    },
    /// A port at a point with a surface.
    OnSurface(Spot),
}

impl Linkage {
    /// How the ports of a connection engage, measured where they are: the nearest code.
    pub fn code(&self, connection: &Connection) -> Code {
        let [first, second] = connection.ports;
        match (self.port_frame(first), self.port_frame(second)) {
            (Some(a), Some(b)) => {
                let x = a.rotation.inverse_transform_vector(&(b.rotation * Vec3::x()));
                let angles = self.orientations(connection);
                let steps = x.y.atan2(x.x) / TAU * f64::from(angles);
                Code::Docked { roll: (steps.round() as i32).rem_euclid(angles) }
            }
            (None, Some(point)) => self.measured(first, &point),
            (Some(point), None) => self.measured(second, &point),
            (None, None) => Code::OnSurface(Spot::new(0, 0, 0)),
        }
    }

    fn measured(&self, surface: Port, point: &Pose) -> Code {
        let ball = self.body_of(surface).rotation;
        Code::OnSurface(Spot::of(&(ball.inverse() * mated(point, 0.0).rotation)))
    }

    /// At how many angles the ports of a connection engage.
    pub fn orientations(&self, connection: &Connection) -> i32 {
        let [a, b] = connection.ports.map(|port| &self.module_type(port.module).ports[port.port].place);
        orientations_between(a, b) as i32
    }

    /// Poses of all modules that follow from these codes of the connections (in their order), with the
    /// joints where they are: the first fixed module of every connected component, or else its
    /// first module, stays where it is, the others follow breadth first over the connections.
    ///
    /// # Panics
    /// When there is not one code for every connection.
    pub fn placed_by(&self, codes: &[Code]) -> Vec<Pose> {
        assert_eq!(codes.len(), self.connections.len(), "one code for every connection");
        let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); self.modules.len()];
        for (index, connection) in self.connections.iter().enumerate() {
            for module in connection.modules() {
                neighbours[module].push(index);
            }
        }
        let local: Vec<Vec<Pose>> =
            (0..self.modules.len()).map(|m| self.module_type(m).body_poses(&self.modules[m].joints)).collect();
        let mut poses: Vec<Option<Pose>> = vec![None; self.modules.len()];
        let fixed = (0..self.modules.len()).filter(|&m| self.modules[m].fixed);
        for anchor in fixed.chain(0..self.modules.len()) {
            if poses[anchor].is_some() {
                continue;
            }
            poses[anchor] = Some(self.modules[anchor].pose);
            let mut queue = VecDeque::from([anchor]);
            while let Some(module) = queue.pop_front() {
                let from = poses[module].expect("a queued module has a pose");
                for &index in &neighbours[module] {
                    let [first, second] = self.connections[index].ports;
                    let (near, far, is_forward) =
                        if first.module == module { (first, second, true) } else { (second, first, false) };
                    if poses[far.module].is_some() {
                        continue;
                    }
                    let body = |port: Port| self.module_type(port.module).ports[port.port].body;
                    let across = self.across(&self.connections[index], codes[index]);
                    let across = if is_forward { across } else { across.inverse() };
                    let far_body = from * local[near.module][body(near)] * across;
                    poses[far.module] = Some(far_body * local[far.module][body(far)].inverse());
                    queue.push_back(far.module);
                }
            }
        }
        poses.into_iter().map(|pose| pose.expect("every module is in a component")).collect()
    }

    /// Pose of the body of a connection's second port in that of its first, engaged as the code says.
    pub fn across(&self, connection: &Connection, code: Code) -> Pose {
        let [first, second] = connection.ports.map(|port| (self.module_type(port.module), port.port));
        match code {
            Code::Docked { roll } => {
                let roll = TAU * f64::from(roll) / f64::from(self.orientations(connection));
                mated(&point(first), roll) * point(second).inverse()
            }
            Code::OnSurface(spot) if is_surface(first) => on_surface(first, spot) * point(second).inverse(),
            Code::OnSurface(spot) => (on_surface(second, spot) * point(first).inverse()).inverse(),
        }
    }
}

fn is_surface((module_type, port): (&ModuleType, usize)) -> bool {
    matches!(module_type.ports[port].place, PortPlace::Surface)
}

/// Frame of a port at a point in its body; that of the body for a surface.
fn point((module_type, port): (&ModuleType, usize)) -> Pose {
    match &module_type.ports[port].place {
        PortPlace::Point { frame, .. } => *frame,
        PortPlace::Surface => Pose::identity(),
    }
}

/// Frame, in the ball's body, of a port that sits on it: z inwards.
fn on_surface((module_type, port): (&ModuleType, usize), spot: Spot) -> Pose {
    let body = &module_type.bodies[module_type.ports[port].body];
    let centre = body.shape_pose.translation.vector;
    let radius = body.shape.ball_radius().unwrap_or(0.0);
    let outwards = Pose::from_parts((centre + spot.direction() * radius).into(), spot.rotation());
    mated(&outwards, 0.0)
}
