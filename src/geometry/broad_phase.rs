//! Candidate pairs among many solids.

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use crate::spatial::Vec3;

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
        let found = indices_in(&self.tree, &bounding_box(solid, margin));
        found.into_iter().map(|index| (index, &self.solids[index])).collect()
    }

    /// Those whose bounding boxes meet the box between two corners, in order.
    pub(super) fn in_box(&self, low: &Vec3, high: &Vec3) -> Vec<(usize, &Solid)> {
        let found = indices_in(&self.tree, &aabb(low, high, 0.0));
        found.into_iter().map(|index| (index, &self.solids[index])).collect()
    }
}

fn bounding_box(solid: &Solid, margin: f64) -> Aabb {
    let (low, high) = solid.bounds();
    aabb(&low, &high, margin)
}

/// The box between two corners, larger by `margin` in m all round.
pub(super) fn aabb(low: &Vec3, high: &Vec3, margin: f64) -> Aabb {
    let (low, high) = (low.add_scalar(-margin), high.add_scalar(margin));
    Aabb::new([low.x, low.y, low.z].into(), [high.x, high.y, high.z].into())
}

/// The leaves whose boxes meet a box, ascending.
pub(super) fn indices_in(tree: &Bvh, room: &Aabb) -> Vec<usize> {
    let mut found: Vec<usize> = tree.intersect_aabb(room).map(|index| index as usize).collect();
    found.sort_unstable();
    found
}
