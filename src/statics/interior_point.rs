//! A primal-dual interior-point method for a block's program.
//!
//! Nesterov-Todd direction, Mehrotra's predictor and corrector, infeasible
//! start; one factorisation of 6 x 6 blocks on the body graph per iteration (see
//! `normal`), where a general solver factorises a system of all variables. It
//! has no certificate for programs without a solution: it gets stuck, and `conic`,
//! which answers the same question, is asked instead. As with `conic`, nothing
//! that comes back is believed: see `bracket`.

use super::conic::Iterate;
use super::normal::{Metric, Normal, Solution, add_forces, array, velocities};
use super::program::{Cone, Form, Group, Program};
use super::respect::respect_unlimited;
use super::second_order::{aim, dot, shortened_step};

/// Scaled forces, opening velocities and t at the start: about what the spanning
/// tree carries.
const START: f64 = 1.0;

/// Largest step towards the boundary of a cone, as a share of the way.
const SHORTEN: f64 = 0.99;

/// Steps shorter than this get nowhere.
const LEAST_STEP: f64 = 1e-4;

/// Scaled bound on t above which the program counts as unsolvable.
const LARGEST: f64 = 1e9;

/// The method at work on a program: `x = (z, t)` and `s = c + A' v` inside their cones.
pub(super) struct InteriorPoint<'p> {
    program: &'p Program,
    normal: Normal<'p>,
    /// The program's groups, and t's.
    groups: Vec<Group>,
    /// Number of cones.
    degree: f64,
    /// Right-hand side: the loads, negative.
    wanted: Vec<f64>,
    cost: Vec<f64>,
    x: Vec<f64>,
    s: Vec<f64>,
    v: Vec<f64>,
    residuals: Residuals,
}

/// How far the iteration has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// Error in t, as far as the residuals show, relative to the larger of t and 1.
    pub error: f64,
    /// What the forces and the motion would prove of t if they lacked nothing.
    pub upper: f64,
    pub lower: f64,
    /// Scaled imbalance of the forces.
    pub imbalance: f64,
}

/// What an iterate lacks.
struct Residuals {
    /// `-L - A x`.
    balance: Vec<f64>,
    /// `c + A' v - s`.
    opening: Vec<f64>,
    gap: f64,
    /// The objective as the forces and as the motion give it.
    primal: f64,
    dual: f64,
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}

/// A direction of `x`, `s` and `v`.
struct Direction {
    x: Vec<f64>,
    s: Vec<f64>,
    v: Vec<f64>,
}

impl<'p> InteriorPoint<'p> {
    /// The start on `program`, with opening velocities inset by `inset` over all
    /// cones as in [`Attempt`](super::conic::Attempt).
    pub(super) fn new(program: &'p Program, inset: f64, in_series: bool) -> Self {
        let normal = Normal::new(program, in_series);
        let size = program.variables + 1;
        let mut groups = program.groups.clone();
        let heads = groups.iter().filter(|group| group.cone != Cone::Free).count() as f64;
        groups.push(Group {
            cone: Cone::NonNegative,
            first: size - 1,
            len: 1,
            link: 0,
            form: Form::Slack,
            scale: 1.0,
            rest: START,
            tie_row: None,
            ties: None,
        });
        let (mut cost, mut x, mut s) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        // No wrench anywhere, and the same complementarity in every cone.
        for group in groups.iter().filter(|group| group.cone != Cone::Free) {
            cost[group.first] = -inset / heads;
            x[group.first] = if group.len == 6 { group.rest.max(START) } else { START };
            s[group.first] = START / x[group.first];
        }
        cost[size - 1] = 1.0;
        let wanted = program.load.iter().map(|load| -load).collect();
        let v = vec![0.0; program.rows()];
        let residuals = Residuals { balance: Vec::new(), opening: Vec::new(), gap: 0.0, primal: 0.0, dual: 0.0 };
        let mut start = Self { program, normal, groups, degree: heads + 1.0, wanted, cost, x, s, v, residuals };
        start.residuals = start.residuals();
        start
    }

    fn residuals(&self) -> Residuals {
        let negative: Vec<f64> = self.x.iter().map(|x| -x).collect();
        let mut balance = self.wanted.clone();
        add_forces(self.program, &negative, &mut balance);
        let mut opening = velocities(self.program, &self.v);
        for ((opening, cost), s) in opening.iter_mut().zip(&self.cost).zip(&self.s) {
            *opening += cost - s;
        }
        let (primal, dual) = (dot(&self.cost, &self.x), -dot(&self.wanted, &self.v));
        Residuals { balance, opening, gap: dot(&self.x, &self.s), primal, dual }
    }

