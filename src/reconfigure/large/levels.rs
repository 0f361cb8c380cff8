//! Which margins to try for.

use crate::reconfigure::domain::Domain;

use super::ways::Ways;

/// Shares of what start and goal leave above the required margin.
const SHARES: [f64; 5] = [0.95, 0.8, 0.6, 0.4, 0.2];

/// Margins to build for, the largest first.
pub struct Levels {
    /// What is left of the list, the smallest first.
    listed: Vec<f64>,
    last: f64,
}

impl Levels {
    /// From what start and goal allow (`at_most`) down to what is `required`.
    pub fn new(domain: &Domain, required: Option<f64>, at_most: f64) -> Self {
        let mut listed = vec![f64::NEG_INFINITY];
        if let (true, Some(required)) = (domain.stability, required) {
            listed = vec![required];
            let span = at_most.min(1.0) - required;
            let shares = SHARES.iter().rev().map(|share| required + share * span);
            listed.extend(shares.filter(|&level| level > required));
        }
        Self { listed, last: f64::INFINITY }
    }

    /// The next margin: the next of the list, or the largest that some move attains above that, since
    /// only there a further move comes into question.
    pub fn next(&mut self, ways: &Ways) -> Option<f64> {
        let listed = *self.listed.last()?;
        let attained = ways.largest_margin_below(self.last).filter(|&margin| margin > listed);
        if attained.is_none() {
            self.listed.pop();
        }
        self.last = attained.unwrap_or(listed);
        Some(self.last)
    }

    /// Whether there is no other after the one that came last.
    pub fn is_last(&self) -> bool {
        self.listed.is_empty()
    }
}
