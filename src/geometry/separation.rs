//! Separating directions of two convex figures.
//!
//! The gap between two convex polytopes along a direction is largest, when it
//! is negative, along a normal of a face of their Minkowski difference: a face
//! normal of either or a cross product of edges (S. Gottschalk, M. C. Lin, D. Manocha:
//! "OBBTree", SIGGRAPH 1996). For two cuboids, three plus three and nine. Figures
//! that are round have further directions, which are found by iteration (E. G. Gilbert, D. W. Johnson,
//! S. S. Keerthi: "A fast procedure for computing the distance between complex objects",
//! IEEE J. Robotics and Automation 1988). The gap along any direction is exact, and
//! none of them exceeds the distance: a direction that is not quite the best claims less.

use smallvec::SmallVec;

use crate::spatial::Vec3;

use super::curve::across;
use super::figure::Figure;
use super::solid::Solid;
use super::tolerances::{PARALLEL, SKIN};

/// A direction and the gap along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Separation {
    /// Unit vector in W, from the second figure to the first.
    pub normal: Vec3,
    /// How far the first lies beyond the second along it in m; negative when
    /// their projections overlap.
    pub gap: f64,
    /// Whether the direction is where the features it comes from say, rather than where an
    /// iteration ended.
    pub is_exact: bool,
}

/// The gaps along all candidate directions, faces first.
pub(super) type Separations = SmallVec<[Separation; 16]>;

/// The gaps of two solids.
pub(super) fn separations(a: &Solid, b: &Solid) -> Separations {
    match (a.cuboid(), b.cuboid()) {
        (Some(half_a), Some(half_b)) => of_cuboids(a, half_a, b, half_b).collect(),
        _ => of_figures(&Figure::new(a), &Figure::new(b), SKIN * a.size().min(b.size())),
    }
}

/// The gaps of two figures. Where they are round, both are made smaller by `skin` in m
/// to find a direction.
pub(super) fn of_figures(a: &Figure, b: &Figure, skin: f64) -> Separations {
    let mut directions: SmallVec<[Vec3; 16]> = a.normals().iter().chain(b.normals()).copied().collect();
    let crossed = a.edges().iter().flat_map(|edge| b.edges().iter().map(|other| edge.cross(other)));
    directions.extend(crossed.filter(|cross| cross.norm_squared() > PARALLEL).map(|cross| cross.normalize()));
    let mut proposed = None;
    if (a.is_round() || b.is_round())
        && let Some((direction, near)) = a.towards_from(b, skin)
    {
        // Loose enough for the error of the iteration, and small against either.
        let loose = 10.0 * skin;
        let curves = [a.curves(&-direction, loose), b.curves(&direction, loose)];
        directions.extend(across(&curves[0], &curves[1], &near));
        proposed = Some(direction);
    }
    // A ball's centre is its radius away from what it touches: far enough for the iteration.
    let is_ball = a.ball().is_some() || b.ball().is_some();
    let exact = directions.into_iter().map(|direction| along(a, b, direction, true));
    exact.chain(proposed.map(|direction| along(a, b, direction, is_ball))).collect()
}

/// The larger of the gaps along a direction and against it.
fn along(a: &Figure, b: &Figure, direction: Vec3, is_exact: bool) -> Separation {
    let forwards = -a.reach(&-direction) - b.reach(&direction);
    let backwards = -a.reach(&direction) - b.reach(&-direction);
    if backwards > forwards {
        Separation { normal: -direction, gap: backwards, is_exact }
    } else {
        Separation { normal: direction, gap: forwards, is_exact }
    }
}

fn of_cuboids<'a>(a: &'a Solid, half_a: Vec3, b: &'a Solid, half_b: Vec3) -> impl Iterator<Item = Separation> + 'a {
    let (axes_a, axes_b) = (a.axes(), b.axes());
    let centres = a.centre() - b.centre();
    let crossed = (0..9).filter_map(move |i| {
        let cross = axes_a[i / 3].cross(&axes_b[i % 3]);
        (cross.norm_squared() > PARALLEL).then(|| cross.normalize())
    });
    let half_extent =
        |solid: &Solid, half: &Vec3, n: &Vec3| half.dot(&solid.pose.rotation.inverse_transform_vector(n).abs());
    axes_a.into_iter().chain(axes_b).chain(crossed).map(move |axis| {
        let distance = centres.dot(&axis);
        let normal = if distance < 0.0 { -axis } else { axis };
        let gap = distance.abs() - half_extent(a, &half_a, &axis) - half_extent(b, &half_b, &axis);
        Separation { normal, gap, is_exact: true }
    })
}

/// Depth in m by which two solids penetrate: the length of the shortest
/// translation that parts them, 0 when they do not overlap. Of cylinders that penetrate deeply it
/// is an upper bound, as their directions are found by iteration.
pub fn penetration(a: &Solid, b: &Solid) -> f64 {
    let gap = separations(a, b).iter().map(|s| s.gap).fold(f64::NEG_INFINITY, f64::max);
    (-gap).max(0.0)
}

/// Whether two solids penetrate deeper than `skin` in m. Touching is not
/// overlapping. A negative skin asks whether they come closer than that much: `false` is sure,
/// `true` also where no direction of the two says so. A non-finite pose overlaps.
pub fn overlap(a: &Solid, b: &Solid, skin: f64) -> bool {
    match (a.cuboid(), b.cuboid()) {
        (Some(half_a), Some(half_b)) => !of_cuboids(a, half_a, b, half_b).any(|s| s.gap >= -skin),
        _ => !separations(a, b).iter().any(|s| s.gap >= -skin),
    }
}
