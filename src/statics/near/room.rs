//! How freely the wrenches of a block's links may move inside their cones.
//!
//! The Hessian of a cone's logarithmic barrier at a wrench is the inverse of
//! `C C'`, with one column of C per variable of the cone: what is near its limit
//! moves least. Only a metric, nothing is proved with it, so a wrench outside its
//! cone is taken to be just inside. A face has a cone at every point.
//!
//! Source: Nesterov and Todd (1997); the quadratic representation of a
//! second-order cone, as in `second_order`.

use nalgebra::{Matrix3, Matrix6, Vector6};

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::{Connector, Model};
use super::super::program::local_body;
use super::super::second_order::norm;
use super::field::{Field, face};

/// Depth inside the cone that every wrench is taken to have at least, relative to
/// what presses or holds there.
const DEPTH: f64 = 1e-3;

/// Room of what is not limited, relative to the typical force.
const UNLIMITED: f64 = 1e3;

/// Room of all links of a block at one field.
#[derive(Default)]
pub(super) struct Rooms {
    /// `C C'` of each link, on wrenches in its frame.
    pub metrics: Vec<Matrix6<f64>>,
    /// The same of each point of the faces, on its force.
    pub points: Vec<Matrix3<f64>>,
    /// The step towards the middles of the cones that the barrier asks for.
    pub centres: Field,
}

impl Rooms {
    /// At `field`, with strengths `level` times the rated ones.
    pub(super) fn new(problem: &Problem<'_>, field: &Field, level: f64) -> Self {
        let Problem { structure, block, program, .. } = *problem;
        let mut rooms = Self::default();
        let mut points = field.points.iter();
        for (l, (&link, wrench)) in block.links.iter().zip(&field.wrenches).enumerate() {
            let force = program.scales.link[l];
            rooms.metrics.push(Matrix6::zeros());
            let centre = match link {
                Link::Contact(i) => {
                    let columns = point_columns(&wrench.force, structure.contacts[i].friction, DEPTH * force);
                    for column in &columns {
                        rooms.push(&Wrench::new(*column, Vec3::zeros()));
                    }
                    Wrench::new(columns[0], Vec3::zeros())
                }
                Link::Connection(i) => {
                    let connector = &structure.connectors[structure.connections[i].connector];
                    match (&connector.model, face(structure, link)) {
                        (Model::Patch { friction, .. }, Some(face)) => {
                            let mut centre = Wrench::ZERO;
                            for (p, force) in face.points.iter().zip(&mut points) {
                                centre += rooms.add_point(force, *friction, p, DEPTH * face.preload(level));
                            }
                            centre
                        }
                        _ => {
                            let sides = program.frames[l].sides().into_iter();
                            let bodies = sides.filter_map(|(side, _)| local_body(block, side));
                            let lever = bodies.map(|i| program.scales.lever[i]).fold(0.0, f64::max);
                            rooms.add_connection(connector, wrench, level, force, lever)
                        }
                    }
                }
            };
            rooms.centres.wrenches.push(centre);
        }
        rooms
    }

    /// Adds a column of C to the metric of the last link.
    fn push(&mut self, column: &Wrench) {
        let Wrench { force: f, torque: m } = column;
        let column = Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
        if let Some(metric) = self.metrics.last_mut() {
            metric.ger(1.0, &column, &column, 1.0);
        }
    }

    fn add_connection(&mut self, connector: &Connector, wrench: &Wrench, level: f64, force: f64, lever: f64) -> Wrench {
        let Wrench { force: f, torque: m } = wrench;
        let held = level * connector.strength;
        match &connector.model {
            Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                let z = [held + f.z, f.x / a, f.y / b, m.x / c, m.y / d, m.z / e];
                let columns = columns(&z, DEPTH * (held + force));
                let wrenches = columns
                    .map(|v| Wrench::new(Vec3::new(v[1] * a, v[2] * b, v[0]), Vec3::new(v[3] * c, v[4] * d, v[5] * e)));
                for column in &wrenches {
                    self.push(column);
                }
                wrenches[0]
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
                let mut centre = Wrench::ZERO;
                for (k, (value, negative, positive)) in components.into_iter().enumerate() {
                    let typical = UNLIMITED * force * if k < 3 { 1.0 } else { lever };
                    let slack = |limit: f64, towards: f64| (level * limit + towards).max(DEPTH * level * limit);
                    let (p, q) = (slack(negative, value), slack(positive, -value));
                    // 1 / room^2 = 1 / p^2 + 1 / q^2, the second derivative of -log p - log q.
                    let room = (p.powi(-2) + q.powi(-2)).powf(-0.5).min(typical);
                    self.push(&component(k, room));
                    if room > 0.0 {
                        centre += component(k, room * room * (1.0 / p - 1.0 / q));
                    }
                }
                centre
            }
            Model::Patch { .. } => Wrench::ZERO,
        }
    }

    /// Room of a force at a point of a face.
    fn add_point(&mut self, force: &Vec3, friction: f64, p: &[f64; 2], depth: f64) -> Wrench {
        let at = Vec3::new(p[0], p[1], 0.0);
        let columns = point_columns(force, friction, depth);
        let mut metric = Matrix3::zeros();
        for column in &columns {
            metric.ger(1.0, column, column, 1.0);
            self.push(&Wrench::new(*column, at.cross(column)));
        }
        self.points.push(metric);
        self.centres.points.push(columns[0]);
        Wrench::new(columns[0], at.cross(&columns[0]))
    }
}

/// The columns of C of a force in a friction cone, itself the first.
fn point_columns(force: &Vec3, friction: f64, depth: f64) -> [Vec3; 3] {
    if friction > 0.0 {
        let z = [force.z, force.x / friction, force.y / friction];
        columns(&z, depth).map(|[normal, x, y]| Vec3::new(x * friction, y * friction, normal))
    } else {
        [Vec3::z() * force.z.max(depth), Vec3::zeros(), Vec3::zeros()]
    }
}

fn component(k: usize, value: f64) -> Wrench {
    let axis = Vec3::ith(k % 3, value);
    if k < 3 { Wrench::new(axis, Vec3::zeros()) } else { Wrench::new(Vec3::zeros(), axis) }
}

/// The symmetric square root of the quadratic representation of `z`, its first
/// column `z` itself; of a point `depth` inside where `z` is not that far inside.
fn columns<const N: usize>(z: &[f64; N], depth: f64) -> [[f64; N]; N] {
    let tail = norm(&z[1..]);
    let head = z[0].max(tail + depth.max(f64::MIN_POSITIVE));
    let (large, small) = ((head + tail).sqrt(), (head - tail).sqrt());
    let along = if tail > 0.0 { (large - small) / (2.0 * tail) } else { 0.0 };
    let root: [f64; N] = std::array::from_fn(|k| if k == 0 { (large + small) / 2.0 } else { z[k] * along });
    let determinant = large * small;
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = if i != j {
                0.0
            } else if i == 0 {
                determinant
            } else {
                -determinant
            };
            2.0 * root[i] * root[j] - unit
        })
    })
}
