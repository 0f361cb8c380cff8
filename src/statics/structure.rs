//! What the oracle is asked about: rigid bodies held by connections and
//! contacts under loads. Plain data, built by hand in a few lines.
//!
//! A structure knows nothing of robots, shapes or plans. All positions and
//! directions are in one world frame W unless a field says otherwise.

use crate::spatial::{Pose, Vec3};

use super::connector::Connector;

/// One end of a connection or contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Anchor {
    /// The world: immovable, carries any wrench.
    World,
    /// The body with this index in [`Structure::bodies`].
    Body(usize),
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Mass in kg, not negative.
    pub mass: f64,
    /// Centre of mass in W, in m.
    pub com: Vec3,
    /// Whether the body is held immovably, so that it needs no balance.
    pub fixed: bool,
}

/// Two bodies held together by a connector.
#[derive(Clone, Debug, PartialEq)]
pub struct Connection {
    /// The side that the frame's z axis points away from.
    pub parent: Anchor,
    /// The side that the frame's z axis points towards; wrenches act on it.
    pub child: Anchor,
    /// Index into [`Structure::connectors`].
    pub connector: usize,
    /// Pose of the connection frame in W: origin at the connection point, z
    /// from the point towards the child.
    pub frame: Pose,
}

/// A frictional point contact without adhesion.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Index of the body that the normal points into.
    pub body: usize,
    /// What it touches.
    pub against: Anchor,
    /// Contact point in W, in m.
    pub position: Vec3,
    /// Unit normal in W, pointing **into** `body`.
    pub normal: Vec3,
    /// Coulomb friction coefficient, not negative.
    pub friction: f64,
}

/// An external wrench on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Index of the loaded body.
    pub body: usize,
    /// Force in N, in W.
    pub force: Vec3,
    /// Torque in N m, in W.
    pub torque: Vec3,
    /// Point of action in W, in m; the centre of mass when `None`.
    pub at: Option<Vec3>,
}

/// A structure: the oracle's input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Structure {
    /// Gravity in m/s^2, in W.
    pub gravity: Vec3,
    /// The rigid bodies.
    pub bodies: Vec<Body>,
    /// The connector models that connections refer to.
    pub connectors: Vec<Connector>,
    /// The connections.
    pub connections: Vec<Connection>,
    /// The contacts that are not connections.
    pub contacts: Vec<Contact>,
    /// The external loads, beside gravity.
    pub loads: Vec<Load>,
}
