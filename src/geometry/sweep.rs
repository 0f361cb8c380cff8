//! Collision of a moving solid along its whole motion.

use crate::spatial::Vec3;

use super::figure::Figure;
use super::motion::Motion;
use super::separation::{Separations, of_figures, separations};
use super::solid::Solid;
use super::tolerances::{ARRIVED, MAX_STEPS, SAGITTA, SKIN};

/// Smallest phase in 0 to 1 at which `solid`, displaced by `motion` from its own pose, hits
/// `other`, or `None` when the way is free. All data must be finite.
///
/// # Guarantees
/// With `s` = [`SKIN`] times the half of the solid's largest extent:
/// - a motion during which some penetration exceeds `sqrt(3) s` is never called free (for a
///   [hull](crate::robot::Hull) `s` times the greatest distance from its centre to a corner over the
///   least to a face, for a ball exactly `s`);
/// - at the phase returned the penetration is at least `0.99 s`, unless
///   the solid scraped along the other that deep for thousands of steps.
///
/// So solids that touch, slide along each other or part are free.
///
/// Conservative advancement (B. Mirtich: "Impulse-based dynamic simulation of
/// rigid body systems", 1996) of the solid with its faces moved
/// inwards by `s`. Where the original steps by the distance over the greatest
/// speed, each step here goes as far as *no corner can close the gap along one
/// of the separating directions*, which is exact for the direction. A face that
/// slides along another has a direction in which it never closes, and costs one step. Of a
/// cylinder the corners are those of an inscribed prism; a ball on either side also lets the other go on by the
/// distance over the speed of its centre, which is nothing when they roll around it.
pub fn first_collision(solid: &Solid, motion: &Motion, other: &Solid) -> Option<f64> {
    let mover = Mover::new(solid, motion);
    mover.may_meet(&other.bounds()).then(|| mover.hits_solid(other, 1.0)).flatten()
}

/// A solid on its way, with its faces moved inwards.
pub(super) struct Mover<'a> {
    solid: Solid,
    figure: Figure,
    /// Points whose hull moves as the solid does.
    guides: Vec<Vec3>,
    motion: &'a Motion,
    size: f64,
}

impl<'a> Mover<'a> {
    /// Prepares a motion.
    pub fn new(solid: &Solid, motion: &'a Motion) -> Self {
        let size = solid.size();
        let solid = solid.shrunk(SKIN * size);
        let figure = Figure::new(&solid);
        Self { guides: figure.guides(SAGITTA * SKIN * size), figure, solid, motion, size }
    }

    /// The solid at the start, with its faces moved inwards.
    pub fn start(&self) -> &Solid {
        &self.solid
    }

    /// Lowest and highest corner of a box that holds the solid all along.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self.motion {
            Motion::Translation { by } => {
                let (low, high) = self.solid.bounds();
                (low.inf(&(low + by)), high.sup(&(high + by)))
            }
            Motion::Rotation { centre, axis, .. } => {
                let foot = centre + axis.into_inner() * axis.dot(&(self.solid.centre() - centre));
                let radius = self.solid.vertices().iter().map(|p| (p - foot).norm()).fold(0.0, f64::max);
                (foot.add_scalar(-radius), foot.add_scalar(radius))
            }
        }
    }

    /// Whether the box that holds the solid all along meets another.
    pub fn may_meet(&self, (low, high): &(Vec3, Vec3)) -> bool {
        let (own_low, own_high) = self.bounds();
        let apart = (own_low - high).sup(&(low - own_high));
        !(apart.max() > 0.0)
    }

    /// First phase up to `until` at which it arrives at another solid.
    pub fn hits_solid(&self, other: &Solid, until: f64) -> Option<f64> {
        if let (Some(_), Some(_)) = (self.solid.cuboid(), other.cuboid()) {
            return self.hits(until, |phase| {
                let now = Solid::new(self.solid.shape.clone(), self.motion.pose(&self.solid.pose, phase));
                self.advance(&separations(&now, other), &now.vertices())
            });
        }
        self.hits_figure(&Figure::new(other), until)
    }

    /// First phase up to `until` at which it arrives at a figure.
    pub fn hits_figure(&self, other: &Figure, until: f64) -> Option<f64> {
        let centre = other.ball().map(|(centre, _)| centre);
        let speed = [centre, self.figure.ball().map(|(centre, _)| centre)]
            .into_iter()
            .flatten()
            .map(|centre| self.motion.speed_of(&centre))
            .fold(f64::INFINITY, f64::min);
        self.hits(until, |phase| {
            let by = self.motion.at(phase);
            let guides: Vec<_> = self.guides.iter().map(|p| (by * crate::spatial::Point::from(*p)).coords).collect();
            let found = of_figures(&self.figure.moved(&by), other, SKIN * self.size);
            let along = self.advance(&found, &guides)?;
            let gap = found.iter().map(|s| s.gap).fold(0.0, f64::max);
            // No speed at all: the distance stays what it is.
            Some(along.max(if speed > 0.0 { gap / speed } else { f64::INFINITY }))
        })
    }

    /// First phase up to `until` at which it arrives at the plane at `level` along `normal`.
    pub fn hits_plane(&self, normal: &Vec3, level: f64, until: f64) -> Option<f64> {
        let lowest = -self.figure.reach(&-normal);
        let phase = if lowest > level { self.motion.free_advance(&self.guides, normal, lowest - level) } else { 0.0 };
        (phase <= until).then_some(phase)
    }

    /// How far the phase may rise along the best of some separating directions; `None` when there is none.
    fn advance(&self, found: &Separations, guides: &[Vec3]) -> Option<f64> {
        let apart = found.iter().filter(|s| s.gap > ARRIVED * self.size);
        apart.map(|s| self.motion.free_advance(guides, &s.normal, s.gap)).reduce(f64::max)
    }

    /// Advances by steps until one is impossible.
    fn hits(&self, until: f64, step: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        let mut phase = 0.0;
        for _ in 0..MAX_STEPS {
            match step(phase) {
                Some(advance) if phase + advance > until => return None,
                Some(advance) => phase += advance,
                None => return Some(phase),
            }
        }
        Some(phase)
    }
}
