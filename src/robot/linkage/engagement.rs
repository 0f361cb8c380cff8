//! Which ports meet, and the frame in which they hold each other.

use crate::robot::catalogue::Catalogue;
use crate::robot::module_type::{ModuleType, PortPlace};
use crate::spatial::{Pose, Vec3};
use crate::statics::Model;

use super::{Connection, Linkage, Port, mated};

/// Distance relative to the size of the modules, and sine of the angle, up to which ports
/// meet: decimal input of six digits behind the point, and far above the rounding of poses.
pub const MEETING: f64 = 5e-5;

/// How two ports hold each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Index into [`Catalogue::connectors`]: of two ports with connectors the weaker one.
    pub connector: usize,
    /// Frame of the connection in W: z from the first port's body to the second's, x that of the
    /// first port at a point.
    pub frame: Pose,
}

/// A port in space.
struct Placed {
    port: Port,
    /// Where it is; of a surface its centre.
    centre: Vec3,
    place: Where,
}

enum Where {
    Point { frame: Pose, orientations: u32 },
    Surface { radius: f64 },
}

impl Catalogue {
    /// The connector with which two ports hold each other, as an index into
    /// [`Catalogue::connectors`]: of two the one of smaller strength (the first if equal), of a
    /// connector and a port without one the connector. `None` where they do not fit: two
    /// surfaces, two points of which one has no connector or no angle to engage at, connectors of different models.
    pub fn connector_between(&self, first: [usize; 2], second: [usize; 2]) -> Option<usize> {
        let [a, b] = [first, second].map(|[module_type, port]| &self.module_types[module_type].ports[port]);
        let is_point = |place: &PortPlace| matches!(place, PortPlace::Point { .. });
        match (is_point(&a.place), is_point(&b.place)) {
            (true, false) => a.connector,
            (false, true) => b.connector,
            (false, false) => None,
            (true, true) => {
                if orientations_between(&a.place, &b.place) == 0 {
                    return None;
                }
                let (a, b) = (a.connector?, b.connector?);
                let (ca, cb) = (&self.connectors[a], &self.connectors[b]);
                let same_model = matches!(
                    (&ca.model, &cb.model),
                    (Model::Cone { .. }, Model::Cone { .. })
                        | (Model::Box { .. }, Model::Box { .. })
                        | (Model::Patch { .. }, Model::Patch { .. })
                );
                same_model.then_some(if cb.strength < ca.strength { b } else { a })
            }
        }
    }
}

impl ModuleType {
    /// Largest distance in m of a port or a shape's centre from the module's origin, with all
    /// joints at zero, or the radius of its ball: what tolerances are relative to.
    pub fn size(&self) -> f64 {
        let ports = self.ports.iter().map(|port| match &port.place {
            PortPlace::Point { frame, .. } => frame.translation.vector.norm(),
            PortPlace::Surface => self.bodies[port.body].shape.ball_radius().unwrap_or(0.0),
        });
        let bodies = self.bodies.iter().map(|body| body.shape_pose.translation.vector.norm());
        ports.chain(bodies).fold(0.0, f64::max)
    }
}

impl Linkage {
    /// How the ports of a connection hold each other, where they are; `None` where they do not
    /// meet or do not fit.
    pub fn engagement(&self, connection: &Connection) -> Option<Engagement> {
        let [a, b] = connection.ports.map(|port| self.placed(port));
        self.meeting(&a, &b)
    }

