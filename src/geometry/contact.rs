//! Contact points of two solids that touch.

use crate::spatial::Vec3;

use super::polygon::{Point2, clip, convex_hull, crossing};
use super::separation::separations;
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
/// point. `None` when the solids are apart, when they penetrate deeper, and when
/// the normal is not unique: two solids that share only (part of) a parallel
/// edge, or meet in a corner, can carry no force that is sure.
pub fn contact(a: &Solid, b: &Solid, tolerance: f64) -> Option<ContactPatch> {
    let normal = touching_normal(a, b, tolerance)?;
    let [u, v] = plane_axes(&normal);
    let support = |solid: &Solid, towards: Vec3| {
        let vertices = solid.vertices();
        let extreme = vertices.iter().map(|p| p.dot(&towards)).fold(f64::NEG_INFINITY, f64::max);
        let near = vertices.into_iter().filter(|p| p.dot(&towards) >= extreme - tolerance);
        let flat = near.map(|p| Point2::new(p.dot(&u), p.dot(&v))).collect();
        (extreme, convex_hull(flat, tolerance))
    };
    let (depth_a, feature_a) = support(a, -normal);
    let (height_b, feature_b) = support(b, normal);
    let level = (height_b - depth_a) / 2.0;

    let common = match (&feature_a[..], &feature_b[..]) {
        (_, [_, _, _, ..]) => clip(feature_a, &feature_b, tolerance),
        ([_, _, _, ..], _) => clip(feature_b, &feature_a, tolerance),
        (&[a0, a1], &[b0, b1]) => crossing([a0, a1], [b0, b1], tolerance).into_iter().collect(),
        _ => Vec::new(),
    };
    let common = convex_hull(common, tolerance);
    let points: Vec<_> = common.iter().map(|p| u * p.x + v * p.y + normal * level).collect();
    (!points.is_empty()).then_some(ContactPatch { normal, points })
}

/// Contact of a solid with the ground below `height` in m: its corners within
/// `tolerance` of the surface; `None` when it is above or deeper in.
pub fn ground_contact(solid: &Solid, height: f64, tolerance: f64) -> Option<ContactPatch> {
    let vertices = solid.vertices();
    let lowest = vertices.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let touches = (lowest - height).abs() <= tolerance;
    if !touches {
        return None;
    }
    let near = vertices.into_iter().filter(|p| p.z <= height + tolerance);
    let flat = convex_hull(near.map(|p| Point2::new(p.x, p.y)).collect(), tolerance);
    let points = flat.iter().map(|p| Vec3::new(p.x, p.y, height)).collect();
    Some(ContactPatch { normal: Vec3::z(), points })
}

/// The one direction along which two solids touch; `None` when they do not, or
/// when there is more than one.
fn touching_normal(a: &Solid, b: &Solid, tolerance: f64) -> Option<Vec3> {
    let mut normal: Option<Vec3> = None;
    for separation in separations(a, b) {
        if separation.gap > tolerance {
            return None;
        }
        if separation.gap >= -tolerance {
            match &normal {
                None => normal = Some(separation.normal),
                Some(first) if first.cross(&separation.normal).norm() <= SAME_NORMAL => {}
                Some(_) => return None,
            }
        }
    }
    normal
}

/// Two unit vectors that complete `normal` to a right-handed frame: along the
/// world's axes where the normal is, so that lattice contacts keep exact numbers.
fn plane_axes(normal: &Vec3) -> [Vec3; 2] {
    let across = Vec3::ith(normal.iamin(), 1.0);
    let u = (across - normal * normal.dot(&across)).normalize();
    [u, normal.cross(&u)]
}
