//! How a module is held while it slides along others: by all that it overlaps on one side, each with its share of the weight.
//!
//! What each of them holds by is as strong as its part of the face. So where every one carries that part of the weight, above
//! the middle of what it holds, no torque is left between them, and all are used as much as a whole face would be: half-way
//! between two modules, where [one alone](super::hanging) has half a face to hold by, nothing is lost.
//!
//! The others carry a mixture of what they would if the whole weight were on one of them at a time. The utilisation is convex in
//! the loads, so it is no larger than the largest of those: questions about one support at a time, as for a module that hangs on one.
//!
//! Knows the moving module and what it slides along; what the others carry is asked elsewhere.

use std::collections::HashMap;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex};

use crate::robot::{Cell, Configuration, Environment, Face, Module, Motion, Placement};
use crate::spatial::Vec3;
use crate::statics::{Bracket, Question, assess};

use super::assembly::{Assembler, Engagement, Moving, Transient};
use super::course::Course;
use super::hanging::Reach;
use super::layout::{Layout, displaced};
use super::moves::Move;
use super::problem::Problem;
use super::sampling;
use super::worst::{Instant, Worst, of_course};

/// Part of a face, of its whole, that holds nothing.
const NOTHING: f64 = 1e-9;

/// How far the parts may be from a whole face, by rounding.
const ROUNDING: f64 = 1e-9;

/// How a sliding module is held.
#[derive(Clone, Debug)]
pub struct Slide {
    /// Proved lower bound on the margin of what holds it, at all samples.
    pub margin: f64,
    /// Where its weight acts on which modules, from the cell that the move leaves.
    pub reaches: Vec<(Cell, Reach)>,
}

/// A move from the cell `[0, 0, 0]`, the class of its module, and the modules along its way with their types.
type Key = (Move, u16, Vec<(Cell, usize)>);

/// All slides that were met so far.
#[derive(Default)]
pub struct Slides {
    known: HashMap<Key, Option<Arc<Slide>>>,
}

/// One side that a module slides along, in some state.
struct Held {
    /// Utilisation of what it holds by.
    utilisation: f64,
    /// The modules that it overlaps, each with where its part of the weight acts, in W, in m.
    parts: Vec<(usize, Vec3)>,
}

impl Slides {
    /// How the module of a fitting move is held that slides over the others of `layout`. `None` for a turn, and where no
    /// side is covered all along.
    pub fn of(&mut self, problem: &Problem, layout: &Layout, class: u16, step: Move) -> Option<Arc<Slide>> {
        let Motion::Translation { .. } = step.motion else { return None };
        let back = step.from.map(|c| -c);
        let mut along: Vec<(Cell, usize)> = step
            .sides()
            .into_iter()
            .filter_map(|(cell, _)| {
                let holder = layout.placed()[layout.at(cell)?].class;
                Some((displaced(cell, back), problem.class(holder).module_type))
            })
            .collect();
        along.sort_unstable();
        along.dedup();
        let key = (Move { from: [0; 3], ..step }, class, along);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let slide = find(problem, &key).map(Arc::new);
        self.known.insert(key, slide.clone());
        slide
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        self.known.len() * (size_of::<Key>() + size_of::<Slide>() + 8 * size_of::<(Cell, Reach)>())
    }
}

