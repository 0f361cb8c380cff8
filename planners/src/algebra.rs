//! What a path is worth: values that add up along it, and their laws.
//!
//! A label-setting search (Dijkstra, A*) with one label a state is right only
//! if the values obey three laws, which tests check for every type here:
//!
//! - *associativity* and *identity*: `then` is a monoid, so a path has one value;
//! - *isotonicity*: if `a >= b` then `a.then(c) >= b.then(c)`: the better of two
//!   ways to a state stays the better one, however the path goes on;
//! - *monotonicity*: `a.then(c) <= a`: going on never improves a path.
//!
//! `Lexicographic<Additive, Bottleneck>` (fewest moves, then the widest) is
//! lawful as long as costs do not saturate. `Lexicographic<Bottleneck, Additive>` (the widest, then fewest moves)
//! is **not** isotone: `(5, 10) > (4, 1)`, yet after a transition `(3, 1)`
//! they are `(3, 11) < (3, 2)`. A search with one label would have thrown the
//! winner away, hence the two passes of [`Search::margin`](crate::Search::margin).
//!
//! Source: J. L. Sobrinho, "Algebra and algorithms for QoS path computation and
//! hop-by-hop routing in the Internet", IEEE/ACM Trans. Networking 10(4), 2002.

use std::cmp::Ordering;

/// Value of a path. The order is by worth: **greater is better**.
pub trait PathValue: Copy + Ord {
    /// Value of the path of no transitions.
    const IDENTITY: Self;

    /// Value of this path followed by `next`.
    fn then(self, next: Self) -> Self;
}

/// Max-min width: a path is as wide as its narrowest transition, wider is better.
/// NaN counts as `NEG_INFINITY`, the worst.
#[derive(Clone, Copy, Debug)]
pub struct Bottleneck(f64);

impl Bottleneck {
    /// Value of a transition of this width.
    pub fn new(width: f64) -> Self {
        // Adding zero turns -0.0 into 0.0, which `total_cmp` would tell apart.
        Bottleneck(if width.is_nan() { f64::NEG_INFINITY } else { width + 0.0 })
    }

    /// The width.
    pub fn width(self) -> f64 {
        self.0
    }
}

impl PathValue for Bottleneck {
    const IDENTITY: Self = Bottleneck(f64::INFINITY);

    fn then(self, next: Self) -> Self {
        self.min(next)
    }
}

impl Ord for Bottleneck {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Bottleneck {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Bottleneck {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Bottleneck {}

/// Additive cost, cheaper is better (so `Additive(2) > Additive(3)`).
/// Sums saturate at `u32::MAX`, the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Additive(pub u32);

impl PathValue for Additive {
    const IDENTITY: Self = Additive(0);

    fn then(self, next: Self) -> Self {
        Additive(self.0.saturating_add(next.0))
    }
}

impl Ord for Additive {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.cmp(&self.0)
    }
}

impl PartialOrd for Additive {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The first value decides, the second breaks ties. Not always lawful: see the
/// head of this module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Lexicographic<A, B>(pub A, pub B);

impl<A: PathValue, B: PathValue> PathValue for Lexicographic<A, B> {
    const IDENTITY: Self = Lexicographic(A::IDENTITY, B::IDENTITY);

    fn then(self, next: Self) -> Self {
        Lexicographic(self.0.then(next.0), self.1.then(next.1))
    }
}
