//! What is to be reached: an arrangement, and the connections of it that are engaged in the end.
//!
//! Knows arrangements; asks no oracle.

use crate::robot::PortPlace;
use crate::robot::linkage::{Connection, MEETING, Port};
use crate::spatial::{Point, Pose, Vec3};

use super::arrangement::{Arrangement, Arrangements, Framed};
use super::moves::View;
use super::places::PlaceId;
use super::problem::Problem;

/// The goal of a problem.
#[derive(Clone, Debug)]
pub struct GoalTest {
    /// Where the modules are.
    pub arrangement: Arrangement,
    bonds: Vec<Bond>,
    /// Distance up to which connections are at one place, in m.
    tolerance: f64,
}

/// A connection by the places of its modules and its own, whatever modules and ports are called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    places: [PlaceId; 2],
    at: Vec3,
}

impl GoalTest {
    /// The goal of a problem.
    pub fn new(problem: &Problem, arrangements: &Arrangements) -> Self {
        let described = problem.wanted();
        let framed = arrangements.of(&described);
        let view = problem.view(&described, problem.goal.connections.clone());
        let size = problem.classes.iter().map(|class| class.kind.size()).fold(0.0, f64::max);
        // Both ends of a connection may be off by as much as ports that meet, and so may the places.
        let tolerance = 4.0 * MEETING * size;
        let bonds = bonds(&view, &framed);
        Self { arrangement: framed.arrangement, bonds, tolerance }
    }

    /// The connections of the goal in a robot that is arranged like it; `None` if one is not there.
    pub fn connections(&self, view: &View, framed: &Framed) -> Option<Vec<Connection>> {
        let here = bonds(view, framed);
        let find = |wanted: &Bond| {
            here.iter().position(|bond| bond.is_at(wanted, self.tolerance)).map(|index| view.connections[index])
        };
        let mut found: Vec<Connection> = self.bonds.iter().map(find).collect::<Option<_>>()?;
        found.sort_unstable();
        Some(found)
    }
}

impl Bond {
    /// Whether it is at the place of another one, up to a distance in m.
    pub fn is_at(&self, other: &Self, tolerance: f64) -> bool {
        self.places == other.places && (self.at - other.at).norm() <= tolerance
    }
}

/// The connections of a robot by where they are in the frame of its arrangement, in their order.
pub fn bonds(view: &View, framed: &Framed) -> Vec<Bond> {
    let back = framed.frame.inverse();
    let bond = |connection: &Connection| {
        let mut places = connection.modules().map(|module| framed.of_module[module]);
        places.sort_unstable();
        let at = connection.ports.into_iter().find_map(|port| point(view, port));
        Bond { places, at: (back * Point::from(at.expect("two surfaces do not connect"))).coords }
    };
    view.connections.iter().map(bond).collect()
}

/// Where a port at a point is.
fn point(view: &View, port: Port) -> Option<Vec3> {
    let body: &Pose = &view.modules[port.module].bodies[view.body_of(port)];
    match &view.kind(port.module).ports[port.port].place {
        PortPlace::Point { frame, .. } => Some((body * frame).translation.vector),
        PortPlace::Surface => None,
    }
}
