//! A start and a goal, prepared for search: classes of interchangeable
//! modules, canonical layouts, and the way back from a canonical layout to a
//! configuration that represents it.
//!
//! Knows no search and asks no oracle.

use crate::robot::{Cell, Configuration, FaceConnection, Goal, ModuleLoad, Orientation, Placement, Port};

use super::goal::GoalTest;
use super::heuristic::{Reach, Targets};
use super::layout::{Bond, Layout, Placed};
use super::moves::Move;
use super::refusal::{Rejection, check};
use super::ways::Ability;

/// What makes modules interchangeable: those of one class can swap places
/// without a difference to geometry, statics or the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Index into the catalogue's module types.
    pub module_type: usize,
    /// Whether its modules are held immovably.
    pub fixed: bool,
    /// The loads on each of its modules; their module index is always 0.
    pub loads: Vec<ModuleLoad>,
    /// The one module of the class, where modules are labelled.
    pub label: Option<String>,
    /// Whether the orientation of its modules matters: a load acts off their
    /// centre. Cubes themselves are alike in all 24 orientations.
    pub turns: bool,
}

/// A reconfiguration problem.
#[derive(Clone, Debug)]
pub struct Problem {
    start: Configuration,
    classes: Vec<Class>,
    abilities: Vec<Ability>,
    class_of: Vec<u16>,
    layout: Layout,
    bonds: Vec<Bond>,
    goal: GoalTest,
}

impl Problem {
    /// Prepares a start and a goal.
    ///
    /// # Errors
    /// [`Rejection::Refused`] for data that no robot can have or a goal that cannot be
    /// compared with the start, [`Rejection::Impossible`] when the modules alone prove
    /// that the goal cannot be reached.
    pub fn new(start: &Configuration, goal: &Goal) -> Result<Self, Rejection> {
        check(start, goal)?;
        let (classes, class_of) = classes(start, goal.matching.labelled);
        let ability = |class: &Class| {
            let ability = Ability::new(&start.catalogue, class.module_type);
            if class.fixed { ability.held() } else { ability }
        };
        let abilities: Vec<_> = classes.iter().map(ability).collect();
        let reaches = abilities.iter().map(Reach::of).collect();
        let goal = GoalTest::new(start, &class_of, &classes, reaches, goal)?;
        let layout = layout(start, &classes, &class_of);
        Ok(Self { layout, bonds: bonds(start), start: start.clone(), classes, abilities, class_of, goal })
    }

    /// The start as it was given.
    pub fn start(&self) -> &Configuration {
        &self.start
    }

    /// Where the modules are at the start.
    pub fn start_layout(&self) -> &Layout {
        &self.layout
    }

    /// The connections that are engaged at the start, ascending.
    pub fn start_bonds(&self) -> &[Bond] {
        &self.bonds
    }

    /// What is to be reached.
    pub fn goal(&self) -> &GoalTest {
        &self.goal
    }

    /// The class with this index.
    pub fn class(&self, class: u16) -> &Class {
        &self.classes[usize::from(class)]
    }

    /// What modules of a class can do. Fixed modules carry others but do not move.
    pub fn ability(&self, class: u16) -> &Ability {
        &self.abilities[usize::from(class)]
    }

    /// The cells that a move may need filled or empty, beside those that it sweeps.
    pub fn needs(&self, step: Move) -> Vec<Cell> {
        let way = self.abilities.iter().find_map(|ability| ability.way(step));
        way.map_or_else(Vec::new, |way| way.needs(step.from).collect())
    }

    /// A layout of this problem's modules as what is to be reached.
    pub fn targets(&self, layout: &Layout) -> Targets {
        Targets::new(layout, self.abilities.iter().map(Reach::of).collect())
    }

    /// Whether the orientation of any module matters.
    pub fn turns(&self) -> bool {
        self.classes.iter().any(|class| class.turns)
    }

    /// Whether all modules must stay connected.
    pub fn must_stay_connected(&self) -> bool {
        self.start.require.connected
    }

