//! What the three connector models demand and dissipate, in intervals.
//!
//! The equations are those of [`Model`]; nothing here is shared with the oracle.

use std::ops::{Div, Mul};

use crate::spatial::Wrench;
use crate::statics::{Connector, Model};

use super::Carried;
use super::allowance::Allowance;
use super::face::on_three_points;
use super::interval::{Interval, Vector, length};

/// A wrench that is known in intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Push {
    pub force: Vector,
    pub torque: Vector,
}

impl Push {
    pub(super) const ZERO: Self = Self { force: Vector::ZERO, torque: Vector::ZERO };

    pub(super) fn exact(wrench: &Wrench) -> Self {
        Self { force: Vector::exact(&wrench.force), torque: Vector::exact(&wrench.torque) }
    }

    /// A force alone.
    pub(super) fn of(force: Vector) -> Self {
        Self { force, torque: Vector::ZERO }
    }

    /// The same wrench about a point that `lever` leads from to the present one.
    pub(super) fn moved(&self, lever: &Vector) -> Self {
        Self { force: self.force, torque: self.torque + lever.cross(&self.force) }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }

    /// At most how large its force and its torque are, in N and N m.
    pub(super) fn sizes(&self) -> [f64; 2] {
        [self.force.norm().upper, self.torque.norm().upper]
    }

    pub(super) fn negative(&self) -> Self {
        Self { force: -self.force, torque: -self.torque }
    }
}

/// A relative velocity at a connection point, in the connection frame, with the
/// sizes against which 1e-12 is judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub linear: Vector,
    pub angular: Vector,
    /// Linear and angular speed, in m/s and rad/s, as felt anywhere on the bodies.
    pub speed: [f64; 2],
}

/// Upper bound on the utilisation that a connector needs to carry what it is said
/// to carry and, on top, the small wrench `rest` on the child in the connection frame.
///
/// # Errors
/// What it cannot carry with any strength.
pub(super) fn demand(connector: &Connector, carried: &Carried, rest: &Push) -> Result<f64, String> {
    let strength = Interval::exact(connector.strength);
    match (&connector.model, carried) {
        (Model::Cone { friction, radius }, Carried::Wrench(wrench)) => {
            let Push { force: f, torque: m } = Push::exact(wrench).plus(rest);
            let rubbing = scaled([f.x, f.y, m.x, m.y, m.z], friction, radius, Div::div);
            Ok(((rubbing - f.z) / strength).upper.max(0.0))
        }
        (Model::Box { .. }, Carried::Wrench(wrench)) => {
            let Push { force: f, torque: m } = Push::exact(wrench).plus(rest);
            let mut largest = 0.0_f64;
            for (component, limits) in [f.x, f.y, f.z, m.x, m.y, m.z].into_iter().zip(limits(&connector.model)) {
                for (amount, limit) in [-component.lower, component.upper].into_iter().zip(limits) {
                    if amount > 0.0 && limit == 0.0 {
                        return Err(format!("carries {amount:e} where its limit is 0"));
                    }
                    if amount > 0.0 && limit < f64::INFINITY {
                        largest = largest.max((Interval::exact(amount) / Interval::exact(limit)).upper);
                    }
                }
            }
            Ok(largest)
        }
        (Model::Patch { friction, points }, Carried::Points { preload, forces }) => {
            let mut forces: Vec<Vector> = forces.iter().map(Vector::exact).collect();
            if *rest != Push::ZERO {
                for (point, share) in on_three_points(points, rest).ok_or("its face cannot carry any wrench")? {
                    forces[point] = forces[point] + share;
                }
            }
            for (point, g) in forces.iter().enumerate() {
                let slip = length(&[g.x, g.y]) - Interval::exact(*friction) * g.z;
                if !(slip.upper <= 0.0 && g.z.lower >= 0.0) {
                    return Err(format!("slips or pulls at its point {point} with {:e} N", slip.upper.max(-g.z.lower)));
                }
            }
            if !(*preload >= 0.0) {
                return Err(format!("has the preload {preload} N"));
            }
            Ok((Interval::exact(*preload) / strength).upper)
        }
        (Model::Cone { .. } | Model::Box { .. } | Model::Patch { .. }, _) => Err("carries what it cannot".to_owned()),
    }
}

/// Length of a cone's tangential components, each divided by (forces) or multiplied with
/// (velocities) its friction coefficient or radius.
fn scaled(
    parts: [Interval; 5],
    friction: &[f64; 2],
    radius: &[f64; 3],
    by: fn(Interval, Interval) -> Interval,
) -> Interval {
    let sizes = friction.iter().chain(radius).map(|size| Interval::exact(*size));
    let parts: Vec<Interval> = parts.into_iter().zip(sizes).map(|(part, size)| by(part, size)).collect();
    length(&parts)
}

