//! The preload that a patch needs to carry a known wrench.
//!
//! The contact forces `g_j` of the face's points must add up to the wrench and
//! the preload, each in its friction cone. Only their total normal force
//!
//! ```text
//! N*(f_x, f_y, tau) = min sum g_j,z   subject to   sum of the g_j's shear,
//!                     bending and torsion as wanted, |g_j,t| <= mu g_j,z
//! ```
//!
//! depends on the points; the demand is `s = max(0, N* - f_z)`. Without shear
//! and torsion, N* is where the centre of pressure reaches the hull's nearest
//! edge. Otherwise it is a cone program in five rows (see `face_program`), and its value
//! a bracket from its two sides.

use nalgebra::Vector2;

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::Bracket;
use super::face_program::{FaceProgram, Rows, UNHELD};
use super::hull::{edges, size};
use super::second_order::slack;
use super::tolerances::DATA;

/// Share of what friction leaves for torsion that is relied on, and how near to an
/// edge, relative to the size of the face, a point counts as on it.
const NEARLY: f64 = 1.0 - 1e-9;
const IN_A_ROW: f64 = 1e-12;

/// Rounds in which forces at a face's points are made to add up to what they carry.
const REPAIRS: usize = 3;

/// The least total normal force and the twist that proves it.
pub(super) struct NormalForce {
    /// Bracket on N* in N; infinite when no preload suffices.
    pub total: Bracket,
    /// Relative twist of the child with unit opening velocity at the origin, in
    /// the connection frame, whose power bounds N* from below.
    pub twist: Twist,
}

/// Least total normal force in N that carries the shear, bending and torsion of
/// `wrench` (its `f_z` plays no part) at points (x, y) with friction `friction`.
pub(super) fn least_normal_force(wrench: &Wrench, friction: f64, points: &[[f64; 2]]) -> NormalForce {
    let radius = size(points);
    let lever = if radius > 0.0 { radius } else { 1.0 };
    let wanted = Rows::new(
        wrench.force.x,
        wrench.force.y,
        wrench.torque.x / lever,
        wrench.torque.y / lever,
        wrench.torque.z / lever,
    );
    let scale = wanted.amax();
    if scale == 0.0 {
        return NormalForce { total: Bracket::exact(0.0), twist: opening(Vec3::zeros()) };
    }
    let negligible = DATA * scale;
    let in_plane = wanted[0].abs().max(wanted[1].abs()).max(wanted[4].abs());
    // What friction takes up it multiplies.
    let frictional = friction > 0.0 && in_plane > negligible * friction.min(1.0);
    let bending = centre_of_pressure(wrench, points);
    if bending.total.upper.is_infinite() || (!frictional && in_plane <= negligible) {
        return bending;
    }
    if !frictional {
        // Nothing holds against sliding along a frictionless face.
        let slide = Twist::new(Vec3::new(-wanted[0], -wanted[1], 0.0), Vec3::z() * (-wanted[4] / lever));
        return NormalForce { total: Bracket::exact(f64::INFINITY), twist: slide };
    }
    if let Some(proportional) = in_proportion(wrench, friction, points, &bending) {
        return proportional;
    }
    iterated(&wanted, lever, friction, points, bending)
}

