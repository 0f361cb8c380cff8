//! The strength that a known wrench demands of a connector.

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Bracket;
use super::connector::{Connector, Model};
use super::patch::least_normal_force;
use super::second_order::norm;
use super::spread::Spread;
use super::tolerances::{DATA, ROUNDING};

/// What a connector must provide to carry a wrench.
#[derive(Clone, Debug)]
pub(super) struct Demand {
    /// Utilisation `s / S`, infinite when no strength suffices.
    pub utilisation: Bracket,
    /// Relative twist of the child, in the connection frame, in which this
    /// connector gives way first: per unit of dissipation, so that its power
    /// against the wrench equals the utilisation.
    pub failing: Twist,
}

/// Sizes of the errors in a wrench: bounds on the error of each component.
#[derive(Clone, Copy, Debug)]
pub(super) struct WrenchError {
    pub force: Vec3,
    pub torque: Vec3,
}

/// Utilisation that `wrench` demands of `connector`.
///
/// `wrench` acts **on the child**, at the connection point, in the connection
/// frame (z towards the child). The bracket covers rounding and `error`, the
/// uncertainty of each component of the wrench. The model's equations are in
/// [`Model`].
pub(super) fn demand(connector: &Connector, wrench: &Wrench, error: &WrenchError) -> Demand {
    match &connector.model {
        Model::Cone { friction, radius } => cone(connector.strength, friction, radius, wrench, error),
        Model::Box { shear, tension, compression, bending, torsion } => {
            let negligible = |size: f64| DATA * size;
            let (force, torque) = (wrench.force.norm(), wrench.torque.norm());
            let components = [
                (wrench.force.x, error.force.x, shear[0], shear[0], negligible(force)),
                (wrench.force.y, error.force.y, shear[1], shear[1], negligible(force)),
                (wrench.force.z, error.force.z, *tension, *compression, negligible(force)),
                (wrench.torque.x, error.torque.x, bending[0], bending[0], negligible(torque)),
                (wrench.torque.y, error.torque.y, bending[1], bending[1], negligible(torque)),
                (wrench.torque.z, error.torque.z, *torsion, *torsion, negligible(torque)),
            ];
            largest_ratio(&components)
        }
        Model::Patch { friction, points } => patch(connector.strength, *friction, points, wrench, error),
    }
}

/// Upper bound on what `wrench` demands, as tight as [`demand`]'s where it is
/// larger than `enough`: what is less may be bounded in a cheaper way.
pub(super) fn demand_at_most(connector: &Connector, wrench: &Wrench, error: &WrenchError, enough: f64) -> f64 {
    if let Model::Patch { friction, points } = &connector.model {
        let ample = Spread::new(points).ample_normal_force(wrench, *friction) - wrench.force.z + error.force.z;
        let utilisation = ample.max(0.0) / connector.strength * (1.0 + ROUNDING);
        if utilisation <= enough {
            return utilisation;
        }
    }
    demand(connector, wrench, error).utilisation.upper
}

fn cone(strength: f64, friction: &[f64; 2], radius: &[f64; 3], wrench: &Wrench, error: &WrenchError) -> Demand {
    let Wrench { force: f, torque: m } = wrench;
    let scaled = [f.x / friction[0], f.y / friction[1], m.x / radius[0], m.y / radius[1], m.z / radius[2]];
    let length = norm(&scaled);
    let spread = norm(&[
        error.force.x / friction[0],
        error.force.y / friction[1],
        error.torque.x / radius[0],
        error.torque.y / radius[1],
        error.torque.z / radius[2],
    ]) + error.force.z
        + ROUNDING * (length + f.z.abs());
    let demanded = length - f.z;
    let unit = |k: usize| if length > 0.0 { scaled[k] / length } else { 0.0 };
    let linear = Vec3::new(-unit(0) / friction[0], -unit(1) / friction[1], 1.0);
    let angular = Vec3::new(-unit(2) / radius[0], -unit(3) / radius[1], -unit(4) / radius[2]);
    Demand {
        utilisation: around(demanded, spread, strength),
        failing: Twist::new(linear / strength, angular / strength),
    }
}

fn largest_ratio(components: &[(f64, f64, f64, f64, f64); 6]) -> Demand {
    let mut utilisation = Bracket::exact(0.0);
    let mut failing = [0.0; 6];
    for (k, &(value, error, negative_limit, positive_limit, negligible)) in components.iter().enumerate() {
        let limit = if value < 0.0 { negative_limit } else { positive_limit };
        if limit.is_infinite() || (limit == 0.0 && value.abs() <= negligible + error) {
            continue;
        }
        let ratio = value.abs() / limit;
        if ratio > utilisation.upper {
            failing = [0.0; 6];
            failing[k] = -value.signum() / if limit > 0.0 { limit } else { 1.0 };
        }
        let spread = if limit > 0.0 { error / limit + ROUNDING * ratio } else { 0.0 };
        utilisation = utilisation.max(around(ratio, spread, 1.0));
    }
    let [a, b, c, d, e, f] = failing;
    Demand { utilisation, failing: Twist::new(Vec3::new(a, b, c), Vec3::new(d, e, f)) }
}

fn patch(strength: f64, friction: f64, points: &[[f64; 2]], wrench: &Wrench, error: &WrenchError) -> Demand {
    let least = least_normal_force(wrench, friction, points);
    let f_z = wrench.force.z;
    // N* is 1/mu-Lipschitz in the shear, and the failing twist bounds the rest to first order.
    let v = &least.twist;
    let spread = 4.0 * (v.linear.abs().dot(&error.force) + v.angular.abs().dot(&error.torque))
        + ROUNDING * (f_z.abs() + if least.total.upper.is_finite() { least.total.upper } else { 0.0 });
    let lower = around(least.total.lower - f_z, spread, strength).lower;
    let upper = around(least.total.upper - f_z, spread, strength).upper;
    Demand { utilisation: Bracket::new(lower, upper), failing: Twist::new(v.linear / strength, v.angular / strength) }
}

