//! Jobs side by side, within the limits of their suite.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread;
use std::time::{Duration, Instant};

use steadfast::io::{Message, read_message};
use steadfast::suite::{Ending, Job, Point, Record, Suite};

use super::arguments::Arguments;
use super::directory::{Directory, complaints_path, plan_path};
use super::settle;
use crate::{output, search};

/// How often the clock and the interrupt are looked at.
const TICK: Duration = Duration::from_millis(50);

/// What a job may take to draw its problem.
const DRAWING: Duration = Duration::from_secs(600);

/// What a job may take to end after its time is over, beside half of that time.
const GRACE: Duration = Duration::from_secs(30);

/// Those who run jobs.
pub struct Crew<'a> {
    /// What the jobs are of.
    pub suite: &'a Suite,
    /// How the program was called.
    pub arguments: &'a Arguments,
    /// How many jobs run at once.
    pub at_once: usize,
}

/// What is left to be done, and what is being done.
struct Board<'a> {
    next: usize,
    running: usize,
    bytes: u64,
    directory: &'a mut Directory,
    finished: usize,
    trouble: Option<io::Error>,
}

impl Crew<'_> {
    /// Runs jobs in their order until all are finished, the total time is over or the user interrupts; says
    /// whether he did.
    ///
    /// # Errors
    /// A process or a file cannot be made or written.
    pub fn work(&self, jobs: &[&Job], directory: &mut Directory) -> Result<bool, String> {
        if jobs.is_empty() {
            return Ok(false);
        }
        let cancel = search::cancelled_by_interrupt()?;
        let until = self.suite.limits.total_time.and_then(|time| Instant::now().checked_add(time));
        let board = Mutex::new(Board { next: 0, running: 0, bytes: 0, directory, finished: 0, trouble: None });
        let changed = Condvar::new();
        thread::scope(|scope| {
            for _ in 0..self.at_once.min(jobs.len()) {
                scope.spawn(|| self.take_turns(jobs, &board, &changed, &cancel, until));
            }
        });
        let board = board.into_inner().expect("no thread panics while it holds the board");
        match board.trouble {
            Some(trouble) => Err(trouble.to_string()),
            None => Ok(cancel.load(Ordering::SeqCst)),
        }
    }

    fn take_turns(
        &self,
        jobs: &[&Job],
        board: &Mutex<Board<'_>>,
        changed: &Condvar,
        cancel: &Arc<AtomicBool>,
        until: Option<Instant>,
    ) {
        let lock = || -> MutexGuard<'_, Board<'_>> { board.lock().expect("no thread panics while it holds the board") };
        loop {
            let mut held = lock();
            let job = loop {
                let over = cancel.load(Ordering::SeqCst) || until.is_some_and(|until| Instant::now() >= until);
                let Some(job) = jobs.get(held.next).filter(|_| !over && held.trouble.is_none()) else { return };
                // A job that is larger than all memory runs alone.
                let fits = self.suite.limits.total_bytes.is_none_or(|all| held.bytes + job.bytes <= all);
                if fits || held.running == 0 {
                    break *job;
                }
                held = changed.wait_timeout(held, TICK).expect("no thread panics while it holds the board").0;
            };
            held.next += 1;
            held.running += 1;
            held.bytes += job.bytes;
            drop(held);

            let done = self.run(job, cancel);
            let mut held = lock();
            held.running -= 1;
            held.bytes -= job.bytes;
            match done {
                Ok(Some(record)) => {
                    held.finished += 1;
                    let line = format!("[{}/{}] {}", held.finished, jobs.len(), settle::line(&record));
                    let written = held.directory.add(job, record).and_then(|()| output::message(&line));
                    held.trouble = held.trouble.take().or(written.err());
                }
                Ok(None) => {}
                Err(trouble) => held.trouble = Some(trouble),
            }
            changed.notify_all();
        }
    }

    /// Runs a job and replays its plan; `None` where the user interrupted it.
    fn run(&self, job: &Job, cancel: &AtomicBool) -> io::Result<Option<Record>> {
        let name = job.name();
        let folder = &self.arguments.out;
        let plan = plan_path(folder, &name);
        if plan.exists() {
            std::fs::remove_file(&plan)?;
        }
        let complaints = complaints_path(folder, &name);
        let mut child = Command::new(std::env::current_exe()?)
            .arg("bench")
            .arg(&self.arguments.suite)
            .arg("--out")
            .arg(folder)
            .args(["--job", &name])
            .env("RAYON_NUM_THREADS", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(File::create(&complaints)?)
            .spawn()?;
        let out = child.stdout.take().expect("it is piped");
        let heard = listen(&mut child, out, job.time, cancel);
        if heard.overran || cancel.load(Ordering::SeqCst) {
            // It may have ended by itself in the meantime.
            let _ = child.kill();
        }
        let status = child.wait()?;
        if !status.success() && !heard.overran {
            // The terminal interrupts both processes, and this one may not know it yet.
            thread::sleep(2 * TICK);
        }
        let complaint = std::fs::read_to_string(&complaints).unwrap_or_default();
        std::fs::remove_file(&complaints)?;
        if cancel.load(Ordering::SeqCst) {
            return Ok(None);
        }
        let record = match heard.record {
            Some(record) if !record.is_interrupted() => *record,
            _ => {
                let ending = if heard.overran { Ending::Overran } else { Ending::Crashed(how(status, &complaint)) };
                Record::without_answer(name, ending, heard.seconds, heard.trace)
            }
        };
        Ok(Some(settle::settled(job, record, &plan)))
    }
}

/// What a job said.
struct Heard {
    record: Option<Box<Record>>,
    trace: Vec<Point>,
    /// Time since planning began, or since the job did where it did not come to that, in s.
    seconds: f64,
    overran: bool,
}

/// Listens to a job until it falls silent, has taken too long, or the user interrupts.
fn listen(child: &mut Child, out: ChildStdout, time: Duration, cancel: &AtomicBool) -> Heard {
    let (say, lines) = mpsc::channel();
    let reader = thread::spawn(move || {
        for line in BufReader::new(out).lines().map_while(Result::ok) {
            if say.send(line).is_err() {
                break;
            }
        }
    });
    let mut began = Instant::now();
    let mut heard = Heard { record: None, trace: Vec::new(), seconds: 0.0, overran: false };
    loop {
        match lines.recv_timeout(TICK) {
            Ok(line) => match read_message(&line) {
                Some(Message::Point(point)) => {
                    if heard.trace.is_empty() {
                        began = Instant::now();
                    }
                    heard.trace.push(point);
                }
                Some(Message::Record(record)) => heard.record = Some(record),
                None => {}
            },
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                let most = if heard.trace.is_empty() { DRAWING } else { time + time / 2 + GRACE };
                heard.overran = began.elapsed() > most && heard.record.is_none();
                if heard.overran || cancel.load(Ordering::SeqCst) {
                    let _ = child.kill();
                    break;
                }
            }
        }
    }
    heard.seconds = began.elapsed().as_secs_f64();
    // It ends with the job's output.
    let _ = reader.join();
    heard
}

/// How a process ended that gave no answer.
fn how(status: ExitStatus, complaint: &str) -> String {
    match complaint.lines().find(|line| !line.trim().is_empty()) {
        Some(line) => format!("{status}: {line}"),
        None => status.to_string(),
    }
}
