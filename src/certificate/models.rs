//! What the three connector models demand and dissipate, in intervals.
//!
//! The equations are those of [`Model`]; nothing here is shared with the oracle.

use crate::statics::{Connector, Model};

use super::interval::{Interval, Vector, length};
use super::{Carried, DATA};

/// A wrench that is known in intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Push {
    pub force: Vector,
    pub torque: Vector,
}

impl Push {
    pub(super) const ZERO: Self = Self { force: Vector::ZERO, torque: Vector::ZERO };

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

/// Keeps account of what is forgiven because data are meant up to 1e-12 only.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Allowance {
    /// The largest share that was forgiven.
    pub forgiven: f64,
}

impl Allowance {
    /// Whether an `excess` over nothing is at most 1e-12 of `size`.
    pub(super) fn forgives(&mut self, excess: f64, size: f64) -> bool {
        if excess <= 0.0 {
            return true;
        }
        let share = excess / size;
        if !(share <= DATA) {
            return false;
        }
        self.forgiven = self.forgiven.max(share);
        true
    }
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
            let (f, m) = (Vector::exact(&wrench.force) + rest.force, Vector::exact(&wrench.torque) + rest.torque);
            let over = |x: Interval, limit: f64| x / Interval::exact(limit);
            let rubbing = length(&[
                over(f.x, friction[0]),
                over(f.y, friction[1]),
                over(m.x, radius[0]),
                over(m.y, radius[1]),
                over(m.z, radius[2]),
            ]);
            Ok(((rubbing - f.z) / strength).upper.max(0.0))
        }
        (Model::Box { .. }, Carried::Wrench(wrench)) => {
            let (f, m) = (Vector::exact(&wrench.force) + rest.force, Vector::exact(&wrench.torque) + rest.torque);
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

/// Forces at the three points of a face that span the largest triangle, which add up
/// to `push`; `None` when there is no triangle. Normal forces by barycentric
/// coordinates, shear evenly, torsion by forces around the triangle's centre.
fn on_three_points(points: &[[f64; 2]], push: &Push) -> Option<[(usize, Vector); 3]> {
    let corners = largest_triangle(points)?;
    let at = corners.map(|i| points[i].map(Interval::exact));
    let cross = |a: [Interval; 2], b: [Interval; 2]| a[0] * b[1] - a[1] * b[0];
    let area = cross(at[0], at[1]) + cross(at[1], at[2]) + cross(at[2], at[0]);
    let third = |k: usize| (at[0][k] + at[1][k] + at[2][k]) / Interval::exact(3.0);
    let centre = [third(0), third(1)];
    let arms = at.map(|p| [p[0] - centre[0], p[1] - centre[1]]);
    let inertia = arms.iter().fold(Interval::ZERO, |sum, arm| sum + arm[0].square() + arm[1].square());
    let torsion = push.torque.z - cross(centre, [push.force.x, push.force.y]);
    let turning = torsion / inertia;
    let mut shares = corners.map(|corner| (corner, Vector::ZERO));
    for k in 0..3 {
        let (b, c) = (at[(k + 1) % 3], at[(k + 2) % 3]);
        // First moments of the normal forces: sum g_z y = tau_x, sum g_z x = -tau_y.
        let moments = (c[1] - b[1]) * push.torque.y + (c[0] - b[0]) * push.torque.x;
        shares[k].1 = Vector {
            x: push.force.x / Interval::exact(3.0) - turning * arms[k][1],
            y: push.force.y / Interval::exact(3.0) + turning * arms[k][0],
            z: (cross(b, c) * push.force.z + moments) / area,
        };
    }
    Some(shares)
}

fn largest_triangle(points: &[[f64; 2]]) -> Option<[usize; 3]> {
    let mut best = (0.0, None);
    for a in 0..points.len() {
        for b in 0..a {
            for c in 0..b {
                let [p, q, r] = [points[a], points[b], points[c]];
                let area = ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs();
                if area > best.0 {
                    best = (area, Some([a, b, c]));
                }
            }
        }
    }
    best.1
}

/// How well a connector carries any wrench whatever, a measure for choosing among
/// several; `None` when there are wrenches that it cannot carry.
pub(super) fn holding(connector: &Connector) -> Option<f64> {
    let least = |limits: &[f64]| limits.iter().copied().fold(f64::INFINITY, f64::min);
    let holding = match &connector.model {
        Model::Cone { friction, radius } => connector.strength * least(friction).min(least(radius)),
        Model::Box { .. } => least(limits(&connector.model).as_flattened()),
        Model::Patch { friction, points } => {
            largest_triangle(points).map_or(0.0, |_| connector.strength * friction.min(1.0))
        }
    };
    (holding > 0.0).then_some(holding)
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
            let times = |x: Interval, factor: f64| x * Interval::exact(factor);
            let rubbing = length(&[
                times(v.x, friction[0]),
                times(v.y, friction[1]),
                times(w.x, radius[0]),
                times(w.y, radius[1]),
                times(w.z, radius[2]),
            ]);
            opens(v.z, rubbing)?;
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
