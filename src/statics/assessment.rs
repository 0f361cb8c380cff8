//! The oracle's answer.

use crate::spatial::{Twist, Vec3, Wrench};

use super::rung::Rung;
use super::tolerances::AT_LIMIT;

/// An interval that is guaranteed to hold a value, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// Proved lower bound.
    pub lower: f64,
    /// Proved upper bound, `f64::INFINITY` when none was proved.
    pub upper: f64,
}

impl Bracket {
    /// A bracket from its two ends.
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// The bracket of a value that is known exactly.
    pub const fn exact(value: f64) -> Self {
        Self { lower: value, upper: value }
    }

    /// The bracket of the larger of two bracketed values.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The bracket of the smaller of two bracketed values.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.min(other.upper) }
    }

    /// Distance between the two ends.
    pub fn width(&self) -> f64 {
        if self.lower == self.upper { 0.0 } else { self.upper - self.lower }
    }

    /// Whether `value` lies in the bracket.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }
}

/// What a bracket on the utilisation proves about a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Every connection can hold: t <= 1 is proved.
    Stable,
    /// Some connection must break: t > 1 is proved.
    InternallyUnstable,
    /// No connection strength helps: it tips, slides or falls.
    WholeBodyUnstable,
    /// The bracket still straddles 1 at the finest setting.
    Undecided,
}

/// The gap of [`Question::VALUE`].
const VALUE_GAP: f64 = 1e-7;

/// How tightly a question wants its answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// Only whether the utilisation is at most this: the bracket may be wide,
    /// as long as it lies on one side of the threshold.
    Decide(f64),
    /// The utilisation itself, with a bracket no wider than this share of the
    /// larger of it and 1, and the verdict if that is narrower still.
    ToGap(f64),
    /// The utilisation as [`Question::VALUE`] wants it and, of all states at that
    /// utilisation, the one with the least sum of strengths and of normal forces at
    /// contacts: see [`Distribution`]. Costs one more cone program per block with cycles.
    Full,
}

impl Question {
    /// The utilisation to seven digits, ten times tighter than users are promised.
    pub const VALUE: Self = Self::ToGap(VALUE_GAP);

    /// Width that the bracket may have, as a share of the larger of the utilisation
    /// and 1.
    pub(super) fn gap(self) -> f64 {
        match self {
            Self::Decide(_) => f64::INFINITY,
            Self::ToGap(gap) => gap,
            Self::Full => VALUE_GAP,
        }
    }

    /// Whether a bracket on the utilisation is as narrow as this asks for.
    pub fn is_answered_by(self, bracket: &Bracket) -> bool {
        let Bracket { lower, upper } = *bracket;
        match self {
            Self::Decide(threshold) => upper <= threshold || lower > threshold,
            Self::ToGap(_) | Self::Full => {
                let gap = self.gap();
                let straddles_one = lower <= 1.0 && upper > 1.0;
                upper.is_finite() && upper - lower <= gap * upper.max(1.0) && !straddles_one
            }
        }
    }
}

/// The part of the answer that concerns one connection.
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectionState {
    /// Wrench on the child at the connection point, in the connection frame.
    pub wrench: Wrench,
    /// Strength in N that the connection must provide in the returned state.
    pub strength: f64,
    /// `strength` over the connector's rated strength.
    pub utilisation: f64,
    /// Whether the connection breaks in the collapse mechanism: without more
    /// strength here, the utilisation could not fall.
    pub critical: bool,
}

/// Which of the balanced fields within the utilisation an answer shows.
///
/// Bodies with loops can carry their loads in many ways; those that reach the
/// utilisation all prove it. What crosses a bridge is the same in all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Distribution {
    /// The field that proved the bracket, and nothing else was asked of it: it may hold
    /// stress that the loads do not need.
    Proof,
    /// The one with the least sum of the strengths of all connections and of the normal
    /// forces of all contacts, each in N, with no utilisation above the bracket's upper
    /// end. That the field holds is proved, that its sum is the least is a solver's
    /// word.
    Least,
    /// The same, except that so many blocks with cycles show the field that proved the
    /// bracket, as no better one could be proved.
    LeastExcept {
        /// How many.
        blocks: usize,
    },
}

/// What was left out of the optimisation because the scene did not need it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Fixed bodies, which need no balance.
    pub fixed_bodies: usize,
    /// Bodies that are held to another one, or to the ground, without limit, and
    /// move with it.
    pub merged_bodies: usize,
    /// Connections whose wrench follows from balance alone.
    pub closed_form_connections: usize,
    /// Contacts whose force follows from balance alone.
    pub closed_form_contacts: usize,
    /// Blocks that a conic program was solved for.
    pub solved_blocks: usize,
    /// Free bodies in the largest such block.
    pub largest_block_bodies: usize,
}

/// The oracle's answer for one structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// What the bracket proves.
    pub verdict: Verdict,
    /// The utilisation t: the smallest common factor on all rated strengths
    /// with which the structure can stand. Both ends infinite when it is
    /// whole-body unstable.
    pub utilisation: Bracket,
    /// One entry per connection, in the structure's order.
    pub connections: Vec<ConnectionState>,
    /// Contact forces in N on each contact's `body`, in W, in the structure's order.
    pub contacts: Vec<Vec3>,
    /// Which state `connections` and `contacts` show.
    pub distribution: Distribution,
    /// Collapse mechanism: a twist per body (of its centre of mass, in W), in the
    /// structure's order. All zero when nothing limits the structure.
    pub mechanism: Vec<Twist>,
    /// What needed no optimisation.
    pub left_out: LeftOut,
    /// Why the verdict is undecided; `None` for any other verdict.
    pub undecided_because: Option<String>,
    /// What the answer took.
    pub decided_by: Rung,
}

impl Assessment {
    /// Bracket on the internal stability margin `1 - t` (dimensionless,
    /// positive is safe); minus infinity when whole-body unstable.
    pub fn margin(&self) -> Bracket {
        Bracket::new(1.0 - self.utilisation.upper, 1.0 - self.utilisation.lower)
    }

    /// Whether a connection is at its limit without being critical: in the returned
    /// state its utilisation is the structure's, to a relative 1e-6, but the
    /// mechanism does not break it, so that another state may spare it. With
    /// [`Question::Full`] these are the connections that the least sum of forces loads
    /// fully; a state that merely proves the bracket says little about them.
    pub fn is_at_limit(&self, connection: usize) -> bool {
        let (state, largest) = (&self.connections[connection], self.utilisation.upper);
        !state.critical && largest.is_finite() && largest > 0.0 && state.utilisation >= largest * (1.0 - AT_LIMIT)
    }

    /// The connection that the verdict hangs on: of the critical connections,
    /// or of all when none is critical, the one with the largest utilisation.
    pub fn weakest_connection(&self) -> Option<usize> {
        let key = |i: &usize| (self.connections[*i].critical, self.connections[*i].utilisation);
        (0..self.connections.len()).max_by(|a, b| {
            let ((ca, ua), (cb, ub)) = (key(a), key(b));
            ca.cmp(&cb).then(ua.total_cmp(&ub)).then(b.cmp(a))
        })
    }
}
