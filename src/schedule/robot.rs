//! What the functions of this module need to know of a robot, and the two kinds that there are.

use std::fmt::{self, Debug, Display};
use std::sync::Arc;

use crate::reconfigure::linkage::assembly::{Held, Touched as LinkageTouched};
use crate::reconfigure::linkage::{self, Action as LinkageAction, replay as linkage_replay};
use crate::reconfigure::partial_order::{self, OrderError, OrderOptions, PartialOrder};
use crate::reconfigure::replay::{self, Fault, Replay};
use crate::reconfigure::{Action, Event, Options, Plan, Refusal, Report, assembly};
use crate::robot::linkage::{Linkage, MEETING};
use crate::robot::{Catalogue, Configuration, FaceConnection, ModuleLoad, Requirement};

use super::{EventOf, PlanOf, Problem, ReportOf};

/// An action that is not legal where it should be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation<T> {
    /// How many actions before it could be taken.
    pub action: usize,
    /// Why it cannot.
    pub fault: Fault<T>,
}

impl<T: Display> Display for Deviation<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "action {}: {}", self.action + 1, self.fault)
    }
}

impl<T: Debug + Display> std::error::Error for Deviation<T> {}

/// A robot at one moment: a [`Configuration`] of lattice modules or a [`Linkage`] of others.
pub trait Robot: Clone + Debug + PartialEq + Send + Sync + 'static {
    /// What its modules do.
    type Action: Clone + Debug + PartialEq + Send + Sync + 'static;
    /// What names one of its connections.
    type Connection: Clone + Debug + PartialEq + Send + Sync + 'static;
    /// What its modules can hit.
    type Touched: Clone + Debug + Display + PartialEq + Send + Sync + 'static;

    /// The robot after actions, each of which must be legal in the state that it is taken in. Forces and collisions are
    /// not looked at: see [`Problem::replay`].
    ///
    /// # Errors
    /// The first action that is not legal: the robot is not where the plan takes it to be.
    fn after<'a>(&self, actions: impl IntoIterator<Item = &'a Self::Action>) -> Result<Self, Deviation<Self::Touched>>;

    /// The modules that are not where `expected` has them, by index; of linkages within the tolerance within which
    /// ports meet. Both must be the same modules.
    fn misplaced(&self, expected: &Self) -> Vec<usize>;

    /// Its ids, in the order of its modules.
    fn ids(&self) -> Vec<&str>;

    /// Its module types and connectors.
    fn catalogue(&self) -> &Arc<Catalogue>;

    /// See [`Robot::catalogue`].
    fn catalogue_mut(&mut self) -> &mut Arc<Catalogue>;

    /// The type of each module: index into the catalogue's.
    fn type_mut(&mut self, module: usize) -> &mut usize;

    /// What every transient state must satisfy.
    fn require_mut(&mut self) -> &mut Requirement;

    /// Takes a module away, with its connections and loads; the others move up in their order.
    fn take_out(&mut self, module: usize);

    /// Whether its connections join all modules.
    fn is_connected(&self) -> bool;

    /// Plans: [`Problem::plan`].
    ///
    /// # Errors
    /// [`Refusal`] for bad input.
    fn solve(
        problem: &Problem<Self>,
        options: &Options,
        on_event: &mut dyn FnMut(&EventOf<Self>),
    ) -> Result<ReportOf<Self>, Refusal>;

    /// Checks a plan: [`Problem::replay`].
    ///
    /// # Errors
    /// [`Refusal`] for bad input.
    fn replay(
        problem: &Problem<Self>,
        plan: &PlanOf<Self>,
        required: f64,
    ) -> Result<Replay<Self::Connection, Self::Touched>, Refusal>;

    /// Which actions of a plan may run at the same time: [`Problem::partial_order`].
    ///
    /// # Errors
    /// [`OrderError::Broken`] for a plan that does not hold from here in its own order.
    fn partial_order(
        &self,
        plan: &PlanOf<Self>,
        options: &OrderOptions,
    ) -> Result<PartialOrder<Self::Touched>, OrderError<Self::Touched>>;
}

/// The index of a module once another one is taken out.
fn moved_up(module: usize, out: usize) -> usize {
    module - usize::from(module > out)
}

