//! Which margins to try for.

use crate::reconfigure::domain::Domain;

use super::ways::Ways;

/// Shares of what start and goal leave above the required margin.
const SHARES: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 0.95];

/// Margins to build for: by bisection between the largest that was attained and the smallest that was not.
pub struct Levels {
    /// Ascending; the first is the one required.
    listed: Vec<f64>,
    /// How many of the list are attained, or below one that is.
    attained: usize,
    /// The first of the list that is not, or above one that is not.
    missed: usize,
    /// The last one tried, by its place; `None` for one between two of the list, which is the last of all.
    tried: Option<usize>,
    /// No plan has a larger margin.
    at_most: f64,
    is_over: bool,
}

impl Levels {
    /// From what is `required` up to what start and goal allow (`at_most`).
    pub fn new(domain: &Domain, required: Option<f64>, at_most: f64) -> Self {
        let mut listed = vec![f64::NEG_INFINITY];
        if let (true, Some(required)) = (domain.stability, required) {
            let span = at_most.min(1.0) - required;
            listed = vec![required];
            listed.extend(SHARES.iter().map(|share| required + share * span).filter(|&level| level > required));
        }
        Self { attained: 0, missed: listed.len(), listed, tried: None, at_most, is_over: false }
    }

    /// The next margin. When the list is decided, the last one is the largest margin of any move
    /// between the two of the list that are left: only there further moves come into question.
    pub fn next(&mut self, ways: &Ways) -> Option<f64> {
        if self.is_over {
            return None;
        }
        if self.attained < self.missed {
            let place = usize::midpoint(self.attained, self.missed - 1);
            self.tried = Some(place);
            return Some(self.listed[place]);
        }
        self.is_over = true;
        self.tried = None;
        let low = *self.listed.get(self.attained.checked_sub(1)?)?;
        let high = self.listed.get(self.missed).copied().unwrap_or(self.at_most);
        ways.largest_margin_below(high).filter(|&margin| margin > low)
    }

    /// Whether the last one tried is the margin that is required.
    pub fn is_required(&self) -> bool {
        self.tried == Some(0)
    }

    /// Forgets which ones were not attained: there is another way to try.
    pub fn reopen(&mut self) {
        self.missed = self.listed.len();
    }

    /// Takes note of whether the last one was attained.
    pub fn note(&mut self, is_attained: bool) {
        match (self.tried, is_attained) {
            (Some(place), true) => self.attained = place + 1,
            (Some(place), false) => self.missed = place,
            (None, _) => {}
        }
    }
}