/// Limits of the six components of a wrench, each for its negative and its positive
/// values; none at all for a connector that is no box.
pub(super) fn limits(model: &Model) -> [[f64; 2]; 6] {
    match model {
        Model::Box { shear, tension, compression, bending, torsion } => {
            let both = |limit: f64| [limit, limit];
            let normal = [*tension, *compression];
            [both(shear[0]), both(shear[1]), normal, both(bending[0]), both(bending[1]), both(*torsion)]
        }
        Model::Cone { .. } | Model::Patch { .. } => [[f64::INFINITY; 2]; 6],
    }
}

/// Upper bound on the power in W that a connector at its rated strength dissipates in
/// a relative motion of the child.
///
/// # Errors
/// Why it can resist the motion without limit.
pub(super) fn dissipation(connector: &Connector, motion: &Motion, allowance: &mut Allowance) -> Result<f64, String> {
    let Motion { linear: v, angular: w, .. } = motion;
    let preload_power = || (Interval::exact(connector.strength) * v.z).upper.max(0.0);
    match &connector.model {
        Model::Cone { friction, radius } => {
            opens(v.z, scaled([v.x, v.y, w.x, w.y, w.z], friction, radius, Mul::mul))?;
            Ok(preload_power())
        }
        Model::Box { .. } => against_limits(motion, &limits(&connector.model), allowance),
        Model::Patch { friction, points } => {
            for point in points {
                let at = velocity_at(motion, point);
                opens(at.z, Interval::exact(*friction) * length(&[at.x, at.y]))?;
            }
            Ok(preload_power())
        }
    }
}

/// Whether a motion meets no resistance from a connector, whatever its strength.
///
/// # Errors
/// Why it does.
pub(super) fn free(connector: &Connector, motion: &Motion, allowance: &mut Allowance) -> Result<(), String> {
    if let Model::Patch { friction, points } = &connector.model {
        // The preload resists opening, the points resist all that does not open.
        let mut resisted = motion.linear.z.magnitude();
        for point in points {
            let at = velocity_at(motion, point);
            let rubbing = Interval::exact(*friction) * length(&[at.x, at.y]);
            resisted = resisted.max((rubbing - at.z).upper);
        }
        let forgiven = allowance.forgives(resisted, motion.speed[0]);
        return if forgiven { Ok(()) } else { Err(format!("resists at {resisted:e} m/s")) };
    }
    let unlimited =
        limits(&connector.model).map(|both| both.map(|limit| if limit > 0.0 { f64::INFINITY } else { 0.0 }));
    against_limits(motion, &unlimited, allowance).map(drop)
}

/// Power of forces and torques at their limits against a motion.
fn against_limits(motion: &Motion, limits: &[[f64; 2]; 6], allowance: &mut Allowance) -> Result<f64, String> {
    let Motion { linear: v, angular: w, speed } = motion;
    let mut power = Interval::ZERO;
    for (k, velocity) in [v.x, v.y, v.z, w.x, w.y, w.z].into_iter().enumerate() {
        let mut most = 0.0_f64;
        // A positive velocity is resisted by a negative force, and the other way round.
        for (amount, limit) in [velocity.upper, -velocity.lower].into_iter().zip(limits[k]) {
            if limit < f64::INFINITY {
                most = most.max((Interval::exact(limit) * Interval::exact(amount.max(0.0))).upper);
            } else if !allowance.forgives(amount, speed[k / 3]) {
                return Err(format!("resists at {amount:e} {} without limit", if k < 3 { "m/s" } else { "rad/s" }));
            }
        }
        power = power + Interval::exact(most);
    }
    Ok(power.upper)
}

/// Velocity of the child at a point of the face.
fn velocity_at(motion: &Motion, point: &[f64; 2]) -> Vector {
    let arm = Vector { x: Interval::exact(point[0]), y: Interval::exact(point[1]), z: Interval::ZERO };
    motion.linear + motion.angular.cross(&arm)
}

/// Whether a gap opens at least as fast as friction wants to close it.
pub(super) fn opens(opening: Interval, rubbing: Interval) -> Result<(), String> {
    if opening.lower >= rubbing.upper {
        return Ok(());
    }
    Err(format!("opens at {:e} m/s, too slowly by {:e}", opening.lower, rubbing.upper - opening.lower))
}
