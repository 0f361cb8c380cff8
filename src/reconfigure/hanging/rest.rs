//! What the modules that stay where they are carry.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use rayon::prelude::*;

use crate::reconfigure::assembly::{Assembler, Engagement, Transient};
use crate::robot::{Configuration, Placement};
use crate::spatial::Vec3;
use crate::statics::{Anchor, Assessment, Load, Memory, Question, Structure, Tally, assess_keeping, assess_near};

/// Steps to the edge of a cell that places of a weight are told apart by, so that walks have many in common.
const GRID: f64 = 4.0;

/// What places may be off by rounding, in steps.
const ROUNDING: f64 = 1e-10;

/// By support and place, counted from it in steps.
type Place = (usize, [i32; 3]);

/// Where a module's weight may act on another: a box in W, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Its lowest corner.
    pub low: Vec3,
    /// Its highest corner.
    pub high: Vec3,
}

impl Reach {
    /// One point.
    pub const fn point(at: Vec3) -> Self {
        Self { low: at, high: at }
    }

    /// The smallest box around two.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The box moved.
    #[must_use]
    pub fn moved(self, by: &Vec3) -> Self {
        Self { low: self.low + by, high: self.high + by }
    }

    /// The corners of the box, widened to a grid about `centre` of [`GRID`] to the edge of a cell, each once and counted
    /// in steps of it. All have the same place along a vertical axis, which changes no torque.
    fn corners(self, vertical: Option<usize>, centre: &Vec3, pitch: f64) -> Vec<[i32; 3]> {
        let mut corners = vec![[0; 3]];
        for axis in (0..3).filter(|&axis| vertical != Some(axis)) {
            let place = |end: f64| (end - centre[axis]) / pitch * GRID;
            let low = (place(self.low[axis]) + ROUNDING).floor() as i32;
            let high = (place(self.high[axis]) - ROUNDING).ceil() as i32;
            let ends = if low >= high { vec![low] } else { vec![low, high] };
            let with = |corner: [i32; 3]| {
                ends.iter().map(move |&end| std::array::from_fn(|i| if i == axis { end } else { corner[i] }))
            };
            corners = corners.iter().copied().flat_map(|corner| with(corner).collect::<Vec<_>>()).collect();
        }
        corners
    }
}

/// All modules of a robot but one, with the weight of that one.
#[derive(Debug)]
pub struct Rest {
    structure: Structure,
    weight: Vec3,
    /// Whether all that this rest can be loaded with is known here.
    is_plain: bool,
    /// What the next state can use, and whether it is of this very structure.
    memory: Option<Memory>,
    is_settled: bool,
    /// By support and place of the weight, the utilisation that was proved and the level it was asked for.
    known: HashMap<Place, (f64, f64)>,
}

/// Makes and asks rests of one robot, each by what is known of those before it.
#[derive(Debug)]
pub struct Rests<'a> {
    configuration: &'a Configuration,
    assembler: Assembler<'a>,
    memory: Option<Memory>,
    solves: Arc<AtomicU64>,
    tally: Mutex<Tally>,
}

impl<'a> Rests<'a> {
    /// Of the modules of `configuration`, in its environment and under its loads.
    pub fn new(configuration: &'a Configuration) -> Self {
        Self {
            configuration,
            assembler: Assembler::new(configuration),
            memory: None,
            solves: Arc::default(),
            tally: Mutex::default(),
        }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }

    /// What it took to assess those since this was last asked.
    pub fn take_tally(&mut self) -> Tally {
        std::mem::take(self.tally.get_mut().expect("no thread panics while it counts"))
    }

