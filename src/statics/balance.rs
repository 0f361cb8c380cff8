//! Makes an approximately balanced wrench field balance.
//!
//! The residual of every body is pushed through the links to the supports by
//! the correction that is smallest in the metric of the cones at the current
//! point: what is near its limit moves least, and a force inside its friction
//! cone stays inside. One factorisation of 6 x 6 blocks on the body graph.

use nalgebra::{Matrix6, Vector6};

use crate::spatial::{Vec3, Wrench};

use super::blocks::{Block, Link};
use super::bracket::Problem;
use super::conic::Iterate;
use super::groups::{Cone, Group};
use super::maps::relative;
use super::network::Network;
use super::program::Program;
use super::second_order::determinant;
use super::series::flexibility_root;
use super::structure::Structure;

/// Rounds of correction; each reduces the residual by the factorisation's accuracy.
const ROUNDS: usize = 6;

/// Scaled imbalance that is mere rounding.
const BALANCED: f64 = 1e-14;

/// Least share of its force scale that counts as going through a body: one that carries
/// less than it might is balanced more finely.
const LITTLE: f64 = 1e-6;

/// Room, relative to the square of the force through a link, that every component
/// has at least: keeps the factorisation accurate where a connection is at its
/// limit. A contact has less, since it must not leave its cone.
const LOOSE_CONNECTION: f64 = 1e-6;
const LOOSE_CONTACT: f64 = 1e-14;

/// Wrench of every link of the block in its frame, as the solver's variables give it.
pub(super) fn wrenches(program: &Program, iterate: &Iterate) -> Vec<Wrench> {
    let t = iterate.t * program.t_scale;
    let preloads = program.preload_local.iter().zip(&program.held_local);
    let mut field: Vec<Wrench> = preloads.map(|(local, held)| *local * t + *held).collect();
    for group in &program.groups {
        let mut local = [0.0; 6];
        group.add_wrench(group.part(&iterate.z), &mut local);
        let [a, b, c, d, e, f] = local;
        field[group.link] += Wrench::new(Vec3::new(a, b, c), Vec3::new(d, e, f));
    }
    field
}

/// Contacts that carry less than `share` of the largest contact force: at a knife
/// edge the others alone hold the structure, and what the solver leaves on these
/// is noise.
pub(super) fn idle_contacts(block: &Block, field: &[Wrench], share: f64) -> Vec<bool> {
    let is_contact = |link: &Link| matches!(link, Link::Contact(_));
    let forces = || block.links.iter().zip(field).map(|(link, w)| if is_contact(link) { w.force.norm() } else { 0.0 });
    let largest = forces().fold(0.0, f64::max);
    block.links.iter().zip(forces()).map(|(link, force)| is_contact(link) && force < share * largest).collect()
}

/// Corrects `field` in place towards balance. What is `idle` carries nothing.
/// With `in_series`, chains are condensed.
pub(super) fn restore(problem: &Problem<'_>, iterate: &Iterate, field: &mut [Wrench], idle: &[bool], in_series: bool) {
    let Problem { structure, block, loads, program } = *problem;
    for (wrench, _) in field.iter_mut().zip(idle).filter(|(_, idle)| **idle) {
        *wrench = Wrench::ZERO;
    }
    let mut springs = None;
    for _ in 0..ROUNDS {
        clip(structure, block, field);
        let lacking = program.residuals(block, loads, field);
        let mut rhs = Vec::with_capacity(6 * lacking.len());
        for (wrench, factors) in lacking.iter().zip(program.row_factor.chunks_exact(6)) {
            rhs.extend(wrench.force.iter().chain(wrench.torque.iter()).zip(factors).map(|(w, f)| -w * f));
        }
        let through = problem.forces_through(field);
        let shares = through.iter().zip(&program.scales.force).map(|(through, force)| through / force);
        let mere_rounding = |(rows, share): (&[f64], f64)| {
            rows.iter().all(|lacking| lacking.abs() <= BALANCED * share.clamp(LITTLE, 1.0))
        };
        if rhs.chunks_exact(6).zip(shares).all(mere_rounding) {
            return;
        }
        let (network, metric) = springs.get_or_insert_with(|| {
            let mut metric = metrics(block, program, iterate, &wrenches(program, iterate));
            for (metric, _) in metric.iter_mut().zip(idle).filter(|(_, idle)| **idle) {
                *metric = Matrix6::zeros();
            }
            let mut network = Network::new(program, in_series);
            network.factorise(program, &metric, |link| flexibility_root(&metric[link]));
            (network, metric)
        });
        let mut changes: Vec<Option<Vector6<f64>>> = vec![None; field.len()];
        let pull = network.solve(&rhs, |link, wrench| changes[link] = Some(wrench));
        if !pull.iter().all(|x| x.is_finite()) {
            return;
        }
        for (link, wrench) in field.iter_mut().enumerate() {
            let change =
                changes[link].unwrap_or_else(|| metric[link] * Vector6::from(relative(&program.sides[link], &pull)));
            *wrench += Wrench::new(change.fixed_rows::<3>(0).into(), change.fixed_rows::<3>(3).into());
        }
    }
}

