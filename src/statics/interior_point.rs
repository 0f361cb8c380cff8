//! A primal-dual interior-point method for a block's program.
//!
//! Nesterov-Todd direction, Mehrotra's predictor and corrector, Gondzio's correction of
//! centrality where a step is short, infeasible start; one factorisation of blocks of a body's balances on the body graph
//! per iteration (see `system`), where a general solver factorises a system of all variables. It
//! has no certificate for programs without a solution: it gets stuck, and `conic`,
//! which answers the same question, is asked instead. As with `conic`, nothing
//! that comes back is believed: see `bracket`.

use super::conic::Iterate;
use super::network::Network;
use super::parts::parts;
use super::planar::{NotPlanar, Planar};
use super::program::Program;
use super::reductions::Reductions;
use super::respect::respect_unlimited;
use super::system::{Residuals, System};

/// Largest step towards the boundary of a cone, as a share of the way.
const SHORTEN: f64 = 0.99;

/// The same for linear programs, which lose nothing close to the boundary.
const SHORTEN_LINEAR: f64 = 0.999;

/// Steps shorter than this are worth bending towards the central path.
const SHORT: f64 = 0.9;

/// Steps shorter than this get nowhere.
const LEAST_STEP: f64 = 1e-4;

/// Scaled bound on t above which the program counts as unsolvable.
const LARGEST: f64 = 1e9;

/// The method at work on a program: `x = (z, t)` and `s = c + A' v` inside their cones.
pub(super) struct InteriorPoint<'p> {
    program: &'p Program,
    system: Balances,
    residuals: Residuals,
}

/// The equations, six per body or three.
enum Balances {
    Space(System<6>),
    Plane(System<3>, Planar),
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

impl<'p> InteriorPoint<'p> {
    /// The start on `program`, with opening velocities inset by `inset` over all
    /// cones as in [`Attempt`](super::conic::Attempt), and forces and t at `start` times
    /// those that are typical.
    pub(super) fn new(program: &'p Program, inset: f64, start: f64, reductions: Reductions) -> Self {
        let bodies = program.scales.force.len();
        let parts = parts(program);
        let tie = |row: usize| program.preload[row];
        let (system, residuals) = match Planar::new(program, &parts, reductions) {
            Ok(planar) => {
                let network = Network::plain(program.pattern());
                let preload = planar.preload.clone();
                let mut system = System::new(&planar.parts, &planar.loads, preload, tie, network, inset, start);
                let residuals = system.advance([0.0; 2]);
                (Balances::Plane(system, planar), residuals)
            }
            Err(why) => {
                let by_body = |rows: &[f64]| rows[..6 * bodies].as_chunks::<6>().0.to_vec();
                let in_series = why == NotPlanar::Chains;
                let network = if in_series { Network::new(program, true) } else { Network::plain(program.pattern()) };
                let (loads, preload) = (by_body(&program.load), by_body(&program.preload));
                let mut system = System::new(&parts, &loads, preload, tie, network, inset, start);
                let residuals = system.advance([0.0; 2]);
                (Balances::Space(system), residuals)
            }
        };
        Self { program, system, residuals }
    }

    /// How good the iterate is.
    pub(super) fn estimate(&self) -> Estimate {
        let Residuals { gap, imbalance, opening, primal, dual, t } = self.residuals;
        let t_scale = self.program.t_scale;
        let scale = primal.abs().max(dual.abs()) + t_scale.recip().min(1.0);
        Estimate {
            error: gap.max(imbalance).max(1e2 * opening) / scale,
            upper: t * t_scale,
            lower: dual * t_scale,
            imbalance,
        }
    }

    /// One step; whether it got anywhere. Without a solution t or the motion grow
    /// without end.
    pub(super) fn step(&mut self) -> bool {
        let stepped = match &mut self.system {
            Balances::Space(system) => step(system, &self.residuals),
            Balances::Plane(system, _) => step(system, &self.residuals),
        };
        if let Some(residuals) = stepped {
            self.residuals = residuals;
        }
        stepped.is_some()
    }

    /// The iterate as it is.
    pub(super) fn iterate(&self) -> Iterate {
        let mut z = vec![0.0; self.program.variables];
        let mut note = |first: usize, x: &[f64]| z[first..first + x.len()].copy_from_slice(x);
        let t = self.residuals.t;
        let mut iterate = match &self.system {
            Balances::Space(system) => {
                system.forces(note);
                let mut v = system.motion().as_flattened().to_vec();
                v.extend(system.tie_motions());
                Iterate { v, z, t }
            }
            Balances::Plane(system, planar) => {
                system.forces(&mut note);
                planar.in_space(&z, system.motion(), t)
            }
        };
        respect_unlimited(self.program, &mut iterate.v);
        iterate
    }
}

/// One step from where `system` has come to; where that is, if it got anywhere.
fn step<const D: usize>(system: &mut System<D>, residuals: &Residuals) -> Option<Residuals> {
    let Residuals { gap, primal, dual, .. } = *residuals;
    if !(primal.abs().max(dual.abs()) < LARGEST) || !system.factorise() {
        return None;
    }
    system.predict();
    let [x, s] = system.reach(1.0);
    let centring = (1.0 - x.min(s)).powi(3);
    let mu = centring * gap / system.degree();
    let shorten = if system.is_linear() { SHORTEN_LINEAR } else { SHORTEN };
    let left = (1.0 - shorten) * gap;
    system.correct(mu, left);
    let mut steps = system.reach(shorten);
    if steps[0].min(steps[1]) < SHORT {
        steps = system.centre(steps, mu, left, shorten);
    }
    if !(steps[0].min(steps[1]) > LEAST_STEP) {
        return None;
    }
    Some(system.advance(steps))
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

    /// An error that the method reaches on every ring, that of a bracket of 1e-7. Most come
    /// to 1e-8; one stops at 7e-8, where the pivots that are left are rounding and rest
    /// (which the most slanting supports need), and `solve_block` keeps the finest iterate.
    const REACHED: f64 = 1e-7;

    /// Solves to `tolerance`; `None` when the method gets stuck before.
    fn solve(program: &Program, inset: f64, tolerance: f64) -> Option<Iterate> {
        let mut method = InteriorPoint::new(program, inset, 1.0, Reductions::ALL);
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