    /// How good the iterate is.
    pub(super) fn estimate(&self) -> Estimate {
        let Residuals { balance, opening, gap, primal, dual } = &self.residuals;
        let t_scale = self.program.t_scale;
        let scale = primal.abs().max(dual.abs()) + t_scale.recip().min(1.0);
        let imbalance = largest(balance);
        Estimate {
            error: gap.max(imbalance).max(1e2 * largest(opening)) / scale,
            upper: self.x[self.program.variables] * t_scale,
            lower: dual * t_scale,
            imbalance,
        }
    }

    /// One step; whether it got anywhere. Without a solution t or the motion grow
    /// without end.
    pub(super) fn step(&mut self) -> bool {
        let residuals = &self.residuals;
        if !(residuals.primal.abs().max(residuals.dual.abs()) < LARGEST) {
            return false;
        }
        let mut metrics = Vec::with_capacity(self.groups.len());
        let mut points = self.x.clone();
        for group in &self.groups {
            let Some(metric) = Metric::new(group.cone, group.part(&self.x), group.part(&self.s)) else { return false };
            match group.cone {
                Cone::Free => points[group.first] = 0.0,
                Cone::NonNegative | Cone::Lorentz => {
                    metric.apply(&mut points[group.first..group.first + group.len]);
                }
            }
            metrics.push(metric);
        }
        self.normal.factorise(&metrics);
        let affine: Vec<f64> = points.iter().map(|p| -p).collect();
        let predictor = self.direction(residuals, &metrics, affine, 1);
        let (reach_x, reach_s) = self.steps(&predictor, 1.0);
        let centring = (1.0 - reach_x.min(reach_s)).powi(3);
        let target = self.corrected(&metrics, &points, &predictor, centring * residuals.gap / self.degree);
        let direction = self.direction(residuals, &metrics, target, 2);
        let (step_x, step_s) = self.steps(&direction, SHORTEN);
        if !(step_x.min(step_s) > LEAST_STEP) {
            return false;
        }
        let move_along = |point: &mut [f64], direction: &[f64], step: f64| {
            for (p, d) in point.iter_mut().zip(direction) {
                *p += step * d;
            }
        };
        move_along(&mut self.x, &direction.x, step_x);
        move_along(&mut self.s, &direction.s, step_s);
        move_along(&mut self.v, &direction.v, step_s);
        self.residuals = self.residuals();
        true
    }

    /// The Newton direction towards `W x + W^-1 s = target` without residuals. A
    /// second round refines on the balance itself.
    fn direction(&self, residuals: &Residuals, metrics: &[Metric], target: Vec<f64>, rounds: usize) -> Direction {
        // W^-1 (target - W^-1 opening) is the change of x at a given opening.
        let change = |opening: &[f64]| {
            let mut change = opening.to_vec();
            for (group, metric) in self.groups.iter().zip(metrics) {
                let range = group.first..group.first + group.len;
                let part = &mut change[range.clone()];
                metric.apply_inverse(part);
                for (value, wanted) in part.iter_mut().zip(&target[range]) {
                    *value = wanted - *value;
                }
                metric.apply_inverse(part);
            }
            change
        };
        let mut s = residuals.opening.clone();
        let mut v = vec![0.0; self.v.len()];
        let mut x = change(&s);
        for _ in 0..rounds {
            let mut rhs: Vec<f64> = residuals.balance.iter().map(|b| -b).collect();
            add_forces(self.program, &x, &mut rhs);
            let Solution { v: correction, known } = self.normal.solve(&rhs);
            for (v, d) in v.iter_mut().zip(&correction) {
                *v += d;
            }
            // Forces are corrected, not computed anew: a stiff link turns the
            // rounding of its motion into force.
            let mut motion = velocities(self.program, &correction);
            for (s, d) in s.iter_mut().zip(&motion) {
                *s += d;
            }
            for (group, metric) in self.groups.iter().zip(metrics) {
                let part = &mut motion[group.first..group.first + group.len];
                metric.apply_inverse(part);
                metric.apply_inverse(part);
            }
            for (variable, force) in known {
                motion[variable] = force;
            }
            for (x, d) in x.iter_mut().zip(&motion) {
                *x -= d;
            }
        }
        for group in self.groups.iter().filter(|group| group.cone == Cone::Free) {
            s[group.first] = 0.0;
        }
        Direction { x, s, v }
    }

