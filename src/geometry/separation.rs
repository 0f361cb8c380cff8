//! Separating axes of two cuboids.
//!
//! The gap between two convex polytopes along a direction is largest, when it
//! is negative, along a normal of a face of their Minkowski difference: for
//! cuboids one of three plus three face normals and nine cross products of
//! edges (S. Gottschalk, M. C. Lin, D. Manocha: "OBBTree", SIGGRAPH 1996).

use crate::spatial::Vec3;

use super::solid::Solid;
use super::tolerances::PARALLEL;

/// A direction and the gap along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Separation {
    /// Unit vector in W, from the second solid to the first.
    pub normal: Vec3,
    /// How far the first lies beyond the second along it in m; negative when
    /// their projections overlap.
    pub gap: f64,
}

/// The gaps along all candidate directions, faces first.
pub(super) fn separations<'a>(a: &'a Solid, b: &'a Solid) -> impl Iterator<Item = Separation> + 'a {
    let (axes_a, axes_b) = (a.axes(), b.axes());
    let centres = a.centre() - b.centre();
    let crossed = (0..9).filter_map(move |i| {
        let cross = axes_a[i / 3].cross(&axes_b[i % 3]);
        (cross.norm_squared() > PARALLEL).then(|| cross.normalize())
    });
    axes_a.into_iter().chain(axes_b).chain(crossed).map(move |axis| {
        let distance = centres.dot(&axis);
        let normal = if distance < 0.0 { -axis } else { axis };
        let gap = distance.abs() - a.half_extent_along(&axis) - b.half_extent_along(&axis);
        Separation { normal, gap }
    })
}

/// Depth in m by which two solids penetrate: the length of the shortest
/// translation that parts them, 0 when they do not overlap.
pub fn penetration(a: &Solid, b: &Solid) -> f64 {
    let gap = separations(a, b).map(|s| s.gap).fold(f64::NEG_INFINITY, f64::max);
    (-gap).max(0.0)
}

/// Whether two solids penetrate deeper than `skin` in m. Touching is not
/// overlapping. A non-finite pose overlaps.
pub fn overlap(a: &Solid, b: &Solid, skin: f64) -> bool {
    !separations(a, b).any(|s| s.gap >= -skin)
}