/// N* of a cone program; `wanted` are shear in N and torques over `lever`.
fn iterated(wanted: &Rows, lever: f64, friction: f64, points: &[[f64; 2]], bending: NormalForce) -> NormalForce {
    let unit: Vec<[f64; 2]> = points.iter().map(|p| [p[0] / lever, p[1] / lever]).collect();
    // Shear and torsion count over the friction coefficient: then there is but one cone.
    let rough = Rows::new(1.0 / friction, 1.0 / friction, 1.0, 1.0, 1.0 / friction);
    let wanted = wanted.component_mul(&rough);
    let scale = wanted.amax();
    let program = FaceProgram::new(&unit, wanted / scale);
    let beyond = program.unheld * program.wanted;
    if !(beyond.norm() <= UNHELD) {
        // No force of a single point, or of points in a row, has this direction.
        let linear = Vec3::new(-beyond[0], -beyond[1], 0.0);
        let angular = Vec3::new(-beyond[2], -beyond[3], -beyond[4]) / lever;
        return NormalForce { total: Bracket::exact(f64::INFINITY), twist: Twist::new(linear, angular) };
    }
    let solved = program.solve();
    let total = Bracket::new(solved.total.lower * scale, solved.total.upper * scale);
    if !(total.lower >= bending.total.lower) {
        let total = Bracket::new(bending.total.lower, total.upper);
        return NormalForce { total, twist: bending.twist };
    }
    let y = solved.y.component_mul(&rough);
    let linear = Vec3::new(-y[0], -y[1], 1.0);
    let angular = Vec3::new(-y[2], -y[3], -y[4]) / lever;
    NormalForce { total, twist: Twist::new(linear, angular) }
}

/// Forces in N at the points of a face, on the child, in the connection frame, that
/// carry `wrench` with the least preload: up to rounding they add up to its shear,
/// bending and torsion, and press with `f_z` or more, so that the preload is their total
/// normal force less `f_z`. `spare` is an extra pressure in N, spread over all
/// points, that keeps them inside their friction cones in spite of rounding.
///
/// Directions that the face cannot hold at all are left out. `None` for a face without
/// points or beyond the reach of numbers.
pub fn face_forces(wrench: &Wrench, friction: f64, points: &[[f64; 2]], spare: f64) -> Option<Vec<Vec3>> {
    let radius = size(points);
    let lever = if radius > 0.0 { radius } else { 1.0 };
    let (f, m) = (&wrench.force, &wrench.torque);
    let grip = if friction > 0.0 { friction } else { f64::INFINITY };
    let wanted = Rows::new(f.x / grip, f.y / grip, m.x / lever, m.y / lever, m.z / (lever * grip));
    let scale = wanted.amax().max(f.z.abs());
    if points.is_empty() || !(scale < f64::INFINITY) {
        return None;
    }
    if scale == 0.0 {
        return Some(vec![Vec3::zeros(); points.len()]);
    }
    let unit: Vec<[f64; 2]> = points.iter().map(|p| [p[0] / lever, p[1] / lever]).collect();
    let program = FaceProgram::new(&unit, wanted / scale);
    let mut x = if wanted == Rows::zeros() { vec![[0.0; 3]; points.len()] } else { program.solve().x };
    for _ in 0..REPAIRS {
        let multipliers = program.gram.as_ref()?.solve(&program.missing(&x));
        for (j, z) in x.iter_mut().enumerate() {
            let change = program.columns(j, &multipliers);
            *z = std::array::from_fn(|k| z[k] + change[k]);
        }
    }
    let pressing = x.iter().zip(&program.pressure).map(|(z, b)| -slack(z) / b).fold(0.0, f64::max);
    let pressure: f64 = program.pressure.iter().sum();
    let total = x.iter().map(|z| z[0]).sum::<f64>() + pressing * pressure;
    let lacking = (f.z / scale - total).max(0.0);
    let more = pressing + (lacking + spare / scale) / pressure;
    let force = |(z, b): (&[f64; 3], &f64)| {
        let grip = if friction > 0.0 { friction } else { 0.0 };
        Vec3::new(grip * z[1], grip * z[2], z[0] + more * b) * scale
    };
    Some(x.iter().zip(&program.pressure).map(force).collect())
}

fn opening(angular: Vec3) -> Twist {
    Twist::new(Vec3::z(), angular)
}

