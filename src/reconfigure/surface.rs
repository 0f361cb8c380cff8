//! How the faces of two module types meet: held together, or only touching.
//!
//! Attaching must never lose: whatever two faces carry by touching they must
//! carry when they are connected. A `box` connector stands beside the contact of
//! the faces; a `patch` and a `cone` contain it, so that a touching pair carries
//! what its connector would carry without preload, or less.

use crate::robot::Catalogue;
use crate::spatial::Vec3;
use crate::statics::{Connector, Model};

/// Portions of a cone's unit norm given to friction, and to the lever of the
/// contact points, of two faces that touch unconnected (squares; their sum is 1
/// but for rounding).
const FRICTION_PORTION: f64 = 0.25;
const LEVER_PORTION: f64 = 0.75 - 1e-9;

/// How the faces of two module types meet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Surface {
    /// The connector that holds them together, as an index into the
    /// catalogue's; `None` when their connectors do not fit.
    pub connector: Option<usize>,
    /// Whether a connection contains the contact of the two faces.
    pub contained: bool,
    /// Friction coefficient of the unconnected faces.
    pub friction: f64,
    /// Contact points of two whole faces in m; their corners when `None`.
    points: Option<Vec<[f64; 2]>>,
    /// Factor by which contact points are drawn in towards their centre.
    lever: f64,
}

impl Surface {
    /// How modules of two types meet. `friction` is that of faces whose
    /// connector says nothing about it.
    pub fn between(catalogue: &Catalogue, first: usize, second: usize, friction: f64) -> Self {
        let half = catalogue.module_types[first].cell().pitch / 2.0;
        let connector = catalogue.face_connector(first, second);
        let bare = Self { connector, contained: false, friction, points: None, lever: 1.0 };
        match connector.map(|c| &catalogue.connectors[c].model) {
            None | Some(Model::Box { .. }) => bare,
            Some(Model::Patch { friction, points }) => {
                let given = (!points.is_empty()).then(|| points.clone());
                let reach = points.iter().flatten().fold(0.0, |reach: f64, x| reach.max(x.abs()));
                let lever = if given.is_some() { (reach / half).min(1.0) } else { 1.0 };
                Self { contained: true, friction: *friction, points: given, lever, ..bare }
            }
            Some(Model::Cone { friction: [mu_x, mu_y], radius }) => {
                let friction = friction.min(FRICTION_PORTION.sqrt() * mu_x.min(*mu_y));
                // |torque / radius|^2 of a unit normal force at a corner of the face.
                let twist = friction * friction * 2.0 * half * half / (radius[2] * radius[2]);
                let demand = (half / radius[0]).powi(2) + (half / radius[1]).powi(2) + twist;
                let lever = (LEVER_PORTION / demand).sqrt().min(1.0);
                Self { contained: true, friction, lever, ..bare }
            }
        }
    }

    /// Contact points of two whole faces, in the connection frame.
    pub fn face_points(&self, pitch: f64) -> Vec<[f64; 2]> {
        self.points.clone().unwrap_or_else(|| square(self.lever * pitch / 2.0))
    }

    /// Draws the corners of a contact area in, by as much as whole faces' are.
    pub fn shrink(&self, points: &mut [Vec3]) {
        if self.lever < 1.0 {
            let centre = points.iter().sum::<Vec3>() / points.len() as f64;
            for point in points {
                *point = centre + (*point - centre) * self.lever;
            }
        }
    }
}

/// A connector as it is on a whole face: a patch without points takes the corners.
pub(super) fn full_face(connector: &Connector, pitch: f64) -> Connector {
    let mut full = connector.clone();
    if let Model::Patch { points, .. } = &mut full.model
        && points.is_empty()
    {
        *points = square(pitch / 2.0);
    }
    full
}

/// A connector on the part of a face that is `extent` of its edges along x and
/// y: its strength and limits go with the area, its points and radii with
/// the lengths.
pub(super) fn scaled(connector: &Connector, extent: [f64; 2]) -> Connector {
    let [ex, ey] = extent;
    let share = ex * ey;
    let model = match &connector.model {
        // A moment about x is carried by a lever along y. Twist is carried at
        // all distances: radius of gyration of the rectangle.
        Model::Cone { friction, radius: [x, y, z] } => {
            let gyration = ((ex * ex + ey * ey) / 2.0).sqrt();
            Model::Cone { friction: *friction, radius: [x * ey, y * ex, z * gyration] }
        }
        Model::Box { shear, tension, compression, bending, torsion } => Model::Box {
            shear: shear.map(|s| s * share),
            tension: tension * share,
            compression: compression * share,
            bending: bending.map(|b| b * share),
            torsion: torsion * share,
        },
        Model::Patch { friction, points } => {
            Model::Patch { friction: *friction, points: points.iter().map(|[x, y]| [x * ex, y * ey]).collect() }
        }
    };
    Connector { name: connector.name.clone(), strength: connector.strength * share, model }
}

/// Corners of a square about the origin.
fn square(half: f64) -> Vec<[f64; 2]> {
    vec![[half, half], [-half, half], [-half, -half], [half, -half]]
}
