//! A block's stiffness where every link gives way as far as its cone has room.
//!
//! With the columns C of `room` and the map A from link wrenches to the bodies'
//! balances, the change of a wrench field that is least in the cones' metric and
//! balances a residual r is `C C' A' v` with `(A C C' A') v = -r`: one
//! factorisation of the network of links, see `network`. The same matrix is the stiffness of the
//! bodies' twists, soft where links are near their limits.

use nalgebra::Vector6;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::balance::residuals;
use super::super::bracket::Problem;
use super::super::maps::relative;
use super::super::network::{Network, flexibility_root};
use super::room::Rooms;

/// Rounds of correction; each is as accurate as the factorisation.
const ROUNDS: usize = 3;

/// Imbalance, relative to what flows through a body, that needs no correction.
const BALANCED: f64 = 1e-13;

/// Factored stiffness of a block.
pub(super) struct Give {
    network: Network<6>,
    rooms: Rooms,
}

impl Give {
    pub(super) fn new(problem: &Problem<'_>, rooms: Rooms) -> Self {
        let mut network = Network::new(problem.program, true);
        network.factorise(&rooms.metrics, |link| flexibility_root(&rooms.metrics[link]));
        Self { network, rooms }
    }

    /// The same block at other rooms: the pattern stays.
    pub(super) fn renew(&mut self, rooms: Rooms) {
        self.network.factorise(&rooms.metrics, |link| flexibility_root(&rooms.metrics[link]));
        self.rooms = rooms;
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
            let wanted = rows(problem, &lacking);
            let mut passed = vec![None; field.len()];
            let v = self.network.solve(&wanted, |link, wrench| passed[link] = Some(wrench));
            if !v.iter().all(|x| x.is_finite()) {
                break;
            }
            for (l, wrench) in field.iter_mut().enumerate() {
                let change = passed[l].unwrap_or_else(|| self.resistance(problem, l, &v));
                *wrench += Wrench::new(-change.fixed_rows::<3>(0), -change.fixed_rows::<3>(3));
            }
            for (sum, v) in total.iter_mut().zip(&v) {
                *sum += v;
            }
        }
        twists(problem, &total)
    }

    /// The wrench with which a link resists scaled twists.
    fn resistance(&self, problem: &Problem<'_>, link: usize, v: &[f64]) -> Vector6<f64> {
        self.rooms.metrics[link] * Vector6::from(relative(&problem.program.sides[link], v))
    }

    /// The twist field nearest to `field`, in the metric of this stiffness, in
    /// which the `locked` links hardly move.
    pub(super) fn lock(&self, problem: &Problem<'_>, field: &[Twist], locked: &[bool]) -> Vec<Twist> {
        let factors = problem.program.row_factor.chunks_exact(6);
        let scaled = |(twist, factor): (&Twist, &[f64])| {
            let (v, w) = (&twist.linear, &twist.angular);
            [v.x / factor[0], v.y / factor[1], v.z / factor[2], w.x / factor[3], w.y / factor[4], w.z / factor[5]]
        };
        let v: Vec<f64> = field.iter().zip(factors).flat_map(scaled).collect();
        let mut pull = vec![0.0; v.len()];
        for l in (0..locked.len()).filter(|&l| locked[l]) {
            let resistance = (-self.resistance(problem, l, &v)).into();
            for side in problem.program.sides[l].iter().flatten() {
                side.push(&resistance, &mut pull);
            }
        }
        let change = twists(problem, &self.network.solve(&pull, |_, _| {}));
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

/// Wrenches on the bodies as scaled balance rows.
fn rows(problem: &Problem<'_>, wrenches: &[Wrench]) -> Vec<f64> {
    let components = wrenches.iter().flat_map(|w| w.force.iter().chain(w.torque.iter()));
    components.zip(&problem.program.row_factor).map(|(w, factor)| w * factor).collect()
}

/// The twists that scaled multipliers of the balances stand for.
fn twists(problem: &Problem<'_>, v: &[f64]) -> Vec<Twist> {
    let unscaled: Vec<f64> = v.iter().zip(&problem.program.row_factor).map(|(v, factor)| v * factor).collect();
    let twist = |v: &[f64]| Twist::new(Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]));
    unscaled.chunks_exact(6).map(twist).collect()
}

