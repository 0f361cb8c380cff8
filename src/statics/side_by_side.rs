//! Solves several blocks at the same time.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

/// The answers of `solve` for each of `items`, in their order. Once one answer
/// `settles` the question those after it are not begun, and may be `None`; those before
/// the first that settles it are always there, whatever the number of threads.
pub(super) fn side_by_side<T: Sync, A: Send>(
    items: &[T],
    solve: impl Fn(&T) -> A + Sync,
    settles: impl Fn(&A) -> bool + Sync,
) -> Vec<Option<A>> {
    let first = AtomicUsize::new(usize::MAX);
    let answer = |(place, item): (usize, &T)| {
        // A stale value only means an answer more than is needed.
        if place > first.load(Ordering::Relaxed) {
            return None;
        }
        let answer = solve(item);
        if settles(&answer) {
            first.fetch_min(place, Ordering::Relaxed);
        }
        Some(answer)
    };
    items.par_iter().enumerate().map(answer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_up_to_the_first_that_settles_it_are_answered() {
        let items: Vec<usize> = (0..200).collect();
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            let answers = pool.install(|| side_by_side(&items, |i| i * i, |square| square % 1000 == 900));
            assert_eq!(answers.len(), 200);
            assert!(answers[..=30].iter().enumerate().all(|(i, answer)| *answer == Some(i * i)));
            assert!(answers.iter().enumerate().all(|(i, answer)| answer.is_none_or(|square| square == i * i)));
        }
    }

    #[test]
    fn one_thread_begins_nothing_that_is_not_needed() {
        let begun = AtomicUsize::new(0);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
        let count = |i: &usize| {
            begun.fetch_add(1, Ordering::Relaxed);
            *i
        };
        pool.install(|| side_by_side(&[0, 1, 2, 3, 4, 5], count, |i| *i == 2));
        assert_eq!(begun.load(Ordering::Relaxed), 3);
    }
}
