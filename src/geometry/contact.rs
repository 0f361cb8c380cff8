//! Contact points of two solids that touch.

use crate::spatial::Vec3;

use super::figure::Figure;
use super::polygon::{Point2, clip, common_of_segments, convex_hull, crossing, depth_within, distance_to_segment};
use super::separation::{Separation, separations};
use super::solid::Solid;
use super::tolerances::SAME_NORMAL;

/// Where two solids touch: the corners of the touching area.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPatch {
    /// Unit normal in W, into the first solid.
    pub normal: Vec3,
    /// Corners of the contact area in W, in m: a convex polygon, the ends of a
    /// segment, or a point. Distinct, in order around the area.
    pub points: Vec<Vec3>,
}

/// Contact of two solids whose gap (or penetration) is at most `tolerance`, in m.
///
/// Face on face gives the corners of the common polygon, an edge on a face the
/// ends of the common segment, a vertex on a face and two crossing edges one
/// point. A ball touches in one point, the side of a cylinder in the ends of a segment or in one point. A
/// cylinder's cap counts as a regular polygon of 16 corners on its rim: an inner approximation,
/// which never claims more support than there is.
///
/// `None` when the solids are apart, when they penetrate deeper, and when
/// the normal is not unique: two solids that share only (part of) a parallel
/// edge, or meet in a corner, can carry no force that is sure.
pub fn contact(a: &Solid, b: &Solid, tolerance: f64) -> Option<ContactPatch> {
    let normal = touching_normal(a, b, tolerance)?;
    let plane = Plane::across(normal);
    let (a, b) = (Figure::new(a), Figure::new(b));
    let [own, theirs] = [plane.lowest(&a, tolerance), plane.highest(&b, tolerance)];
    let common = convex_hull(intersection(own.clone(), theirs.clone(), tolerance), tolerance);
    let middle = common.iter().sum::<Point2>() / common.len().max(1) as f64;
    if !is_only_normal([(&a, &own), (&b, &theirs)], &middle, tolerance) {
        return None;
    }
    let level = (b.reach(&normal) - a.reach(&-normal)) / 2.0;
    let points: Vec<_> = common.iter().map(|p| plane.at(p, level)).collect();
    (!points.is_empty()).then_some(ContactPatch { normal, points })
}

/// Whether figures that touch at `middle` with these features do so along one normal only. Of polytopes the
/// separating directions have said so; a cylinder's rim has many at every point.
fn is_only_normal(sides: [(&Figure, &[Point2]); 2], middle: &Point2, tolerance: f64) -> bool {
    let [(a, own), (b, theirs)] = sides;
    let is_polytopes = !a.is_round() && !b.is_round();
    if is_polytopes || a.ball().is_some() || b.ball().is_some() {
        return true;
    }
    let in_face = |feature: &[Point2]| feature.len() >= 3 && depth_within(middle, feature) > tolerance;
    let in_side = |(figure, feature): (&Figure, &[Point2])| {
        figure.is_round() && feature.len() == 2 && feature.iter().all(|end| (end - middle).norm() > tolerance)
    };
    let in_edge = |feature: &[Point2]| is_well_inside(middle, feature, tolerance);
    let on_rim = |(figure, feature): (&Figure, &[Point2])| figure.is_round() && feature.len() == 1;
    in_face(own)
        || in_face(theirs)
        || in_side(sides[0])
        || in_side(sides[1])
        || (on_rim(sides[0]) && (in_edge(theirs) || on_rim(sides[1])))
        || (on_rim(sides[1]) && in_edge(own))
}

/// Contact of a solid with a half-space: its corners within `tolerance` in m of the plane at `level` along
/// `normal` (unit, out of the half-space); `None` when it is above or deeper in.
pub(super) fn half_space_contact(solid: &Solid, normal: &Vec3, level: f64, tolerance: f64) -> Option<ContactPatch> {
    let figure = Figure::new(solid);
    let lowest = -figure.reach(&-normal);
    let touches = (lowest - level).abs() <= tolerance;
    if !touches {
        return None;
    }
    let plane = Plane::across(*normal);
    let near = figure.feature(&-normal, level + tolerance - lowest);
    let flat = convex_hull(near.iter().map(|p| plane.flat(p)).collect(), tolerance);
    Some(ContactPatch { normal: *normal, points: flat.iter().map(|p| plane.at(p, level)).collect() })
}

