//! What the searches over a linkage share: arrangements, moves that hit nothing, and margins as widths.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard};

use planners::Width;

use crate::reconfigure::worst::Worst;
use crate::robot::linkage::Connection;
use crate::statics::Bracket;

use super::arrangement::{Arrangement, Arrangements, Frame, Framed};
use super::assembly::Held;
use super::clearance::Clearance;
use super::contacts::Contacts;
use super::goal::GoalTest;
use super::moves::{Rules, Step, View};
use super::oracle::Oracle;
use super::places::{Place, PlaceId};
use super::problem::{Described, Problem};

/// How many robots are kept with their moves.
const RECENT: usize = 4;

/// The robot of an arrangement with its moves.
#[derive(Debug)]
pub struct Moves {
    arrangement: Arrangement,
    /// The robot, everything engaged.
    pub view: View,
    /// Its moves, in their order.
    pub steps: Vec<Step>,
}

/// A problem with everything that answers questions about its states.
pub struct Domain<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// Where its modules can be.
    pub arrangements: Arrangements,
    /// What is to be reached.
    pub goal: GoalTest,
    /// The oracle for its states.
    pub oracle: Oracle<'a>,
    /// Whether states must be stable at all.
    pub stability: bool,
    contacts: Contacts<'a>,
    clearance: Clearance,
    /// What was looked at last: a search asks for the moves out of one state several times in a row, on either end.
    recent: Mutex<VecDeque<Arc<Moves>>>,
    /// Margins at rest with everything engaged.
    at_rest: Mutex<HashMap<Arrangement, Bracket>>,
}

impl<'a> Domain<'a> {
    /// Prepares for questions about a problem's states.
    pub fn new(problem: &'a Problem, stability: bool) -> Self {
        let arrangements = Arrangements::new(&problem.classes, problem.frame);
        Self {
            problem,
            goal: GoalTest::new(problem, &arrangements),
            arrangements,
            oracle: Oracle::new(problem),
            stability,
            contacts: Contacts::new(problem),
            clearance: Clearance::new(problem),
            recent: Mutex::new(VecDeque::new()),
            at_rest: Mutex::new(HashMap::new()),
        }
    }

    /// Approximate memory of all answers that are kept, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let at_rest = self.at_rest.lock().expect("no thread panics while it holds the margins");
        let numbers = self.problem.start.modules.len() * size_of::<PlaceId>();
        let known = at_rest.capacity() * (size_of::<(Arrangement, Bracket)>() + 1) * 8 / 7 + at_rest.len() * numbers;
        known + self.contacts.memory_bytes()
    }

    /// What may move.
    pub fn rules(&self) -> Rules {
        Rules { connected: self.problem.start.require.connected, either_side: self.problem.frame == Frame::Free }
    }

    /// The robot of an arrangement with everything engaged.
    pub fn saturated(&self, arrangement: &Arrangement) -> View {
        self.contacts.saturated(arrangement, self.arrangements.modules(arrangement))
    }

    /// The robot of an arrangement with its moves.
    pub fn moves(&self, arrangement: &Arrangement) -> Arc<Moves> {
        let mut recent = self.recent();
        let known = recent.iter().position(|moves| moves.arrangement == *arrangement);
        let moves = known.and_then(|index| recent.remove(index)).unwrap_or_else(|| {
            let view = self.saturated(arrangement);
            let steps = view.steps(self.rules());
            Arc::new(Moves { arrangement: arrangement.clone(), view, steps })
        });
        recent.truncate(RECENT - 1);
        recent.push_front(Arc::clone(&moves));
        moves
    }

    fn recent(&self) -> MutexGuard<'_, VecDeque<Arc<Moves>>> {
        self.recent.lock().expect("no thread panics while it holds moves")
    }

    /// Whether a state at rest is connected, if it has to be.
    pub fn is_connected(&self, view: &View, engaged: &[Connection]) -> bool {
        let mut components = petgraph::unionfind::UnionFind::<usize>::new(view.modules.len());
        let joined = engaged.iter().filter(|connection| {
            let [a, b] = connection.modules();
            components.union(a, b)
        });
        !self.problem.start.require.connected || joined.count() + 1 >= view.modules.len()
    }

    /// Whether nothing is hit during a move.
    pub fn is_free(&self, view: &View, step: &Step) -> bool {
        self.clearance.is_free(view, step)
    }

    /// Margin of a robot at rest that is described in the order of its arrangement.
    pub fn of_state(&self, view: &View, engaged: &[Connection]) -> Worst<Held> {
        self.oracle.of_state(view, &self.problem.slots, engaged)
    }

    /// Margin of a move with the detachments before it, likewise.
    pub fn of_move(&self, view: &View, step: &Step, floor: f64) -> Worst<Held> {
        self.oracle.of_move(view, &self.problem.slots, &view.kept(step), step, floor)
    }

    /// Margin of an arrangement with everything engaged.
    pub fn settled(&self, arrangement: &Arrangement) -> Bracket {
        let known = |at_rest: &Mutex<HashMap<_, Bracket>>| {
            at_rest.lock().expect("no thread panics while it holds margins").get(arrangement).copied()
        };
        known(&self.at_rest).unwrap_or_else(|| {
            let view = self.saturated(arrangement);
            let margin = self.of_state(&view, &view.connections).margin;
            self.at_rest.lock().expect("no thread panics while it holds margins").insert(arrangement.clone(), margin);
            margin
        })
    }
}

impl Problem {
    /// A robot whose modules are in this order, with these connections engaged.
    pub fn view(&self, modules: &[Described], connections: Vec<Connection>) -> View {
        let place =
            |(class, pose, joints): &Described| Place::new(*class, &self.classes[*class].kind, *pose, joints).into();
        View { classes: Arc::clone(&self.classes), modules: modules.iter().map(place).collect(), connections }
    }
}

/// How an arrangement frames itself.
pub fn framed(arrangement: &Arrangement) -> Framed {
    Framed {
        arrangement: arrangement.clone(),
        frame: crate::spatial::Pose::identity(),
        of_module: arrangement.0.to_vec(),
    }
}

/// A margin as a width.
pub fn width(margin: Bracket) -> Width {
    Width { lower: margin.lower, upper: margin.upper }
}
