//! Convex figures in W: what separations, contacts and sweeps know of a solid
//! or a triangle.

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::contact_support_map_support_map;
use parry3d_f64::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;
use smallvec::SmallVec;

use crate::robot::Shape;
use crate::spatial::{Point, Pose, Vec3};

use super::curve::{Curve, Curves};
use super::solid::Solid;

/// Corners of the polygon that stands for the rim of a cylinder's cap where that is a
/// contact area. Inscribed, so that it claims no support that is not there: of a cap's lever
/// against tipping it keeps `cos(pi/16)`, 98.1 %.
const CAP_CORNERS: usize = 16;

/// A convex figure: the hull of some points, a ball around one, or a cylinder around the
/// segment between two.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    /// Corners; a ball's centre; the ends of a cylinder's axis. In m.
    points: SmallVec<[Vec3; 8]>,
    round: Option<Round>,
    /// Normals of its flat faces, of parallel ones one.
    normals: SmallVec<[Vec3; 4]>,
    /// Directions of its straight edges.
    edges: SmallVec<[Vec3; 4]>,
}

/// What is not a polytope.
#[derive(Clone, Copy, Debug)]
enum Round {
    Ball {
        radius: f64,
    },
    Cylinder {
        /// Unit vector from the first end to the second.
        axis: Vec3,
        /// Unit vector across the axis that turns with the body.
        across: Vec3,
        radius: f64,
    },
}

impl Figure {
    /// The figure of a solid.
    pub fn new(solid: &Solid) -> Self {
        let rotation = solid.pose.rotation.to_rotation_matrix().into_inner();
        let column = |i: usize| rotation.column(i).into_owned();
        match &solid.shape {
            Shape::Cuboid { .. } => {
                let axes: SmallVec<[Vec3; 4]> = (0..3).map(column).collect();
                Self { points: solid.vertices().into_iter().collect(), round: None, normals: axes.clone(), edges: axes }
            }
            Shape::Cylinder { radius, height } => {
                let (axis, centre) = (column(2), solid.pose.translation.vector);
                let reach = axis * (height / 2.0);
                Self {
                    points: [centre - reach, centre + reach].into_iter().collect(),
                    round: Some(Round::Cylinder { axis, across: column(0), radius: *radius }),
                    normals: std::iter::once(axis).collect(),
                    edges: std::iter::once(axis).collect(),
                }
            }
            Shape::Ball { radius } => Self {
                points: std::iter::once(solid.pose.translation.vector).collect(),
                round: Some(Round::Ball { radius: *radius }),
                normals: SmallVec::new(),
                edges: SmallVec::new(),
            },
            Shape::Convex(hull) => Self {
                points: hull.corners().iter().map(|p| (solid.pose * Point::from(*p)).coords).collect(),
                round: None,
                normals: one_of_parallel(hull.faces().iter().map(|face| rotation * face.normal)),
                edges: hull.edges().iter().map(|edge| rotation * edge).collect(),
            },
        }
    }

    /// A triangle with this unit normal.
    pub fn triangle(corners: [Vec3; 3], normal: Vec3) -> Self {
        let [a, b, c] = corners;
        Self {
            points: corners.into_iter().collect(),
            round: None,
            normals: std::iter::once(normal).collect(),
            edges: [b - a, c - b, a - c].map(|edge| edge.normalize()).into_iter().collect(),
        }
    }

    /// The figure displaced.
    pub fn moved(&self, by: &Pose) -> Self {
        let turned = |v: &Vec3| by.rotation * v;
        let round = self.round.map(|round| match round {
            Round::Ball { radius } => Round::Ball { radius },
            Round::Cylinder { axis, across, radius } => {
                Round::Cylinder { axis: turned(&axis), across: turned(&across), radius }
            }
        });
        Self {
            points: self.points.iter().map(|p| (by * Point::from(*p)).coords).collect(),
            round,
            normals: self.normals.iter().map(turned).collect(),
            edges: self.edges.iter().map(turned).collect(),
        }
    }