#[cfg(test)]
mod tests {
    use super::super::opening::{inadmissible, open};
    use super::*;
    use crate::spatial::Pose;
    use crate::statics::blocks::{Block, cut};
    use crate::statics::connector::{Connector, Model};
    use crate::statics::loads::{BodyLoad, own_loads};
    use crate::statics::program::Program;
    use crate::statics::structure::{Anchor, Body, Connection, Structure};

    /// Four cubes of 0.1 m on top of each other's sides, a ring that stands on the world.
    fn ring() -> Structure {
        let mut ring = Structure { gravity: Vec3::new(0.5, 0.2, -9.81), ..Structure::default() };
        let model = Model::Cone { friction: [0.5, 0.4], radius: [0.03, 0.03, 0.04] };
        ring.connectors.push(Connector { name: "c".to_owned(), strength: 20.0, model });
        for [x, z] in [[0.0, 0.1], [0.1, 0.1], [0.0, 0.2], [0.1, 0.2]] {
            ring.bodies.push(Body { mass: 0.3, com: Vec3::new(x, 0.0, z), fixed: false });
        }
        let sideways = crate::spatial::Rotation::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_2);
        let upwards = crate::spatial::Rotation::identity();
        let mut join = |parent, child, at: [f64; 2], rotation| {
            let frame = Pose::from_parts(Vec3::new(at[0], 0.0, at[1]).into(), rotation);
            ring.connections.push(Connection { parent, child: Anchor::Body(child), connector: 0, frame });
        };
        join(Anchor::Body(0), 1, [0.05, 0.1], sideways);
        join(Anchor::Body(2), 3, [0.05, 0.2], sideways);
        join(Anchor::Body(0), 2, [0.0, 0.15], upwards);
        join(Anchor::Body(1), 3, [0.1, 0.15], upwards);
        join(Anchor::World, 0, [0.0, 0.05], upwards);
        join(Anchor::World, 1, [0.1, 0.05], upwards);
        ring
    }

    fn with_problem(check: impl Fn(&Problem<'_>)) {
        let structure = ring();
        let pieces = cut(&structure);
        let (block, loads): (&Block, Vec<BodyLoad>) = (&pieces.blocks[0], own_loads(&structure));
        let program = Program::unstated(&structure, block, &loads, 1e-9);
        check(&Problem { structure: &structure, block, loads: &loads, program: &program });
    }

    #[test]
    fn fields_balance_afterwards_with_or_without_centring() {
        with_problem(|problem| {
            for centring in [0.0, 0.7] {
                let mut field = vec![Wrench::ZERO; problem.block.links.len()];
                let mut give = Give::new(problem, Rooms::new(problem, &field, 1.0));
                give.balance(problem, &mut field, centring);
                assert!(balances(problem, &lacking(problem, &field)));
                // Another room, the same pattern.
                give.renew(Rooms::new(problem, &field, 0.5));
                field[2] = Wrench::ZERO;
                give.balance(problem, &mut field, centring);
                assert!(balances(problem, &lacking(problem, &field)));
            }
        });
    }

    #[test]
    fn the_loads_do_work_in_the_way_they_would_win() {
        with_problem(|problem| {
            let mut field = vec![Wrench::ZERO; problem.block.links.len()];
            let way = Give::new(problem, Rooms::new(problem, &field, 1.0)).balance(problem, &mut field, 0.0);
            let power: f64 = way.iter().zip(problem.loads).map(|(twist, load)| twist.power(&load.wrench)).sum();
            assert!(power > 0.0);
        });
    }

    #[test]
    fn locked_links_hardly_move_and_opening_does_the_rest() {
        with_problem(|problem| {
            // Two cubes go sideways: links between them and the others slip.
            let slide = Twist::new(Vec3::x(), Vec3::zeros());
            let twists = [Twist::ZERO, slide, Twist::ZERO, slide];
            let locked = inadmissible(problem, &twists);
            assert_eq!(locked, [false, false, false, false, false, true]);
            let field = vec![Wrench::ZERO; locked.len()];
            let give = Give::new(problem, Rooms::locking(problem, &field, 1.0, |l| locked[l]));
            let mut twists = give.lock(problem, &twists, &locked);
            assert!(twists[1].linear.norm() < 1e-3, "{twists:?}");
            assert!(open(problem, &mut twists));
            assert!(!inadmissible(problem, &twists).contains(&true));
        });
    }
}
