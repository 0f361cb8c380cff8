//! What is forgiven because data are meant up to a relative 1e-12 only.

use super::DATA;

/// Keeps account of what is forgiven because data are meant up to 1e-12 only.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Allowance {
    /// The largest share that was forgiven.
    pub forgiven: f64,
}

impl Allowance {
    /// Whether an `excess` over nothing is at most 1e-12 of `size`.
    pub(super) fn forgives(&mut self, excess: f64, size: f64) -> bool {
        if excess <= 0.0 {
            return true;
        }
        let share = excess / size;
        if !(share <= DATA) {
            return false;
        }
        self.forgiven = self.forgiven.max(share);
        true
    }
}
