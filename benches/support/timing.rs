//! Medians of several ways to do something, measured in turns.
//!
//! Times are processor times of this process: everything is done by one thread, so on a quiet
//! machine they are what a clock on the wall shows, and on a busy one they do not count the
//! others' turns.

use std::time::Duration;

use cpu_time::ProcessTime;

/// Does some work and says how long it took, in ms.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let started = ProcessTime::now();
    let result = std::hint::black_box(work());
    (result, started.elapsed().as_secs_f64() * 1e3)
}

/// What counts as quick, in ms.
const QUICK: f64 = 10.0;

/// Runs every way once after the other, over and over, and returns for each its
/// median time in ms and how often it ran. A way is left out once it alone has
/// used `budget`, and all stop after `most` rounds; each runs at least once. What is
/// quick runs once more before it is timed: the way before may have left it cold caches.
pub fn medians(ways: &mut [Box<dyn FnMut() + '_>], budget: Duration, most: usize) -> Vec<(f64, usize)> {
    let budget = budget.as_secs_f64() * 1e3;
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); ways.len()];
    for _ in 0..most.max(1) {
        for (way, times) in ways.iter_mut().zip(&mut times) {
            if times.is_empty() || times.iter().sum::<f64>() < budget {
                if times.last().is_some_and(|&last| last < QUICK) {
                    way();
                }
                times.push(timed(way).1);
            }
        }
    }
    times.into_iter().map(|times| (median(&times), times.len())).collect()
}

/// The middle of a list of numbers, the mean of the middle two in an even one.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { f64::midpoint(sorted[middle - 1], sorted[middle]) }
}

/// Whether to measure: `cargo bench` says so; without it, as under
/// `cargo test --benches`, a bench only shows that it works.
pub fn measuring() -> bool {
    let given = |wanted: &str| std::env::args().any(|argument| argument == wanted);
    given("--bench") && !given("--test")
}
