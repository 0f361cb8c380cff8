//! What certified intervals leave open in a widest-path proof.

use std::collections::BinaryHeap;

use crate::algebra::Bottleneck;
use crate::space::Width;

/// Certified intervals that are wider than a point.
///
/// Let a widest-path search rank certified transitions by `lower` and others by
/// their upper bound, and let `k` be the best value still open. Every path that
/// is not found has a first transition ranked at most `k`. Either that is not
/// certified, and its width is at most `k`; or it is, and its width is at most
/// its `upper`. So no path is wider than `k` or the largest `upper` of
/// those certified with `lower <= k`, whichever is more. This is about all paths
/// whenever it is asked, so the least of the answers holds.
pub(crate) struct Brackets {
    /// Least answer so far.
    proved: f64,
    by_upper: BinaryHeap<(Bottleneck, Bottleneck)>,
}

impl Brackets {
    /// `cap`: no path is wider.
    pub fn new(cap: f64) -> Self {
        Brackets { proved: cap, by_upper: BinaryHeap::new() }
    }

    pub fn insert(&mut self, width: Width) {
        if width.lower < width.upper {
            self.by_upper.push((Bottleneck::new(width.upper), Bottleneck::new(width.lower)));
        }
    }

    /// Upper bound on the width of all paths when `k` is the best value open.
    /// From call to call `k` must not rise.
    pub fn width_at_most(&mut self, k: f64) -> f64 {
        while self.by_upper.peek().is_some_and(|(_, lower)| lower.width() > k) {
            self.by_upper.pop();
        }
        let bound = self.by_upper.peek().map_or(k, |(upper, _)| k.max(upper.width()));
        self.proved = self.proved.min(bound);
        self.proved
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        self.by_upper.len() * size_of::<(Bottleneck, Bottleneck)>()
    }
}
