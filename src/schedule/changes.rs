//! What can happen to a robot, as changes of its problem.
//!
//! A change applies to the start and the goal alike, so that they stay comparable, or to neither if it is refused.

use std::fmt;
use std::sync::Arc;

use crate::robot::Catalogue;
use crate::statics::{Connector, Model};

use super::Problem;
use super::robot::Robot;

/// Why a change is refused. Nothing has changed then.
#[derive(Clone, Debug, PartialEq)]
pub enum ChangeError {
    /// No module of the start has this id.
    UnknownModule(String),
    /// The goal has no module with this id, or of another type than the start's, so that it does not say where that
    /// very module is to end.
    NotInGoal(String),
    /// The two modules, of the start and of the goal, are of different types.
    TypesDiffer(String, String),
    /// The catalogue has no connector of this name.
    UnknownConnector(String),
    /// The module has no port of this name with a connector.
    UnknownPort(String),
    /// What is left of a strength must be above 0 and at most 1.
    Factor(f64),
}

impl fmt::Display for ChangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownModule(id) => write!(f, "there is no module `{id}`"),
            Self::NotInGoal(id) => write!(f, "the goal does not say where module `{id}` is to be"),
            Self::TypesDiffer(a, b) => {
                write!(f, "module `{a}` of the start and `{b}` of the goal are of different types")
            }
            Self::UnknownConnector(name) => write!(f, "there is no connector `{name}`"),
            Self::UnknownPort(name) => write!(f, "the module has no port `{name}` with a connector"),
            Self::Factor(factor) => write!(f, "a strength cannot be multiplied by {factor}: above 0, at most 1"),
        }
    }
}

impl std::error::Error for ChangeError {}

/// All connectors of a kind hold only this share of what they did, by their name in the catalogue.
///
/// # Errors
/// See [`ChangeError`].
pub fn weaken_connector<R: Robot>(problem: &mut Problem<R>, name: &str, factor: f64) -> Result<(), ChangeError> {
    check_factor(factor)?;
    let catalogue = problem.start.catalogue();
    let known = catalogue.connectors.iter().position(|connector| connector.name == name);
    let index = known.ok_or_else(|| ChangeError::UnknownConnector(name.to_owned()))?;
    let mut weaker = Catalogue::clone(catalogue);
    weaker.connectors[index] = weakened(&weaker.connectors[index], factor);
    share(problem, weaker);
    Ok(())
}

/// One port of one module holds only this share of what it did. The module becomes one of a type of its own, which
/// no other can stand in for: the goal must place the module of this very id.
///
/// The faces of a lattice module share one connector, so all six are weakened with it: what is proved then holds all
/// the more (statics: monotony).
///
/// # Errors
/// See [`ChangeError`].
pub fn weaken_port<R: Robot>(
    problem: &mut Problem<R>,
    module: &str,
    port: &str,
    factor: f64,
) -> Result<(), ChangeError> {
    check_factor(factor)?;
    let here = index_of(&problem.start, module)?;
    let kind = *problem.start.type_mut(here);
    let there = index_of(&problem.goal, module).map_err(|_| ChangeError::NotInGoal(module.to_owned()))?;
    if *problem.goal.type_mut(there) != kind {
        return Err(ChangeError::NotInGoal(module.to_owned()));
    }
    let mut catalogue = Catalogue::clone(problem.start.catalogue());
    let mut own = catalogue.module_types[kind].clone();
    let unknown = || ChangeError::UnknownPort(port.to_owned());
    let at = own.port(port).ok_or_else(unknown)?;
    let connector = own.ports[at].connector.ok_or_else(unknown)?;
    let mut weaker = weakened(&catalogue.connectors[connector], factor);
    weaker.name = unused(&format!("{} of {module}:{port}", weaker.name), |name| {
        catalogue.connectors.iter().any(|connector| connector.name == name)
    });
    own.name = unused(&format!("{} {module}", own.name), |name| catalogue.find(name).is_some());
    let index = catalogue.connectors.len();
    match &mut own.lattice {
        Some(lattice) => {
            lattice.face = index;
            own.ports.iter_mut().for_each(|port| port.connector = Some(index));
        }
        None => own.ports[at].connector = Some(index),
    }
    catalogue.connectors.push(weaker);
    catalogue.module_types.push(own);
    let own = catalogue.module_types.len() - 1;
    *problem.start.type_mut(here) = own;
    *problem.goal.type_mut(there) = own;
    share(problem, catalogue);
    Ok(())
}

/// A module is gone, and the goal does without one of its own: `unfilled`, by its id in the goal.
///
/// # Errors
/// See [`ChangeError`].
pub fn remove<R: Robot>(problem: &Problem<R>, module: &str, unfilled: &str) -> Result<Problem<R>, ChangeError> {
    let here = index_of(&problem.start, module)?;
    let there = index_of(&problem.goal, unfilled).map_err(|_| ChangeError::NotInGoal(unfilled.to_owned()))?;
    let mut left = problem.clone();
    if left.start.type_mut(here) != left.goal.type_mut(there) {
        return Err(ChangeError::TypesDiffer(module.to_owned(), unfilled.to_owned()));
    }
    left.start.take_out(here);
    left.goal.take_out(there);
    let require = left.start.require_mut().clone();
    *left.goal.require_mut() = require;
    Ok(left)
}

/// The problems that are left once a module is gone: one for each module of its type that the goal can do without and
/// still hold together, with that module's id. Plan them all, as with [`plan_batch`](super::plan_batch), and take the
/// [`best`](super::best).
///
/// # Errors
/// [`ChangeError::UnknownModule`].
pub fn without<R: Robot>(problem: &Problem<R>, module: &str) -> Result<Vec<(String, Problem<R>)>, ChangeError> {
    index_of(&problem.start, module)?;
    let ids = problem.goal.ids().into_iter().map(str::to_owned);
    let left = ids.filter_map(|unfilled| Some((remove(problem, module, &unfilled).ok()?, unfilled)));
    Ok(left.filter(|(left, _)| left.goal.is_connected()).map(|(left, unfilled)| (unfilled, left)).collect())
}

fn index_of<R: Robot>(robot: &R, id: &str) -> Result<usize, ChangeError> {
    robot.ids().iter().position(|other| *other == id).ok_or_else(|| ChangeError::UnknownModule(id.to_owned()))
}

fn check_factor(factor: f64) -> Result<(), ChangeError> {
    if factor > 0.0 && factor <= 1.0 { Ok(()) } else { Err(ChangeError::Factor(factor)) }
}

/// Gives start and goal one catalogue.
fn share<R: Robot>(problem: &mut Problem<R>, catalogue: Catalogue) {
    let shared = Arc::new(catalogue);
    *problem.start.catalogue_mut() = Arc::clone(&shared);
    *problem.goal.catalogue_mut() = shared;
}

/// A connector that carries so much of every wrench that it did. Compression is carried by the bodies, not by it.
fn weakened(connector: &Connector, factor: f64) -> Connector {
    let model = match &connector.model {
        Model::Box { shear, tension, compression, bending, torsion } => Model::Box {
            shear: shear.map(|limit| factor * limit),
            tension: factor * tension,
            compression: *compression,
            bending: bending.map(|limit| factor * limit),
            torsion: factor * torsion,
        },
        Model::Cone { .. } | Model::Patch { .. } => connector.model.clone(),
    };
    Connector { name: connector.name.clone(), strength: factor * connector.strength, model }
}

/// A name like this one that is not taken.
fn unused(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2..).map(|number| format!("{name} {number}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_taken(name)).expect("names do not run out")
}
