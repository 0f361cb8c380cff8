//! How freely the wrenches of a block's links may move inside their cones.
//!
//! The Hessian of a cone's logarithmic barrier at a wrench z is the inverse of
//! `C C' = 2 z z' - det(z) J`, the quadratic representation of z: what is near its limit
//! moves least, and z itself is the step towards the middle. Only a metric, nothing is
//! proved with it, so a wrench outside its cone is taken to be just inside. A face has a
//! cone at every point.
//!
//! Source: Nesterov and Todd (1997); the quadratic representation of a
//! second-order cone, as in `second_order`.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::{Connector, Model};
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
    /// Per link, how many points come before its own.
    pub first_point: Vec<usize>,
    /// The step towards the middles of the cones that the barrier asks for.
    pub centres: Field,
}

impl Rooms {
    /// At `field`, with strengths `level` times the rated ones.
    pub(super) fn new(problem: &Problem<'_>, field: &Field, level: f64) -> Self {
        let Problem { structure, block, program, .. } = *problem;
        let links = block.links.len();
        let mut rooms = Self::default();
        rooms.metrics.reserve_exact(links);
        rooms.first_point.reserve_exact(links);
        rooms.centres.wrenches.reserve_exact(links);
        rooms.points.reserve_exact(field.points.len());
        rooms.centres.points.reserve_exact(field.points.len());
        let mut points = field.points.iter();
        for (l, (&link, wrench)) in block.links.iter().zip(&field.wrenches).enumerate() {
            let force = program.scales.link[l];
            rooms.metrics.push(Matrix6::zeros());
            rooms.first_point.push(rooms.points.len());
            let centre = match link {
                Link::Contact(i) => {
                    let (force, room) = point(&wrench.force, structure.contacts[i].friction, DEPTH * force);
                    rooms.add(&[[&room, &Matrix3::zeros()], [&Matrix3::zeros(), &Matrix3::zeros()]]);
                    Wrench::new(force, Vec3::zeros())
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
                        _ => rooms.add_connection(connector, wrench, level, force, program.lever_of(l)),
                    }
                }
            };
            rooms.centres.wrenches.push(centre);
        }
        rooms
    }

    /// Adds blocks to the metric of the last link.
    fn add(&mut self, [[ff, fm], [mf, mm]]: &[[&Matrix3<f64>; 2]; 2]) {
        if let Some(metric) = self.metrics.last_mut() {
            for (block, at) in [(ff, (0, 0)), (fm, (0, 3)), (mf, (3, 0)), (mm, (3, 3))] {
                let mut view = metric.fixed_view_mut::<3, 3>(at.0, at.1);
                view += *block;
            }
        }
    }

    fn add_connection(&mut self, connector: &Connector, wrench: &Wrench, level: f64, force: f64, lever: f64) -> Wrench {
        let Wrench { force: f, torque: m } = wrench;
        let held = level * connector.strength;
        match &connector.model {
            Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                let z = [held + f.z, f.x / a, f.y / b, m.x / c, m.y / d, m.z / e];
                let (z, determinant) = inside(&z, DEPTH * (held + force));
                let wrench = [z[1] * a, z[2] * b, z[0], z[3] * c, z[4] * d, z[5] * e];
                let squares = Vector6::from([a * a, b * b, -1.0, c * c, d * d, e * e]);
                let along = Vector6::from(wrench);
                if let Some(metric) = self.metrics.last_mut() {
                    metric.ger(2.0, &along, &along, 0.0);
                    for k in 0..6 {
                        metric[(k, k)] += determinant * squares[k];
                    }
                }
                Wrench::new(along.fixed_rows::<3>(0).into(), along.fixed_rows::<3>(3).into())
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
                    if let Some(metric) = self.metrics.last_mut() {
                        metric[(k, k)] = room * room;
                    }
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
        let (force, room) = point(force, friction, depth);
        let lever = at.cross_matrix();
        let torque = lever * room;
        self.add(&[[&room, &torque.transpose()], [&torque, &(torque * lever.transpose())]]);
        self.points.push(room);
        self.centres.points.push(force);
        Wrench::new(force, at.cross(&force))
    }
}

/// A force in a friction cone, inside it, and its room there.
fn point(force: &Vec3, friction: f64, depth: f64) -> (Vec3, Matrix3<f64>) {
    if !(friction > 0.0) {
        let pressed = Vec3::z() * force.z.max(depth);
        return (pressed, pressed * pressed.transpose());
    }
    let ([normal, x, y], determinant) = inside(&[force.z, force.x / friction, force.y / friction], depth);
    let force = Vec3::new(x * friction, y * friction, normal);
    let squares = Vector3::new(friction * friction, friction * friction, -1.0);
    (force, force * force.transpose() * 2.0 + Matrix3::from_diagonal(&(squares * determinant)))
}

fn component(k: usize, value: f64) -> Wrench {
    let axis = Vec3::ith(k % 3, value);
    if k < 3 { Wrench::new(axis, Vec3::zeros()) } else { Wrench::new(Vec3::zeros(), axis) }
}

/// `z`, or where that is not as far inside its cone the point at `depth` that has its tail, and
/// the determinant there.
fn inside<const N: usize>(z: &[f64; N], depth: f64) -> ([f64; N], f64) {
    let tail = norm(&z[1..]);
    let mut inside = *z;
    inside[0] = z[0].max(tail + depth.max(f64::MIN_POSITIVE));
    (inside, (inside[0] - tail) * (inside[0] + tail))
}
