//! One line on a terminal that tells how far the search is.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use steadfast::reconfigure::Event;

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
    pub fn show(&mut self, event: &Event) {
        if !self.on_terminal || self.drawn.is_some_and(|drawn| drawn.elapsed() < INTERVAL) {
            return;
        }
        self.drawn = Some(Instant::now());
        // A progress line that cannot be written is no reason to stop.
        let _ = write!(io::stderr().lock(), "\r\x1b[K{}", line(event, self.began.elapsed()));
        let _ = io::stderr().flush();
    }

    /// Takes the line away.
    pub fn clear(&mut self) {
        if self.drawn.take().is_some() {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}

fn line(event: &Event, elapsed: Duration) -> String {
    let progress = &event.progress;
    let mut parts = vec![
        format!("{:.0} s", elapsed.as_secs_f64()),
        format!("{} expanded", progress.statistics.expanded),
        format!("{} oracle solves", event.oracle_solves),
    ];
    match progress.best_width {
        Some(width) if width.is_finite() => parts.push(format!("best margin {width:.4}")),
        _ => parts.push("no plan yet".to_string()),
    }
    if progress.width_at_most.is_finite() {
        parts.push(format!("none above {:.4}", progress.width_at_most));
    }
    if let Some(cost) = progress.best_cost {
        parts.push(format!("{cost} moves"));
    }
    if progress.cost_at_least > 0 && progress.cost_at_least < u32::MAX {
        parts.push(format!("none under {} moves", progress.cost_at_least));
    }
    parts.join(" | ")
}
