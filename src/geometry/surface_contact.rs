//! Contacts of a solid with a surface of triangles.
//!
//! Every triangle near the solid is a convex figure that may touch it along several directions. A direction
//! counts where it is the only one: where the solid touches a flat part of the surface, the
//! surface a flat part of the solid, or two edges cross. What is found so is put together plane by
//! plane: forces in one plane with one normal and one friction have the same wrenches as forces at
//! the corners of their hull, so that nothing is lost, and a floor of many triangles carries
//! exactly as one face does.

use crate::spatial::Vec3;

use super::contact::{ContactPatch, Plane, intersection, is_well_inside, wider};
use super::figure::Figure;
use super::polygon::{Point2, convex_hull, depth_within, distance_to_segment};
use super::separation::{Separation, Separations, of_figures};
use super::solid::Solid;
use super::surface::{Surface, Triangle};
use super::tolerances::{SAME_NORMAL, SKIN};

/// What touches in one plane.
struct Group {
    normal: Vec3,
    /// Height of the plane along the normal, in m.
    level: f64,
    points: Vec<Vec3>,
}

impl Surface {
    /// Where a solid touches the surface with a gap (or penetration) of at most `tolerance` in m:
    /// a patch for each plane, in the order of the triangles.
    pub fn contacts(&self, solid: &Solid, tolerance: f64) -> Vec<ContactPatch> {
        let (low, high) = solid.bounds();
        let near: Vec<&Triangle> =
            self.near(&low, &high, tolerance).into_iter().map(|index| &self.triangles[index]).collect();
        let touching = Touching {
            figure: Figure::new(solid),
            near: &near,
            is_closed: self.is_closed,
            skin: SKIN * solid.size(),
            tolerance,
        };
        let mut groups: Vec<Group> = Vec::new();
        for triangle in &near {
            touching.add(triangle, &mut groups);
        }
        let patch = |group: Group| {
            let plane = Plane::across(group.normal);
            let hull = convex_hull(group.points.iter().map(|p| plane.flat(p)).collect(), tolerance);
            let points = hull.iter().map(|p| plane.at(p, group.level)).collect();
            ContactPatch { normal: group.normal, points }
        };
        groups.into_iter().map(patch).collect()
    }
}

/// A solid and the triangles near it.
struct Touching<'a> {
    figure: Figure,
    near: &'a [&'a Triangle],
    is_closed: bool,
    skin: f64,
    tolerance: f64,
}

impl Touching<'_> {
    /// Adds what touches a triangle.
    fn add(&self, triangle: &Triangle, groups: &mut Vec<Group>) {
        let figure = triangle.figure();
        let found = of_figures(&self.figure, &figure, self.skin);
        if found.iter().any(|s| s.gap > self.tolerance) {
            return;
        }
        for separation in self.candidates(&found) {
            let normal = separation.normal;
            let front = normal.dot(&triangle.normal);
            if self.is_closed && front < -SAME_NORMAL {
                continue; // from within
            }
            let plane = Plane::across(normal);
            let own = plane.lowest(&self.figure, self.tolerance);
            let theirs = plane.highest(&figure, self.tolerance);
            let common = convex_hull(intersection(own.clone(), theirs.clone(), self.tolerance), self.tolerance);
            if common.is_empty() {
                continue;
            }
            let level = (figure.reach(&normal) - self.figure.reach(&-normal)) / 2.0;
            let middle = common.iter().sum::<Point2>() / common.len() as f64;
            let is_sure = if (front.abs() - 1.0).abs() <= SAME_NORMAL * SAME_NORMAL {
                // The middle of an area is inside the triangle.
                common.len() >= 3 || self.is_within_plane(&plane.at(&middle, level), &normal, &plane)
            } else {
                self.is_within_feature(&middle, &own)
                    || is_across_ridge(triangle, &plane, &middle, &own, &theirs, front >= 0.0, self)
            };
            if is_sure {
                let points = common.iter().map(|p| plane.at(p, level));
                self.put(groups, normal, level, points);
            }
        }
    }

    /// The directions along which the figures touch, each once.
    fn candidates(&self, found: &Separations) -> Vec<Separation> {
        let touching = found.iter().copied().filter(|s| s.gap >= -self.tolerance && s.is_exact);
        if self.figure.is_round() {
            return touching.reduce(wider).into_iter().collect();
        }
        let mut distinct: Vec<Separation> = Vec::new();
        for separation in touching {
            if !distinct.iter().any(|known| (known.normal - separation.normal).norm() <= SAME_NORMAL) {
                distinct.push(separation);
            }
        }
        distinct
    }

    /// Whether the surface around a point is no lower than the plane through it: the point is inside the
    /// triangles of the plane, or on an edge from which the surface rises.
    fn is_within_plane(&self, point: &Vec3, normal: &Vec3, plane: &Plane) -> bool {
        let level = normal.dot(point);
        let flat = plane.flat(point);
        let mut angle = 0.0;
        let (mut rises, mut falls) = (false, false);
        for triangle in self.near {
            let heights = triangle.corners.map(|p| normal.dot(&p) - level);
            let (low, high) = (
                heights.into_iter().fold(f64::INFINITY, f64::min),
                heights.into_iter().fold(f64::NEG_INFINITY, f64::max),
            );
            if low > self.tolerance || high < -self.tolerance {
                continue;
            }
            let is_flat = triangle.normal.dot(normal).abs() >= 1.0 - SAME_NORMAL * SAME_NORMAL;
            if is_flat {
                angle += angle_at(&flat, &triangle.corners.each_ref().map(|p| plane.flat(p)), self.tolerance);
            } else if distance_to_triangle(point, triangle) <= self.tolerance {
                rises |= high > self.tolerance;
                falls |= low < -self.tolerance;
            }
        }
        angle >= std::f64::consts::TAU - 1e-6 || (rises && !falls)
    }

    /// Whether a point lies inside a face of the solid, away from its edges.
    fn is_within_feature(&self, point: &Point2, feature: &[Point2]) -> bool {
        feature.len() >= 3 && depth_within(point, feature) > self.tolerance
    }

    fn put(&self, groups: &mut Vec<Group>, normal: Vec3, level: f64, points: impl Iterator<Item = Vec3>) {
        let same = |group: &&mut Group| {
            (group.normal - normal).norm() <= SAME_NORMAL && (group.level - level).abs() <= 2.0 * self.tolerance
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.points.extend(points),
            None => groups.push(Group { normal, level, points: points.collect() }),
        }
    }
}

