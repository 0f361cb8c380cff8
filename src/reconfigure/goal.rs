//! What is to be reached, in canonical form, up to what the goal leaves open.
//!
//! Knows cells and classes; asks no oracle.

use crate::robot::{Cell, Configuration, Face, Goal, Module, Orientation};

use super::heuristic::{Reach, Targets};
use super::layout::{Bond, Layout, Placed};
use super::problem::{Class, bonds};
use super::refusal::{Impossible, Refusal, Rejection};

/// The goal of a problem.
#[derive(Clone, Debug)]
pub struct GoalTest {
    /// The goal's cells and connections: one form in the world frame; where the
    /// frame is free, its turns about the vertical, moved to the origin.
    forms: Vec<Form>,
    free: bool,
}

/// One way to turn the goal.
#[derive(Clone, Debug)]
struct Form {
    layout: Layout,
    bonds: Vec<Bond>,
    targets: Targets,
    bounds: [[i32; 2]; 2],
}

/// How a layout meets the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    form: usize,
    offset: Cell,
}

impl GoalTest {
    /// Prepares a goal for a start whose modules have these classes, which come so far in one move.
    pub(super) fn new(
        start: &Configuration,
        class_of: &[u16],
        classes: &[Class],
        reaches: Vec<Reach>,
        goal: &Goal,
    ) -> Result<Self, Rejection> {
        let free = goal.matching.free_frame;
        if free {
            check_free_frame(start)?;
        }
        let wanted = goal_classes(start, class_of, classes, goal)?;
        let modules = goal.configuration.modules.iter();
        let placed = modules.zip(wanted).map(|(module, class)| Placed {
            cell: module.placement.cell,
            class,
            orientation: Orientation::IDENTITY,
        });
        let layout = Layout::new(placed.collect());
        let listed = bonds(&goal.configuration);
        let turns = if free { 4 } else { 1 };
        let forms = (0..turns).map(|turn| Form::new(&layout, &listed, turn, free, &reaches)).collect();
        Ok(Self { forms, free })
    }

    /// The goal's layout; some displacement of it where the frame is free.
    pub fn layout(&self) -> &Layout {
        &self.forms[0].layout
    }

    /// The connections of [`GoalTest::layout`].
    pub fn listed(&self) -> &[Bond] {
        &self.forms[0].bonds
    }

    /// Whether the goal may be met anywhere on the ground.
    pub fn is_free(&self) -> bool {
        self.free
    }

    /// The goal's layout where it has most modules of `layout` in place already: in a free frame over all turns, and
    /// all displacements for which the bounding boxes meet; of equals the first.
    pub fn placed_best(&self, layout: &Layout) -> Layout {
        if !self.free {
            return self.forms[0].layout.clone();
        }
        let here = bounds(layout);
        let in_place = |placed: &Layout| {
            let stays = |p: &&Placed| layout.at(p.cell).is_some_and(|at| layout.placed()[at].class == p.class);
            placed.placed().iter().filter(stays).count()
        };
        let placings = self.forms.iter().flat_map(|form| {
            let [xs, ys] = [0, 1].map(|i| here[i][0] - form.bounds[i][1]..=here[i][1] - form.bounds[i][0]);
            xs.flat_map(move |x| ys.clone().map(move |y| form.layout.displaced([x, y, 0])))
        });
        let counted = placings.map(|placed| (in_place(&placed), placed));
        let best = counted.reduce(|best, next| if next.0 > best.0 { next } else { best });
        best.map_or_else(|| self.forms[0].layout.clone(), |(_, placed)| placed)
    }

    /// How a layout fills the goal's cells, if it does.
    pub fn arrival(&self, layout: &Layout) -> Option<Arrival> {
        let corner = bounds(layout).map(|[low, _]| low);
        self.forms.iter().enumerate().find_map(|(form, wanted)| {
            let offset = if self.free { [corner[0], corner[1], 0] } else { [0; 3] };
            (wanted.targets.are_met_by(layout, offset)).then_some(Arrival { form, offset })
        })
    }

    /// The goal's connections where a layout has met it, ascending.
    pub fn bonds(&self, arrival: Arrival) -> Vec<Bond> {
        let mut bonds: Vec<Bond> =
            self.forms[arrival.form].bonds.iter().map(|bond| bond.displaced(arrival.offset)).collect();
        bonds.sort_unstable();
        bonds
    }

    /// Admissible lower bound on the moves that are left; `None` when the goal
    /// is out of reach for good.
    ///
    /// In a free frame it is the smallest over all turns and all displacements
    /// for which the layout's and the goal's bounding boxes meet: beyond, every
    /// module is on one side of every target along some axis, and no cost falls with the distance.
    pub fn fewest_moves(&self, layout: &Layout) -> Option<u32> {
        if !self.free {
            return self.forms[0].targets.fewest_moves(layout, [0; 3]);
        }
        let here = bounds(layout);
        let fewest = |form: &Form| {
            let [xs, ys] = [0, 1].map(|i| here[i][0] - form.bounds[i][1]..=here[i][1] - form.bounds[i][0]);
            xs.flat_map(|x| ys.clone().map(move |y| [x, y, 0]))
                .filter_map(|offset| form.targets.fewest_moves(layout, offset))
                .min()
        };
        self.forms.iter().filter_map(fewest).min()
    }
}

