//! A partial order with what was asked.

use crate::reconfigure::assembly::Touched;
use crate::reconfigure::partial_order::{OrderOptions, PartialOrder, Timetable};

/// What a `partial-order/1` report says of a document's best plan; `T` is what a module hits.
#[derive(Clone, Copy, Debug)]
pub struct PartialOrderReport<'a, T = Touched> {
    /// What was asked.
    pub options: &'a OrderOptions,
    /// The answer.
    pub order: &'a PartialOrder<T>,
    /// When actions run.
    pub times: &'a Timetable,
}
