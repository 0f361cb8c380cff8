//! How freely the wrenches of a block's links may move inside their cones.
//!
//! The Hessian of a cone's logarithmic barrier at a wrench is the inverse of
//! `C C'`, with one column of C per variable of the cone: what is near its limit
//! moves least. Only a metric, nothing is proved with it, so a wrench outside its
//! cone is taken to be just inside, and a face's points share its wrench as they
//! would if they were springs.
//!
//! Source: Nesterov and Todd (1997); the quadratic representation of a
//! second-order cone, as in `second_order`.

use nalgebra::{Matrix6, Vector6};

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::{Connector, Model};
use super::super::program::local_body;
use super::super::second_order::norm;
use super::super::spread::Spread;

/// Depth inside the cone that every wrench is taken to have at least, relative to
/// what presses or holds there.
const DEPTH: f64 = 1e-3;

/// Room of what is not limited, and of a locked link, relative to the typical force.
const UNLIMITED: f64 = 1e3;

/// Room of all links of a block at one field.
#[derive(Default)]
pub(super) struct Rooms {
    /// `C C'` of each link, on wrenches in its frame.
    pub metrics: Vec<Matrix6<f64>>,
    /// Per link: the step towards the middle of its cone that the barrier asks for.
    pub centres: Vec<Wrench>,
}

impl Rooms {
    /// At `field`, with strengths `level` times the rated ones.
    pub(super) fn new(problem: &Problem<'_>, field: &[Wrench], level: f64) -> Self {
        Self::locking(problem, field, level, |_| false)
    }

    /// As `new`, but without resistance of some links to changes of their wrench:
    /// for twists, whose stiffness this is, they are locked.
    pub(super) fn locking(problem: &Problem<'_>, field: &[Wrench], level: f64, locked: impl Fn(usize) -> bool) -> Self {
        let Problem { structure, block, program, .. } = *problem;
        let mut rooms = Self::default();
        for (l, (&link, wrench)) in block.links.iter().zip(field).enumerate() {
            let force = program.scales.link[l];
            let sides = program.frames[l].sides().into_iter().filter_map(|(side, _)| local_body(block, side));
            let lever = sides.map(|i| program.scales.lever[i]).fold(0.0, f64::max);
            rooms.metrics.push(Matrix6::zeros());
            let centre = match link {
                Link::Contact(_) if locked(l) => rooms.lock(3, force, lever),
                Link::Contact(i) => {
                    let friction = structure.contacts[i].friction;
                    rooms.add_point(&wrench.force, friction, &Vec3::zeros(), DEPTH * force)
                }
                Link::Connection(i) => {
                    let connector = &structure.connectors[structure.connections[i].connector];
                    if locked(l) {
                        rooms.lock(6, force + level * connector.strength, lever)
                    } else {
                        rooms.add_connection(connector, wrench, level, force, lever)
                    }
                }
            };
            rooms.centres.push(centre);
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

    fn lock(&mut self, components: usize, force: f64, lever: f64) -> Wrench {
        for k in 0..components {
            self.push(&component(k, UNLIMITED * force * if k < 3 { 1.0 } else { lever }));
        }
        Wrench::ZERO
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
            Model::Patch { friction, points } => {
                let mut centre = Wrench::ZERO;
                let spread = Spread::new(points);
                let total = (held + f.z).max(DEPTH * held);
                for p in points {
                    let at = Vec3::new(p[0], p[1], 0.0);
                    let pressed = spread.force(p, &Wrench::new(Vec3::new(f.x, f.y, total), *m));
                    centre += self.add_point(&pressed, *friction, &at, DEPTH * held);
                }
                centre
            }
        }
    }

    /// Room of a force in a friction cone at a point of the link's frame.
    fn add_point(&mut self, force: &Vec3, friction: f64, at: &Vec3, depth: f64) -> Wrench {
        let at_origin = |force: Vec3| Wrench::new(force, at.cross(&force));
        if friction > 0.0 {
            let z = [force.z, force.x / friction, force.y / friction];
            let columns = columns(&z, depth);
            let columns = columns.map(|[normal, x, y]| at_origin(Vec3::new(x * friction, y * friction, normal)));
            for column in &columns {
                self.push(column);
            }
            columns[0]
        } else {
            let column = at_origin(Vec3::z() * force.z.max(depth));
            self.push(&column);
            column
        }
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
