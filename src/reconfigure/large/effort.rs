//! How much work attempts are worth, so that planning ends by itself and the same way on any machine.
//!
//! Knows counts of work; does not know what is done.

/// Work that one further attempt may take, and all of them together, in terms of that which led to the first plan.
const FURTHER: [u64; 2] = [2, 4];

/// Work that any attempt may take, and all after the first plan together, however small the robot is and however soon it came:
/// seconds for dozens of modules.
const LEAST: [u64; 2] = [10_000, 30_000];

/// Work that is left for attempts.
pub struct Effort {
    /// Modules that are not in place at the start, at least one.
    away: u64,
    /// Work that led to the first plan, and all that was done since.
    first: Option<u64>,
    further: u64,
}

impl Effort {
    /// For so many modules that are not in place.
    pub fn new(away: usize) -> Self {
        Self { away: (away as u64).max(1), first: None, further: 0 }
    }

    /// Work that the next attempt may take, before there is a plan so much `each` for every module that is not in place;
    /// `None` where none is worth it any more.
    pub fn limit(&self, each: u64) -> Option<u64> {
        let Some(first) = self.first else { return Some(LEAST[0] + self.away * each) };
        let [one, all] = [0, 1].map(|which| LEAST[which].max(FURTHER[which] * first));
        // Less than what led to the first plan leads to no other.
        let left = all.saturating_sub(self.further);
        (left >= first).then_some(one.min(left))
    }

    /// Takes note of an attempt.
    pub fn note(&mut self, work: u64, led_to_a_plan: bool) {
        match self.first {
            Some(_) => self.further += work,
            None if led_to_a_plan => self.first = Some(work.max(1)),
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attempts_after_the_first_plan_end() {
        let mut effort = Effort::new(10);
        let before = effort.limit(100).unwrap();
        assert!(effort.limit(200).unwrap() > before);
        effort.note(before, false);
        assert_eq!(effort.limit(100), Some(before), "as long as there is no plan, all margins are worth the same");
        effort.note(20_000, true);
        let mut further = 0;
        while let Some(limit) = effort.limit(100) {
            assert!((20_000..=40_000).contains(&limit));
            effort.note(limit, false);
            further += limit;
        }
        assert!(further <= 80_000);
    }
}
