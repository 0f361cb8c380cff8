//! Several modules on their way at once: whether their ways are apart, and what holds them.

use crate::geometry::{Motion, Solid};
use crate::reconfigure::assembly::Engagement;
use crate::reconfigure::partial_order::Because;
use crate::reconfigure::replay::legality::Path;
use crate::robot::Configuration;
use crate::spatial::Vec3;

/// Angle in degrees that one box around a turning module covers.
const BOX_DEGREES: f64 = 3.0;

/// Share of a module's size by which boxes may overlap and still count as apart: the rounding of their corners.
const ROUNDING: f64 = 1e-6;

/// A box along the world's axes: its lowest and its highest corner, in m.
type Room = [Vec3; 2];

/// Whether the ways of two modules are apart, whatever their phases. `false` is not sure.
pub fn are_apart(state: &Configuration, a: &Path, b: &Path) -> bool {
    let tolerance = ROUNDING * state.pitch();
    let rooms = [a, b].map(|path| rooms(state, path));
    rooms[0].iter().all(|[low, high]| {
        rooms[1].iter().all(|[other_low, other_high]| {
            let gap = (low - other_high).sup(&(other_low - high));
            gap.max() >= -tolerance
        })
    })
}

/// Boxes that between them hold a module all along its way.
fn rooms(state: &Configuration, path: &Path) -> Vec<Room> {
    let start = state.pose(path.module);
    let shape = &state.module_type(path.module).body().shape;
    let corners = |phase: f64| Solid::new(shape.clone(), path.motion.pose(&start, phase)).vertices();
    match &path.motion {
        Motion::Translation { .. } => vec![room(corners(0.0).into_iter().chain(corners(1.0)), 0.0)],
        Motion::Rotation { centre, axis, angle } => {
            let radius = corners(0.0).iter().map(|p| axis.cross(&(p - centre)).norm()).fold(0.0, f64::max);
            let parts = (angle.abs().to_degrees() / BOX_DEGREES).ceil().max(1.0);
            // Within half a part a corner goes no farther than its arc is long.
            let reach = radius * angle.abs() / parts / 2.0;
            (0..parts as u32).map(|part| room(corners((f64::from(part) + 0.5) / parts).into_iter(), reach)).collect()
        }
    }
}

/// The box around points, larger by `reach` all round.
fn room(points: impl Iterator<Item = Vec3>, reach: f64) -> Room {
    let [low, high] = points.fold([Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)], |[low, high], p| {
        [low.inf(&p), high.sup(&p)]
    });
    [low.add_scalar(-reach), high.add_scalar(reach)]
}

/// What holds the robot together while these modules move; [`Because::HoldsTheOther`] where one would move along
/// another that moves as well.
pub fn engaged(state: &Configuration, paths: &[Path]) -> Result<Vec<Engagement>, Because> {
    let is_moving = |module: &usize| paths.iter().any(|path| path.module == *module);
    let resting = state.connections.iter().filter(|connection| !connection.modules().iter().any(is_moving));
    let mut engaged: Vec<Engagement> = resting.map(|connection| Engagement::face(state, connection)).collect();
    for path in paths {
        for held in path.engaged.iter().filter(|held| held.modules().contains(&path.module)) {
            if held.modules().iter().all(is_moving) {
                return Err(Because::HoldsTheOther);
            }
            engaged.push(*held);
        }
    }
    Ok(engaged)
}