    /// Where they are counted, also while someone asks.
    pub fn counter(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.solves)
    }

    /// All modules but `module`, held together by `engaged`, of which those of `module` play no part.
    pub fn without(&self, module: usize, placements: &[Placement], engaged: &[Engagement]) -> Rest {
        Rest::new(self.configuration, &self.assembler, (module, placements, engaged), self.memory.clone())
    }

    /// Proved upper bound on the utilisation of `rest` with the module's weight on `support`, wherever in `reach` it
    /// acts. Asks no more than whether that is at most `level`; infinite where that was not proved.
    pub fn utilisation(&mut self, rest: &mut Rest, support: usize, reach: Reach, level: f64) -> f64 {
        if !rest.is_plain {
            return f64::INFINITY;
        }
        let gravity = self.configuration.gravity;
        let vertical = (0..3).find(|&axis| (0..3).all(|other| other == axis || gravity[other] == 0.0));
        let pitch = self.configuration.pitch();
        let corners = reach.corners(vertical, &rest.structure.bodies[support].com, pitch);
        let key = |corner: &[i32; 3]| (support, *corner);
        let is_open = |corner: &[i32; 3]| match rest.known.get(&key(corner)) {
            Some(&(found, asked)) => !(found <= level || asked >= level),
            None => true,
        };
        let mut open: Vec<[i32; 3]> = corners.iter().copied().filter(is_open).collect();
        if !rest.is_settled && !open.is_empty() {
            let corner = open.remove(0);
            let asked = self.ask(rest, support, &corner, level);
            let found = asked.as_ref().map_or(f64::INFINITY, |(found, _)| *found);
            rest.known.insert(key(&corner), (found, level));
            if let Some((_, memory)) = asked {
                self.memory = Some(memory.clone());
                rest.memory = Some(memory);
                rest.is_settled = true;
            }
            if !(found <= level) {
                return f64::INFINITY;
            }
        }
        let asked: Vec<(f64, f64)> = open
            .par_iter()
            .map(|corner| (self.ask(rest, support, corner, level).map_or(f64::INFINITY, |(found, _)| found), level))
            .collect();
        rest.known.extend(open.iter().map(key).zip(asked));
        let most = corners.iter().map(|corner| rest.known[&key(corner)].0).fold(0.0, f64::max);
        if most <= level { most } else { f64::INFINITY }
    }

    fn ask(&self, rest: &Rest, support: usize, corner: &[i32; 3], level: f64) -> Option<(f64, Memory)> {
        let off_centre = Vec3::from(corner.map(f64::from)) * (self.configuration.pitch() / GRID);
        let at = Some(rest.structure.bodies[support].com + off_centre);
        let load = Load { body: support, force: rest.weight, torque: Vec3::zeros(), at };
        self.solves.fetch_add(1, Ordering::Relaxed);
        let (found, memory) = rest.ask(&[load], level)?;
        self.tally.lock().expect("no thread panics while it counts").count(&found);
        Some((found.utilisation.upper, memory))
    }
}

impl Rest {
    /// All modules of a robot but one, held together by engagements of which those of this one play no part. `memory` is what
    /// a state of the robot before left.
    pub fn new(
        configuration: &Configuration,
        assembler: &Assembler,
        (module, placements, engaged): (usize, &[Placement], &[Engagement]),
        memory: Option<Memory>,
    ) -> Self {
        let others: Vec<Engagement> =
            engaged.iter().copied().filter(|engagement| !engagement.modules().contains(&module)).collect();
        let state = Transient { placements, moving: None, engaged: &others };
        let mut structure = assembler.assemble(&state).structure;
        // Nothing touches it, so that it needs no balance.
        let gone = Anchor::Body(module);
        structure.contacts.retain(|contact| contact.body != module && contact.against != gone);
        structure.loads.retain(|load| load.body != module);
        structure.bodies[module].fixed = true;
        let weight = configuration.module_type(module).body().mass * configuration.gravity;
        let is_plain = configuration.loads.iter().all(|load| load.module != module);
        Self { structure, weight, is_plain, memory, is_settled: false, known: HashMap::new() }
    }

    /// Proved upper bound on the utilisation under further loads, with none of the module's weight. Asks no more than
    /// whether that is at most `level`; infinite where that was not proved. What was asked is counted.
    pub fn under(&mut self, loads: &[Load], level: f64, tally: &mut Tally) -> f64 {
        // Unsound structures are found by whoever asks about the whole robot.
        let Some((found, memory)) = self.ask(loads, level) else { return f64::INFINITY };
        tally.count(&found);
        if !self.is_settled {
            (self.memory, self.is_settled) = (Some(memory), true);
        }
        if found.utilisation.upper <= level { found.utilisation.upper } else { f64::INFINITY }
    }

    /// What the next state can use, once something was asked.
    pub fn memory(&self) -> Option<&Memory> {
        self.memory.as_ref()
    }

    fn ask(&self, loads: &[Load], level: f64) -> Option<(Assessment, Memory)> {
        let mut structure = self.structure.clone();
        structure.loads.extend_from_slice(loads);
        let question = Question::Decide(level);
        let same: Vec<Option<usize>> = (0..structure.bodies.len()).map(Some).collect();
        match &self.memory {
            Some(memory) => assess_near(&structure, question, memory, &same).ok(),
            None => assess_keeping(&structure, question).ok(),
        }
    }
}
