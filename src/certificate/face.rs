//! How a face carries a small wrench on top of what it carries: by three of its points.

use super::interval::{Interval, Vector};
use super::models::Push;

/// Forces at the three points of a face that span the largest triangle, which add up
/// to `push`; `None` when there is no triangle. Normal forces by barycentric
/// coordinates, shear evenly, torsion by forces around the triangle's centre.
pub(super) fn on_three_points(points: &[[f64; 2]], push: &Push) -> Option<[(usize, Vector); 3]> {
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

/// The three points that are farthest from being in line.
pub(super) fn largest_triangle(points: &[[f64; 2]]) -> Option<[usize; 3]> {
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