/// `max(0, value -+ spread) / strength`.
fn around(value: f64, spread: f64, strength: f64) -> Bracket {
    Bracket::new((value - spread).max(0.0) / strength, (value + spread).max(0.0) / strength)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: WrenchError = WrenchError { force: Vec3::new(0.0, 0.0, 0.0), torque: Vec3::new(0.0, 0.0, 0.0) };

    fn models() -> [Model; 3] {
        [
            Model::Cone { friction: [0.8, 0.5], radius: [0.02, 0.03, 0.01] },
            Model::Box {
                shear: [10.0, 20.0],
                tension: 30.0,
                compression: f64::INFINITY,
                bending: [1.0, 2.0],
                torsion: 3.0,
            },
            Model::Patch { friction: 0.4, points: vec![[0.04, 0.03], [-0.04, 0.04], [-0.03, -0.04], [0.04, -0.05]] },
        ]
    }

    fn wrenches() -> impl Iterator<Item = Wrench> {
        let part = |seed: i32| Vec3::from_fn(|k, _| f64::from((seed * (7 + 4 * k as i32)) % 11 - 5));
        (1..40).map(move |i| Wrench::new(part(i), part(i * i + 3) * 0.03))
    }

    /// The failing twist is the dual: its power against the wrench is the demand,
    /// against any other wrench a lower bound of that one's.
    #[test]
    fn failing_twists_support_the_demand() {
        for model in models() {
            let connector = Connector { name: String::new(), strength: 25.0, model };
            for wrench in wrenches() {
                let found = demand(&connector, &wrench, &NONE);
                let Bracket { lower, upper } = found.utilisation;
                assert!(upper - lower <= 1e-9 * upper.max(1.0), "{wrench:?}");
                let power = |w: &Wrench| -found.failing.power(w);
                if lower > 0.0 {
                    assert!((power(&wrench) - lower).abs() <= 1e-9 * upper, "{wrench:?}: {} {lower}", power(&wrench));
                    for other in wrenches() {
                        let needed = demand(&connector, &other, &NONE).utilisation.upper;
                        assert!(power(&other) <= needed * (1.0 + 1e-9) + 1e-9, "{wrench:?} {other:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn demand_is_convex_and_homogeneous() {
        for model in models() {
            let connector = Connector { name: String::new(), strength: 25.0, model };
            let of = |w: &Wrench| demand(&connector, w, &NONE).utilisation;
            for (a, b) in wrenches().zip(wrenches().skip(5)) {
                let (sum, parts) = (of(&(a + b)), of(&a).upper + of(&b).upper);
                assert!(sum.lower <= parts * (1.0 + 1e-9) + 1e-12, "{a:?} {b:?}");
                let (once, thrice) = (of(&a), of(&(a * 3.0)));
                assert!((thrice.upper - 3.0 * once.upper).abs() <= 1e-8 * thrice.upper.max(1.0));
            }
        }
    }

    #[test]
    fn hardly_any_friction_is_not_none() {
        let points = vec![[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]];
        let connector =
            Connector { name: String::new(), strength: 1.0, model: Model::Patch { friction: 1e-6, points } };
        let shear = Wrench::new(Vec3::new(0.0, 2.0, 0.0), Vec3::zeros());
        let found = demand(&connector, &shear, &NONE).utilisation;
        assert!((found.lower - 2e6).abs() < 1.0 && (found.upper - 2e6).abs() < 1.0, "{found:?}");
    }

    /// One point carries no moment, two none about their line, and an origin on
    /// the hull's edge none beyond it, whatever the preload.
    #[test]
    fn degenerate_patches_resist_what_they_can() {
        let patch = |points: &[[f64; 2]], force: [f64; 3], torque: [f64; 3]| {
            let model = Model::Patch { friction: 0.5, points: points.to_vec() };
            let connector = Connector { name: String::new(), strength: 10.0, model };
            demand(&connector, &Wrench::new(force.into(), torque.into()), &NONE).utilisation
        };
        let near = |found: Bracket, t: f64| (found.lower - t).abs() < 1e-6 && (found.upper - t).abs() < 1e-6;
        let (point, line, edge) = ([[0.0, 0.0]], [[0.1, 0.0], [-0.1, 0.0]], [[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1]]);
        let found = patch(&point, [3.0, 0.0, -1.0], [0.0; 3]);
        assert!(near(found, 0.7), "{found:?}");
        assert_eq!(patch(&point, [0.0; 3], [0.0, 1.0, 0.0]).lower, f64::INFINITY);
        assert_eq!(patch(&point, [3.0, 0.0, 9.0], [0.0, 0.0, 1.0]).lower, f64::INFINITY);
        let found = patch(&line, [0.0; 3], [0.0, 1.0, 0.0]);
        assert!(near(found, 1.0), "{found:?}");
        assert_eq!(patch(&line, [0.0; 3], [1.0, 0.0, 0.0]).lower, f64::INFINITY);
        // Pressure moves to (0, y) for a torque N y about x: only towards the hull.
        let found = patch(&edge, [0.0; 3], [-1.0, 0.0, 0.0]);
        assert_eq!(found.lower, f64::INFINITY, "{found:?}");
        let found = patch(&edge, [0.0; 3], [1.0, 0.0, 0.0]);
        assert!(near(found, 1.0), "{found:?}");
    }
}