/// Whether a rim that crosses a segment at a point does so away from its ends: even where it runs almost along the
/// segment, it is beyond the tolerance there.
pub(super) fn is_well_inside(point: &Point2, segment: &[Point2], tolerance: f64) -> bool {
    let &[from, to] = segment else { return false };
    let room = (2.0 * tolerance * (to - from).norm()).sqrt();
    (from - point).norm() > room && (to - point).norm() > room
}

/// The one direction along which two solids touch; `None` when they do not, or
/// when there is more than one.
fn touching_normal(a: &Solid, b: &Solid, tolerance: f64) -> Option<Vec3> {
    let found = separations(a, b);
    if found.iter().any(|s| s.gap > tolerance) {
        return None;
    }
    let touching = || found.iter().filter(|s| s.gap >= -tolerance && s.is_exact);
    let first = touching().next()?.normal;
    if [a, b].iter().any(|solid| solid.is_round()) {
        // What is round has almost the same gap along directions close by; whether the
        // best is the only one is for the features to say.
        return touching().copied().reduce(wider).map(|s| s.normal);
    }
    touching().all(|s| first.cross(&s.normal).norm() <= SAME_NORMAL).then_some(first)
}

/// The separation with the larger gap, the first if equal.
pub(super) fn wider(a: Separation, b: Separation) -> Separation {
    if b.gap > a.gap { b } else { a }
}

/// Coordinates in the planes across a normal.
pub(super) struct Plane {
    normal: Vec3,
    axes: [Vec3; 2],
}

impl Plane {
    /// Coordinates across `normal` (unit), right-handed with it: along the world's axes where
    /// the normal is, so that lattice contacts keep exact numbers.
    pub fn across(normal: Vec3) -> Self {
        let across = Vec3::ith(normal.iamin(), 1.0);
        let u = (across - normal * normal.dot(&across)).normalize();
        Self { normal, axes: [u, normal.cross(&u)] }
    }

    /// A point without its height.
    pub fn flat(&self, p: &Vec3) -> Point2 {
        Point2::new(p.dot(&self.axes[0]), p.dot(&self.axes[1]))
    }

    /// The point at a height along the normal.
    pub fn at(&self, p: &Point2, level: f64) -> Vec3 {
        self.axes[0] * p.x + self.axes[1] * p.y + self.normal * level
    }

    /// The hull of the feature of `figure` that lies farthest against the normal.
    pub fn lowest(&self, figure: &Figure, tolerance: f64) -> Vec<Point2> {
        self.flattened(figure, -self.normal, tolerance)
    }

    /// The hull of the feature of `figure` that lies farthest along the normal.
    pub fn highest(&self, figure: &Figure, tolerance: f64) -> Vec<Point2> {
        self.flattened(figure, self.normal, tolerance)
    }

    fn flattened(&self, figure: &Figure, direction: Vec3, tolerance: f64) -> Vec<Point2> {
        let feature = figure.feature(&direction, tolerance);
        convex_hull(feature.iter().map(|p| self.flat(p)).collect(), tolerance)
    }
}

/// The common part of two convex figures in a plane: polygons, segments or points, corners in order.
pub(super) fn intersection(a: Vec<Point2>, b: Vec<Point2>, tolerance: f64) -> Vec<Point2> {
    match (&a[..], &b[..]) {
        (_, [_, _, _, ..]) => clip(a, &b, tolerance),
        ([_, _, _, ..], _) => clip(b, &a, tolerance),
        (&[a0, a1], &[b0, b1]) => match crossing([a0, a1], [b0, b1], tolerance) {
            Some(point) => vec![point],
            None => common_of_segments([a0, a1], [b0, b1], tolerance),
        },
        (&[p], &[from, to]) | (&[from, to], &[p]) => {
            if distance_to_segment(&p, from, to) <= tolerance {
                vec![p]
            } else {
                Vec::new()
            }
        }
        (&[p], &[q]) => {
            if (p - q).norm() <= tolerance {
                vec![p]
            } else {
                Vec::new()
            }
        }
        _ => Vec::new(),
    }
}
