//! Where an edge or a rim crosses another: the direction along which two figures touch there.

use smallvec::SmallVec;

use crate::spatial::Vec3;

use super::tolerances::PARALLEL;

/// Alternating projections between two curves: the error shrinks by the squared cosine of their angle each
/// time, so that at 30 degrees a hundred reach 1e-12.
const PROJECTIONS: usize = 100;

/// A corner, an edge, a rim, or the axis of a curved side.
#[derive(Clone, Copy, Debug)]
pub(super) enum Curve {
    /// A corner.
    Corner(Vec3),
    /// A straight edge.
    Edge {
        /// A point of it.
        at: Vec3,
        /// Its direction, unit length.
        along: Vec3,
    },
    /// The axis of a cylinder whose side is meant.
    Axis {
        /// A point of it.
        at: Vec3,
        /// Its direction, unit length.
        along: Vec3,
    },
    /// The rim of a cylinder's cap.
    Rim {
        /// Its centre.
        centre: Vec3,
        /// The cylinder's axis, unit length.
        axis: Vec3,
        /// Its radius in m.
        radius: f64,
    },
}

/// The curves of a figure that are outermost in a direction.
pub(super) type Curves = SmallVec<[Curve; 2]>;

impl Curve {
    fn nearest(&self, p: &Vec3) -> Vec3 {
        match self {
            Self::Corner(at) => *at,
            Self::Edge { at, along } | Self::Axis { at, along } => at + along * along.dot(&(p - at)),
            Self::Rim { centre, axis, radius } => {
                let out = p - centre;
                let flat = out - axis * axis.dot(&out);
                centre + flat.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * *radius
            }
        }
    }

    fn tangent(&self, p: &Vec3) -> Vec3 {
        match self {
            Self::Corner(_) => Vec3::zeros(),
            Self::Edge { along, .. } | Self::Axis { along, .. } => *along,
            Self::Rim { centre, axis, .. } => axis.cross(&(p - centre)),
        }
    }

    const fn is_rim(&self) -> bool {
        matches!(self, Self::Rim { .. })
    }

    const fn is_axis(&self) -> bool {
        matches!(self, Self::Axis { .. })
    }
}

/// The directions across each pair of curves where they come closest, near `start`; not those across two
/// straight lines that are not parallel, which are known.
pub(super) fn across(a: &Curves, b: &Curves, start: &Vec3) -> SmallVec<[Vec3; 4]> {
    let pairs = a.iter().flat_map(|first| b.iter().map(move |second| (first, second)));
    pairs.filter_map(|(a, b)| across_pair(a, b, start)).collect()
}

fn across_pair(a: &Curve, b: &Curve, start: &Vec3) -> Option<Vec3> {
    let is_round = a.is_axis() || b.is_axis() || a.is_rim() || b.is_rim();
    let are_askew = !a.is_rim() && !b.is_rim() && a.tangent(start).cross(&b.tangent(start)).norm_squared() > PARALLEL;
    if !is_round || are_askew {
        return None;
    }
    let mut on_a = a.nearest(start);
    let mut on_b = b.nearest(&on_a);
    for _ in 0..PROJECTIONS {
        let next = a.nearest(&on_b);
        let step = (next - on_a).norm_squared();
        (on_a, on_b) = (next, b.nearest(&next));
        if !(step > 0.0) {
            break;
        }
    }
    if a.is_axis() || b.is_axis() {
        return (on_a - on_b).try_normalize(1e-12);
    }
    a.tangent(&on_a).cross(&b.tangent(&on_b)).try_normalize(1e-12)
}