/// Whether an edge of the triangle, from where the surface falls away, meets the inside of an edge of the
/// solid or its curved side.
fn is_across_ridge(
    triangle: &Triangle,
    plane: &Plane,
    middle: &Point2,
    own: &[Point2],
    theirs: &[Point2],
    from_front: bool,
    touching: &Touching<'_>,
) -> bool {
    let tolerance = touching.tolerance;
    let inside = |segment: &[Point2]| segment.len() == 2 && segment.iter().all(|end| (end - middle).norm() > tolerance);
    let is_smooth = touching.figure.ball().is_some();
    // A rim crosses an edge in a point of its own.
    let crosses =
        inside(own) || (touching.figure.is_round() && own.len() == 1 && is_well_inside(middle, theirs, tolerance));
    if !(is_smooth || crosses) {
        return false;
    }
    // What of the triangle is touched: an edge between its ends, or a corner with the edges that meet there.
    let on_edge = |i: usize| {
        let [from, to] = [i, (i + 1) % 3].map(|corner| plane.flat(&triangle.corners[corner]));
        distance_to_segment(middle, from, to) <= tolerance
    };
    let exposed = (0..3).any(|i| on_edge(i) && triangle.bends[i].is_exposed(from_front));
    // A corner counts for what is smooth there, which has one normal.
    exposed && (inside(theirs) || is_smooth || touching.figure.is_round())
}

/// The angle in rad that a triangle fills around a point, in their plane.
fn angle_at(point: &Point2, corners: &[Point2; 3], tolerance: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    for i in 0..3 {
        let corner = corners[i];
        if (corner - point).norm() <= tolerance {
            let [u, v] = [corners[(i + 1) % 3] - corner, corners[(i + 2) % 3] - corner];
            return u.perp(&v).abs().atan2(u.dot(&v));
        }
    }
    let [a, b, c] = *corners;
    if [[a, b], [b, c], [c, a]].iter().any(|&[from, to]| distance_to_segment(point, from, to) <= tolerance) {
        return PI;
    }
    let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| (to - from).perp(&(point - from)));
    let inside = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
    if inside { TAU } else { 0.0 }
}

/// Distance in m of a point from a triangle.
fn distance_to_triangle(point: &Vec3, triangle: &Triangle) -> f64 {
    let plane = Plane::across(triangle.normal);
    let height = triangle.normal.dot(&(point - triangle.corners[0]));
    let flat = plane.flat(point);
    let corners = triangle.corners.each_ref().map(|p| plane.flat(p));
    let [a, b, c] = corners;
    let beside = if angle_at(&flat, &corners, 0.0) > 0.0 {
        0.0
    } else {
        let sides = [[a, b], [b, c], [c, a]];
        sides.iter().map(|&[from, to]| distance_to_segment(&flat, from, to)).fold(f64::INFINITY, f64::min)
    };
    height.hypot(beside)
}
