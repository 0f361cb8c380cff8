//! Growth: time and memory against the number of bodies.
//!
//! Every point is measured in a process of its own, which is this program started with a hidden
//! argument, so that the largest resident size is that of one method on one scene.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use steadfast::statics::Structure;

use crate::methods::{Answer, Claim, DEFAULT, Method};
use crate::reference::tree;
use crate::scenes::chain;
use crate::scenes_support as support;
use crate::timing::{median, timed};

/// Asks this program to measure one point: family, size and method follow.
pub const ONE_POINT: &str = "--one-point";

/// Structures of one kind and any size.
pub struct Family {
    pub name: &'static str,
    sizes: &'static [usize],
    build: fn(usize) -> Structure,
    /// The exponent that the oracle's time may grow with, where that is promised.
    pub promised: Option<f64>,
}

/// The families of growing size.
pub const FAMILIES: [Family; 5] = [
    Family {
        name: "chains",
        sizes: &[10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000],
        build: chain,
        promised: Some(1.1),
    },
    Family {
        name: "trees",
        sizes: &[10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000],
        build: support::tree,
        promised: Some(1.1),
    },
    Family {
        name: "N x 2 x 2 trusses",
        sizes: &[1, 2, 5, 10, 20, 50, 100, 200, 335],
        build: |count| support::truss([count, 2, 2]),
        promised: Some(1.3),
    },
    Family {
        name: "walls",
        sizes: &[3, 4, 6, 8, 11, 16, 23, 32, 45],
        build: |side| support::wall(side, side),
        promised: Some(1.6),
    },
    Family {
        name: "lattices",
        sizes: &[2, 3, 4, 5, 6, 8, 10],
        build: |side| support::truss([side, side, side]),
        promised: None,
    },
];

/// The methods whose growth is measured.
pub const METHODS: [(&str, Method); 4] = [
    ("ours to 1e-6", Method::ToGap(1e-6)),
    ("ours, verdict", Method::Decide),
    ("standard", Method::Standard(DEFAULT)),
    ("paper", Method::Paper(DEFAULT)),
];

/// One method on one structure.
pub struct Point {
    pub family: &'static str,
    pub method: &'static str,
    pub bodies: usize,
    /// Median time.
    pub milliseconds: f64,
    /// Largest resident size of the process in MiB; 0 where the system does not tell.
    pub peak: f64,
    /// How much of it the method added to the structure and the program.
    pub added: f64,
    pub claim: String,
    pub lower: f64,
    pub upper: f64,
    /// Distance from the closed form, on chains and trees.
    pub error: Option<f64>,
}

/// Measures every family, each method until one point takes longer than `limit`;
/// structures of at most `most` bodies.
pub fn growth(limit: Duration, most: usize) -> Vec<Point> {
    let mut points = Vec::new();
    for family in &FAMILIES {
        for (name, _) in METHODS {
            for &size in family.sizes {
                if (family.build)(size).bodies.len() > most {
                    break;
                }
                match measure(family.name, size, name, limit) {
                    Some(point) => points.push(point),
                    None => break,
                }
            }
        }
    }
    points
}

/// Starts this program anew for one point; `None` past the limit or without an answer.
fn measure(family: &'static str, size: usize, method: &'static str, limit: Duration) -> Option<Point> {
    let program = std::env::current_exe().expect("this program knows where it is");
    let mut child = Command::new(program)
        .args([ONE_POINT, family, &size.to_string(), method])
        .stdout(Stdio::piped())
        .spawn()
        .expect("this program can be started again");
    let started = Instant::now();
    while child.try_wait().expect("the child is ours").is_none() {
        // Building the structure and the first run count.
        if started.elapsed() > limit {
            child.kill().expect("the child is ours");
            child.wait().expect("the child is ours");
            return None;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().expect("the child is ours");
    let text = String::from_utf8_lossy(&output.stdout);
    let fields: Vec<&str> = text.trim().split(';').collect();
    let [bodies, milliseconds, peak, added, claim, lower, upper, error] = fields[..] else { return None };
    let number = |text: &str| text.parse::<f64>().ok();
    Some(Point {
        family,
        method,
        bodies: bodies.parse().ok()?,
        milliseconds: number(milliseconds)?,
        peak: number(peak)?,
        added: number(added)?,
        claim: claim.to_owned(),
        lower: number(lower)?,
        upper: number(upper)?,
        error: number(error),
    })
}

/// What a process started with [`ONE_POINT`] does; the line that it prints.
///
/// # Panics
/// Where the arguments name nothing, or a proved answer is wrong.
pub fn one_point(arguments: &[String]) -> String {
    let [family, size, method] = arguments else { panic!("{ONE_POINT} wants a family, a size and a method") };
    let family = FAMILIES.iter().find(|known| known.name == family).expect("a known family");
    let (_, method) = METHODS.into_iter().find(|known| known.0 == method).expect("a known method");
    let structure = (family.build)(size.parse().expect("a size"));
    forget_peak();
    let before = resident("VmRSS:");
    let (answer, first) = timed(|| method.run(&structure, None));
    let mut times = vec![first];
    let peak = resident("VmHWM:");
    while times.iter().sum::<f64>() < 500.0 && times.len() < 15 {
        times.push(timed(|| method.run(&structure, None)).1);
    }
    let error = tree(&structure).map(|exact| check(&answer, exact.into()));
    let Answer { claim, lower, upper } = answer;
    let (bodies, time, added) = (structure.bodies.len(), median(&times), peak - before);
    let error = error.map_or_else(String::new, |error| format!("{error:e}"));
    format!("{bodies};{time};{peak};{added};{claim:?};{lower};{upper};{error}")
}

/// The error of an answer relative to the exact value.
fn check(answer: &Answer, exact: f64) -> f64 {
    let (low, high) = (exact * (1.0 - 1e-12), exact * (1.0 + 1e-12));
    let holds = answer.lower <= high && low <= answer.upper;
    assert!(answer.claim != Claim::Proved || holds, "{answer:?} does not hold {exact}");
    answer.error(exact).unwrap_or(f64::INFINITY) / exact
}

/// Makes the largest resident size start anew, where the system can.
fn forget_peak() {
    // Refused on systems without it; then the peak includes building the structure.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// A size of this process in MiB.
fn resident(which: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(which)).unwrap_or_default();
    let kibibytes: f64 = line.split_whitespace().next().and_then(|size| size.parse().ok()).unwrap_or(0.0);
    kibibytes / 1024.0
}

/// Exponent of `y` in `x` by least squares of the logarithms over the upper half of the
/// points (at least three).
pub fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let upper = &points[points.len() / 2..];
    if upper.len() < 3 {
        return None;
    }
    let logs: Vec<(f64, f64)> = upper.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| logs.iter().map(part).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>();
    Some(slope / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>())
}
