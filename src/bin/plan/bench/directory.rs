//! The folder of a run: its results, its plans, and on what it was run.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use steadfast::io::{Diagnostics, Results, SourceFile, read_results, write_result};
use steadfast::suite::{Job, Record};

/// Why a folder cannot be used.
pub enum Trouble {
    /// Its results cannot be read.
    Results(Diagnostics),
    /// Anything else, in a sentence.
    Other(String),
}

/// The folder of a run.
pub struct Directory {
    path: PathBuf,
    /// Locked as long as the run lasts.
    results: File,
    records: BTreeMap<String, Record>,
    /// Bytes of a half-written last line that were taken away.
    pub cut_off: usize,
}

/// Where the plan of a job is.
pub fn plan_path(folder: &Path, job: &str) -> PathBuf {
    folder.join("plans").join(format!("{job}.json"))
}

/// Where what a job complains of is.
pub fn complaints_path(folder: &Path, job: &str) -> PathBuf {
    folder.join("plans").join(format!("{job}.stderr"))
}

impl Directory {
    /// Opens a folder for the jobs of a suite, and makes it where it is missing.
    ///
    /// # Errors
    /// The folder cannot be used, or holds results that are broken or of other jobs.
    pub fn open(path: &Path, jobs: &[Job]) -> Result<Self, Trouble> {
        let name = path.join("results.jsonl");
        let fails = |what: &Path, error: &dyn fmt::Display| Trouble::Other(format!("{}: {error}", what.display()));
        fs::create_dir_all(path.join("plans")).map_err(|error| fails(path, &error))?;
        let mut options = OpenOptions::new();
        let mut results =
            options.read(true).append(true).create(true).open(&name).map_err(|error| fails(&name, &error))?;
        match results.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(fails(&name, &"another run is writing to it")),
            Err(TryLockError::Error(error)) => return Err(fails(&name, &error)),
        }
        let mut bytes = Vec::new();
        results.read_to_end(&mut bytes).map_err(|error| fails(&name, &error))?;
        let length = bytes.len();
        let file = SourceFile::new(name.display().to_string(), bytes);
        let Results { records, whole_bytes } = read_results(&file).map_err(Trouble::Results)?;
        let known: BTreeSet<String> = jobs.iter().map(Job::name).collect();
        if let Some(line) = records.iter().position(|record| !known.contains(&record.job)) {
            let message = format!("line {}: the suite has no job {}; use another folder", line + 1, records[line].job);
            return Err(fails(&name, &message));
        }
        if whole_bytes < length {
            results.set_len(whole_bytes as u64).map_err(|error| fails(&name, &error))?;
            results.seek(SeekFrom::End(0)).map_err(|error| fails(&name, &error))?;
        }
        let records = records.into_iter().map(|record| (record.job.clone(), record)).collect();
        Ok(Self { path: path.to_path_buf(), results, records, cut_off: length - whole_bytes })
    }

    /// What a job found, if it is finished.
    pub fn record(&self, job: &Job) -> Option<&Record> {
        self.records.get(&job.name())
    }

    /// Adds what a job found, in one piece.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn add(&mut self, job: &Job, record: Record) -> io::Result<()> {
        let line = write_result(job, &record).map_err(io::Error::other)?;
        self.results.write_all(line.as_bytes())?;
        self.results.sync_data()?;
        self.records.insert(record.job.clone(), record);
        Ok(())
    }

    /// Notes on what the run goes on.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn note_machine(&self, at_once: usize) -> io::Result<()> {
        let mut notes = OpenOptions::new().append(true).create(true).open(self.path.join("machines.txt"))?;
        writeln!(notes, "{}", machine(at_once))
    }

    /// On what the run went, each machine and revision once.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn machines(&self) -> io::Result<Vec<String>> {
        let notes = fs::read_to_string(self.path.join("machines.txt"))?;
        let mut machines: Vec<String> = notes.lines().map(str::to_string).collect();
        machines.dedup();
        Ok(machines)
    }
}

/// Version and revision of the program, processor and cores, on one line.
fn machine(at_once: usize) -> String {
    let revision = Command::new("git").args(["describe", "--always", "--dirty"]).output().ok();
    let revision = revision.filter(|output| output.status.success());
    let revision =
        revision.map_or_else(|| "unknown".into(), |out| String::from_utf8_lossy(&out.stdout).trim().to_string());
    let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processors.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown processor");
    let model = model.trim_start_matches(['\t', ' ', ':']);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let profile = if cfg!(debug_assertions) { "development build" } else { "release build" };
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "version {version}, revision {revision}, {profile}; {model}, {cores} cores; {at_once} jobs at once, one thread each"
    )
}
