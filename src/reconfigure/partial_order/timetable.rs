//! When actions run if each begins as early as it may.

/// A run of a plan without idle waiting.
#[derive(Clone, Debug, PartialEq)]
pub struct Timetable {
    /// When each action begins and ends.
    pub spans: Vec<[f64; 2]>,
    /// When the last one ends.
    pub makespan: f64,
    /// How long they take one after the other.
    pub one_by_one: f64,
}

impl Timetable {
    /// Of so many actions, each of which waits for earlier ones.
    pub(super) fn new(
        actions: usize,
        waits_for: impl Fn(usize) -> Vec<usize>,
        duration: impl Fn(usize) -> f64,
    ) -> Self {
        let mut spans: Vec<[f64; 2]> = Vec::with_capacity(actions);
        for action in 0..actions {
            let begin = waits_for(action).into_iter().map(|before| spans[before][1]).fold(0.0, f64::max);
            spans.push([begin, begin + duration(action)]);
        }
        Self {
            makespan: spans.iter().map(|[_, end]| *end).fold(0.0, f64::max),
            one_by_one: (0..actions).map(duration).sum(),
            spans,
        }
    }

    /// Share of the time that overlapping saves, from 0 to 1; 0 where nothing takes any time.
    pub fn saved(&self) -> f64 {
        if self.one_by_one > 0.0 { 1.0 - self.makespan / self.one_by_one } else { 0.0 }
    }
}
