//! A block's stiffness where every link gives way as far as its cone has room.
//!
//! With the columns C of `room` and the map A from link wrenches to the bodies'
//! balances, the change of a wrench field that is least in the cones' metric and
//! balances a residual r is `C C' A' v` with `(A C C' A') v = -r`: one
//! factorisation of the network of links, see `network`. The same matrix is the stiffness of the
//! bodies' twists, soft where links are near their limits.

use nalgebra::Vector6;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::bracket::Problem;
use super::super::maps::relative;
use super::super::network::Network;
use super::super::program::Program;
use super::super::series::flexibility_root;
use super::field::{Field, face};
use super::room::Rooms;

/// Imbalance, relative to what flows through a body, that needs no correction.
const BALANCED: f64 = 1e-11;

/// Rounds of correction after a change; each is as accurate as the factorisation.
const REFINEMENTS: usize = 2;

/// Factored stiffness of a block.
pub(super) struct Give {
    network: Network<6>,
    rooms: Rooms,
    /// What its balance rows are scaled by.
    row_factor: Vec<f64>,
}

impl std::fmt::Debug for Give {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Give").field("links", &self.rooms.metrics.len()).finish_non_exhaustive()
    }
}

/// A change of the field, and the twists that it comes from.
pub(super) struct Change {
    pub field: Field,
    pub twists: Vec<Twist>,
}

impl Give {
    pub(super) fn new(problem: &Problem<'_>, rooms: Rooms) -> Self {
        let mut network = Network::new(problem.program, true);
        network.factorise(problem.program, &rooms.metrics, |link| flexibility_root(&rooms.metrics[link]));
        Self { network, rooms, row_factor: problem.program.row_factor.clone() }
    }

    /// Spares `program`, of a neighbouring block of the same bodies, an order of elimination of its own.
    pub(super) fn lend_pattern(&self, program: &Program) {
        program.take_pattern(self.network.pattern());
    }

    /// The same block at other rooms: the pattern stays.
    pub(super) fn renew(&mut self, problem: &Problem<'_>, rooms: Rooms) {
        self.network.factorise(problem.program, &rooms.metrics, |link| flexibility_root(&rooms.metrics[link]));
        self.rooms = rooms;
    }

    /// The change that makes `field` balance and is least but for `centring` times the step
    /// towards the middles of the cones. What resists its twists is least near its limit, so
    /// where the loads are too large, they are the way in which the loads win.
    pub(super) fn balancing(&self, problem: &Problem<'_>, field: &Field, centring: f64) -> Change {
        let mut lacking = lacking(problem, &field.wrenches);
        for (lacking, push) in lacking.iter_mut().zip(pushes(problem, &self.rooms.centres.wrenches)) {
            *lacking += push * centring;
        }
        let mut change = self.answer(problem, &lacking, Some);
        change.field.add(&self.rooms.centres, centring);
        change
    }

    /// The twists of the step towards the middles of the cones that leaves the balance as it
    /// is. Near the middle of the whole, every link admits them with something to spare.
    pub(super) fn centring(&self, problem: &Problem<'_>) -> Vec<Twist> {
        let rows = self.rows(&pushes(problem, &self.rooms.centres.wrenches));
        twists(problem, &self.network.solve(&rows, |_, _| {}))
    }

    /// Corrects what rounding left of the imbalance of `field`; whether it balances then.
    pub(super) fn refine(&self, problem: &Problem<'_>, field: &mut Field) -> bool {
        self.refine_by(problem, field, Some)
    }

    /// As [`refine`](Self::refine) with the springs of a neighbouring block of the same bodies,
    /// `spring` of each link; a link without one stays as it is. Any imbalance will do, as long
    /// as the springs are where they were.
    pub(super) fn refine_by(
        &self,
        problem: &Problem<'_>,
        field: &mut Field,
        spring: impl Fn(usize) -> Option<usize>,
    ) -> bool {
        for _ in 0..REFINEMENTS {
            let lacking = lacking(problem, &field.wrenches);
            if balances(problem, &lacking) {
                return true;
            }
            field.add(&self.answer(problem, &lacking, &spring).field, 1.0);
        }
        balances(problem, &lacking(problem, &field.wrenches))
    }

    /// The least change of the field that holds `wrenches` on the bodies.
    fn answer(&self, problem: &Problem<'_>, wrenches: &[Wrench], spring: impl Fn(usize) -> Option<usize>) -> Change {
        let Problem { structure, block, program, .. } = *problem;
        let links = block.links.len();
        let mut passed = vec![None; self.rooms.metrics.len()];
        let mut v = self.network.solve(&self.rows(wrenches), |link, wrench| passed[link] = Some(wrench));
        for ((v, own), factor) in v.iter_mut().zip(&self.row_factor).zip(&program.row_factor) {
            *v *= own / factor;
        }
        let mut field = Field { wrenches: Vec::with_capacity(links), points: Vec::new() };
        for (l, &link) in block.links.iter().enumerate() {
            let face = face(structure, link);
            let Some(own) = spring(l) else {
                field.wrenches.push(Wrench::ZERO);
                field.points.extend(face.iter().flat_map(|face| face.points).map(|_| Vec3::zeros()));
                continue;
            };
            let change = passed[own].unwrap_or_else(|| {
                let [vx, vy, vz, wx, wy, wz] = relative(&program.sides[l], &v);
                if let Some(face) = face {
                    let apart = Twist::new(Vec3::new(vx, vy, vz), Vec3::new(wx, wy, wz));
                    for (p, metric) in face.points.iter().zip(&self.rooms.points[self.rooms.first_point[own]..]) {
                        field.points.push(-(metric * apart.at(&Vec3::new(p[0], p[1], 0.0))));
                    }
                }
                self.rooms.metrics[own] * Vector6::new(vx, vy, vz, wx, wy, wz)
            });
            field.wrenches.push(Wrench::new(-change.fixed_rows::<3>(0), -change.fixed_rows::<3>(3)));
        }
        Change { field, twists: twists(problem, &v) }
    }

