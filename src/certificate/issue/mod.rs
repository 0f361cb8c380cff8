//! Makes a certificate from an answer of the oracle.
//!
//! Nothing here needs to be trusted: what does not verify is not issued. Fields that
//! the oracle returns are exact up to rounding only, while the checker wants proofs,
//! so they are prepared: wrenches are made to balance along the checker's own forest,
//! faces press a little harder than they must, bodies that move as one are given the
//! very same twist, and what opens opens a little faster.

mod mechanism;
mod settle;
mod stress;

use std::fmt;

use crate::statics::{Assessment, Bracket, Structure};

use super::allowance::Allowance;
use super::check::{Fault, check, follows};
use super::{Certificate, Mechanism, Stress, balance, motion};

/// Why an answer could not be certified.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertified {
    /// What the checker found wrong with what is nearest to the answer.
    pub faults: Vec<Fault>,
    /// How many times as large as the loads the answer's forces are: by as much more
    /// than that of the loads does their rounding count.
    pub forces: f64,
}

impl fmt::Display for Uncertified {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no certificate: ")?;
        match self.faults.first() {
            Some(fault) => write!(f, "{fault}")?,
            None => f.write_str("nothing is proved")?,
        }
        f.write_str("; the answer's fields are exact up to rounding only, and to prove it from them takes more")?;
        if self.forces > LARGE {
            write!(f, " (its largest force is {:.0e} times the loads)", self.forces)?;
        }
        Ok(())
    }
}

/// Forces, relative to the loads, from which on their rounding is worth a word.
const LARGE: f64 = 1e3;

impl std::error::Error for Uncertified {}

/// How far a certified bracket may reach beyond the answer's at either end, relative to
/// the larger of the bound and 1. Magnets with a radius of a nanometre, or thousands of
/// connections on one body, multiply the rounding of forces by as much; what is wider
/// would be another answer.
const WIDER: f64 = 1e-5;

/// Certifies an answer of the oracle on `structure`. The certificate claims the answer's
/// own bracket, widened to what the checker proves.
///
/// # Errors
/// The fields do not prove the answer; with what is wrong with them.
pub fn issue(structure: &Structure, answer: &Assessment) -> Result<Certificate, Uncertified> {
    let wanted = answer.utilisation;
    let refused = |faults| Uncertified { faults, forces: largest_force(structure, answer) };
    let (mut lower, mut mechanism) = (0.0, None);
    if wanted.lower > 0.0 {
        let (proved, found) = best_mechanism(structure, answer).map_err(refused)?;
        (lower, mechanism) = (proved, Some(found));
    }
    let (mut upper, mut stress) = (f64::INFINITY, None);
    if wanted.upper < f64::INFINITY {
        let (proved, found) = best_stress(structure, answer).map_err(refused)?;
        (upper, stress) = (proved, Some(found));
    }
    // Never more than the oracle says: proofs for data that are meant up to 1e-12 may cross.
    let utilisation = Bracket::new(lower.min(wanted.lower), upper.max(wanted.upper));
    let room = |bound: f64| WIDER * bound.max(1.0);
    let near = utilisation.lower == wanted.lower || utilisation.lower >= wanted.lower - room(wanted.lower);
    let near = near && (utilisation.upper == wanted.upper || utilisation.upper <= wanted.upper + room(wanted.upper));
    let verdict = follows(utilisation).filter(|verdict| *verdict == answer.verdict);
    let Some(verdict) = verdict.filter(|_| near) else {
        let Bracket { lower: from, upper: to } = wanted;
        let problem = format!(
            "rounding of its forces and velocities widens [{from}, {to}] to [{}, {}]",
            utilisation.lower, utilisation.upper
        );
        return Err(refused(vec![Fault::Claim(problem)]));
    };
    let certificate = Certificate { structure: structure.clone(), verdict, utilisation, stress, mechanism };
    match check(&certificate) {
        Ok(_) => Ok(certificate),
        Err(faults) => Err(refused(faults)),
    }
}

/// The largest force of an answer over the sum of all loads.
fn largest_force(structure: &Structure, answer: &Assessment) -> f64 {
    let forces = answer.connections.iter().map(|state| state.wrench.force.norm().max(state.strength));
    let largest = forces.chain(answer.contacts.iter().map(|force| force.norm())).fold(0.0, f64::max);
    let weights = structure.bodies.iter().map(|body| body.mass * structure.gravity.norm());
    largest / weights.chain(structure.loads.iter().map(|load| load.force.norm())).sum::<f64>()
}

/// The prepared stress that proves the least upper bound.
fn best_stress(structure: &Structure, answer: &Assessment) -> Result<(f64, Stress), Vec<Fault>> {
    let mut first = None;
    for prepared in stress::prepare(structure, answer) {
        match balance::upper_bound(structure, &prepared, &mut Allowance::default()) {
            Ok(upper) => return Ok((upper, prepared)),
            Err(faults) => first = first.or(Some(faults)),
        }
    }
    Err(first.unwrap_or_default())
}

/// The prepared mechanism that proves the largest lower bound, or the first that comes
/// close enough to the answer's.
fn best_mechanism(structure: &Structure, answer: &Assessment) -> Result<(f64, Mechanism), Vec<Fault>> {
    let wanted = answer.utilisation.lower;
    let collapse = wanted == f64::INFINITY;
    let mut best: Option<(f64, Mechanism)> = None;
    let mut first = None;
    for prepared in mechanism::prepare(structure, &answer.mechanism, collapse) {
        match motion::lower_bound(structure, &prepared, collapse, &mut Allowance::default()) {
            Ok(lower) if lower > best.as_ref().map_or(0.0, |best| best.0) => {
                let enough = lower >= wanted - 1e-12 * wanted.max(1.0) || lower == wanted;
                best = Some((lower, prepared));
                if enough {
                    break;
                }
            }
            Ok(_) => {}
            Err(faults) => first = first.or(Some(faults)),
        }
    }
    best.ok_or_else(|| first.unwrap_or_else(|| vec![Fault::Claim("the mechanism does no work".to_owned())]))
}
