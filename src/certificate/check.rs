//! Claims against proofs.

use std::fmt;

use crate::statics::{Bracket, Verdict};

use super::Certificate;
use super::allowance::Allowance;
use super::balance::upper_bound;
use super::motion::lower_bound;
use super::sound::unsound;

/// What a certificate proves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// The bracket that its fields prove, within the one that it claims.
    pub utilisation: Bracket,
    /// Largest part of a load, a force or a speed that had to count as none because
    /// data are meant up to [`DATA`](super::DATA) only (dimensionless); 0 when the proof holds for
    /// the data as they are, to the last bit.
    pub forgiven: f64,
}

/// What is wrong with a certificate. Parts are named by their index in the structure.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Its data mean nothing.
    Unsound(String),
    /// It claims more than its fields prove.
    Claim(String),
    /// A body is out of balance, or moves where it must not.
    Body {
        /// Which one.
        body: usize,
        /// What is wrong, with amounts.
        problem: String,
    },
    /// A connection does not carry what it should, or resists the mechanism.
    Connection {
        /// Which one.
        connection: usize,
        /// What is wrong, with amounts.
        problem: String,
    },
    /// A contact force leaves its friction cone, or a contact resists the mechanism.
    Contact {
        /// Which one.
        contact: usize,
        /// What is wrong, with amounts.
        problem: String,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsound(problem) | Self::Claim(problem) => f.write_str(problem),
            Self::Body { body, problem } => write!(f, "body {body} {problem}"),
            Self::Connection { connection, problem } => write!(f, "connection {connection} {problem}"),
            Self::Contact { contact, problem } => write!(f, "contact {contact} {problem}"),
        }
    }
}

impl std::error::Error for Fault {}

/// Checks a certificate: its verdict against its bracket, its bracket against what its
/// fields prove.
///
/// # Errors
/// All that is wrong with it, at least one fault.
pub fn check(certificate: &Certificate) -> Result<Proof, Vec<Fault>> {
    if let Some(problem) = unsound(certificate) {
        return Err(vec![Fault::Unsound(problem)]);
    }
    let mut faults = Vec::new();
    let claimed = certificate.utilisation;
    match follows(claimed) {
        Some(verdict) if verdict == certificate.verdict => {}
        Some(verdict) => {
            let problem = format!("the verdict {:?} is claimed, but {verdict:?} follows", certificate.verdict);
            faults.push(Fault::Claim(problem));
        }
        None => faults.push(Fault::Claim(format!("[{}, {}] is no bracket", claimed.lower, claimed.upper))),
    }
    let mut allowance = Allowance::default();
    let mut proved = Bracket::new(0.0, f64::INFINITY);
    if let Some(stress) = &certificate.stress {
        match upper_bound(&certificate.structure, stress, &mut allowance) {
            Ok(upper) => proved.upper = upper,
            Err(found) => faults.extend(found),
        }
    }
    if let Some(mechanism) = &certificate.mechanism {
        let collapse = claimed.lower == f64::INFINITY;
        match lower_bound(&certificate.structure, mechanism, collapse, &mut allowance) {
            Ok(lower) => proved.lower = lower,
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() && !(claimed.lower <= proved.lower) {
        faults.push(Fault::Claim(format!("the mechanism proves {} from below, not {}", proved.lower, claimed.lower)));
    }
    if faults.is_empty() && !(proved.upper <= claimed.upper) {
        faults.push(Fault::Claim(format!("the stress proves {} from above, not {}", proved.upper, claimed.upper)));
    }
    if faults.is_empty() { Ok(Proof { utilisation: proved, forgiven: allowance.forgiven }) } else { Err(faults) }
}

/// The verdict that follows from a bracket; `None` when it is none.
pub(super) fn follows(utilisation: Bracket) -> Option<Verdict> {
    let Bracket { lower, upper } = utilisation;
    if !(0.0 <= lower && lower <= upper) {
        return None;
    }
    Some(match (lower, upper) {
        (f64::INFINITY, _) => Verdict::WholeBodyUnstable,
        (_, upper) if upper <= 1.0 => Verdict::Stable,
        (lower, _) if lower > 1.0 => Verdict::InternallyUnstable,
        _ => Verdict::Undecided,
    })
}
