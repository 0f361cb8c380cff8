//! Makes an approximately balanced wrench field balance.
//!
//! The residual of every body is pushed through the links to the supports by
//! the correction that is smallest in the metric of the cones at the current
//! point: what is near its limit moves least, and a force inside its friction
//! cone stays inside. One factorisation of 6 x 6 blocks on the body graph.

use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettingsBuilder};
use nalgebra::{Matrix6, SMatrix, Vector6};

use crate::spatial::{Vec3, Wrench};

use super::blocks::{Block, Link};
use super::conic::Iterate;
use super::loads::BodyLoad;
use super::program::{Cone, Program, local_body};
use super::second_order::determinant;
use super::structure::Structure;

/// Rounds of correction; each reduces the residual by the factorisation's accuracy.
const ROUNDS: usize = 6;

/// Room, relative to the square of the force through a link, that every component
/// has at least: keeps the factorisation accurate where a connection is at its
/// limit. A contact has less, since it must not leave its cone.
const LOOSE_CONNECTION: f64 = 1e-6;
const LOOSE_CONTACT: f64 = 1e-14;

/// For each side of a link that needs balance: the body's index in the block, and
/// the map from the link's wrench to the body's scaled balance rows.
type SideMaps = [Option<(usize, Matrix6<f64>)>; 2];

/// Wrench of every link of the block in its frame, as the solver's variables give it.
pub(super) fn wrenches(program: &Program, iterate: &Iterate) -> Vec<Wrench> {
    let t = iterate.t * program.t_scale;
    let mut field: Vec<Wrench> = program.preload_local.iter().map(|local| *local * t).collect();
    for group in &program.groups {
        for k in group.first..group.first + group.len {
            field[group.link] += program.columns[k].local * (group.scale * iterate.z[k]);
        }
    }
    field
}