    /// Where the corrector aims: `l \ (mu e - l o l - W dx o W^-1 ds)` at the
    /// scaled point l.
    fn corrected(&self, metrics: &[Metric], points: &[f64], predictor: &Direction, mu: f64) -> Vec<f64> {
        let mut target = vec![0.0; points.len()];
        for (group, metric) in self.groups.iter().zip(metrics) {
            let range = group.first..group.first + group.len;
            let (mut dx, mut ds) = ([0.0; 6], [0.0; 6]);
            let (dx, ds) = (&mut dx[..group.len], &mut ds[..group.len]);
            dx.copy_from_slice(&predictor.x[range.clone()]);
            ds.copy_from_slice(&predictor.s[range.clone()]);
            metric.apply(dx);
            metric.apply_inverse(ds);
            let (point, target) = (&points[range.clone()], &mut target[range]);
            match (group.cone, group.len) {
                // No cone, nothing to be complementary to: W dx + W^-1 ds = 0.
                (Cone::Free, _) => {}
                (Cone::NonNegative, _) => target[0] = (mu - dx[0] * ds[0]) / point[0] - point[0],
                (Cone::Lorentz, 3) => target.copy_from_slice(&aim::<3>(&array(point), &array(dx), &array(ds), mu)),
                (Cone::Lorentz, _) => target.copy_from_slice(&aim::<6>(&array(point), &array(dx), &array(ds), mu)),
            }
        }
        target
    }

    /// Largest steps of x and s, at most 1, that stay in the cones, times `shorten`.
    fn steps(&self, direction: &Direction, shorten: f64) -> (f64, f64) {
        let longest = |point: &[f64], direction: &[f64]| {
            self.groups.iter().fold(1.0_f64, |step, group| {
                let range = group.first..group.first + group.len;
                let (p, d) = (&point[range.clone()], &direction[range]);
                match (group.cone, group.len) {
                    (Cone::Free, _) => step,
                    (Cone::NonNegative, _) => shortened_step::<1>(&array(p), &array(d), shorten, step),
                    (Cone::Lorentz, 3) => shortened_step::<3>(&array(p), &array(d), shorten, step),
                    (Cone::Lorentz, _) => shortened_step::<6>(&array(p), &array(d), shorten, step),
                }
            })
        };
        (longest(&self.x, &direction.x), longest(&self.s, &direction.s))
    }

