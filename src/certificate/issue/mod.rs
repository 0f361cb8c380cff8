//! Makes a certificate from an answer of the oracle.
//!
//! Nothing here needs to be trusted: what does not verify is not issued. Fields that
//! the oracle returns are exact up to rounding only, while the checker wants proofs,
//! so they are prepared: wrenches are made to balance along the checker's own forest,
//! faces press a little harder than they must, bodies that move as one are given the
//! very same twist, and what opens opens a little faster.

mod mechanism;
mod stress;

use std::fmt;

use crate::statics::{Assessment, Bracket, Structure};

use super::check::{Fault, check, follows};
use super::models::Allowance;
use super::{Certificate, Mechanism, Stress, balance, motion};

/// Why an answer could not be certified.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertified {
    /// What the checker found wrong with the best attempt.
    pub faults: Vec<Fault>,
}

impl fmt::Display for Uncertified {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no certificate: ")?;
        match self.faults.first() {
            Some(fault) => write!(f, "{fault}"),
            None => f.write_str("nothing is proved"),
        }
    }
}

impl std::error::Error for Uncertified {}

/// How far a certified bracket may reach beyond the answer's at either end, relative to
/// the larger of the bound and 1: what preparing the fields may cost, no more than the
/// width to which the utilisation is usually asked for.
const WIDER: f64 = 1e-7;

/// Certifies an answer of the oracle on `structure`. The certificate's bracket is what
/// the checker itself proves, wider than the answer's by rounding.
///
/// # Errors
/// The fields do not prove the answer; with what is wrong with them.
pub fn issue(structure: &Structure, answer: &Assessment) -> Result<Certificate, Uncertified> {
    let wanted = answer.utilisation;
    let (mut lower, mut mechanism) = (0.0, None);
    if wanted.lower > 0.0 {
        let (proved, found) = best_mechanism(structure, answer).map_err(|faults| Uncertified { faults })?;
        (lower, mechanism) = (proved, Some(found));
    }
    let (mut upper, mut stress) = (f64::INFINITY, None);
    if wanted.upper < f64::INFINITY {
        let (proved, found) = best_stress(structure, answer).map_err(|faults| Uncertified { faults })?;
        (upper, stress) = (proved, Some(found));
    }
    // Proofs for data that are meant up to 1e-12 may cross by as much.
    let utilisation = Bracket::new(lower.min(upper), upper.max(lower));
    let near = |proved: f64, wanted: f64| proved == wanted || (proved - wanted).abs() <= WIDER * wanted.max(1.0);
    let Some(verdict) = follows(utilisation).filter(|verdict| *verdict == answer.verdict) else {
        let problem = format!("[{lower}, {upper}] is proved, from which {:?} does not follow", answer.verdict);
        return Err(Uncertified { faults: vec![Fault::Claim(problem)] });
    };
    if !(near(utilisation.lower, wanted.lower) && near(utilisation.upper, wanted.upper)) {
        let problem = format!("[{lower}, {upper}] is proved of [{}, {}]", wanted.lower, wanted.upper);
        return Err(Uncertified { faults: vec![Fault::Claim(problem)] });
    }
    let certificate = Certificate { structure: structure.clone(), verdict, utilisation, stress, mechanism };
    match check(&certificate) {
        Ok(_) => Ok(certificate),
        Err(faults) => Err(Uncertified { faults }),
    }
}

/// The prepared stress that proves the least upper bound.
fn best_stress(structure: &Structure, answer: &Assessment) -> Result<(f64, Stress), Vec<Fault>> {
    let mut last = Vec::new();
    for prepared in stress::prepare(structure, answer) {
        match balance::upper_bound(structure, &prepared, &mut Allowance::default()) {
            Ok(upper) => return Ok((upper, prepared)),
            Err(faults) => last = faults,
        }
    }
    Err(last)
}

/// The prepared mechanism that proves the largest lower bound, or the first that comes
/// close enough to the answer's.
fn best_mechanism(structure: &Structure, answer: &Assessment) -> Result<(f64, Mechanism), Vec<Fault>> {
    let wanted = answer.utilisation.lower;
    let collapse = wanted == f64::INFINITY;
    let mut best: Option<(f64, Mechanism)> = None;
    let mut last = vec![Fault::Claim("the mechanism does no work".to_owned())];
    for prepared in mechanism::prepare(structure, &answer.mechanism) {
        match motion::lower_bound(structure, &prepared, collapse, &mut Allowance::default()) {
            Ok(lower) if lower > best.as_ref().map_or(0.0, |best| best.0) => {
                let enough = lower >= wanted - 1e-12 * wanted.max(1.0) || lower == wanted;
                best = Some((lower, prepared));
                if enough {
                    break;
                }
            }
            Ok(_) => {}
            Err(faults) => last = faults,
        }
    }
    best.ok_or(last)
}
