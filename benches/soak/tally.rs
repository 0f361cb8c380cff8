//! Counts what came of each kind, and writes it down.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

use super::Outcome;
use super::random::{Kind, Recipe};
use steadfast::statics::Verdict;

/// Structures named one by one in the record, of each sort of fault.
const NAMED: usize = 40;

/// What came of one kind.
#[derive(Default)]
struct Counts {
    total: usize,
    stable: usize,
    internally: usize,
    whole_body: usize,
    agree: usize,
    differ: usize,
    settled: usize,
    silent: usize,
    unproved: usize,
    undecided: usize,
    wide: usize,
    milliseconds: Vec<f64>,
}

impl Counts {
    fn add(&mut self, outcome: &Outcome) {
        self.total += 1;
        self.stable += usize::from(outcome.verdict == Verdict::Stable);
        self.internally += usize::from(outcome.verdict == Verdict::InternallyUnstable);
        self.whole_body += usize::from(outcome.verdict == Verdict::WholeBodyUnstable);
        self.agree += usize::from(outcome.agrees);
        self.differ += usize::from(outcome.wrong.is_some());
        self.settled += usize::from(outcome.settled.is_some());
        self.silent += usize::from(outcome.silent);
        self.unproved += usize::from(outcome.unproved.is_some());
        self.undecided += usize::from(outcome.undecided);
        self.wide += usize::from(outcome.wide);
        self.milliseconds.push(outcome.time.as_secs_f64() * 1e3);
    }

    fn merge(&mut self, other: &Self) {
        self.total += other.total;
        self.stable += other.stable;
        self.internally += other.internally;
        self.whole_body += other.whole_body;
        self.agree += other.agree;
        self.differ += other.differ;
        self.settled += other.settled;
        self.silent += other.silent;
        self.unproved += other.unproved;
        self.undecided += other.undecided;
        self.wide += other.wide;
        self.milliseconds.extend(&other.milliseconds);
    }

    /// One row of the record, in the order of [`COLUMNS`].
    fn row(&self) -> Vec<String> {
        let mut times = self.milliseconds.clone();
        times.sort_by(f64::total_cmp);
        let at = |share: f64| times.get(((times.len() as f64 - 1.0) * share).round() as usize).copied();
        let time = |share: f64| at(share).map_or_else(String::new, |time| format!("{time:.2}"));
        let counts = [
            self.total,
            self.stable,
            self.internally,
            self.whole_body,
            self.agree,
            self.differ,
            self.settled,
            self.silent,
            self.unproved,
            self.undecided,
            self.wide,
        ];
        counts.iter().map(usize::to_string).chain([time(0.5), time(0.95), time(1.0)]).collect()
    }
}

const COLUMNS: [&str; 15] = [
    "kind",
    "structures",
    "stable",
    "internally unstable",
    "whole-body unstable",
    "agree",
    "differ",
    "settled",
    "no second opinion",
    "not proved",
    "undecided",
    "too wide",
    "median ms",
    "95 % ms",
    "max ms",
];

/// Everything that was found.
pub struct Tally {
    seed: u64,
    kinds: Vec<Counts>,
    faults: Vec<String>,
    settled: Vec<String>,
    open: Vec<String>,
    wide: Vec<String>,
}

impl Tally {
    pub fn new(seed: u64) -> Self {
        let kinds = Kind::ALL.iter().map(|_| Counts::default()).collect();
        Self { seed, kinds, faults: Vec::new(), settled: Vec::new(), open: Vec::new(), wide: Vec::new() }
    }

    pub fn add(&mut self, outcome: &Outcome) {
        let kind = Kind::ALL.iter().position(|kind| *kind == outcome.recipe.kind).expect("ALL holds every kind");
        self.kinds[kind].add(outcome);
        let Recipe { kind, bodies, seed } = outcome.recipe;
        let name = format!("--kind {kind:?} --bodies {bodies} --seed {seed}");
        for fault in [&outcome.wrong, &outcome.unproved].into_iter().flatten() {
            self.faults.push(format!("{name}: {fault}"));
        }
        if let Some(complaint) = &outcome.settled {
            self.settled.push(format!("{name}: {complaint}"));
        }
        if outcome.undecided {
            self.open.push(name);
        } else if outcome.wide {
            self.wide.push(name);
        }
    }