    /// The iterate as it is.
    pub(super) fn iterate(&self) -> Iterate {
        let mut z = self.x.clone();
        let t = z.pop().expect("t is the last");
        let mut v = self.v.clone();
        respect_unlimited(self.program, &mut v);
        Iterate { v, z, t }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::spatial::{Pose, Rotation, Vec3};
    use crate::statics::blocks::cut;
    use crate::statics::conic::{self, Attempt};
    use crate::statics::connector::{Connector, Model};
    use crate::statics::loads::{lump, own_loads};
    use crate::statics::program::Purpose;
    use crate::statics::structure::{Anchor, Body, Connection, Contact, Structure};

    /// Two by two cubes of 0.1 m and 0.3 kg, joined in a ring; one side is held by
    /// a wall, the lower cubes may rest on the ground. Nothing can clamp itself.
    fn ring(model: &Model, friction: Option<f64>) -> Structure {
        let mut ring = Structure { gravity: Vec3::new(1.0, 0.5, -9.81), ..Structure::default() };
        ring.connectors.push(Connector { name: "c".to_owned(), strength: 20.0, model: model.clone() });
        let places = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1], [0.1, 0.1]];
        for [x, z] in places {
            ring.bodies.push(Body { mass: 0.3, com: Vec3::new(x, 0.0, z), fixed: false });
        }
        let sideways = Rotation::from_axis_angle(&Vec3::y_axis(), FRAC_PI_2);
        let upwards = Rotation::identity();
        let mut join = |parent, child, at: [f64; 2], rotation| {
            let frame = Pose::from_parts(Vec3::new(at[0], 0.0, at[1]).into(), rotation);
            ring.connections.push(Connection { parent, child, connector: 0, frame });
        };
        let body = Anchor::Body;
        join(body(0), body(1), [0.05, 0.0], sideways);
        join(body(2), body(3), [0.05, 0.1], sideways);
        join(body(0), body(2), [0.0, 0.05], upwards);
        join(body(1), body(3), [0.1, 0.05], upwards);
        join(Anchor::World, body(0), [-0.05, 0.0], sideways);
        join(Anchor::World, body(2), [-0.05, 0.1], sideways);
        if let Some(friction) = friction {
            for (index, x) in [0.0, 0.1].into_iter().enumerate() {
                for corner in [[0.04, 0.04], [-0.04, 0.04], [0.0, -0.04]] {
                    let position = Vec3::new(x + corner[0], corner[1], -0.05);
                    let (against, normal) = (Anchor::World, Vec3::z());
                    ring.contacts.push(Contact { body: index, against, position, normal, friction });
                }
            }
        }
        ring
    }

    fn models() -> Vec<Model> {
        let points = vec![[0.05, 0.05], [-0.05, 0.05], [-0.05, -0.05], [0.05, -0.05]];
        let latch = |compression, torsion| Model::Box {
            shear: [20.0, 10.0],
            tension: 20.0,
            compression,
            bending: [1.0, 2.0],
            torsion,
        };
        vec![
            Model::Cone { friction: [0.5, 0.4], radius: [0.03, 0.03, 0.04] },
            Model::Patch { friction: 0.4, points },
            latch(f64::INFINITY, 1.0),
            latch(30.0, f64::INFINITY),
            latch(30.0, 1.0),
        ]
    }

    /// An error that the method reaches on every ring: a ninth of what a bracket of 1e-7
    /// asks for. One of them stops at 1.06e-8, where the next factorisation has lost its
    /// last digits and the step spoils the balance; `solve_block` keeps the finest iterate.
    const REACHED: f64 = 1.1e-8;

    /// Solves to `tolerance`; `None` when the method gets stuck before.
    fn solve(program: &Program, inset: f64, tolerance: f64) -> Option<Iterate> {
        let mut method = InteriorPoint::new(program, inset, true);
        for _ in 0..40 {
            if method.estimate().error <= tolerance {
                return Some(method.iterate());
            }
            if !method.step() {
                return None;
            }
        }
        None
    }

    /// The programs of all blocks with cycles.
    fn programs(structure: &Structure, purpose: Purpose) -> Vec<Program> {
        let pieces = cut(structure);
        let loads = lump(structure, &pieces.blocks, own_loads(structure));
        let blocks = pieces.blocks.iter().filter(|block| block.links.len() > 1);
        blocks.map(|block| Program::new(structure, block, &loads, purpose)).collect()
    }

    #[test]
    fn agrees_with_the_general_solver() {
        let attempt = Attempt { tolerance: 1e-9, inset: 1e-8, regularization: 1e-8 };
        let mut compared = 0;
        for model in models() {
            for friction in [None, Some(0.0), Some(0.6)] {
                for program in programs(&ring(&model, friction), Purpose::Utilisation) {
                    let own = solve(&program, 1e-8, REACHED).expect("solvable");
                    let other = conic::solve(&program, &attempt).expect("solvable");
                    let (own, other) = (own.t * program.t_scale, other.t * program.t_scale);
                    assert!((own - other).abs() < 1e-7 * other.max(1.0), "{model:?} {friction:?}: {own} {other}");
                    compared += 1;
                }
            }
        }
        assert!(compared >= 15);
    }

    #[test]
    fn two_alike_share_a_load() {
        let mut pair = Structure { gravity: Vec3::new(0.0, 0.0, -10.0), ..Structure::default() };
        pair.bodies.push(Body { mass: 2.0, com: Vec3::zeros(), fixed: false });
        let model = Model::Cone { friction: [0.5, 0.5], radius: [0.1, 0.1, 0.1] };
        pair.connectors.push(Connector { name: "c".to_owned(), strength: 5.0, model });
        let down = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
        for x in [-0.3, 0.3] {
            let frame = Pose::from_parts(Vec3::new(x, 0.0, 0.2).into(), down);
            pair.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(0), connector: 0, frame });
        }
        let programs = programs(&pair, Purpose::Utilisation);
        assert_eq!(programs.len(), 1);
        let t = solve(&programs[0], 0.0, 1e-9).expect("solvable").t * programs[0].t_scale;
        assert!((t - 20.0 / 5.0 / 2.0).abs() < 1e-8, "{t}");
    }

    #[test]
    fn gives_up_without_a_solution() {
        let mut slope = Structure { gravity: Vec3::new(3.0, 0.0, -9.0), ..Structure::default() };
        slope.bodies.push(Body { mass: 1.0, com: Vec3::new(0.0, 0.0, 0.1), fixed: false });
        for [x, y] in [[0.1, 0.1], [-0.1, 0.1], [0.0, -0.1]] {
            let position = Vec3::new(x, y, 0.0);
            let contact = Contact { body: 0, against: Anchor::World, position, normal: Vec3::z(), friction: 0.2 };
            slope.contacts.push(contact);
        }
        for program in programs(&slope, Purpose::Utilisation) {
            assert!(solve(&program, 1e-8, 1e-8).is_none());
        }
        for program in programs(&slope, Purpose::Support) {
            let unheld = solve(&program, 1e-8, 1e-8).expect("always solvable").t;
            assert!(unheld > 0.1, "{unheld}");
        }
    }

    #[test]
    fn repeats_itself_to_the_last_bit() {
        for model in models() {
            let again = || {
                let programs = programs(&ring(&model, Some(0.3)), Purpose::Utilisation);
                programs.iter().map(|program| solve(program, 1e-8, REACHED).expect("solvable").v).collect::<Vec<_>>()
            };
            assert_eq!(again(), again());
        }
    }
}
