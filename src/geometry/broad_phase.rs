//! Candidate pairs among many solids.

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use super::solid::Solid;

/// Pairs of solids whose bounding boxes come within `margin` in m of each
/// other, as indices, smaller first, sorted. In far less than quadratic time.
pub fn touching_candidates(solids: &[Solid], margin: f64) -> Vec<[usize; 2]> {
    let boxes: Vec<Aabb> = solids.iter().map(|solid| bounding_box(solid, margin / 2.0)).collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    let mut pairs = Vec::new();
    for (i, bounds) in boxes.iter().enumerate() {
        pairs.extend(tree.intersect_aabb(bounds).map(|j| j as usize).filter(|&j| i < j).map(|j| [i, j]));
    }
    pairs.sort_unstable();
    pairs
}

fn bounding_box(solid: &Solid, margin: f64) -> Aabb {
    let (centre, half) = (solid.centre(), solid.bounds().add_scalar(margin));
    let (low, high) = (centre - half, centre + half);
    Aabb::new([low.x, low.y, low.z].into(), [high.x, high.y, high.z].into())
}