    /// The centre and radius of a ball.
    pub fn ball(&self) -> Option<(Vec3, f64)> {
        match self.round {
            Some(Round::Ball { radius }) => Some((self.points[0], radius)),
            Some(Round::Cylinder { .. }) | None => None,
        }
    }

    /// Whether it is bounded by more than planes.
    pub fn is_round(&self) -> bool {
        self.round.is_some()
    }

    /// Normals of its flat faces, of parallel ones one.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Directions of its straight edges.
    pub fn edges(&self) -> &[Vec3] {
        &self.edges
    }

    /// A point of it that is farthest along `direction` (unit).
    fn farthest(&self, direction: &Vec3) -> Vec3 {
        let mut farthest = self.points[0];
        for p in &self.points[1..] {
            if p.dot(direction) > farthest.dot(direction) {
                farthest = *p;
            }
        }
        match self.round {
            None => farthest,
            Some(Round::Ball { radius }) => farthest + direction * radius,
            Some(Round::Cylinder { axis, radius, .. }) => farthest + radial(&axis, direction) * radius,
        }
    }

    /// How far it reaches along `direction` (unit) from the origin, in m.
    pub fn reach(&self, direction: &Vec3) -> f64 {
        let along = self.points.iter().map(|p| p.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
        along
            + match self.round {
                None => 0.0,
                Some(Round::Ball { radius }) => radius,
                Some(Round::Cylinder { axis, radius, .. }) => radius * axis.cross(direction).norm(),
            }
    }

    /// The corners of what lies within `slack` in m of its farthest point along `direction`
    /// (unit): of a polygon, a segment or a point, in no particular order.
    pub fn feature(&self, direction: &Vec3, slack: f64) -> Vec<Vec3> {
        match self.round {
            None => {
                let least = self.reach(direction) - slack;
                self.points.iter().copied().filter(|p| p.dot(direction) >= least).collect()
            }
            Some(Round::Ball { radius }) => vec![self.points[0] + direction * radius],
            Some(Round::Cylinder { axis, across, radius }) => {
                let (along, sideways) = (axis.dot(direction), axis.cross(direction).norm());
                let end = self.points[usize::from(along > 0.0)];
                // Twice the radius, the height: how far the other side of the feature falls back.
                if 2.0 * radius * sideways <= slack {
                    let beside = axis.cross(&across);
                    let corner = |i: usize| {
                        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CAP_CORNERS as f64).sin_cos();
                        end + (across * cos + beside * sin) * radius
                    };
                    return (0..CAP_CORNERS).map(corner).collect();
                }
                let out = radial(&axis, direction) * radius;
                if (self.points[1] - self.points[0]).dot(direction).abs() <= slack {
                    return self.points.iter().map(|p| p + out).collect();
                }
                vec![end + out]
            }
        }
    }

