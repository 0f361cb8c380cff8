//! A block's stiffness where every link gives way as far as its cone has room.
//!
//! With the columns C of `room` and the map A from link wrenches to the bodies'
//! balances, the change of a wrench field that is least in the cones' metric and
//! balances a residual r is `C C' A' v` with `(A C C' A') v = -r`: one
//! factorisation on the body graph. The same matrix is the stiffness of the
//! bodies' twists, soft where links are near their limits.

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::balance::residuals;
use super::super::bracket::Problem;
use super::super::program::local_body;
use super::super::stiffness::Stiffness;
use super::room::Rooms;

/// Rounds of correction; each is as accurate as the factorisation.
const ROUNDS: usize = 3;

/// Imbalance, relative to what flows through a body, that needs no correction.
const BALANCED: f64 = 1e-13;

/// A column's part in the balance of one body, torques over the body's lever.
type Rows = [f64; 6];

/// Factored stiffness of a block.
pub(super) struct Give {
    stiffness: Stiffness,
    rooms: Rooms,
    /// Per link: the bodies that need balance, by their index in the block.
    bodies: Vec<[Option<usize>; 2]>,
    /// Per column: its part in the balances of those.
    parts: Vec<[Rows; 2]>,
}

impl Give {
    pub(super) fn new(problem: &Problem<'_>, rooms: Rooms) -> Self {
        let Problem { block, program, .. } = *problem;
        let local = |l: usize| program.frames[l].sides().map(|(side, _)| local_body(block, side));
        let bodies: Vec<[Option<usize>; 2]> = (0..block.links.len()).map(local).collect();
        let pairs = bodies.iter().filter_map(|[a, b]| Some(((*a)?, (*b)?)));
        let stiffness = Stiffness::new(block.bodies.len(), pairs);
        let mut give = Self { stiffness, rooms, bodies, parts: Vec::new() };
        give.factorise(problem);
        give
    }

    /// The same block at other rooms: the pattern stays.
    pub(super) fn renew(&mut self, problem: &Problem<'_>, rooms: Rooms) {
        self.rooms = rooms;
        self.stiffness.clear();
        self.factorise(problem);
    }

    fn factorise(&mut self, problem: &Problem<'_>) {
        let Problem { structure, block, program, .. } = *problem;
        self.parts.clear();
        for (l, bodies) in self.bodies.iter().enumerate() {
            let frame = &program.frames[l];
            for column in &self.rooms.columns[self.rooms.first[l]..self.rooms.first[l + 1]] {
                let mut parts = [[0.0; 6]; 2];
                let mut squared = [(0, [0.0; 6]); 2];
                let mut count = 0;
                for ((body, part), (_, sign)) in bodies.iter().zip(&mut parts).zip(frame.sides()) {
                    if let Some(i) = *body {
                        let here = frame.to_body(column, &structure.bodies[block.bodies[i]].com) * sign;
                        *part = rows(&here, program.scales.lever[i].recip());
                        squared[count] = (i, *part);
                        count += 1;
                    }
                }
                self.stiffness.add_square(&squared[..count]);
                self.parts.push(parts);
            }
        }
        self.stiffness.factorise();
    }

    /// Moves `field` towards the middles of the cones by the share `centring` of
    /// what the barrier asks for, and to balance. Returns the twists that the
    /// change came from: what resists them is least near its limit, so where the
    /// loads are too large, this is the way in which they win.
    pub(super) fn balance(&self, problem: &Problem<'_>, field: &mut [Wrench], centring: f64) -> Vec<Twist> {
        for (wrench, centre) in field.iter_mut().zip(&self.rooms.centres) {
            *wrench += *centre * centring;
        }
        let mut total = vec![0.0; 6 * problem.block.bodies.len()];
        for _ in 0..ROUNDS {
            let lacking = lacking(problem, field);
            if imbalance(problem, &lacking) <= BALANCED {
                break;
            }
            let levers = &problem.program.scales.lever;
            let wanted: Vec<f64> =
                lacking.iter().zip(levers).flat_map(|(wrench, lever)| rows(wrench, lever.recip())).collect();
            let v = self.stiffness.backward(self.stiffness.forward(&wanted));
            if !v.iter().all(|x| x.is_finite()) {
                break;
            }
            for (l, wrench) in field.iter_mut().enumerate() {
                for (column, along) in self.along(l, &v) {
                    *wrench += self.rooms.columns[column] * -along;
                }
            }
            for (sum, v) in total.iter_mut().zip(&v) {
                *sum += v;
            }
        }
        twists(problem, &total)
    }