    pub fn total(&self) -> usize {
        self.kinds.iter().map(|counts| counts.total).sum()
    }

    /// Whether no answer was wrong or unproved.
    pub fn right(&self) -> bool {
        self.faults.is_empty()
    }

    pub fn summary(&self) -> String {
        let all = self.all();
        format!("{} differ, {} not proved, {} undecided, {} wide", all.differ, all.unproved, all.undecided, all.wide)
    }

    fn all(&self) -> Counts {
        let mut all = Counts::default();
        for counts in &self.kinds {
            all.merge(counts);
        }
        all
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let named = |name: String, counts: &Counts| [name].into_iter().chain(counts.row()).collect();
        let kinds = Kind::ALL.iter().zip(&self.kinds).filter(|(_, counts)| counts.total > 0);
        let mut rows: Vec<Vec<String>> = kinds.map(|(kind, counts)| named(format!("{kind:?}"), counts)).collect();
        rows.push(named("all".to_owned(), &self.all()));
        rows
    }
}

/// What is written down.
pub struct Record<'t> {
    tally: &'t Tally,
    time: Duration,
}

impl<'t> Record<'t> {
    pub fn new(tally: &'t Tally, time: Duration) -> Self {
        Self { tally, time }
    }

    /// Writes both files.
    pub fn write(&self) -> std::io::Result<()> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("benches/record");
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("soak.csv"), self.table())?;
        std::fs::write(folder.join("soak.md"), self.page())
    }

    fn table(&self) -> String {
        let mut text = COLUMNS.join(",") + "\n";
        for row in self.tally.rows() {
            text += &(row.join(",") + "\n");
        }
        text
    }

    pub fn page(&self) -> String {
        let seconds = self.time.as_secs_f64();
        let mut text = format!(
            "# {} random structures\n\nSeed {}; {}; {seconds:.0} s.\n\n\
             *differ*: the second method, the paper's formulation in a general solver asked at up to three tolerances, is sure\n\
             of another answer, or the oracle's own two answers contradict each other. *not proved*: the independent re-check\n\
             of the fields finds fault. *settled*: one of these had a complaint, but a certificate of the answer, issued and\n\
             checked in interval arithmetic, proves verdict and bracket, or the same solver with twice the digits is sure of a\n\
             value in the bracket; such are not counted as differing or not proved.\n\
             *undecided*: though t is not proved to be within 1e-3 of 1. *too wide*: the bracket is\n\
             wider than 1e-6 of the larger of t and 1. Times are of the value, in parallel with the others.\n\n",
            self.tally.total(),
            self.tally.seed,
            machine(),
        );
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        text += &line(&COLUMNS.map(str::to_owned));
        text += &line(&COLUMNS.map(|_| "---".to_owned()));
        for row in self.tally.rows() {
            text += &line(&row);
        }
        for (title, names) in [
            ("Wrong", &self.tally.faults),
            ("Settled", &self.tally.settled),
            ("Undecided", &self.tally.open),
            ("Too wide", &self.tally.wide),
        ] {
            if !names.is_empty() {
                let _ = write!(text, "\n## {title}: {}\n\n", names.len());
                for name in names.iter().take(NAMED) {
                    let _ = writeln!(text, "    {name}");
                }
            }
        }
        text
    }
}

/// Revision, processor and number of threads.
fn machine() -> String {
    let output = std::process::Command::new("git").args(["describe", "--always", "--dirty"]).output().ok();
    let revision = output.map_or_else(String::new, |out| String::from_utf8_lossy(&out.stdout).trim().to_owned());
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processors.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown processor");
    let model = model.trim_start_matches(['\t', ' ', ':']);
    format!("revision {revision}; {model}, {} threads", rayon::current_num_threads())
}
