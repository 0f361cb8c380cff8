//! Moves a wrench field to balance, in the metric of the cones it lies in.

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::balance::residuals;
use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::program::local_body;
use super::super::stiffness::Stiffness;
use super::room::{Columns, room};

/// Rounds of correction, each as accurate as the factorisation.
const ROUNDS: usize = 3;

/// Imbalance, relative to what flows through a body, that counts as none.
const BALANCED: f64 = 1e-13;

/// A link's columns on the balances of its bodies.
struct Sides {
    bodies: usize,
    columns: Vec<[(usize, [f64; 6]); 2]>,
}

/// The largest imbalance of any body, relative to what flows through it.
pub(super) fn imbalance(problem: &Problem<'_>, lacking: &[Wrench]) -> f64 {
    let scales = &problem.program.scales;
    let relative = lacking.iter().enumerate().map(|(i, wrench)| {
        (wrench.force.norm() + wrench.torque.norm() / scales.lever[i]) / scales.force[i]
    });
    relative.fold(0.0, f64::max)
}

/// What every body of the block lacks for balance.
pub(super) fn lacking(problem: &Problem<'_>, field: &[Wrench]) -> Vec<Wrench> {
    residuals(problem.structure, problem.block, problem.program, problem.loads, field)
}

/// The block's stiffness where every link gives way as its cone has room.
pub(super) struct Give {
    stiffness: Stiffness,
    rooms: Vec<Columns>,
    sides: Vec<Sides>,
}

impl Give {
    pub(super) fn new(problem: &Problem<'_>, field: &[Wrench], level: f64, stiffened: Option<&[bool]>) -> Self {
        let Problem { structure, block, program, .. } = *problem;
        let lever = |l: usize| {
            let sides = program.frames[l].sides().into_iter().filter_map(|(side, _)| local_body(block, side));
            sides.map(|i| program.scales.lever[i]).fold(0.0, f64::max)
        };
        let rooms: Vec<Columns> = block
            .links
            .iter()
            .zip(field.iter())
            .enumerate()
            .map(|(l, (&link, wrench))| {
                let scale = program.scales.link[l];
                if stiffened.is_some_and(|s| s[l]) {
                    let size = 1e3 * (scale + match link { Link::Connection(i) => level * structure.connectors[structure.connections[i].connector].strength, Link::Contact(_) => 0.0 });
                    let n = if matches!(link, Link::Contact(_)) { 3 } else { 6 };
                    return (0..n).map(|k| if k < 3 { Wrench::new(Vec3::ith(k, size), Vec3::zeros()) } else { Wrench::new(Vec3::zeros(), Vec3::ith(k - 3, size * lever(l))) }).collect();
                }
                room(structure, link, wrench, level, scale, lever(l))
            })
            .collect();
        let sides: Vec<Sides> = rooms.iter().enumerate().map(|(l, columns)| on_bodies(problem, l, columns)).collect();
        let pairs = sides.iter().filter(|sides| sides.bodies == 2).map(|sides| (sides.columns[0][0].0, sides.columns[0][1].0));
        let mut stiffness = Stiffness::new(block.bodies.len(), pairs);
        for link in &sides {
            for column in &link.columns {
                stiffness.add_square(&column[..link.bodies]);
            }
        }
        stiffness.factorise();
        Self { stiffness, rooms, sides }
    }

