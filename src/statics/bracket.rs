//! Bounds on a block's utilisation, from fields alone.
//!
//! Limit-analysis duality: the largest demand of *any* balanced wrench field is
//! an upper bound, and power over dissipation of *any* admissible twist field is
//! a lower bound, whoever proposed them. Both are evaluated here on the original,
//! unscaled data, without the solver's matrices or status.

use crate::spatial::{Twist, Wrench};

use super::blocks::{Block, Link};
use super::connector::{Connector, Model};
use super::demand::{WrenchError, demand_at_most};
use super::loads::{BodyLoad, cross_size};
use super::program::Program;
use super::second_order::norm;
use super::structure::Structure;
use super::tolerances::{BALANCE, DATA, ROUNDING};

/// A block with what its bounds are evaluated from.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub structure: &'a Structure,
    pub block: &'a Block,
    pub loads: &'a [BodyLoad],
    pub program: &'a Program,
}

impl Problem<'_> {
    /// Upper bound on the utilisation from a wrench per link, in its frame, and
    /// the utilisation of each link (0 for contacts).
    /// `None` when the field does not balance or leaves a friction cone. Where a
    /// link's utilisation is at most `enough`, it is only said that it is.
    ///
    /// What imbalance is left, at most [`BALANCE`] of the flow through a body,
    /// is charged with its power in the twist field `twists` of unit dissipation.
    pub(super) fn upper_bound(
        &self,
        field: &[Wrench],
        twists: Option<&[Twist]>,
        enough: f64,
    ) -> Option<(f64, Vec<f64>)> {
        self.upper_bound_by(field, twists, |_, connector, wrench, error| {
            demand_at_most(connector, wrench, error, enough)
        })
    }

    /// As [`upper_bound`](Self::upper_bound), with upper bounds on the demands of connections, one
    /// after the other, from elsewhere.
    pub(super) fn upper_bound_by(
        &self,
        field: &[Wrench],
        twists: Option<&[Twist]>,
        demand: impl FnMut(Link, &Connector, &Wrench, &WrenchError) -> f64,
    ) -> Option<(f64, Vec<f64>)> {
        let charge = self.charge(field, twists)?;
        let demands = self.demands(field, demand)?;
        Some((demands.iter().copied().fold(0.0, f64::max) + charge, demands))
    }

    /// What the imbalance of `field` is charged with in `twists`; `None` where it is too large.
    fn charge(&self, field: &[Wrench], twists: Option<&[Twist]>) -> Option<f64> {
        let Self { block, program, .. } = self;
        let mut charge = 0.0;
        let through = self.forces_through(field);
        for (i, lacking) in program.residuals(block, self.loads, field).iter().enumerate() {
            let allowed = BALANCE * program.scales.force[i] + ROUNDING * through[i];
            let holds = lacking.force.norm() <= allowed && lacking.torque.norm() <= allowed * program.scales.lever[i];
            if !holds {
                return None;
            }
            // The imbalance is known up to rounding only, which a nearly singular
            // support multiplies as it does the imbalance.
            let (unknown, lever) = (ROUNDING * through[i], program.scales.lever[i]);
            charge += twists.map_or(0.0, |twists| {
                let v = &twists[i];
                v.power(lacking).abs() + (v.linear.norm() + v.angular.norm() * lever) * unknown
            });
        }
        Some(charge)
    }

    /// The utilisation of each link in `field` as `demand` has it, 0 for contacts. `None` where one
    /// is infinite or a force leaves its friction cone.
    pub(super) fn demands(
        &self,
        field: &[Wrench],
        mut demand: impl FnMut(Link, &Connector, &Wrench, &WrenchError) -> f64,
    ) -> Option<Vec<f64>> {
        let Self { structure, block, program, .. } = self;
        let mut demands = Vec::with_capacity(field.len());
        for (l, (&link, wrench)) in block.links.iter().zip(field).enumerate() {
            match link {
                Link::Contact(i) => {
                    let slip = DATA * program.scales.link[l];
                    let friction = structure.contacts[i].friction;
                    let held = wrench.force.z >= -slip
                        && wrench.force.xy().norm() <= friction * wrench.force.z.max(0.0) + slip;
                    if !held {
                        return None;
                    }
                    demands.push(0.0);
                }
                Link::Connection(i) => {
                    let connector = &structure.connectors[structure.connections[i].connector];
                    let upper = demand(link, connector, wrench, &rounding(wrench));
                    if !(upper < f64::INFINITY) {
                        return None;
                    }
                    demands.push(upper);
                }
            }
        }
        Some(demands)
    }

    /// Sum of the sizes of all forces on every body of the block.
    pub(super) fn forces_through(&self, field: &[Wrench]) -> Vec<f64> {
        let mut through = vec![0.0; self.block.bodies.len()];
        for (ends, wrench) in self.program.ends.iter().zip(field) {
            let (force, torque) = (wrench.force.norm(), wrench.torque.norm());
            for &i in ends.iter().flatten() {
                through[i] += force + torque / self.program.scales.lever[i];
            }
        }
        through
    }

    /// How much each link moves in a twist field along every component in its frame, as the
    /// power it would take up if the force that typically flows through it acted there.
    pub(super) fn link_powers(&self, twists: &[Twist]) -> Vec<[f64; 6]> {
        let program = self.program;
        let scales = program.scales.link.iter().enumerate();
        scales
            .map(|(l, force)| {
                let Twist { linear: v, angular: w } = program.relative_twist(l, twists);
                let lever = program.lever_of(l);
                [v.x, v.y, v.z, w.x * lever, w.y * lever, w.z * lever].map(|motion| force * motion.abs())
            })
            .collect()
    }

    /// Lower bound on the utilisation from a twist per body of the block, of its
    /// centre of mass in W, with the share of each link in the dissipation.
    /// `None` when the field is not admissible or does no positive work.
    pub(super) fn lower_bound(&self, twists: &[Twist]) -> Option<(f64, Vec<f64>)> {
        let (dissipation, mut shares) = self.dissipation(twists)?;
        let (power, error) = self.power(self.loads, twists);
        let power = power - error;
        if !(power > 0.0 && dissipation > 0.0) {
            return None;
        }
        for share in &mut shares {
            *share /= dissipation;
        }
        Some((power / dissipation, shares))
    }

    /// Upper bound on the power in W that the connections at their rated strengths dissipate
    /// in a twist per body of the block, and what each link takes up. `None` when the
    /// field is not admissible.
    pub(super) fn dissipation(&self, twists: &[Twist]) -> Option<(f64, Vec<f64>)> {
        let Self { structure, block, program, .. } = self;
        let mut shares = Vec::with_capacity(block.links.len());
        let mut dissipation = 0.0;
        for (l, &link) in block.links.iter().enumerate() {
            let relative = program.relative_twist(l, twists);
            let error = self.velocity_error(l, twists);
            let share = match link {
                Link::Contact(i) => {
                    let friction = structure.contacts[i].friction;
                    let slack = relative.linear.z - friction * relative.linear.xy().norm();
                    if !(slack >= error.linear * (1.0 + friction)) {
                        return None;
                    }
                    0.0
                }
                Link::Connection(i) => {
                    let connector = &structure.connectors[structure.connections[i].connector];
                    dissipated(connector, &relative, &error)?
                }
            };
            dissipation += share;
            shares.push(share);
        }
        Some((dissipation * (1.0 + (block.links.len() as f64 + 16.0) * f64::EPSILON), shares))
    }

    /// Power in W of `loads`, indexed by the structure's bodies, in a twist per body of the
    /// block, and a bound on its rounding error.
    pub(super) fn power(&self, loads: &[BodyLoad], twists: &[Twist]) -> (f64, f64) {
        let (mut power, mut size) = (0.0, 0.0);
        for (twist, &body) in twists.iter().zip(&self.block.bodies) {
            let load = &loads[body];
            power += twist.power(&load.wrench);
            size += twist.linear.abs().dot(&load.force_size) + twist.angular.abs().dot(&load.torque_size);
        }
        (power, size * (self.block.bodies.len() as f64 + 16.0) * f64::EPSILON)
    }

    /// Rounding of a link's relative twist.
    fn velocity_error(&self, link: usize, twists: &[Twist]) -> VelocityError {
        let program = self.program;
        let (mut linear, mut angular) = (0.0, 0.0);
        for &i in program.ends[link].iter().flatten() {
            let arm = program.frames[link].origin - program.coms[i];
            let twist = &twists[i];
            linear += (twist.linear.abs() + cross_size(&arm, &twist.angular.abs())).norm();
            angular += twist.angular.norm();
        }
        VelocityError { linear: ROUNDING * linear, angular: ROUNDING * angular }
    }
}