    /// Every connection that could be engaged where the modules are, sorted.
    pub fn touching(&self) -> Vec<Connection> {
        let mut placed: Vec<Placed> = Vec::new();
        for module in 0..self.modules.len() {
            let poses = self.body_poses(module);
            let ports = self.module_type(module).ports.iter().enumerate();
            placed.extend(ports.map(|(port, kind)| self.place(Port { module, port }, &poses[kind.body])));
        }
        placed.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x).then(a.port.cmp(&b.port)));
        let reach = |placed: &Placed| match placed.place {
            Where::Point { .. } => 0.0,
            Where::Surface { radius } => radius,
        };
        let widest = placed.iter().map(reach).fold(0.0, f64::max);
        let slack = MEETING * self.size();
        let mut connections = Vec::new();
        for (i, first) in placed.iter().enumerate() {
            let near = |other: &&Placed| other.centre.x - first.centre.x <= reach(first).max(widest) + slack;
            for second in placed[i + 1..].iter().take_while(near) {
                if first.port.module != second.port.module && self.meeting(first, second).is_some() {
                    connections.push(Connection::new(first.port, second.port));
                }
            }
        }
        connections.sort_unstable();
        connections
    }

    /// The largest size of a module.
    fn size(&self) -> f64 {
        (0..self.modules.len()).map(|module| self.module_type(module).size()).fold(0.0, f64::max)
    }

    fn placed(&self, port: Port) -> Placed {
        self.place(port, &self.body_of(port))
    }

    fn place(&self, port: Port, body_pose: &Pose) -> Placed {
        let module_type = self.module_type(port.module);
        let kind = &module_type.ports[port.port];
        match &kind.place {
            PortPlace::Point { frame, orientations } => {
                let frame = body_pose * frame;
                let place = Where::Point { frame, orientations: *orientations };
                Placed { port, centre: frame.translation.vector, place }
            }
            PortPlace::Surface => {
                let body = &module_type.bodies[kind.body];
                let centre = (body_pose * body.shape_pose).translation.vector;
                Placed { port, centre, place: Where::Surface { radius: body.shape.ball_radius().unwrap_or(0.0) } }
            }
        }
    }

    /// The engagement of two placed ports, the one that comes first by [`Connection::new`] as
    /// the parent.
    fn meeting(&self, a: &Placed, b: &Placed) -> Option<Engagement> {
        let (parent, child) = if a.port <= b.port { (a, b) } else { (b, a) };
        let kind = |placed: &Placed| [self.modules[placed.port.module].module_type, placed.port.port];
        let connector = self.catalogue.connector_between(kind(parent), kind(child))?;
        let sizes = [a, b].map(|placed| self.module_type(placed.port.module).size());
        let tolerance = MEETING * sizes[0].max(sizes[1]);
        let frame = match (&parent.place, &child.place) {
            (Where::Point { frame, orientations: m }, Where::Point { frame: other, orientations: n }) => {
                (docked(frame, other, tolerance) && at_an_angle(frame, other, common(*m, *n))).then_some(*frame)
            }
            (Where::Point { frame, .. }, Where::Surface { radius }) => {
                lies_on(frame, &child.centre, *radius, tolerance).then_some(*frame)
            }
            (Where::Surface { radius }, Where::Point { frame, .. }) => {
                lies_on(frame, &parent.centre, *radius, tolerance).then(|| mated(frame, 0.0))
            }
            (Where::Surface { .. }, Where::Surface { .. }) => None,
        }?;
        Some(Engagement { connector, frame })
    }
}

/// Whether two ports at points lie on each other and look at each other.
fn docked(a: &Pose, b: &Pose, tolerance: f64) -> bool {
    let apart = (a.translation.vector - b.translation.vector).norm();
    let [za, zb] = [a, b].map(|frame| frame.rotation * Vec3::z());
    apart <= tolerance && za.dot(&zb) < 0.0 && za.cross(&zb).norm() <= MEETING
}

/// At how many angles, equally spaced over a turn, two ports engage: those at which both do, none where one of them
/// engages with surfaces only. 1 with a surface, which has no angle.
pub fn orientations_between(a: &PortPlace, b: &PortPlace) -> u32 {
    match (a, b) {
        (PortPlace::Point { orientations: m, .. }, PortPlace::Point { orientations: n, .. }) if m.min(n) > &0 => {
            common(*m, *n)
        }
        (PortPlace::Point { .. }, PortPlace::Point { .. }) => 0,
        _ => 1,
    }
}

/// The greatest common divisor.
fn common(m: u32, n: u32) -> u32 {
    if n == 0 { m } else { common(n, m % n) }
}

/// Frame in W of the connection of two ports, each of a module type and on a body with this pose in W: z from the
/// first one's body to the second's, x that of the port at a point (of two the first one's). `None` for two
/// surfaces. Whether they meet is not asked.
pub fn frame_between([first, second]: [(&ModuleType, usize, Pose); 2]) -> Option<Pose> {
    let place = |(module_type, port, _): &(&ModuleType, usize, Pose)| match &module_type.ports[*port].place {
        PortPlace::Point { frame, .. } => Some(*frame),
        PortPlace::Surface => None,
    };
    match (place(&first), place(&second)) {
        (Some(frame), _) => Some(first.2 * frame),
        (None, Some(frame)) => Some(mated(&(second.2 * frame), 0.0)),
        (None, None) => None,
    }
}

/// Whether two ports that look at each other are turned by a multiple of a turn over `orientations`.
fn at_an_angle(a: &Pose, b: &Pose, orientations: u32) -> bool {
    let x = a.rotation.inverse_transform_vector(&(b.rotation * Vec3::x()));
    let steps = x.y.atan2(x.x) / std::f64::consts::TAU * f64::from(orientations);
    (steps - steps.round()).abs() <= MEETING * f64::from(orientations)
}

/// Whether a port at a point lies on a ball and looks at its centre.
fn lies_on(frame: &Pose, centre: &Vec3, radius: f64, tolerance: f64) -> bool {
    let inwards = centre - frame.translation.vector;
    let z = frame.rotation * Vec3::z();
    (inwards.norm() - radius).abs() <= tolerance
        && z.dot(&inwards) > 0.0
        && z.cross(&inwards).norm() <= MEETING * inwards.norm()
}