/// Takes a module out of what names modules by index.
fn take_out_of(loads: &mut Vec<ModuleLoad>, require: &mut Requirement, out: usize) {
    loads.retain(|load| load.module != out);
    loads.iter_mut().for_each(|load| load.module = moved_up(load.module, out));
    require.stay.retain(|&module| module != out);
    require.stay.iter_mut().for_each(|module| *module = moved_up(*module, out));
}

/// What is written alike for both kinds of robot, since their fields have the same names.
macro_rules! by_its_fields {
    () => {
        fn ids(&self) -> Vec<&str> {
            self.modules.iter().map(|module| module.id.as_str()).collect()
        }

        fn catalogue(&self) -> &Arc<Catalogue> {
            &self.catalogue
        }

        fn catalogue_mut(&mut self) -> &mut Arc<Catalogue> {
            &mut self.catalogue
        }

        fn type_mut(&mut self, module: usize) -> &mut usize {
            &mut self.modules[module].module_type
        }

        fn require_mut(&mut self) -> &mut Requirement {
            &mut self.require
        }

        fn take_out(&mut self, module: usize) {
            self.modules.remove(module);
            self.connections.retain(|connection| !connection.modules().contains(&module));
            for port in self.connections.iter_mut().flat_map(|connection| &mut connection.ports) {
                port.module = moved_up(port.module, module);
            }
            take_out_of(&mut self.loads, &mut self.require, module);
        }

        fn is_connected(&self) -> bool {
            Self::is_connected(self)
        }
    };
}

impl Robot for Configuration {
    type Action = Action;
    type Connection = FaceConnection;
    type Touched = assembly::Touched;

    fn after<'a>(&self, actions: impl IntoIterator<Item = &'a Action>) -> Result<Self, Deviation<Self::Touched>> {
        replay::after(self, actions).map_err(|(action, fault)| Deviation { action, fault })
    }

    fn misplaced(&self, expected: &Self) -> Vec<usize> {
        let is_there = |&m: &usize| self.modules.get(m).map(|m| m.placement) == Some(expected.modules[m].placement);
        (0..expected.modules.len()).filter(|module| !is_there(module)).collect()
    }

    by_its_fields!();

    fn solve(problem: &Problem<Self>, options: &Options, on_event: &mut dyn FnMut(&Event)) -> Result<Report, Refusal> {
        super::solve_lattice(problem, options, on_event)
    }

    fn replay(problem: &Problem<Self>, plan: &Plan, required: f64) -> Result<Replay, Refusal> {
        super::replay_lattice(problem, plan, required)
    }

    fn partial_order(&self, plan: &Plan, options: &OrderOptions) -> Result<PartialOrder, OrderError> {
        partial_order::partial_order(self, plan, options)
    }
}

impl Robot for Linkage {
    type Action = LinkageAction;
    type Connection = Held;
    type Touched = LinkageTouched;

    fn after<'a>(
        &self,
        actions: impl IntoIterator<Item = &'a LinkageAction>,
    ) -> Result<Self, Deviation<Self::Touched>> {
        linkage_replay::after(self, actions).map_err(|(action, fault)| Deviation { action, fault })
    }

    fn misplaced(&self, expected: &Self) -> Vec<usize> {
        let is_there = |&m: &usize| {
            let there = &expected.modules[m];
            let tolerance = MEETING * expected.module_type(m).size();
            self.modules.get(m).is_some_and(|here| {
                let apart = (here.pose.translation.vector - there.pose.translation.vector).norm();
                here.joints == there.joints
                    && apart <= tolerance
                    && here.pose.rotation.angle_to(&there.pose.rotation) <= MEETING
            })
        };
        (0..expected.modules.len()).filter(|module| !is_there(module)).collect()
    }

    by_its_fields!();

    fn solve(
        problem: &Problem<Self>,
        options: &Options,
        on_event: &mut dyn FnMut(&EventOf<Self>),
    ) -> Result<Report<LinkageAction, Held>, Refusal> {
        super::solve_linkage(problem, options, on_event)
    }

    fn replay(
        problem: &Problem<Self>,
        plan: &Plan<LinkageAction, Held>,
        required: f64,
    ) -> Result<Replay<Held, LinkageTouched>, Refusal> {
        super::replay_linkage(problem, plan, required)
    }

    fn partial_order(
        &self,
        plan: &PlanOf<Self>,
        options: &OrderOptions,
    ) -> Result<PartialOrder<LinkageTouched>, OrderError<LinkageTouched>> {
        linkage::partial_order(self, plan, options)
    }
}
