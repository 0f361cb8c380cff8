//! Strengths that are never needed, lowered to what might be.
//!
//! A connection that is a million times stronger than what flows through it
//! calls for nothing, but its cone variable is a million times the forces, and
//! beside it the program loses the small ones. Letting it use a share of its
//! strength only costs nothing as long as it does not use that share up: what
//! holds with less holds with more, and a connection that is not at its limit
//! does not move in the collapse mechanism. Which shares suffice is a guess here
//! and proved elsewhere: see `bracket`.

use super::blocks::{Block, Link};
use super::connector::{Connector, Model};
use super::program::Program;
use super::structure::Structure;

/// How many times the typical force a connection may use at first, and by how
/// much that grows where it is used up.
const ROOM: f64 = 1e2;

/// Part of its share from which on a connection counts as using it up.
const USED_UP: f64 = 0.1;

/// How many times the typical force each link of a block may use.
pub(super) struct Lowered {
    room: Vec<f64>,
    /// Utilisation that the typical force demands; infinite for contacts.
    typical: Vec<f64>,
}

impl Lowered {
    pub(super) fn new(structure: &Structure, block: &Block, program: &Program) -> Self {
        let typical = block.links.iter().enumerate().map(|(index, link)| match link {
            Link::Contact(_) => f64::INFINITY,
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[*i].connector];
                typical_demand(connector, program.scales.link[index], program.lever_of(index))
            }
        });
        Self { room: vec![ROOM; block.links.len()], typical: typical.collect() }
    }

    /// The share of its strength that every link may use where about `t` is needed.
    pub(super) fn shares(&self, t: f64) -> Vec<f64> {
        self.typical.iter().zip(&self.room).map(|(typical, room)| (room * typical / t).min(1.0)).collect()
    }

    /// Gives more room to the links that use up their shares in a state with these
    /// demands; whether there are any.
    pub(super) fn raise(&mut self, shares: &[f64], demands: &[f64], t: f64) -> bool {
        let mut any = false;
        for ((room, share), demand) in self.room.iter_mut().zip(shares).zip(demands) {
            if *share < 1.0 && *demand > USED_UP * share * t {
                *room *= ROOM;
                any = true;
            }
        }
        any
    }
}

/// Utilisation that a typical force at a typical lever demands of a connector.
fn typical_demand(connector: &Connector, force: f64, lever: f64) -> f64 {
    let strength = connector.strength;
    match &connector.model {
        Model::Cone { friction, radius } => {
            let shear = friction.iter().map(|mu| 1.0 / mu).fold(1.0, f64::max);
            let torque = radius.iter().map(|rho| lever / rho).fold(0.0, f64::max);
            force * shear.max(torque) / strength
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            let least = |limits: &[f64]| limits.iter().copied().filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
            let (forces, torques) = ([shear[0], shear[1], *tension, *compression], [bending[0], bending[1], *torsion]);
            (force / least(&forces)).max(force * lever / least(&torques))
        }
        Model::Patch { friction, points } => {
            let reach = points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
            force * (1.0 + 1.0 / friction + lever / reach) / strength
        }
    }
}