/// N* of bending alone: the centre of pressure `(-tau_y, tau_x) / N` must stay
/// inside every edge of the hull.
fn centre_of_pressure(wrench: &Wrench, points: &[[f64; 2]]) -> NormalForce {
    let moment = [-wrench.torque.y, wrench.torque.x];
    let negligible = DATA * wrench.torque.norm().max(wrench.force.norm() * size(points));
    let mut worst = NormalForce { total: Bracket::exact(0.0), twist: opening(Vec3::zeros()) };
    for edge in edges(points) {
        let pull = edge.normal[0] * moment[0] + edge.normal[1] * moment[1];
        if pull <= negligible {
            continue;
        }
        // Tilting about the edge opens the face by `1 - n.p / distance` at p.
        let tilt = Vec3::new(-edge.normal[1], edge.normal[0], 0.0);
        if edge.distance <= 0.0 {
            return NormalForce { total: Bracket::exact(f64::INFINITY), twist: Twist::new(Vec3::zeros(), tilt) };
        }
        let total = pull / edge.distance;
        if total > worst.total.upper {
            worst = NormalForce { total: Bracket::exact(total), twist: opening(tilt / edge.distance) };
        }
    }
    worst
}

/// N* where no more pressure is needed than bending or shear take on their own: with shear
/// in proportion to pressure, which twists the face about the centre of pressure not at all, and
/// where bending decides, with the two points that it leaves under pressure slid around that
/// centre as far as friction allows. `None` where that does not give the torsion that is
/// wanted.
fn in_proportion(wrench: &Wrench, friction: f64, points: &[[f64; 2]], bending: &NormalForce) -> Option<NormalForce> {
    let (f, m) = (&wrench.force, &wrench.torque);
    let shear = f.xy().norm();
    let rubbing = shear / friction;
    let total = bending.total.upper.max(rubbing);
    if !(total > 0.0 && total < f64::INFINITY) {
        return None;
    }
    let centre = Vector2::new(-m.y, m.x) / total;
    let torsion = (m.z - (centre.x * f.y - centre.y * f.x)).abs();
    // More pressure by a share DATA would hold it.
    let negligible = DATA * friction * total * size(points);
    if rubbing > bending.total.upper {
        let slide = Twist::new(Vec3::new(-f.x, -f.y, 0.0) / rubbing / (friction * friction) + Vec3::z(), Vec3::zeros());
        return (torsion <= negligible).then(|| NormalForce { total: Bracket::exact(total), twist: slide });
    }
    let left = (friction * total - shear) * arm_on_edge(&centre, points);
    let twisted = torsion <= negligible || torsion <= left * NEARLY;
    twisted.then_some(NormalForce { total: bending.total, twist: bending.twist })
}