    /// Points whose hull moves as the figure does: its corners, a ball's centre; of a cylinder the
    /// corners of an inscribed prism whose sides are nowhere deeper than `sagitta` in m below its surface.
    pub fn guides(&self, sagitta: f64) -> Vec<Vec3> {
        let Some(Round::Cylinder { axis, across, radius }) = self.round else { return self.points.to_vec() };
        let half_angle = (1.0 - (sagitta / radius).min(0.5)).acos();
        let sides = (std::f64::consts::PI / half_angle).ceil();
        let beside = axis.cross(&across);
        let around = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / sides).sin_cos();
            (across * cos + beside * sin) * radius
        };
        // At least three: the sagitta is at most half of the radius.
        let offsets = (0..sides as usize).map(around);
        offsets.flat_map(|offset| self.points.iter().map(move |p| p + offset)).collect()
    }

    /// The same with what is round taken off: a ball's centre, a cylinder smaller by `skin` in m all round.
    fn core(&self, skin: f64) -> Self {
        let mut core = self.clone();
        match &mut core.round {
            None => {}
            Some(Round::Ball { radius }) => *radius = 0.0,
            Some(Round::Cylinder { axis, radius, .. }) => {
                let shorter = *axis * skin.min((core.points[1] - core.points[0]).norm() / 2.0);
                core.points[0] += shorter;
                core.points[1] -= shorter;
                *radius = (*radius - skin).max(0.0);
            }
        }
        core
    }

    /// Unit vector of the shortest way from `other` to this figure, or out of it where they overlap, and a point
    /// near where it starts: found by iteration, so close to the best direction rather than exactly that. Figures that are round
    /// are made smaller for it by `skin` in m, as touching ones have no shortest way.
    pub fn towards_from(&self, other: &Self, skin: f64) -> Option<(Vec3, Vec3)> {
        // The distance from a ball's centre is its radius already.
        let bare = if self.ball().is_some() || other.ball().is_some() { 0.0 } else { skin };
        let [a, b] = [self, other].map(|figure| figure.core(bare));
        let origin = (a.points[0] + b.points[0]) / 2.0;
        let [a, b] = [a, b].map(|figure| Map { figure, origin });
        let here = ParryPose::IDENTITY;
        let mut simplex = VoronoiSimplex::new();
        let between = b.figure.points[0] - a.figure.points[0];
        let first = between.try_normalize(0.0).unwrap_or_else(Vec3::x);
        simplex.reset(CsoPoint::from_shapes(&here, &a, &b, parry(first)));
        let (way, near) = match gjk::closest_points(&here, &a, &b, f64::MAX, true, &mut simplex) {
            GJKResult::ClosestPoints(on_a, on_b, _) => (ours(on_a - on_b), ours(on_a)),
            GJKResult::Intersection => {
                let contact = contact_support_map_support_map(&here, &a, &b, f64::MAX)?;
                (-ours(contact.normal1), ours(contact.point1))
            }
            GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => return None,
        };
        let way = way.try_normalize(0.0).filter(|way| way.iter().all(|c| c.is_finite()))?;
        Some((way, near + origin))
    }

    /// The corner, the edge, the rim or the axis of the curved side that lie within `slack` in m of the farthest point along
    /// `direction` (unit), where it is one of these.
    pub fn curves(&self, direction: &Vec3, slack: f64) -> Curves {
        match self.round {
            None => match self.feature(direction, slack)[..] {
                [corner] => std::iter::once(Curve::Corner(corner)).collect(),
                [from, to] => std::iter::once(Curve::Edge { at: from, along: (to - from).normalize() }).collect(),
                _ => Curves::new(),
            },
            Some(Round::Ball { .. }) => Curves::new(),
            Some(Round::Cylinder { axis, radius, .. }) => {
                let end = self.points[usize::from(axis.dot(direction) > 0.0)];
                let mut curves: Curves = std::iter::once(Curve::Rim { centre: end, axis, radius }).collect();
                if (self.points[1] - self.points[0]).dot(direction).abs() <= slack {
                    curves.push(Curve::Axis { at: end, along: axis });
                }
                curves
            }
        }
    }
}

/// The part of `direction` across `axis` (unit), unit length; zero along the axis.
fn radial(axis: &Vec3, direction: &Vec3) -> Vec3 {
    (direction - axis * axis.dot(direction)).try_normalize(1e-12).unwrap_or_else(Vec3::zeros)
}

fn one_of_parallel(normals: impl Iterator<Item = Vec3>) -> SmallVec<[Vec3; 4]> {
    let mut kept: SmallVec<[Vec3; 4]> = SmallVec::new();
    for normal in normals {
        if !kept.iter().any(|known| (known + normal).amax() <= 1e-12) {
            kept.push(normal);
        }
    }
    kept
}

/// A figure as parry's iterations see it, around an origin of its own.
struct Map {
    figure: Figure,
    origin: Vec3,
}

impl SupportMap for Map {
    fn local_support_point(&self, direction: ParryVector) -> ParryVector {
        let direction = ours(direction).try_normalize(0.0).unwrap_or_else(Vec3::x);
        parry(self.figure.farthest(&direction) - self.origin)
    }
}

fn parry(v: Vec3) -> ParryVector {
    [v.x, v.y, v.z].into()
}

fn ours(v: ParryVector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}
