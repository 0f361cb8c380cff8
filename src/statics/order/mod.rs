//! The order in which connections would give way.
//!
//! The utilisation says how much the most loaded connections need at least; all others could
//! be loaded in many ways below that. The order goes on: with the critical connections held at
//! what they need, the least that the most loaded of the others needs, and so on,
//!
//! ```text
//! t_1 = min max s_l / S_l,   t_k = min t  subject to  balance, friction cones,
//!                                          s_l <= t_j S_l for what is critical at level j < k,
//!                                          s_l <= t S_l for all others,
//! ```
//!
//! the lexicographic minimax. Connections with a share in the mechanism of a level are critical
//! there: less than that level is not enough for them together. Every level is a bracket (see
//! `level`): from above by a wrench field in which all levels hold, from below by a motion, with
//! what the connections of earlier levels dissipate taken off its power. Earlier levels count with their
//! upper ends, and a little more for rounding, so that each level states something for itself.
//!
//! Blocks are independent of each other, so their levels are found apart and merged. It is an
//! order of loads in the structure as it is: what happens after a connection broke is another structure.

mod level;

use super::assessment::{Bracket, Question};
use super::blocks::{Block, Link, cut};
use super::closed_form::assess_bridge;
use super::loads::{BodyLoad, lump, own_loads};
use super::part::Part;
use super::reductions::Reductions;
use super::rigid_links::Merged;
use super::solve_block::assess_block;
use super::structure::Structure;
use super::tolerances::CRITICAL_SHARE;
use super::validate::{InvalidStructure, validate};

use level::{Held, next};

/// Connections that would give way together.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureLevel {
    /// What they need at least, as a utilisation, once all before have what they need.
    pub utilisation: Bracket,
    /// Indices into [`Structure::connections`], ascending.
    pub connections: Vec<usize>,
}

/// The order in which connections would give way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FailureOrder {
    /// The most loaded first. Brackets of neighbouring levels may overlap.
    pub levels: Vec<FailureLevel>,
    /// Connections that nothing has to flow through once all levels have what they need, ascending.
    pub idle: Vec<usize>,
    /// Those whose level was not asked for or could not be proved, ascending.
    pub open: Vec<usize>,
}

/// Utilisation, as a share of the largest, below which nothing has to flow through a connection.
const IDLE: f64 = 1e-7;

/// Relative difference of levels that count as one.
const SAME: f64 = 1e-6;

/// The first `most` levels of the order in which the connections of `structure` would give way; `None`
/// when it is whole-body unstable, or that is not excluded.
///
/// # Errors
/// As for [`assess`](super::assess()).
pub fn failure_order(structure: &Structure, most: usize) -> Result<Option<FailureOrder>, Vec<InvalidStructure>> {
    validate(structure)?;
    let merged = Merged::new(structure);
    let structure = merged.as_ref().map_or(structure, |merged| &merged.structure);
    let pieces = cut(structure);
    let loads = lump(structure, &pieces.blocks, own_loads(structure));
    if pieces.afloat.iter().any(|&root| super::assess::drift(&loads[root]).is_some()) {
        return Ok(None);
    }
    let mut found = Found { levels: Vec::new(), known: vec![false; structure.connections.len()], most };
    for block in &pieces.blocks {
        if !found.add(structure, block, &loads) {
            return Ok(None);
        }
    }
    Ok(Some(found.order(structure)))
}

/// The levels of the blocks so far.
struct Found {
    levels: Vec<FailureLevel>,
    /// Which connections have a level or were found idle.
    known: Vec<bool>,
    most: usize,
}

impl Found {
    /// Adds the levels of a block; whether it can stand.
    fn add(&mut self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> bool {
        if let [link] = block.links[..] {
            let utilisation = assess_bridge(structure, link, block.bodies[0], loads).utilisation;
            if let (Link::Connection(i), true) = (link, utilisation.upper.is_finite()) {
                self.note(utilisation, vec![i]);
            }
            return utilisation.upper.is_finite();
        }
        let first = assess_block(structure, block, loads, Question::VALUE, 0.0, Reductions::ALL);
        let Part::Stands { utilisation, shares, .. } = first else { return false };
        if !utilisation.upper.is_finite() {
            return false;
        }
        let mut held = Held::new(block.links.len());
        let (mut level, mut shares) = (utilisation, shares);
        for _ in 0..self.most {
            let free = |(index, link): (usize, &Link)| match link {
                Link::Connection(i) if held.is_free(index) => Some((index, *i)),
                _ => None,
            };
            let free: Vec<(usize, usize)> = block.links.iter().enumerate().filter_map(free).collect();
            if level.upper <= IDLE * utilisation.upper.max(f64::MIN_POSITIVE) {
                for (_, connection) in free {
                    self.known[connection] = true;
                }
                break;
            }
            let critical: Vec<(usize, usize)> =
                free.iter().copied().filter(|(index, _)| shares[*index] > CRITICAL_SHARE).collect();
            if critical.is_empty() {
                break;
            }
            for (index, _) in &critical {
                held.hold(*index, level.upper);
            }
            self.note(level, critical.iter().map(|(_, connection)| *connection).collect());
            if critical.len() == free.len() {
                break;
            }
            let Some(found) = next(structure, block, loads, &held) else { break };
            (level, shares) = found;
        }
        true
    }

    fn note(&mut self, utilisation: Bracket, connections: Vec<usize>) {
        for &connection in &connections {
            self.known[connection] = true;
        }
        self.levels.push(FailureLevel { utilisation, connections });
    }

    /// The levels of all blocks in one order.
    fn order(mut self, structure: &Structure) -> FailureOrder {
        let largest = self.levels.iter().map(|level| level.utilisation.upper).fold(0.0, f64::max);
        self.levels.sort_by(|a, b| {
            b.utilisation.upper.total_cmp(&a.utilisation.upper).then(a.connections.cmp(&b.connections))
        });
        let mut order = FailureOrder::default();
        for FailureLevel { utilisation, connections } in self.levels {
            if utilisation.upper <= IDLE * largest || utilisation.upper == 0.0 {
                order.idle.extend(connections);
                continue;
            }
            let room = order.levels.len() < self.most;
            match order.levels.last_mut() {
                Some(level) if level.utilisation.upper - utilisation.upper <= SAME * level.utilisation.upper => {
                    level.utilisation = level.utilisation.max(utilisation);
                    level.connections.extend(connections);
                }
                _ if room => order.levels.push(FailureLevel { utilisation, connections }),
                _ => order.open.extend(connections),
            }
        }
        for level in &mut order.levels {
            level.connections.sort_unstable();
        }
        let listed = |i: &usize| order.levels.iter().any(|level| level.connections.binary_search(i).is_ok());
        let unlimited = |i: usize| structure.connectors[structure.connections[i].connector].model.is_unlimited();
        for (i, known) in self.known.iter().enumerate() {
            if *known || unlimited(i) {
                if !listed(&i) && !order.open.contains(&i) && !order.idle.contains(&i) {
                    order.idle.push(i);
                }
            } else {
                order.open.push(i);
            }
        }
        order.idle.sort_unstable();
        order.open.sort_unstable();
        order
    }
}