    /// The columns of a link, each with how far twists move along it.
    fn along<'a>(&'a self, link: usize, v: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        (self.rooms.first[link]..self.rooms.first[link + 1]).map(move |column| {
            let mut sum = 0.0;
            for (body, part) in self.bodies[link].iter().zip(&self.parts[column]) {
                if let Some(i) = body {
                    sum += part.iter().zip(&v[6 * i..6 * i + 6]).map(|(a, b)| a * b).sum::<f64>();
                }
            }
            (column, sum)
        })
    }

    /// The twist field nearest to `field`, in the metric of this stiffness, in
    /// which the `locked` links hardly move.
    pub(super) fn lock(&self, problem: &Problem<'_>, field: &[Twist], locked: &[bool]) -> Vec<Twist> {
        let levers = &problem.program.scales.lever;
        let scaled = |(twist, lever): (&Twist, &f64)| rows(&Wrench::new(twist.linear, twist.angular), *lever);
        let v: Vec<f64> = field.iter().zip(levers).flat_map(scaled).collect();
        let mut pull = vec![0.0; v.len()];
        for l in (0..locked.len()).filter(|&l| locked[l]) {
            for (column, along) in self.along(l, &v) {
                for (body, part) in self.bodies[l].iter().zip(&self.parts[column]) {
                    if let Some(i) = body {
                        for (row, entry) in pull[6 * i..6 * i + 6].iter_mut().zip(part) {
                            *row -= entry * along;
                        }
                    }
                }
            }
        }
        let change = twists(problem, &self.stiffness.backward(self.stiffness.forward(&pull)));
        let add = |(a, b): (&Twist, &Twist)| Twist::new(a.linear + b.linear, a.angular + b.angular);
        field.iter().zip(&change).map(add).collect()
    }
}

/// What every body of the block lacks for balance.
pub(super) fn lacking(problem: &Problem<'_>, field: &[Wrench]) -> Vec<Wrench> {
    residuals(problem.structure, problem.block, problem.program, problem.loads, field)
}

/// Whether `lacking` is nothing but rounding.
pub(super) fn balances(problem: &Problem<'_>, lacking: &[Wrench]) -> bool {
    imbalance(problem, lacking) <= 10.0 * BALANCED
}

/// The largest of what bodies lack, relative to what flows through them.
fn imbalance(problem: &Problem<'_>, lacking: &[Wrench]) -> f64 {
    let scales = &problem.program.scales;
    let sizes = scales.force.iter().zip(&scales.lever);
    let relative =
        lacking.iter().zip(sizes).map(|(w, (force, lever))| (w.force.norm() + w.torque.norm() / lever) / force);
    relative.fold(0.0, f64::max)
}

fn rows(wrench: &Wrench, factor: f64) -> Rows {
    let (f, m) = (&wrench.force, wrench.torque * factor);
    [f.x, f.y, f.z, m.x, m.y, m.z]
}

/// The twists that scaled multipliers of the balances stand for.
fn twists(problem: &Problem<'_>, v: &[f64]) -> Vec<Twist> {
    let twist = |(i, lever): (usize, &f64)| {
        let v = &v[6 * i..6 * i + 6];
        Twist::new(Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]) / *lever)
    };
    problem.program.scales.lever.iter().enumerate().map(twist).collect()
}
