//! The forces of a face's points if they were equal springs.
//!
//! Pressure is linear over the face and shear is that of a rigid rotation about
//! the points' centroid: one way of many to carry a wrench, in closed form. What
//! it needs is enough, and mostly not much more than what the best way needs,
//! which takes an iteration (see `patch`).

use nalgebra::{Matrix2, Vector2};

use crate::spatial::{Vec3, Wrench};

/// Least determinant of the points' second moments over the square of their
/// trace, and least share of a point in the pressure over that of an average one:
/// below, the formulas lose too many digits.
const REGULAR: f64 = 1e-3;

/// Rounding of all of this, relative to the terms that are added up, for points
/// that are regular in that sense: three orders more than it can be.
const ERROR: f64 = 1e-9;

/// Points of a face with equal stiffness.
pub(super) struct Spread<'p> {
    points: &'p [[f64; 2]],
    centroid: Vector2<f64>,
    /// Inverse of the second moments about the centroid; `None` for points that
    /// are nearly in a row.
    compliance: Option<Matrix2<f64>>,
    /// Polar moment about the centroid.
    polar: f64,
}

impl<'p> Spread<'p> {
    /// `points` in the face's plane, in m.
    pub(super) fn new(points: &'p [[f64; 2]]) -> Self {
        let count = points.len().max(1) as f64;
        let centroid = points.iter().map(|p| Vector2::from(*p)).sum::<Vector2<f64>>() / count;
        let mut moments = Matrix2::zeros();
        for p in points {
            let arm = Vector2::from(*p) - centroid;
            moments += arm * arm.transpose();
        }
        let polar = moments.trace();
        let regular = moments.determinant() > REGULAR * polar * polar;
        let compliance = if regular { moments.try_inverse() } else { None };
        Self { points, centroid, compliance, polar }
    }

    /// How pressure changes over the face: per N of normal force through the
    /// origin, and for the bending of `wrench`.
    fn slopes(&self, wrench: &Wrench) -> Option<(Vector2<f64>, Vector2<f64>)> {
        let compliance = self.compliance?;
        let bending = Vector2::new(-wrench.torque.y, wrench.torque.x);
        Some((-(compliance * self.centroid), compliance * bending))
    }

    fn twisting(&self, wrench: &Wrench) -> f64 {
        let (f, c) = (&wrench.force, &self.centroid);
        if self.polar > 0.0 { (wrench.torque.z - (c.x * f.y - c.y * f.x)) / self.polar } else { 0.0 }
    }

    /// Force at `at`, one of the points, in the face's frame, when all together
    /// carry `wrench` with the normal force `wrench.force.z`. Only its bending is
    /// left out where the points are nearly in a row.
    pub(super) fn force(&self, at: &[f64; 2], wrench: &Wrench) -> Vec3 {
        let count = self.points.len() as f64;
        let arm = Vector2::from(*at) - self.centroid;
        let (own, bent) = self.slopes(wrench).unwrap_or_default();
        let (f, twist) = (&wrench.force, self.twisting(wrench));
        let normal = f.z * (count.recip() + own.dot(&arm)) + bent.dot(&arm);
        Vec3::new(f.x / count - twist * arm.y, f.y / count + twist * arm.x, normal)
    }

    /// A total normal force, in N, with which all points carry the shear, bending
    /// and torsion of `wrench` inside friction cones; infinite where springs cannot.
    pub(super) fn ample_normal_force(&self, wrench: &Wrench, friction: f64) -> f64 {
        let Some((own, bent)) = self.slopes(wrench) else { return f64::INFINITY };
        let count = self.points.len() as f64;
        let twist = self.twisting(wrench);
        let shear = wrench.force.xy();
        let polar_size = (wrench.torque.z.abs() + self.centroid.norm() * shear.norm()) / self.polar;
        let mut total = 0.0_f64;
        for p in self.points {
            let arm = Vector2::from(*p) - self.centroid;
            let share = count.recip() + own.dot(&arm);
            if !(share >= REGULAR / count) {
                return f64::INFINITY;
            }
            let sideways = (shear / count + Vector2::new(-arm.y, arm.x) * twist).norm() / friction;
            let size = bent.norm() * arm.norm() + (shear.norm() / count + polar_size * arm.norm()) / friction;
            let needed = (sideways - bent.dot(&arm) + ERROR * size) / share;
            if !(needed < f64::INFINITY) {
                return f64::INFINITY;
            }
            total = total.max(needed);
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::patch::least_normal_force;

    /// Irregular faces and wrenches from a fixed sequence.
    fn cases() -> Vec<(Vec<[f64; 2]>, Wrench)> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        (0..300)
            .map(|_| {
                let points = corners.iter().map(|p| [0.1 * p[0] + 0.03 * next(), 0.1 * p[1] + 0.03 * next()]).collect();
                let force = Vec3::new(next(), next(), next()) * 10.0;
                (points, Wrench::new(force, Vec3::new(next(), next(), next())))
            })
            .collect()
    }

    #[test]
    fn point_forces_add_up_to_the_wrench() {
        for (points, wrench) in cases() {
            let spread = Spread::new(&points);
            let mut sum = Wrench::ZERO;
            for p in &points {
                let force = spread.force(p, &wrench);
                sum += Wrench::new(force, Vec3::new(p[0], p[1], 0.0).cross(&force));
            }
            assert!((sum.force - wrench.force).norm() < 1e-12, "{sum:?} {wrench:?}");
            assert!((sum.torque - wrench.torque).norm() < 1e-12, "{sum:?} {wrench:?}");
        }
    }

    #[test]
    fn ample_is_never_less_than_the_least_and_mostly_not_much_more() {
        let mut close = 0;
        for (points, wrench) in cases() {
            let ample = Spread::new(&points).ample_normal_force(&wrench, 0.5);
            let least = least_normal_force(&wrench, 0.5, &points).total;
            assert!(ample >= least.lower, "{ample} {least:?}");
            close += usize::from(ample <= 2.0 * least.upper);
        }
        assert!(close > 200, "{close}");
    }

    #[test]
    fn points_in_a_row_are_left_to_others() {
        let points = [[-0.1, 0.0], [0.0, 0.0], [0.1, 0.0]];
        let bent = Wrench::new(Vec3::zeros(), Vec3::y());
        assert!(Spread::new(&points).ample_normal_force(&bent, 0.5).is_infinite());
        assert!(Spread::new(&points).force(&points[0], &bent).norm() < 1e-15);
    }
}
