//! A start and a goal, prepared for search: classes of interchangeable
//! modules, canonical layouts, and the way back from a canonical layout to a
//! configuration that represents it.
//!
//! Knows no search and asks no oracle.

use crate::robot::{Configuration, FaceConnection, Goal, ModuleLoad, Placement, Port};

use super::goal::GoalTest;
use super::layout::{Bond, Layout, Placed};
use super::moves::Ability;
use super::refusal::Refusal;

/// Largest coordinate of a cell, so that no arithmetic on cells overflows.
const LARGEST_COORDINATE: u32 = 1 << 24;

/// What makes modules interchangeable: those of one class can swap places
/// without a difference to geometry, statics or the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Index into the catalogue's module types.
    pub module_type: usize,
    /// Whether its modules are held immovably.
    pub fixed: bool,
    /// The loads on each of its modules; their module index is meaningless.
    loads: Vec<ModuleLoad>,
    /// The one module of the class, where modules are labelled.
    label: Option<String>,
    /// Whether the orientation of its modules matters: their centre of mass or
    /// a point of action is off the centre of the cube.
    pub turns: bool,
}

/// A reconfiguration problem.
#[derive(Clone, Debug)]
pub struct Problem {
    start: Configuration,
    classes: Vec<Class>,
    class_of: Vec<u16>,
    layout: Layout,
    bonds: Vec<Bond>,
    goal: GoalTest,
}

impl Problem {
    /// Prepares a start and a goal.
    ///
    /// # Errors
    /// Data that no robot can have, or a goal that cannot be compared with the
    /// start; the first problem found.
    pub fn new(start: &Configuration, goal: &Goal) -> Result<Self, Refusal> {
        for configuration in [start, &goal.configuration] {
            check(configuration)?;
        }
        if start.catalogue != goal.configuration.catalogue {
            return Err(Refusal::CataloguesDiffer);
        }
        let (classes, class_of) = classes(start, goal.matching.labelled);
        let layout = layout(start, &classes, &class_of);
        let goal = GoalTest::new(start, goal, &classes)?;
        Ok(Self { layout, bonds: bonds(start), start: start.clone(), classes, class_of, goal })
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
    pub fn ability(&self, class: u16) -> Ability {
        let class = self.class(class);
        let lattice = &self.start.catalogue.module_types[class.module_type].lattice;
        let free = !class.fixed;
        Ability { slide: free && lattice.slide, pivot: free && lattice.pivot, hinge: lattice.hinge.is_some() }
    }

    /// A configuration with these placements and connections, in which the
    /// modules of each class fill its cells in ascending order.
    pub fn representative(&self, layout: &Layout, bonds: &[Bond]) -> Configuration {
        let mut configuration = self.start.clone();
        for (class, _) in self.classes.iter().enumerate() {
            let modules = (0..self.class_of.len()).filter(|&m| usize::from(self.class_of[m]) == class);
            let places = layout.placed().iter().filter(|placed| usize::from(placed.class) == class);
            for (module, placed) in modules.zip(places) {
                configuration.modules[module].placement =
                    Placement { cell: placed.cell, orientation: placed.orientation };
            }
        }
        configuration.connections = bonds.iter().filter_map(|&bond| connection(&configuration, bond)).collect();
        configuration.connections.sort_unstable();
        configuration
    }
}

/// The module in a cell.
pub fn module_at(configuration: &Configuration, cell: crate::robot::Cell) -> Option<usize> {
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

/// The canonical layout of a configuration whose modules have these classes.
fn layout(configuration: &Configuration, classes: &[Class], class_of: &[u16]) -> Layout {
    let placed = configuration.modules.iter().zip(class_of).map(|(module, &class)| {
        let turns = classes[usize::from(class)].turns;
        let Placement { cell, orientation } = module.placement;
        Placed { cell, class, orientation: if turns { orientation } else { Default::default() } }
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
        let com = start.catalogue.module_types[module.module_type].body.com;
        let off_centre = |load: &ModuleLoad| load.at.is_some_and(|at| at != com);
        let class = Class {
            module_type: module.module_type,
            fixed: module.fixed,
            label: labelled.then(|| module.id.clone()),
            turns: com.norm() > 0.0 || loads.iter().any(off_centre),
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