    /// Corrects `field` to balance; returns the twists.
    pub(super) fn project(&self, problem: &Problem<'_>, field: &mut [Wrench]) -> Vec<Twist> {
        let program = problem.program;
        let mut total = vec![0.0; 6 * problem.block.bodies.len()];
        for _ in 0..ROUNDS {
            let lacking = lacking(problem, field);
            if imbalance(problem, &lacking) <= BALANCED {
                break;
            }
            let rhs: Vec<f64> = lacking
                .iter()
                .enumerate()
                .flat_map(|(i, wrench)| {
                    let (f, m) = (wrench.force, wrench.torque / program.scales.lever[i]);
                    [-f.x, -f.y, -f.z, -m.x, -m.y, -m.z]
                })
                .collect();
            let v = self.stiffness.backward(self.stiffness.forward(&rhs));
            if !v.iter().all(|x| x.is_finite()) {
                break;
            }
            for (l, wrench) in field.iter_mut().enumerate() {
                for (column, pull) in self.rooms[l].iter().zip(self.pulls(l, &v)) {
                    *wrench += *column * pull;
                }
            }
            for (sum, v) in total.iter_mut().zip(&v) {
                *sum += v;
            }
        }
        twists(problem, &total, -1.0)
    }

    fn pulls<'a>(&'a self, link: usize, v: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let sides = &self.sides[link];
        sides.columns.iter().map(move |parts| {
            let along = parts[..sides.bodies].iter();
            along.map(|(i, part)| part.iter().zip(&v[6 * i..6 * i + 6]).map(|(a, b)| a * b).sum::<f64>()).sum()
        })
    }

    /// Least change of the twists that makes the stiffened links move as little as they may.
    pub(super) fn lock(&self, problem: &Problem<'_>, field: &[Twist], stiffened: &[bool]) -> Vec<Twist> {
        let levers = &problem.program.scales.lever;
        let v: Vec<f64> = field.iter().zip(levers).flat_map(|(t, lever)| {
            let (f, m) = (t.linear, t.angular * *lever);
            [f.x, f.y, f.z, m.x, m.y, m.z]
        }).collect();
        let mut rhs = vec![0.0; v.len()];
        for l in (0..self.rooms.len()).filter(|&l| stiffened[l]) {
            let pulls: Vec<f64> = self.pulls(l, &v).collect();
            let sides = &self.sides[l];
            for (parts, pull) in sides.columns.iter().zip(pulls) {
                for (i, part) in &parts[..sides.bodies] {
                    for (row, entry) in rhs[6 * i..6 * i + 6].iter_mut().zip(part) {
                        *row -= entry * pull;
                    }
                }
            }
        }
        let change = self.stiffness.backward(self.stiffness.forward(&rhs));
        let change = twists(problem, &change, 1.0);
        field.iter().zip(change).map(|(a, b)| Twist::new(a.linear + b.linear, a.angular + b.angular)).collect()
    }
}

/// Twists from balances' multipliers.
fn twists(problem: &Problem<'_>, v: &[f64], sign: f64) -> Vec<Twist> {
    let scaled = |i: usize| {
        let lever = problem.program.scales.lever[i];
        let part = &v[6 * i..6 * i + 6];
        Twist::new(Vec3::new(part[0], part[1], part[2]) * sign, Vec3::new(part[3], part[4], part[5]) * (sign / lever))
    };
    (0..problem.block.bodies.len()).map(scaled).collect()
}

/// The columns of a link as loads on its bodies, torques over the bodies' levers.
fn on_bodies(problem: &Problem<'_>, link: usize, columns: &[Wrench]) -> Sides {
    let Problem { structure, block, program, .. } = *problem;
    let frame = &program.frames[link];
    let mut bodies = [(0, 0.0, Vec3::zeros()); 2];
    let mut count = 0;
    for (side, sign) in frame.sides() {
        if let Some(i) = local_body(block, side) {
            bodies[count] = (i, sign, structure.bodies[block.bodies[i]].com);
            count += 1;
        }
    }
    let columns = columns
        .iter()
        .map(|column| {
            let mut parts = [(0, [0.0; 6]); 2];
            for (part, (i, sign, com)) in parts.iter_mut().zip(&bodies[..count]) {
                let here = frame.to_body(column, com) * *sign;
                let (f, m) = (here.force, here.torque / program.scales.lever[*i]);
                *part = (*i, [f.x, f.y, f.z, m.x, m.y, m.z]);
            }
            parts
        })
        .collect();
    Sides { bodies: count, columns }
}
