//! Second-order (Lorentz) cones `{z : z_0 >= |z_1..|}` and their
//! Nesterov-Todd scaling.
//!
//! Source: Nesterov and Todd (1997); formulas as in Vandenberghe, "The CVXOPT
//! linear and quadratic cone program solvers" (2010), section 4.

/// `z_0 - |z_1..|`: positive inside the cone, negative outside; the distance to
/// the boundary times the square root of 2.
pub(super) fn slack(z: &[f64]) -> f64 {
    z[0] - norm(&z[1..])
}

/// `z' J z = z_0^2 - |z_1..|^2`, without cancellation.
pub(super) fn determinant(z: &[f64]) -> f64 {
    let tail = norm(&z[1..]);
    (z[0] - tail) * (z[0] + tail)
}

/// Largest step `a <= 1` with `z + a d` in the cone, times `shorten` if that
/// is less than 1. `z` must be inside.
pub(super) fn step_length<const N: usize>(z: &[f64; N], d: &[f64; N], shorten: f64) -> f64 {
    // Roots of det(z + a d), of which the smallest positive one leaves the cone.
    let (zz, dd) = (determinant(z), determinant(d));
    let zd = z[0] * d[0] - dot(&z[1..], &d[1..]);
    let discriminant = zd * zd - zz * dd;
    let reach = if discriminant <= 0.0 {
        f64::INFINITY
    } else {
        let q = -(zd + zd.signum() * discriminant.sqrt());
        [q / dd, zz / q].into_iter().filter(|a| *a > 0.0).fold(f64::INFINITY, f64::min)
    };
    let head = if d[0] < 0.0 { -z[0] / d[0] } else { f64::INFINITY };
    (shorten * reach.min(head)).min(1.0)
}

/// Whether `z + a d` is in the cone's interior, up to rounding.
fn allows<const N: usize>(z: &[f64; N], d: &[f64; N], a: f64) -> bool {
    let there: [f64; N] = std::array::from_fn(|k| z[k] + a * d[k]);
    there[0] > 0.0 && there[0] * there[0] > dot(&there[1..], &there[1..])
}

/// The smaller of `step` and the step that one cone allows, times `shorten`.
pub(super) fn shortened_step<const N: usize>(z: &[f64; N], d: &[f64; N], shorten: f64, step: f64) -> f64 {
    // Most cones are not in the way, which is cheaper to see than where they are left.
    if allows(z, d, step / shorten) { step } else { step.min(step_length(z, d, shorten)) }
}

/// The Nesterov-Todd scaling `W` of a pair in the cone's interior: the symmetric
/// matrix with `W x = W^-1 s`.
pub(super) struct Scaling<const N: usize> {
    eta: f64,
    w: [f64; N],
}

impl<const N: usize> Scaling<N> {
    /// `None` when a point is not inside its cone.
    pub(super) fn inside(x: &[f64; N], s: &[f64; N]) -> Option<Self> {
        let (dx, ds) = (determinant(x), determinant(s));
        (x[0] > 0.0 && dx > 0.0 && s[0] > 0.0 && ds > 0.0).then(|| Self::at(x, s, dx, ds))
    }

    /// The scaling by `factor`.
    pub(super) fn even(factor: f64) -> Self {
        Self { eta: factor, w: std::array::from_fn(|k| if k == 0 { 1.0 } else { 0.0 }) }
    }

    pub(super) fn new(x: &[f64; N], s: &[f64; N]) -> Self {
        Self::at(x, s, determinant(x), determinant(s))
    }

    fn at(x: &[f64; N], s: &[f64; N], dx: f64, ds: f64) -> Self {
        let (rx, rs) = (dx.sqrt(), ds.sqrt());
        let gamma = ((1.0 + dot(x, s) / (rx * rs)) / 2.0).sqrt();
        let w = std::array::from_fn(|i| {
            let reflected = if i == 0 { x[0] } else { -x[i] };
            (s[i] / rs + reflected / rx) / (2.0 * gamma)
        });
        Self { eta: (ds / dx).sqrt().sqrt(), w }
    }

    /// `W v`.
    pub(super) fn apply(&self, v: &[f64; N]) -> [f64; N] {
        self.rotate(v, 1.0, self.eta)
    }

    /// `W^-1 v`.
    pub(super) fn apply_inverse(&self, v: &[f64; N]) -> [f64; N] {
        self.rotate(v, -1.0, 1.0 / self.eta)
    }

    /// `(scale, u)` with `W^-2 = scale (2 u u' - J)`, entry by entry free of
    /// cancellation since `u_0 >= 1`.
    pub(super) fn inverse_square(&self) -> (f64, [f64; N]) {
        let u = std::array::from_fn(|i| if i == 0 { self.w[0] } else { -self.w[i] });
        ((self.eta * self.eta).recip(), u)
    }

