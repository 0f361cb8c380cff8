//! Candidate pairs among many solids.

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use super::solid::Solid;

/// Immovable solids, prepared for asking which of them are near another one.
#[derive(Clone, Debug)]
pub struct BroadPhase {
    solids: Vec<Solid>,
    tree: Bvh,
}

impl BroadPhase {
    /// Prepares these solids, in a time that grows hardly faster than their number.
    pub fn new(solids: Vec<Solid>) -> Self {
        let boxes: Vec<Aabb> = solids.iter().map(|solid| bounding_box(solid, 0.0)).collect();
        Self { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), solids }
    }

    /// The solids whose bounding boxes come within `margin` in m of another's,
    /// with their indices, in order. A superset of those within `margin` of it.
    pub fn near(&self, solid: &Solid, margin: f64) -> Vec<(usize, &Solid)> {
        let mut found: Vec<usize> =
            self.tree.intersect_aabb(&bounding_box(solid, margin)).map(|index| index as usize).collect();
        found.sort_unstable();
        found.into_iter().map(|index| (index, &self.solids[index])).collect()
    }
}

fn bounding_box(solid: &Solid, margin: f64) -> Aabb {
    let (centre, half) = (solid.centre(), solid.bounds().add_scalar(margin));
    let (low, high) = (centre - half, centre + half);
    Aabb::new([low.x, low.y, low.z].into(), [high.x, high.y, high.z].into())
}
