//! The force along a line that helps most: that of a rod without any limit.
//!
//! A rod from the world to the point of action carries any force along the line and nothing
//! else, a `box` connector whose other components carry nothing. Its force is chosen with all
//! others where the utilisation is least, so one assessment answers.

use crate::spatial::{Pose, Rotation, Vec3};

use super::super::assess::assess;
use super::super::assessment::{Assessment, Question};
use super::super::connector::{Connector, Model};
use super::super::structure::{Anchor, Connection};
use super::line::Line;

/// The least utilisation over all forces along the line.
pub(super) fn least(line: &Line<'_>) -> Assessment {
    let mut held = line.structure.clone();
    let none = f64::INFINITY;
    let model = Model::Box { shear: [0.0; 2], tension: none, compression: none, bending: [0.0; 2], torsion: 0.0 };
    held.connectors.push(Connector { name: "rod".to_owned(), strength: 1.0, model });
    let along = Rotation::rotation_between(&Vec3::z(), &line.unit.force)
        .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    let at = line.unit.at.unwrap_or_else(Vec3::zeros);
    held.connections.push(Connection {
        parent: Anchor::World,
        child: Anchor::Body(line.unit.body),
        connector: held.connectors.len() - 1,
        frame: Pose::from_parts(at.into(), along),
    });
    assess(&held, Question::VALUE).expect("a sound structure with a sound rod")
}

/// The force of the rod in that answer, in N along the line's direction.
pub(super) fn force(answer: &Assessment) -> f64 {
    answer.connections.last().map_or(0.0, |rod| rod.wrench.force.z)
}
