//! Collision of a moving solid along its whole motion.

use nalgebra::Vector3;

use super::motion::Motion;
use super::separation::separations;
use super::solid::Solid;
use super::tolerances::{ARRIVED, MAX_STEPS, SKIN};

/// What a moving solid may hit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Immovable solids.
    pub solids: Vec<Solid>,
    /// Height in m of the ground, which fills everything below.
    pub ground: Option<f64>,
}

/// Smallest phase in 0 to 1 at which `solid`, displaced by `motion` from its own pose, hits
/// something, or `None` when the way is free. All data must be finite.
///
/// # Guarantees
/// With `s` = [`SKIN`] times the half of the solid's largest extent:
/// - a motion during which some penetration exceeds `sqrt(3) s` is never called free;
/// - at the phase returned the penetration is at least `0.99 s`, unless
///   the solid scraped along an obstacle that deep for thousands of steps.
///
/// So solids that touch, slide along each other or part are free.
///
/// Conservative advancement (B. Mirtich: "Impulse-based dynamic simulation of
/// rigid body systems", 1996) of the solid with its faces moved
/// inwards by `s`. Where the original steps by the distance over the greatest
/// speed, each step here goes as far as *no corner can close the gap along one
/// of the separating directions*, which is exact for the direction. A face that
/// slides along another has a direction in which it never closes, and costs one step.
pub fn first_collision(solid: &Solid, motion: &Motion, surroundings: &Surroundings) -> Option<f64> {
    let moving = solid.shrunk(SKIN * solid.size());
    let mut first = surroundings.ground.map_or(f64::INFINITY, |height| {
        let vertices = moving.vertices();
        let lowest = vertices.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        if lowest > height { motion.free_advance(&vertices, &Vector3::z(), lowest - height) } else { 0.0 }
    });
    let (centre, reach) = swept_box(&moving, motion);
    for obstacle in &surroundings.solids {
        let apart = (obstacle.centre() - centre).abs() - obstacle.bounds() - reach;
        if apart.max() > 0.0 {
            continue;
        }
        if let Some(phase) = hit(&moving, motion, obstacle, first.min(1.0)) {
            first = first.min(phase);
        }
    }
    (first <= 1.0).then_some(first)
}

/// First phase up to `until` at which the shrunk solid arrives at an obstacle.
fn hit(moving: &Solid, motion: &Motion, obstacle: &Solid, until: f64) -> Option<f64> {
    let arrived = ARRIVED * moving.size();
    let mut phase = 0.0;
    for _ in 0..MAX_STEPS {
        let now = Solid::new(moving.shape.clone(), motion.pose(&moving.pose, phase));
        let vertices = now.vertices();
        let advance = separations(&now, obstacle)
            .filter(|s| s.gap > arrived)
            .map(|s| motion.free_advance(&vertices, &s.normal, s.gap))
            .reduce(f64::max);
        match advance {
            Some(advance) if phase + advance > until => return None,
            Some(advance) => phase += advance,
            None => return Some(phase),
        }
    }
    Some(phase)
}

/// Centre and half extents in W of a box that holds the solid all along.
fn swept_box(solid: &Solid, motion: &Motion) -> (Vector3<f64>, Vector3<f64>) {
    match motion {
        Motion::Translation { by } => (solid.centre() + by / 2.0, solid.bounds() + by.abs() / 2.0),
        Motion::Rotation { centre, axis, .. } => {
            let foot = centre + axis.into_inner() * axis.dot(&(solid.centre() - centre));
            let radius = solid.vertices().iter().map(|p| (p - foot).norm()).fold(0.0, f64::max);
            (foot, Vector3::repeat(radius))
        }
    }
}