    /// The modules of the start, not fixed, whose places are filled by the like of them in all of these layouts.
    pub fn unmoved(&self, layouts: &[&Layout]) -> Vec<usize> {
        let modules = self.start.modules.iter().zip(&self.class_of).enumerate();
        let stays = |cell: Cell, class: u16| {
            layouts.iter().all(|layout| layout.at(cell).is_some_and(|at| layout.placed()[at].class == class))
        };
        let unmoved = modules.filter(|(_, (module, class))| !module.fixed && stays(module.placement.cell, **class));
        unmoved.map(|(index, _)| index).collect()
    }

    /// A placement for every module of the start that represents `layout`: the
    /// modules of each class fill its cells in ascending order.
    pub fn placements(&self, layout: &Layout) -> Vec<Placement> {
        let mut next: Vec<_> = (0..self.classes.len()).map(|class| of_class(layout, class)).collect();
        let place = |&class: &u16| {
            let placed = next[usize::from(class)].next().expect("a layout of the start's modules");
            Placement { cell: placed.cell, orientation: placed.orientation }
        };
        self.class_of.iter().map(place).collect()
    }
}

/// The modules of one class, by ascending cell.
fn of_class(layout: &Layout, class: usize) -> impl Iterator<Item = &Placed> {
    layout.placed().iter().filter(move |placed| usize::from(placed.class) == class)
}

/// The module in a cell.
pub fn module_at(configuration: &Configuration, cell: Cell) -> Option<usize> {
    configuration.modules.iter().position(|module| module.placement.cell == cell)
}

/// The connection of two modules' coinciding faces; `None` where a cell is empty.
pub fn connection(configuration: &Configuration, bond: Bond) -> Option<FaceConnection> {
    let [first, second] = bond.cells();
    let port = |cell, towards| {
        let module = module_at(configuration, cell)?;
        let face = configuration.modules[module].placement.orientation.to_module(towards);
        Some(Port { module, face })
    };
    Some(FaceConnection::new(port(first, bond.face())?, port(second, bond.face().opposite())?))
}

/// The engaged connections of a configuration by where they are, ascending.
pub fn bonds(configuration: &Configuration) -> Vec<Bond> {
    let bond = |connection: &FaceConnection| {
        let port = connection.ports[0];
        Bond::new(configuration.modules[port.module].placement.cell, configuration.direction(port))
    };
    let mut bonds: Vec<Bond> = configuration.connections.iter().map(bond).collect();
    bonds.sort_unstable();
    bonds.dedup();
    bonds
}

/// The cells of a configuration's modules, all of one class.
pub fn cells(configuration: &Configuration) -> Layout {
    let placed = configuration.modules.iter().map(|module| Placed {
        cell: module.placement.cell,
        class: 0,
        orientation: Orientation::IDENTITY,
    });
    Layout::new(placed.collect())
}

/// The canonical layout of a configuration whose modules have these classes.
fn layout(configuration: &Configuration, classes: &[Class], class_of: &[u16]) -> Layout {
    let placed = configuration.modules.iter().zip(class_of).map(|(module, &class)| {
        let turns = classes[usize::from(class)].turns;
        let Placement { cell, orientation } = module.placement;
        Placed { cell, class, orientation: if turns { orientation } else { Orientation::IDENTITY } }
    });
    Layout::new(placed.collect())
}

/// The classes of the start's modules, in order of first appearance.
fn classes(start: &Configuration, labelled: bool) -> (Vec<Class>, Vec<u16>) {
    let mut classes: Vec<Class> = Vec::new();
    let mut class_of = Vec::with_capacity(start.modules.len());
    for (index, module) in start.modules.iter().enumerate() {
        let own = start.loads.iter().filter(|load| load.module == index);
        let loads: Vec<ModuleLoad> = own.map(|load| ModuleLoad { module: 0, ..load.clone() }).collect();
        let off_centre = |load: &ModuleLoad| load.at.is_some_and(|at| at.amax() > 0.0);
        let class = Class {
            module_type: module.module_type,
            fixed: module.fixed,
            label: labelled.then(|| module.id.clone()),
            turns: loads.iter().any(off_centre),
            loads,
        };
        let known = classes.iter().position(|other| *other == class);
        let position = known.unwrap_or_else(|| {
            classes.push(class);
            classes.len() - 1
        });
        class_of.push(u16::try_from(position).expect("checked: fewer modules than class numbers"));
    }
    (classes, class_of)
}
