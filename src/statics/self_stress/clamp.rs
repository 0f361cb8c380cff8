//! Whether contacts can press on each other without any load.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use crate::spatial::Vec3;

use super::super::blocks::{Block, Link, Vertex, ends};
use super::super::clusters::Clusters;
use super::super::collapse::unbound;
use super::super::conic::{Attempt, settings};
use super::super::distribution::compressed;
use super::super::loads::BodyLoad;
use super::super::program::{Cone, Program, Purpose};
use super::super::structure::Structure;

/// How much less bodies are spread sideways than they are lifted.
const SPREAD: f64 = 1e-3;

/// How much faster than friction needs a contact has to open, relative to the motion.
const CLEARLY: f64 = 1e-9;

/// Whether lifting and spreading what connections join opens every contact, so that no forces
/// between them balance without a load. Costs next to nothing.
pub(super) fn opens(structure: &Structure, block: &Block) -> bool {
    let Some(up) = (-structure.gravity).try_normalize(0.0) else { return false };
    let clusters = Clusters::new(structure, block, |_, link| matches!(link, Link::Connection(_)));
    let mut centres = vec![(Vec3::zeros(), 0.0_f64); clusters.count()];
    for &body in &block.bodies {
        if let Some(cluster) = clusters.of_body(block, body) {
            centres[cluster].0 += structure.bodies[body].com;
            centres[cluster].1 += 1.0;
        }
    }
    let centres: Vec<Vec3> = centres.into_iter().map(|(sum, count)| sum / count).collect();
    let middle = centres.iter().sum::<Vec3>() / (centres.len().max(1) as f64);
    let lowest = block.links.iter().filter_map(|link| match link {
        Link::Contact(i) => Some(structure.contacts[*i].position.dot(&up)),
        Link::Connection(_) => None,
    });
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let velocity = |vertex: Vertex| match vertex {
        Vertex::Body(body) if vertex != block.root => {
            clusters.of_body(block, body).map_or_else(Vec3::zeros, |cluster| {
                let from_middle = centres[cluster] - middle;
                let level = from_middle - up * from_middle.dot(&up);
                up * (centres[cluster].dot(&up) - lowest) + level * SPREAD
            })
        }
        _ => Vec3::zeros(),
    };
    block.links.iter().all(|&link| match link {
        Link::Connection(_) => true,
        Link::Contact(i) => {
            let contact = &structure.contacts[i];
            let [here, there] = ends(structure, link).map(velocity);
            let opening = (here - there).dot(&contact.normal);
            let sliding = (here - there - contact.normal * opening).norm();
            opening - contact.friction * sliding > CLEARLY * (here.norm() + there.norm())
        }
    })
}

/// Sum of pressures, as a share of the largest allowed, from which on there is a self-stress.
const POSSIBLE: f64 = 1e-4;

/// How the solver is asked.
const ATTEMPT: Attempt = Attempt { tolerance: 1e-8, inset: 0.0, regularization: 1e-8 };

/// Whether some forces of contacts, with whatever connections of any strength pass on, balance
/// without a load: maximises their sum of pressures, up to a bound. `None` when the solver does not say.
pub(super) fn is_possible(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<bool> {
    let mut strong = structure.clone();
    for connector in &mut strong.connectors {
        unbound(&mut connector.model);
    }
    let program = Program::new(&strong, block, loads, Purpose::Support);
    let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(program.variables);
    for group in &program.groups {
        columns.extend((0..group.len).map(|k| program.entries(group, k)));
    }
    let mut rhs = vec![0.0; program.rows()];
    let mut cones = vec![SupportedConeT::ZeroConeT(rhs.len())];
    let mut objective = vec![0.0; program.variables];
    for group in program.groups.iter().filter(|group| group.cone == Cone::NonNegative) {
        columns[group.first].push((rhs.len(), -1.0));
        rhs.push(0.0);
    }
    let bound = rhs.len();
    rhs.push(1.0);
    for group in &program.groups {
        if let Link::Contact(_) = block.links[group.link] {
            columns[group.first].push((bound, 1.0));
            objective[group.first] = -1.0;
        }
    }
    cones.push(SupportedConeT::NonnegativeConeT(rhs.len() - program.rows()));
    for group in program.groups.iter().filter(|group| group.cone == Cone::Lorentz) {
        for column in &mut columns[group.first..group.first + group.len] {
            column.push((rhs.len(), -1.0));
            rhs.push(0.0);
        }
        cones.push(SupportedConeT::SecondOrderConeT(group.len));
    }
    let nothing = CscMatrix::zeros((objective.len(), objective.len()));
    let matrix = compressed(rhs.len(), columns);
    let mut solver = DefaultSolver::new(&nothing, &objective, &matrix, &rhs, &cones, settings(&ATTEMPT)?).ok()?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Some(-solver.solution.obj_val > POSSIBLE),
        SolverStatus::Unsolved
        | SolverStatus::PrimalInfeasible
        | SolverStatus::DualInfeasible
        | SolverStatus::AlmostPrimalInfeasible
        | SolverStatus::AlmostDualInfeasible
        | SolverStatus::MaxIterations
        | SolverStatus::MaxTime
        | SolverStatus::NumericalError
        | SolverStatus::InsufficientProgress
        | SolverStatus::CallbackTerminated => None,
    }
}
