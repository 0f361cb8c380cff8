//! How freely a link's wrench may move inside its cone.
//!
//! The Hessian of the cone's logarithmic barrier at a wrench is the inverse of
//! `C C'`, with one column of C per variable: what is near its limit moves least.
//! Only a metric, nothing is proved with it: a wrench outside the cone is
//! treated as one near its axis.

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::connector::{Connector, Model};
use super::super::structure::Structure;

/// Depth inside the cone that every wrench is taken to have at least, as a share
/// of what presses or holds there.
const DEPTH: f64 = 1e-3;

/// Room of a component without limits, as a multiple of the typical force.
const UNLIMITED: f64 = 1e3;

/// The columns of C, as wrenches in the link's frame.
pub(super) type Columns = Vec<Wrench>;

/// Room around `wrench` of a link at which strengths are `level` times the rated
/// ones. `force` is the typical force through the link, `lever` its distance
/// from its bodies' centres of mass.
pub(super) fn room(
    structure: &Structure,
    link: Link,
    wrench: &Wrench,
    level: f64,
    force: f64,
    lever: f64,
) -> Columns {
    let mut columns = Vec::with_capacity(6);
    match link {
        Link::Contact(i) => {
            let friction = structure.contacts[i].friction;
            point(&mut columns, &wrench.force, friction, &Vec3::zeros(), DEPTH * force);
        }
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            connection(&mut columns, connector, wrench, level, force, lever);
        }
    }
    columns
}

fn connection(columns: &mut Columns, connector: &Connector, wrench: &Wrench, level: f64, force: f64, lever: f64) {
    let Wrench { force: f, torque: m } = wrench;
    let held = level * connector.strength;
    match &connector.model {
        Model::Cone { friction: [a, b], radius: [c, d, e] } => {
            let units = [1.0, *a, *b, *c, *d, *e];
            let z = [held + f.z, f.x / a, f.y / b, m.x / c, m.y / d, m.z / e];
            let root = square_root(&z, DEPTH * (held + force));
            for column in quadratic(&root) {
                let v: [f64; 6] = std::array::from_fn(|k| column[k] * units[k]);
                columns.push(Wrench::new(Vec3::new(v[1], v[2], v[0]), Vec3::new(v[3], v[4], v[5])));
            }
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            let components = [
                (f.x, shear[0], shear[0]),
                (f.y, shear[1], shear[1]),
                (f.z, *tension, *compression),
                (m.x, bending[0], bending[0]),
                (m.y, bending[1], bending[1]),
                (m.z, *torsion, *torsion),
            ];
            for (k, (value, negative, positive)) in components.into_iter().enumerate() {
                let typical = if k < 3 { force } else { force * lever };
                let slack = |limit: f64, towards: f64| {
                    if limit.is_finite() { (level * limit + towards).max(DEPTH * level * limit) } else { f64::INFINITY }
                };
                let (p, q) = (slack(negative, value), slack(positive, -value));
                // Harmonic in the squares: the smaller one rules.
                let room = (p.powi(-2) + q.powi(-2)).powf(-0.5).min(UNLIMITED * typical);
                let axis = Vec3::ith(k % 3, room);
                columns.push(if k < 3 {
                    Wrench::new(axis, Vec3::zeros())
                } else {
                    Wrench::new(Vec3::zeros(), axis)
                });
            }
        }
        Model::Patch { friction, points } => {
            for (p, force) in points.iter().zip(super::carry::pressures(wrench, held, points)) {
                let at = Vec3::new(p[0], p[1], 0.0);
                let share = force.z / (held + f.z).max(DEPTH * held);
                let shear = Vec3::new(f.x * share, f.y * share, force.z);
                point(columns, &shear, *friction, &at, DEPTH * held);
            }
        }
    }
}

/// Room of a force in a friction cone at a point of the link's frame.
fn point(columns: &mut Columns, force: &Vec3, friction: f64, at: &Vec3, depth: f64) {
    if friction > 0.0 {
        let z = [force.z, force.x / friction, force.y / friction];
        let root = square_root(&z, depth);
        for [normal, x, y] in quadratic(&root) {
            let force = Vec3::new(x * friction, y * friction, normal);
            columns.push(Wrench::new(force, at.cross(&force)));
        }
    } else {
        let force = Vec3::z() * force.z.max(depth);
        columns.push(Wrench::new(force, at.cross(&force)));
    }
}

/// The Jordan square root of `z`, with `depth` added to its head where it is not
/// that far inside the cone.
fn square_root<const N: usize>(z: &[f64; N], depth: f64) -> [f64; N] {
    let tail = z[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
    let head = z[0].max(tail + depth.max(f64::MIN_POSITIVE));
    let (large, small) = ((head + tail).sqrt(), (head - tail).sqrt());
    let along = if tail > 0.0 { (large - small) / (2.0 * tail) } else { 0.0 };
    std::array::from_fn(|k| if k == 0 { (large + small) / 2.0 } else { z[k] * along })
}

/// Rows of the quadratic representation `2 z z' - det(z) J`, a symmetric matrix.
fn quadratic<const N: usize>(z: &[f64; N]) -> [[f64; N]; N] {
    let tail: f64 = z[1..].iter().map(|x| x * x).sum();
    let determinant = z[0] * z[0] - tail;
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = match (i == j, i) {
                (false, _) => 0.0,
                (true, 0) => determinant,
                (true, _) => -determinant,
            };
            2.0 * z[i] * z[j] - unit
        })
    })
}
