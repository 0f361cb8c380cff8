//! Names that other parts of a file refer to.

use std::collections::HashMap;

use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::{codes, suggest};

/// Names with the places they have in their list.
#[derive(Debug)]
pub(super) struct Names<'a> {
    what: &'static str,
    distinct: Vec<&'a str>,
    indices: HashMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    /// Names of things that messages call `what`, in plural. `place_of` says
    /// where a name stands; of equal names the first one counts.
    pub(super) fn new<'p>(
        what: &'static str,
        list: Vec<&'a str>,
        place_of: impl Fn(usize) -> Place<'p>,
        findings: &mut Findings,
    ) -> Self {
        let mut indices = HashMap::with_capacity(list.len());
        let mut distinct = Vec::with_capacity(list.len());
        for (index, name) in list.into_iter().enumerate() {
            let first = *indices.entry(name).or_insert(index);
            if first == index {
                distinct.push(name);
            }
            if first != index {
                let message =
                    format!("the id `{}` is taken already, by number {} of the {what}", clipped(name), first + 1);
                findings.add(&place_of(index), codes::DUPLICATE_ID, message, "ids are unique".to_string());
            }
        }
        Self { what, distinct, indices }
    }

    /// The index of `name`, which stands at `place`.
    pub(super) fn find(&self, name: &str, place: &Place<'_>, findings: &mut Findings) -> Option<usize> {
        let found = self.indices.get(name).copied();
        if found.is_none() {
            if findings.is_full() {
                findings.truncate();
                return None;
            }
            let hint = suggest::hint(name, self.what, self.distinct.iter().copied());
            findings.add(
                place,
                codes::UNKNOWN_NAME,
                format!("`{}` is not one of the {}", clipped(name), self.what),
                hint,
            );
        }
        found
    }
}
