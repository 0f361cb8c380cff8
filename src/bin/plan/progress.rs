//! One line on a terminal that tells how far the search is.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use steadfast::reconfigure::{Event, Known};

/// How often the line is drawn anew.
const INTERVAL: Duration = Duration::from_millis(100);

/// The line; silent unless standard error is a terminal.
pub struct ProgressLine {
    began: Instant,
    drawn: Option<Instant>,
    on_terminal: bool,
}

impl ProgressLine {
    pub fn new() -> Self {
        Self { began: Instant::now(), drawn: None, on_terminal: io::stderr().is_terminal() }
    }

    /// Draws the line, unless it was drawn a moment ago.
    pub fn show<A, C>(&mut self, event: &Event<A, C>) {
        if !self.on_terminal || self.drawn.is_some_and(|drawn| drawn.elapsed() < INTERVAL) {
            return;
        }
        self.drawn = Some(Instant::now());
        // A progress line that cannot be written is no reason to stop.
        let _ = write!(io::stderr().lock(), "\r\x1b[K{}", line(&event.known, self.began.elapsed()));
        let _ = io::stderr().flush();
    }

    /// Takes the line away.
    pub fn clear(&mut self) {
        if self.drawn.take().is_some() {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}

fn line(known: &Known, elapsed: Duration) -> String {
    let mut parts = Vec::new();
    match known.margin {
        Some(margin) => parts.push(format!("best margin {margin:.4}")),
        None if known.moves.is_some() => {}
        None => parts.push("no plan yet".to_string()),
    }
    if known.margin_at_most.is_finite() {
        parts.push(format!("none above {:.4}", known.margin_at_most));
    }
    if let Some(moves) = known.moves {
        parts.push(format!("{moves} moves"));
    }
    if known.moves_at_least > 0 {
        parts.push(format!("none under {}", known.moves_at_least));
    }
    let spent = &known.statistics;
    let (seconds, solves) = (elapsed.as_secs_f64(), known.oracle_solves);
    format!("{} | {} states expanded, {solves} oracle solves, {seconds:.0} s", parts.join(", "), spent.expanded)
}