/// Puts contact forces that left their friction cone back onto it, by pressing harder.
fn clip(structure: &Structure, block: &Block, field: &mut [Wrench]) {
    for (&link, wrench) in block.links.iter().zip(field) {
        if let Link::Contact(i) = link {
            let (friction, force) = (structure.contacts[i].friction, &mut wrench.force);
            if friction > 0.0 {
                force.z = force.z.max(force.xy().norm() / friction);
            } else {
                *force = Vec3::new(0.0, 0.0, force.z.max(0.0));
            }
            wrench.torque = Vec3::zeros();
        }
    }
}

/// The cone metric of every link's wrench: how freely its components may move.
fn metrics(block: &Block, program: &Program, iterate: &Iterate, field: &[Wrench]) -> Vec<Matrix6<f64>> {
    let mut metric: Vec<Matrix6<f64>> = vec![Matrix6::zeros(); program.frames.len()];
    let column = |group: &Group, k: usize| {
        let (mut unit, mut wrench) = ([0.0; 6], [0.0; 6]);
        unit[k] = 1.0;
        group.add_wrench(&unit[..group.len], &mut wrench);
        Vector6::from(wrench)
    };
    let mut other_slack = vec![None; program.variables];
    for group in &program.groups {
        if let Some(k) = group.ties {
            other_slack[k] = Some(iterate.z[group.first]);
        }
    }
    let mut force: Vec<f64> = field.iter().map(|wrench| wrench.force.norm()).collect();
    for (force, scale) in force.iter_mut().zip(&program.scales.link) {
        *force = force.max(scale * 1e-3);
    }
    for group in program.groups.iter().filter(|group| group.ties.is_none()) {
        let z = &iterate.z[group.first..group.first + group.len];
        let looseness = match block.links[group.link] {
            Link::Connection(_) => LOOSE_CONNECTION,
            Link::Contact(_) => LOOSE_CONTACT,
        };
        let relative = force[group.link] / program.scales.link[group.link];
        let loose = looseness * relative * relative;
        match group.cone {
            Cone::Free => {
                let c = column(group, 0) * relative.max(1.0);
                metric[group.link] += c * c.transpose();
            }
            Cone::NonNegative => {
                let c = column(group, 0);
                let p = z[0];
                let room = match other_slack[group.first] {
                    Some(q) => p * p * q * q / (p * p + q * q).max(f64::MIN_POSITIVE),
                    None => p * p,
                };
                metric[group.link] += c * c.transpose() * (room + loose);
            }
            Cone::Lorentz => {
                // Quadratic representation 2 z z' - det(z) J.
                let determinant = determinant(z).max(0.0);
                let mut along = Vector6::zeros();
                for (k, value) in z.iter().enumerate() {
                    let c = column(group, k);
                    along += c * *value;
                    let sign = if k == 0 { -1.0 } else { 1.0 };
                    metric[group.link] += c * c.transpose() * (sign * determinant + loose);
                }
                metric[group.link] += along * along.transpose() * 2.0;
            }
        }
    }
    metric
}