    /// Wrenches on the bodies as scaled balance rows.
    fn rows(&self, wrenches: &[Wrench]) -> Vec<f64> {
        let components = wrenches.iter().flat_map(|w| w.force.iter().chain(w.torque.iter()));
        components.zip(&self.row_factor).map(|(w, factor)| w * factor).collect()
    }
}

/// What the wrenches of links push the block's bodies with.
fn pushes(problem: &Problem<'_>, wrenches: &[Wrench]) -> Vec<Wrench> {
    let mut pushed = vec![Wrench::ZERO; problem.block.bodies.len()];
    problem.program.push(wrenches, &mut pushed);
    pushed
}

/// What every body of the block lacks for balance.
pub(super) fn lacking(problem: &Problem<'_>, field: &[Wrench]) -> Vec<Wrench> {
    problem.program.residuals(problem.block, problem.loads, field)
}

/// Whether `lacking` is nothing but rounding.
pub(super) fn balances(problem: &Problem<'_>, lacking: &[Wrench]) -> bool {
    imbalance(problem, lacking) <= BALANCED
}

/// The largest of what bodies lack, relative to what flows through them.
fn imbalance(problem: &Problem<'_>, lacking: &[Wrench]) -> f64 {
    let scales = &problem.program.scales;
    let sizes = scales.force.iter().zip(&scales.lever);
    let relative =
        lacking.iter().zip(sizes).map(|(w, (force, lever))| (w.force.norm() + w.torque.norm() / lever) / force);
    relative.fold(0.0, f64::max)
}

/// The twists that scaled multipliers of the balances stand for.
fn twists(problem: &Problem<'_>, v: &[f64]) -> Vec<Twist> {
    let unscaled: Vec<f64> = v.iter().zip(&problem.program.row_factor).map(|(v, factor)| v * factor).collect();
    let twist = |v: &[f64]| Twist::new(Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]));
    unscaled.chunks_exact(6).map(twist).collect()
}

#[cfg(test)]
mod tests {
    use super::super::opening::Opening;
    use super::*;
    use crate::spatial::Pose;
    use crate::statics::blocks::{Block, cut};
    use crate::statics::connector::{Connector, Model};
    use crate::statics::loads::{BodyLoad, own_loads};
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

    /// The field of nothing at all, at the rated strengths.
    fn idle(problem: &Problem<'_>) -> Field {
        Field::new(problem, vec![Wrench::ZERO; problem.block.links.len()], 1.0, |_| Vec::new())
    }

    #[test]
    fn fields_balance_afterwards_with_or_without_centring() {
        with_problem(|problem| {
            let mut field = idle(problem);
            let mut give = Give::new(problem, Rooms::new(problem, &field, 1.0));
            for centring in [0.0, 0.7] {
                let mut moved = field.clone();
                moved.add(&give.balancing(problem, &field, centring).field, 1.0);
                assert!(give.refine(problem, &mut moved));
                assert!(balances(problem, &lacking(problem, &moved.wrenches)));
                // Another room, the same pattern.
                give.renew(problem, Rooms::new(problem, &moved, 0.5));
                moved.wrenches[2] = Wrench::ZERO;
                field = moved;
            }
        });
    }

    #[test]
    fn near_the_middle_every_link_opens() {
        with_problem(|problem| {
            let mut field = idle(problem);
            let mut give = Give::new(problem, Rooms::new(problem, &field, 3.0));
            for _ in 0..10 {
                field.add(&give.balancing(problem, &field, 0.7).field, 1.0);
                give.renew(problem, Rooms::new(problem, &field, 3.0));
            }
            let opening = Opening::new(problem, give.centring(problem));
            // Two cubes go sideways: links between them and the others slip.
            let slide = Twist::new(Vec3::x(), Vec3::zeros());
            let mut twists = [Twist::ZERO, slide, Twist::ZERO, slide];
            assert!(problem.lower_bound(&twists).is_none());
            assert!(opening.open(&mut twists));
            let opened = twists;
            assert!(opening.open(&mut twists));
            assert_eq!(twists, opened, "every link admits them by now");
        });
    }

    #[test]
    fn the_loads_do_work_in_the_way_they_would_win() {
        with_problem(|problem| {
            let field = idle(problem);
            let way = Give::new(problem, Rooms::new(problem, &field, 1.0)).balancing(problem, &field, 0.0).twists;
            let power: f64 = way.iter().zip(problem.loads).map(|(twist, load)| twist.power(&load.wrench)).sum();
            assert!(power > 0.0);
        });
    }
}