/// Bounds on the errors of a relative twist's components.
#[derive(Clone, Copy)]
struct VelocityError {
    /// In m/s.
    linear: f64,
    /// In rad/s.
    angular: f64,
}

/// Rounding of a wrench that was just computed.
fn rounding(wrench: &Wrench) -> WrenchError {
    WrenchError { force: wrench.force.abs() * ROUNDING, torque: wrench.torque.abs() * ROUNDING }
}

/// Power that a connector at its rated strength dissipates in a relative twist
/// of the child, in the connection frame; `None` when the twist is not
/// admissible, i.e. when the connector could resist it without limit. Each
/// component of the twist is uncertain by `error`.
fn dissipated(connector: &Connector, relative: &Twist, error: &VelocityError) -> Option<f64> {
    let Twist { linear: v, angular: w } = relative;
    match &connector.model {
        Model::Cone { friction: [a, b], radius: [c, d, e] } => {
            let rubbing = norm(&[a * v.x, b * v.y, c * w.x, d * w.y, e * w.z]);
            let slack = v.z - rubbing;
            let uncertain = error.linear * (1.0 + a + b) + error.angular * (c + d + e);
            (slack >= uncertain).then_some(connector.strength * (v.z + error.linear))
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            let components = [
                (v.x, error.linear, shear[0], shear[0]),
                (v.y, error.linear, shear[1], shear[1]),
                (v.z, error.linear, *tension, *compression),
                (w.x, error.angular, bending[0], bending[0]),
                (w.y, error.angular, bending[1], bending[1]),
                (w.z, error.angular, *torsion, *torsion),
            ];
            let mut total = 0.0;
            for (velocity, error, opening_limit, closing_limit) in components {
                let admissible = match (opening_limit.is_finite(), closing_limit.is_finite()) {
                    (true, true) => true,
                    (true, false) => velocity >= error,
                    (false, true) => velocity <= -error,
                    (false, false) => velocity.abs() <= error * (DATA / ROUNDING),
                };
                if !admissible {
                    return None;
                }
                let limit = if velocity >= 0.0 { opening_limit } else { closing_limit };
                if limit.is_finite() {
                    total += limit * (velocity.abs() + error);
                }
            }
            Some(total)
        }
        Model::Patch { friction, points } => {
            for p in points {
                let at = relative.at(&crate::spatial::Vec3::new(p[0], p[1], 0.0));
                let uncertain = (error.linear + error.angular * (p[0].abs() + p[1].abs())) * (1.0 + friction);
                if !(at.z - friction * at.xy().norm() >= uncertain) {
                    return None;
                }
            }
            Some(connector.strength * (v.z + error.linear))
        }
    }
}