fn find(problem: &Problem, (step, class, along): &Key) -> Option<Slide> {
    let own = problem.class(*class);
    if !own.loads.is_empty() {
        return None;
    }
    let types = std::iter::once(own.module_type).chain(along.iter().map(|(_, module_type)| *module_type));
    let start = problem.start();
    let few = Configuration {
        // The others do not give way, and what is between them carries nothing.
        modules: types.enumerate().map(|(index, module_type)| module(module_type, index > 0)).collect(),
        environment: Environment { module_friction: start.environment.module_friction, ..Environment::default() },
        connections: Vec::new(),
        loads: Vec::new(),
        ..start.clone()
    };
    let cells: Vec<Cell> = std::iter::once([0; 3]).chain(along.iter().map(|(cell, _)| *cell)).collect();
    let placements: Vec<Placement> = cells.iter().map(|&cell| Placement::new(cell)).collect();
    let course = Course::new(placements, &[], *step, few.pitch())?;
    let assembler = Assembler::new(&few);
    let reaches: Mutex<Vec<Option<Reach>>> = Mutex::new(vec![None; cells.len()]);
    let ask = |phase: f64| {
        let instant = Instant::Phase(phase);
        let Some(held) = best_side(&few, &assembler, &course.at(phase)) else {
            return Worst { margin: Bracket::exact(f64::NEG_INFINITY), instant, weakest: Some(()) };
        };
        let mut reaches = reaches.lock().expect("no thread panics while it adds");
        for (module, at) in held.parts {
            let reach = Reach::point(at);
            reaches[module] = Some(reaches[module].map_or(reach, |known| known.joined(reach)));
        }
        Worst { margin: Bracket::exact(1.0 - held.utilisation), instant, weakest: Some(()) }
    };
    let worst = of_course(sampling::of(*step), &ask, f64::NEG_INFINITY, &AtomicU64::new(0)).ok()?;
    let reaches = reaches.into_inner().expect("no thread panics while it adds");
    let reaches = cells.iter().zip(reaches).filter_map(|(&cell, reach)| Some((cell, reach?))).collect();
    Some(Slide { margin: worst.margin.lower, reaches })
}

fn module(module_type: usize, fixed: bool) -> Module {
    Module { id: String::new(), module_type, placement: Placement::new([0; 3]), fixed }
}

/// Of all sides on which modules cover the whole face of the first module, which is on its way, the one that it holds by best; of
/// equals the first.
fn best_side(few: &Configuration, assembler: &Assembler, state: &Transient) -> Option<Held> {
    let moving = state.moving?;
    let mut sides: Vec<Face> = state.engaged.iter().filter_map(|held| side(held, moving.module)).collect();
    sides.sort_unstable();
    sides.dedup();
    let held = sides.into_iter().filter_map(|face| held_on(face, few, assembler, (state, moving)));
    held.reduce(|best, next| if next.utilisation < best.utilisation { next } else { best })
}

/// The side of the moving module that an engagement is on.
fn side(held: &Engagement, moving: usize) -> Option<Face> {
    match *held {
        Engagement::Face { modules: [first, _], towards } if first == moving => Some(towards),
        Engagement::Face { towards, .. } => Some(towards.opposite()),
        Engagement::Hinge { .. } => None,
    }
}

/// How the module on its way holds on one side; `None` where that is not wholly covered.
fn held_on(
    face: Face,
    few: &Configuration,
    assembler: &Assembler,
    (state, moving): (&Transient, Moving),
) -> Option<Held> {
    let pitch = few.pitch();
    let engaged: Vec<Engagement> =
        state.engaged.iter().copied().filter(|held| side(held, moving.module) == Some(face)).collect();
    let mut parts = Vec::new();
    let (mut covered, mut utilisation) = (0.0, 0.0_f64);
    for held in engaged {
        let support = held.modules().into_iter().find(|&other| other != moving.module)?;
        // Where the module would be if this one covered its face, from where it is.
        let beneath = state.placements[support].pose(pitch).translation.vector - face.normal() * pitch;
        let off = beneath - moving.pose.translation.vector;
        let part: f64 = (0..3).map(|axis| (1.0 - off[axis].abs() / pitch).max(0.0)).product();
        if part <= NOTHING {
            continue;
        }
        let alone = Transient { placements: state.placements, moving: Some(moving), engaged: &[held] };
        let mut structure = assembler.assemble_alone(&alone).structure;
        // Nothing but this connection.
        structure.contacts.clear();
        let body = &mut structure.bodies[moving.module];
        body.mass *= part;
        body.com += off / 2.0;
        let at = body.com;
        utilisation = utilisation.max(assess(&structure, Question::VALUE).ok()?.utilisation.upper);
        covered += part;
        parts.push((support, at));
    }
    ((covered - 1.0_f64).abs() <= ROUNDING).then_some(Held { utilisation, parts })
}