/// What every body still lacks for balance, about its centre of mass in W.
pub(super) fn residuals(
    structure: &Structure,
    block: &Block,
    program: &Program,
    loads: &[BodyLoad],
    field: &[Wrench],
) -> Vec<Wrench> {
    let mut lacking: Vec<Wrench> = block.bodies.iter().map(|&body| loads[body].wrench).collect();
    for (frame, wrench) in program.frames.iter().zip(field) {
        for (side, sign) in frame.sides() {
            if let Some(i) = local_body(block, side) {
                lacking[i] += frame.to_body(wrench, &structure.bodies[block.bodies[i]].com) * sign;
            }
        }
    }
    lacking
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
pub(super) fn restore(
    structure: &Structure,
    block: &Block,
    program: &Program,
    loads: &[BodyLoad],
    iterate: &Iterate,
    field: &mut [Wrench],
    idle: &[bool],
) {
    let mut metric = metrics(block, program, iterate, field);
    for ((metric, wrench), _) in metric.iter_mut().zip(field.iter_mut()).zip(idle).filter(|(_, idle)| **idle) {
        *metric = Matrix6::zeros();
        *wrench = Wrench::ZERO;
    }
    let levers: Vec<SideMaps> = (0..field.len()).map(|link| scaled_maps(structure, block, program, link)).collect();
    let Some(mut factor) = factorise(block.bodies.len(), &metric, &levers) else { return };
    for _ in 0..ROUNDS {
        clip(structure, block, field);
        let lacking = residuals(structure, block, program, loads, field);
        let mut rhs = Vec::with_capacity(6 * lacking.len());
        for (i, wrench) in lacking.iter().enumerate() {
            let factors = &program.row_factor[6 * i..6 * i + 6];
            rhs.extend(wrench.force.iter().chain(wrench.torque.iter()).zip(factors).map(|(w, f)| -w * f));
        }
        factor.solve(&mut rhs);
        if !rhs.iter().all(|x| x.is_finite()) {
            return;
        }
        for (link, wrench) in field.iter_mut().enumerate() {
            let mut pull = Vector6::zeros();
            for (i, map) in levers[link].iter().flatten() {
                pull += map.tr_mul(&Vector6::from_column_slice(&rhs[6 * i..6 * i + 6]));
            }
            let change = metric[link] * pull;
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
    let column = |k: usize| {
        let local = &program.columns[k].local;
        Vector6::new(local.force.x, local.force.y, local.force.z, local.torque.x, local.torque.y, local.torque.z)
    };
    let mut other_slack = vec![None; program.columns.len()];
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
        let scale = group.scale;
        let looseness = match block.links[group.link] {
            Link::Connection(_) => LOOSE_CONNECTION,
            Link::Contact(_) => LOOSE_CONTACT,
        };
        let loose = looseness * (force[group.link] * scale / program.scales.link[group.link]).powi(2);
        match group.cone {
            Cone::Free => {
                let c = column(group.first) * (scale * (force[group.link] / program.scales.link[group.link]).max(1.0));
                metric[group.link] += c * c.transpose();
            }
            Cone::NonNegative => {
                let c = column(group.first);
                let p = z[0];
                let room = match other_slack[group.first] {
                    Some(q) => p * p * q * q / (p * p + q * q).max(f64::MIN_POSITIVE),
                    None => p * p,
                };
                metric[group.link] += c * c.transpose() * (room * scale * scale + loose);
            }
            Cone::Lorentz => {
                // Quadratic representation 2 z z' - det(z) J.
                let determinant = determinant(z).max(0.0);
                let mut along = Vector6::zeros();
                for (k, value) in z.iter().enumerate() {
                    let c = column(group.first + k);
                    along += c * *value;
                    let sign = if k == 0 { -1.0 } else { 1.0 };
                    metric[group.link] += c * c.transpose() * (sign * determinant * scale * scale + loose);
                }
                metric[group.link] += along * along.transpose() * (2.0 * scale * scale);
            }
        }
    }
    metric
}

/// The maps from a link's wrench to the scaled balance rows of its bodies.
fn scaled_maps(structure: &Structure, block: &Block, program: &Program, link: usize) -> SideMaps {
    let frame = &program.frames[link];
    frame.sides().map(|(side, sign)| {
        let i = local_body(block, side)?;
        let com = &structure.bodies[block.bodies[i]].com;
        let lever = (frame.origin - com).cross_matrix() * frame.axes;
        let mut map = Matrix6::zeros();
        map.fixed_view_mut::<3, 3>(0, 0).copy_from(&frame.axes);
        map.fixed_view_mut::<3, 3>(3, 0).copy_from(&lever);
        map.fixed_view_mut::<3, 3>(3, 3).copy_from(&frame.axes);
        for row in 0..6 {
            let factor = sign * program.row_factor[6 * i + row];
            map.row_mut(row).scale_mut(factor);
        }
        Some((i, map))
    })
}

/// Factorises `sum map metric map'`, the stiffness matrix of the block.
fn factorise(bodies: usize, metric: &[Matrix6<f64>], maps: &[SideMaps]) -> Option<QDLDLFactorisation<f64>> {
    let mut blocks: std::collections::BTreeMap<(usize, usize), SMatrix<f64, 6, 6>> =
        (0..bodies).map(|i| ((i, i), Matrix6::zeros())).collect();
    for (metric, sides) in metric.iter().zip(maps) {
        for (i, a) in sides.iter().flatten() {
            for (j, b) in sides.iter().flatten().filter(|(j, _)| i <= j) {
                // Keyed by (column, row) so that iteration runs down the columns.
                *blocks.entry((*j, *i)).or_insert_with(Matrix6::zeros) += a * metric * b.transpose();
            }
        }
    }
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in 0..bodies {
        for k in 0..6 {
            for (&(_, row), block) in blocks.range((column, 0)..=(column, column)) {
                let height = if row == column { k + 1 } else { 6 };
                for r in 0..height {
                    rows.push(6 * row + r);
                    values.push(block[(r, k)]);
                }
            }
            starts.push(rows.len());
        }
    }
    let size = 6 * bodies;
    let matrix = CscMatrix::new(size, size, starts, rows, values);
    let settings = QDLDLSettingsBuilder::default()
        .Dsigns(vec![1; size])
        .regularize_enable(true)
        .regularize_eps(1e-30)
        .regularize_delta(1e-12)
        .build()
        .ok()?;
    QDLDLFactorisation::new(&matrix, Some(settings)).ok()
}