impl Form {
    /// The goal turned by so many quarters about z; moved to the corner of
    /// the positive quadrant where the frame is free.
    fn new(layout: &Layout, listed: &[Bond], turn: usize, free: bool, reaches: &[Reach]) -> Self {
        let quarters = (0..turn).fold(Orientation::IDENTITY, |o, _| o.turned(Orientation::quarter_turn(Face::PosZ)));
        let rows = quarters.rows();
        let turned =
            |cell: Cell| -> Cell { std::array::from_fn(|i| (0..3).map(|j| i32::from(rows[i][j]) * cell[j]).sum()) };
        let turned_layout =
            Layout::new(layout.placed().iter().map(|p| Placed { cell: turned(p.cell), ..*p }).collect());
        let corner = bounds(&turned_layout).map(|[low, _]| -low);
        let offset = if free { [corner[0], corner[1], 0] } else { [0; 3] };
        let layout = turned_layout.displaced(offset);
        let bonds = listed.iter().map(|bond| {
            let cell = turned(bond.cells()[0]);
            Bond::new(cell, quarters.to_world(bond.face())).displaced(offset)
        });
        let targets = Targets::new(&layout, reaches.to_vec());
        let mut bonds: Vec<Bond> = bonds.collect();
        bonds.sort_unstable();
        Self { bonds, bounds: bounds(&layout), targets, layout }
    }
}

/// Lowest and highest coordinate along x and y.
fn bounds(layout: &Layout) -> [[i32; 2]; 2] {
    [0, 1].map(|axis| {
        let along = layout.placed().iter().map(|placed| placed.cell[axis]);
        along.fold([i32::MAX, i32::MIN], |[low, high], c| [low.min(c), high.max(c)])
    })
}

/// A displacement over the ground leaves a problem as it is only where nothing
/// stands on the ground or is bound to it, and gravity is vertical.
fn check_free_frame(start: &Configuration) -> Result<(), Refusal> {
    let because = if !start.environment.obstacles.is_empty() {
        "there are obstacles"
    } else if start.modules.iter().any(|module| module.fixed) {
        "some modules are fixed"
    } else if !start.require.stay.is_empty() {
        "some modules may not move"
    } else if !start.require.keep_out.is_empty() {
        "there are forbidden regions"
    } else if start.gravity.x != 0.0 || start.gravity.y != 0.0 {
        "gravity is not vertical"
    } else {
        return Ok(());
    };
    Err(Refusal::NoFreeFrame { because })
}

/// The class of each of the goal's modules.
///
/// A goal module in the cell of a fixed one *is* that one. A loaded module is recognised by
/// its id, since the goal's file does not repeat the loads.
fn goal_classes(
    start: &Configuration,
    class_of: &[u16],
    classes: &[Class],
    goal: &Goal,
) -> Result<Vec<u16>, Rejection> {
    for (index, loaded) in start.modules.iter().enumerate() {
        let is_placed = || goal.configuration.modules.iter().any(|module| module.id == loaded.id);
        if !loaded.fixed && !classes[usize::from(class_of[index])].loads.is_empty() && !is_placed() {
            return Err(Refusal::LoadedModuleMissing { module: loaded.id.clone() }.into());
        }
    }
    let mut counts = vec![0_usize; classes.len()];
    let mut wanted = Vec::with_capacity(goal.configuration.modules.len());
    for module in &goal.configuration.modules {
        let held = start.modules.iter().position(|m| m.fixed && m.placement.cell == module.placement.cell);
        let class = if let Some(held) = held {
            let same = start.modules[held].module_type == module.module_type
                && (!goal.matching.labelled || start.modules[held].id == module.id);
            if !same {
                return Err(Impossible::FixedModule { module: start.modules[held].id.clone() }.into());
            }
            Some(class_of[held])
        } else if module.fixed {
            return Err(Impossible::FixedModule { module: module.id.clone() }.into());
        } else {
            free_class(start, class_of, classes, goal, module)
        };
        let Some(class) = class else {
            return Err(differ(start, goal, module.module_type));
        };
        counts[usize::from(class)] += 1;
        wanted.push(class);
    }
    for (index, module) in start.modules.iter().enumerate() {
        let class = usize::from(class_of[index]);
        let present = class_of.iter().filter(|&&c| usize::from(c) == class).count();
        if counts[class] != present {
            if module.fixed {
                return Err(Impossible::FixedModule { module: module.id.clone() }.into());
            }
            let module_type = start.module_type(index).name.clone();
            return Err(Impossible::ModulesDiffer { module_type, start: present, goal: counts[class] }.into());
        }
    }
    for &stays in &start.require.stay {
        let cell = start.modules[stays].placement.cell;
        let mut there = goal.configuration.modules.iter().zip(&wanted).filter(|(m, _)| m.placement.cell == cell);
        if !there.any(|(_, &class)| class == class_of[stays]) {
            return Err(Impossible::FixedModule { module: start.modules[stays].id.clone() }.into());
        }
    }
    Ok(wanted)
}

/// The class of a module that the goal does not hold.
fn free_class(start: &Configuration, class_of: &[u16], classes: &[Class], goal: &Goal, module: &Module) -> Option<u16> {
    let namesake = start.modules.iter().position(|m| m.id == module.id && !m.fixed);
    let loads = namesake.map_or(&[][..], |m| &classes[usize::from(class_of[m])].loads);
    let fits = |class: &Class| {
        class.module_type == module.module_type
            && !class.fixed
            && class.loads == loads
            && (!goal.matching.labelled || class.label.as_deref() == Some(module.id.as_str()))
    };
    classes.iter().position(fits).and_then(|class| u16::try_from(class).ok())
}

/// That start and goal differ in how many modules of a type they have.
fn differ(start: &Configuration, goal: &Goal, module_type: usize) -> Rejection {
    let count = |c: &Configuration| c.modules.iter().filter(|m| m.module_type == module_type).count();
    Impossible::ModulesDiffer {
        module_type: start.catalogue.module_types[module_type].name.clone(),
        start: count(start),
        goal: count(&goal.configuration),
    }
    .into()
}
