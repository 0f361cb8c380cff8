//! Unit quaternions, directions and the 24 rotations of a cube.

use nalgebra::{Matrix3, Quaternion, Rotation3, Unit};

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire::Real;
use crate::robot::{Face, Orientation};
use crate::spatial::{Rotation, Vec3};

/// How far a unit quaternion or normal may be off unit length, as the formats
/// say: six digits written by hand pass, a forgotten component does not.
const UNIT: f64 = 1e-6;

/// Up to this distance from unit length, the roundings of a chain of turns, normalising again
/// would only change the last bits, and what is written could not be read back equal.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The rotation of a quaternion `[x, y, z, w]`, normalised.
pub(super) fn rotation(xyzw: [Real; 4], place: &Place<'_>, findings: &mut Findings) -> Rotation {
    let [x, y, z, w] = xyzw.map(|real| real.0);
    let quaternion = Quaternion::new(w, x, y, z);
    let off = (quaternion.norm() - 1.0).abs();
    if off <= ROUNDING {
        return Rotation::new_unchecked(quaternion);
    }
    if off > UNIT || off.is_nan() {
        let message = format!("a quaternion must have length 1, found {:.6}", quaternion.norm());
        findings.add(place, codes::NOT_UNIT, message, quaternion_hint(quaternion));
        return Rotation::identity();
    }
    Rotation::new_normalize(quaternion)
}

fn quaternion_hint(quaternion: Quaternion<f64>) -> Option<String> {
    let norm = quaternion.norm();
    if !(norm > 0.0 && norm.is_finite()) {
        return Some("no rotation is [0, 0, 0, 1]".to_string());
    }
    let [x, y, z, w] = [quaternion.i, quaternion.j, quaternion.k, quaternion.w].map(|part| part / norm);
    Some(format!("the order is x, y, z, w; normalised it is [{x:.6}, {y:.6}, {z:.6}, {w:.6}]"))
}

/// A unit normal, normalised.
pub(super) fn normal(components: [Real; 3], place: &Place<'_>, findings: &mut Findings) -> Vec3 {
    let normal = vector(components);
    let length = normal.norm();
    let off = (length - 1.0).abs();
    if off <= ROUNDING {
        return normal;
    }
    if off > UNIT || off.is_nan() {
        let hint = (length > 0.0 && length.is_finite()).then(|| {
            let unit = normal / length;
            format!("normalised it is [{:.6}, {:.6}, {:.6}]", unit.x, unit.y, unit.z)
        });
        findings.add(place, codes::NOT_UNIT, format!("a normal must have length 1, found {length:.6}"), hint);
        return Vec3::z();
    }
    normal / length
}

/// A direction of any length but zero, normalised; `None` where there is none.
pub(super) fn direction(components: [Real; 3], place: &Place<'_>, findings: &mut Findings) -> Option<Unit<Vec3>> {
    let found = unit(components);
    if found.is_none() {
        let hint = "any length does, but it must point somewhere, e.g. [0, 0, 1]".to_string();
        findings.add(place, codes::NOT_UNIT, "a direction of length 0 says nothing", hint);
    }
    found
}

fn unit(components: [Real; 3]) -> Option<Unit<Vec3>> {
    let given = vector(components);
    if (given.norm() - 1.0).abs() <= ROUNDING {
        return Some(Unit::new_unchecked(given));
    }
    // Scaled first, so that no square overflows or vanishes.
    let largest = given.amax();
    (largest > 0.0).then(|| Unit::new_normalize(given / largest))
}

/// Cosine of the angle to the body's x axis up to which a port's x axis is taken from it.
const ASIDE: f64 = 0.9;

/// The frame of a port: z along `axis`, x as close to `x_axis` as may be, by default to the body's x axis,
/// or to its y axis where `axis` is close to x. `place` is that of the port.
pub(super) fn frame_along(
    axis: [Real; 3],
    x_axis: Option<[Real; 3]>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Rotation> {
    let z = direction(axis, &place.key("axis"), findings);
    let given = match x_axis {
        Some(x) => Some(direction(x, &place.key("x_axis"), findings)?),
        None => None,
    };
    let z = z?;
    let near = given.unwrap_or(if z.x.abs() <= ASIDE { Vec3::x_axis() } else { Vec3::y_axis() });
    let found = axes(&z, &near);
    if found.is_none() {
        let hint = "it says how the connector is turned about `axis`: choose a direction across it".to_string();
        findings.add(&place.key("x_axis"), codes::NOT_UNIT, "is parallel to `axis`", hint);
    }
    found
}

/// The rotation that a port's `axis` and `x_axis` say when they are read.
pub(in super::super) fn port_rotation(axis: [Real; 3], x_axis: [Real; 3]) -> Option<Rotation> {
    let [z, x] = [axis, x_axis].map(unit);
    axes(&z?, &x?)
}

/// The rotation to axes with this z, and x as close to `near` as may be; `None` where they are parallel.
fn axes(z: &Unit<Vec3>, near: &Unit<Vec3>) -> Option<Rotation> {
    let z = z.into_inner();
    let across = near.into_inner() - z * near.dot(&z);
    if !(across.norm() > UNIT) {
        return None;
    }
    let x = across.normalize();
    let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
    Some(Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)))
}

/// A vector from three numbers.
pub(super) fn vector(components: [Real; 3]) -> Vec3 {
    Vec3::from(components.map(|real| real.0))
}

/// The rotation of a cube that a quaternion stands for.
pub(super) fn orientation(xyzw: [Real; 4], place: &Place<'_>, findings: &mut Findings) -> Orientation {
    let wanted = rotation(xyzw, place, findings);
    // Half the angle is its arc sine, so a thousandth of a degree passes.
    const SAME: f64 = 1e-5;
    let same = |candidate: &Orientation| {
        let found = candidate.rotation();
        let distance = |sign: f64| (wanted.coords - found.coords * sign).norm();
        distance(1.0).min(distance(-1.0)) <= SAME
    };
    all_orientations().find(same).unwrap_or_else(|| {
        let hint =
            "the axes of a cube lie along the world's: the components are 0, 0.5, 0.70710678 or 1, or their negatives";
        findings.add(place, codes::NOT_UNIT, "not one of the 24 rotations of a lattice module", hint.to_string());
        Orientation::IDENTITY
    })
}

/// The 24 rotations of a cube: a face up, then four turns about it.
pub(crate) fn all_orientations() -> impl Iterator<Item = Orientation> {
    let quarter = Orientation::quarter_turn;
    let up = [
        Orientation::IDENTITY,
        quarter(Face::PosX),
        quarter(Face::NegX),
        quarter(Face::PosY),
        quarter(Face::NegY),
        quarter(Face::PosX).turned(quarter(Face::PosX)),
    ];
    up.into_iter().flat_map(move |tilt| {
        (0..4).scan(tilt, move |turned, _| {
            let this = *turned;
            *turned = turned.turned(quarter(Face::PosZ));
            Some(this)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::all_orientations;

    #[test]
    fn a_cube_has_24_rotations() {
        let mut all: Vec<_> = all_orientations().collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 24);
    }
}