    fn rotate(&self, v: &[f64; N], sign: f64, scale: f64) -> [f64; N] {
        let along = dot(&self.w[1..], &v[1..]);
        let head = self.w[0] * v[0] + sign * along;
        let factor = sign * v[0] + along / (1.0 + self.w[0]);
        std::array::from_fn(|i| scale * if i == 0 { head } else { v[i] + factor * self.w[i] })
    }
}

/// Jordan product `u o v`.
pub(super) fn product<const N: usize>(u: &[f64; N], v: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| if i == 0 { dot(u, v) } else { u[0] * v[i] + v[0] * u[i] })
}

/// The `d` with `u o d = v`, for `u` in the cone's interior.
pub(super) fn divide<const N: usize>(u: &[f64; N], v: &[f64; N]) -> [f64; N] {
    let along = dot(&u[1..], &v[1..]);
    let head = (u[0] * v[0] - along) / determinant(u);
    std::array::from_fn(|i| if i == 0 { head } else { (v[i] - head * u[i]) / u[0] })
}

/// Mehrotra's target `l \ (mu e - l o l - dx o ds)` at the scaled point `l` and
/// the scaled predictor steps.
pub(super) fn aim<const N: usize>(point: &[f64; N], dx: &[f64; N], ds: &[f64; N], mu: f64) -> [f64; N] {
    let (square, second) = (product(point, point), product(dx, ds));
    let wanted = std::array::from_fn(|k| if k == 0 { mu } else { 0.0 } - square[k] - second[k]);
    divide(point, &wanted)
}

/// What brings the eigenvalues of `p`, `p_0 +- |p_1..|`, into the interval; from far above
/// only by the interval's upper end (Gondzio 1996).
pub(super) fn towards<const N: usize>(p: &[f64; N], [low, high]: [f64; 2]) -> [f64; N] {
    let tail = norm(&p[1..]);
    let change = |value: f64| (value.clamp(low, high) - value).max(-high);
    let (up, down) = (change(p[0] + tail), change(p[0] - tail));
    if N == 1 || tail == 0.0 {
        return std::array::from_fn(|k| if k == 0 { up } else { 0.0 });
    }
    std::array::from_fn(|k| if k == 0 { 0.5 * (up + down) } else { 0.5 * (up - down) * p[k] / tail })
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Euclidean length, without overflow or underflow.
pub(super) fn norm(a: &[f64]) -> f64 {
    let square = dot(a, a);
    if square > 1e-200 && square < 1e200 {
        return square.sqrt();
    }
    let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if size == 0.0 || !size.is_finite() {
        size
    } else {
        size * a.iter().map(|x| (x / size).powi(2)).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_maps_the_pair_onto_one_point() {
        let (x, s) = ([2.0, 0.5, -1.0], [1.5, -0.3, 1.1]);
        let scaling = Scaling::new(&x, &s);
        let (a, b) = (scaling.apply(&x), scaling.apply_inverse(&s));
        for i in 0..3 {
            assert!((a[i] - b[i]).abs() < 1e-14, "{a:?} {b:?}");
        }
        let back = scaling.apply_inverse(&scaling.apply(&[0.1, 2.0, -3.0]));
        assert!((back[1] - 2.0).abs() < 1e-13 && (back[2] + 3.0).abs() < 1e-13);
    }

    #[test]
    fn division_undoes_the_product() {
        let (u, v) = ([2.0, 0.5, -1.0], [0.3, -4.0, 0.7]);
        let d = divide(&u, &v);
        let again = product(&u, &d);
        for i in 0..3 {
            assert!((again[i] - v[i]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_step_is_allowed_up_to_its_length() {
        let (z, d) = ([2.0, 0.5, -1.0], [-0.4, 3.0, 0.7]);
        let reach = step_length(&z, &d, 1.0);
        assert!(reach < 1.0);
        assert!(allows(&z, &d, 0.999 * reach) && !allows(&z, &d, 1.001 * reach));
    }

    #[test]
    fn length_neither_overflows_nor_vanishes() {
        for scale in [1e-300, 1e-150, 1.0, 1e150, 1e300] {
            assert!((norm(&[3.0 * scale, -4.0 * scale]) / scale - 5.0).abs() < 1e-14);
        }
        assert_eq!(norm(&[0.0, 0.0]), 0.0);
        assert!(norm(&[f64::NAN, 1.0]).is_nan() && norm(&[f64::INFINITY, 1.0]).is_infinite());
    }

    #[test]
    fn step_stops_at_the_boundary() {
        let z = [1.0, 0.0, 0.0];
        assert!((step_length(&z, &[0.0, 4.0, 0.0], 1.0) - 0.25).abs() < 1e-15);
        assert!((step_length(&z, &[-2.0, 0.0, 0.0], 1.0) - 0.5).abs() < 1e-15);
        assert_eq!(step_length(&z, &[1.0, 0.5, 0.0], 0.9), 1.0);
        assert!(slack(&[1.0, 0.6, 0.8]).abs() < 1e-15);
    }
}
