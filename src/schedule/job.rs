//! Planning on a thread of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};

use crate::reconfigure::{Options, Refusal};

use super::robot::Robot;
use super::{EventOf, Problem, ReportOf};

/// Stops a [`Job`] from any thread, as often as one likes.
#[derive(Clone, Debug)]
pub struct Canceller(Arc<AtomicBool>);

impl Canceller {
    /// Stops it: it ends with the best plan so far, and [`Limit::Cancelled`](crate::reconfigure::Limit::Cancelled).
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// A problem that is being planned. Dropping it cancels it.
#[derive(Debug)]
pub struct Job<R: Robot> {
    events: Receiver<EventOf<R>>,
    canceller: Canceller,
    thread: Option<JoinHandle<Result<ReportOf<R>, Refusal>>>,
}

impl<R: Robot> Job<R> {
    /// Begins to plan. A flag for cancellation in `options` works as well as [`Job::canceller`].
    pub fn start(problem: Problem<R>, mut options: Options) -> Self {
        let flag = Arc::clone(options.cancel.get_or_insert_default());
        let (sender, events) = mpsc::channel();
        let thread = thread::spawn(move || {
            // Nobody has to listen.
            problem.plan(&options, &mut |event| sender.send(event.clone()).unwrap_or_default())
        });
        Self { events, canceller: Canceller(flag), thread: Some(thread) }
    }

    /// What happens, as it happens; ends when planning does.
    pub fn events(&self) -> impl Iterator<Item = EventOf<R>> + '_ {
        self.events.iter()
    }

    /// What has happened since the last call, without waiting.
    pub fn new_events(&self) -> impl Iterator<Item = EventOf<R>> + '_ {
        self.events.try_iter()
    }

    /// What stops it.
    pub fn canceller(&self) -> Canceller {
        self.canceller.clone()
    }

    /// Whether planning has ended, so that [`Job::wait`] returns at once.
    pub fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// The answer, once there is one.
    ///
    /// # Errors
    /// [`Refusal`] for bad input.
    ///
    /// # Panics
    /// If planning has, which would be a bug.
    pub fn wait(mut self) -> Result<ReportOf<R>, Refusal> {
        let thread = self.thread.take().expect("only waiting takes the thread, and that once");
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

impl<R: Robot> Drop for Job<R> {
    fn drop(&mut self) {
        self.canceller.cancel();
    }
}