/// Distance in m of the nearer of the two outermost points in a row with `centre`, a point of the
/// hull's boundary between them; 0 where there are none.
fn arm_on_edge(centre: &Vector2<f64>, points: &[[f64; 2]]) -> f64 {
    let near = size(points) * IN_A_ROW;
    let on_edge = edges(points).into_iter().filter_map(|edge| {
        let normal = Vector2::from(edge.normal);
        ((normal.dot(centre) - edge.distance).abs() <= near).then(|| {
            let along = Vector2::new(-normal.y, normal.x);
            let row =
                points.iter().map(|p| Vector2::from(*p)).filter(|p| (normal.dot(p) - edge.distance).abs() <= near);
            let ahead = |side: f64| row.clone().map(|p| side * along.dot(&(p - centre))).fold(0.0, f64::max);
            ahead(1.0).min(ahead(-1.0))
        })
    });
    on_edge.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.04, 0.04], [-0.04, 0.04], [-0.04, -0.04], [0.04, -0.04]];

    fn total(force: [f64; 3], torque: [f64; 3], friction: f64) -> Bracket {
        least_normal_force(&Wrench::new(force.into(), torque.into()), friction, &SQUARE).total
    }

    #[test]
    fn pure_bending_moves_the_centre_of_pressure_to_the_edge() {
        let found = total([0.0; 3], [0.0, 0.2, 0.0], 0.4);
        assert!(found.contains(5.0) && found.width() < 1e-12, "{found:?}");
    }

    #[test]
    fn pure_shear_needs_force_over_friction() {
        let found = total([3.0, 4.0, 7.0], [0.0; 3], 0.5);
        assert!((found.lower - 10.0).abs() < 1e-9 && (found.upper - 10.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn pure_torsion_uses_the_corners() {
        // All four corners slide at the radius 0.04 sqrt 2.
        let found = total([0.0; 3], [0.0, 0.0, 1.0], 0.5);
        let expected = 1.0 / (0.5 * 0.04 * 2.0_f64.sqrt());
        assert!((found.lower - expected).abs() < 1e-9 * expected && (found.upper - expected).abs() < 1e-9 * expected);
    }

    #[test]
    fn combined_loads_are_bracketed_tightly_by_an_admissible_twist() {
        let wrench = Wrench::new(Vec3::new(1.0, -2.0, 0.0), Vec3::new(0.1, 0.05, -0.07));
        let found = least_normal_force(&wrench, 0.4, &SQUARE);
        assert!(found.total.width() <= 1e-10 * found.total.upper, "{:?}", found.total);
        for [px, py] in SQUARE {
            let at = found.twist.at(&Vec3::new(px, py, 0.0));
            assert!(at.z >= 0.4 * at.xy().norm() - 1e-12);
        }
        let power = -found.twist.power(&wrench);
        assert!((power - found.total.lower).abs() <= 1e-9 * power);
    }

    #[test]
    fn in_proportion_agrees_with_the_iteration() {
        let mut state = 3_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        let (mut bent, mut rubbed) = (0, 0);
        for n in 0..600 {
            let points: Vec<[f64; 2]> = SQUARE.map(|p| [p[0] + 0.01 * next(), p[1] + 0.01 * next()]).to_vec();
            let shear = [next(), next()];
            let mut wrench = Wrench::new(Vec3::new(shear[0], shear[1], 0.0), Vec3::new(next(), next(), 0.0) * 0.2);
            let bending = centre_of_pressure(&wrench, &points);
            let total = bending.total.upper.max(wrench.force.xy().norm() / 0.4);
            let centre = [-wrench.torque.y / total, wrench.torque.x / total];
            let twist = if n % 2 == 0 { 0.0 } else { 0.05 * next() };
            wrench.torque.z = centre[0] * shear[1] - centre[1] * shear[0] + twist;
            let Some(closed) = in_proportion(&wrench, 0.4, &points, &bending) else { continue };
            *(if closed.total.upper > bending.total.upper { &mut rubbed } else { &mut bent }) += 1;
            let (f, m) = (wrench.force, wrench.torque);
            let wanted = Rows::new(f.x, f.y, m.x / 0.05, m.y / 0.05, m.z / 0.05);
            let iterated = iterated(&wanted, 0.05, 0.4, &points, bending).total;
            assert!(
                (closed.total.upper - iterated.upper).abs() <= 1e-8 * iterated.upper,
                "{:?} {iterated:?}",
                closed.total
            );
            for [px, py] in points {
                let at = closed.twist.at(&Vec3::new(px, py, 0.0));
                assert!(at.z >= 0.4 * at.xy().norm() - 1e-12, "{at:?}");
            }
            assert!((-closed.twist.power(&wrench) - closed.total.lower).abs() <= 1e-12 * closed.total.lower);
        }
        assert!(bent > 150 && rubbed > 40, "{bent} {rubbed}");
    }

    #[test]
    fn nothing_holds_a_frictionless_face_against_shear() {
        assert!(total([1.0, 0.0, 0.0], [0.0; 3], 0.0).lower.is_infinite());
        assert_eq!(total([0.0, 0.0, -5.0], [0.0; 3], 0.0), Bracket::exact(0.0));
    }
}
