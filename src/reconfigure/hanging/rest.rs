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

/// Questions about one rest that are asked at the same time. The same for any number of threads, since all that
/// were asked are known afterwards.
const AT_ONCE: usize = 8;

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

    /// Proved upper bounds on the utilisation of `rest` with the module's weight on one support after another, each
    /// wherever in its reach it acts. Asks no more than whether that is at most `level`.
    ///
    /// # Errors
    /// The place of the first of the supports of which that was not proved.
    pub fn utilisations(
        &mut self,
        rest: &mut Rest,
        supports: &[(usize, Reach)],
        level: f64,
    ) -> Result<Vec<f64>, usize> {
        if !rest.is_plain {
            return Err(0);
        }
        let gravity = self.configuration.gravity;
        let vertical = (0..3).find(|&axis| (0..3).all(|other| other == axis || gravity[other] == 0.0));
        let pitch = self.configuration.pitch();
        let places = |&(support, reach): &(usize, Reach)| -> Vec<Place> {
            let corners = reach.corners(vertical, &rest.structure.bodies[support].com, pitch);
            corners.into_iter().map(|corner| (support, corner)).collect()
        };
        let places: Vec<Vec<Place>> = supports.iter().map(places).collect();
        let mut open: Vec<Place> = Vec::new();
        for place in places.iter().flatten() {
            let is_open = rest.known.get(place).is_none_or(|&(found, asked)| !(found <= level || asked >= level));
            if is_open && !open.contains(place) {
                open.push(*place);
            }
        }
        let mut open = &open[..];
        while let Some(first) = open.first() {
            // The first answer is what all others begin from.
            let at_once = if rest.is_settled { AT_ONCE.min(open.len()) } else { 1 };
            let (now, later) = open.split_at(at_once);
            if rest.is_settled {
                let ask = |place: &Place| self.ask(rest, place, level).map_or(f64::INFINITY, |(found, _)| found);
                let found: Vec<f64> = now.par_iter().map(ask).collect();
                rest.known.extend(now.iter().copied().zip(found.into_iter().map(|found| (found, level))));
            } else {
                let asked = self.ask(rest, first, level);
                let found = asked.as_ref().map_or(f64::INFINITY, |(found, _)| *found);
                rest.known.insert(*first, (found, level));
                if let Some((_, memory)) = asked {
                    rest.is_settled = rest.memory.is_some();
                    self.memory = Some(memory.clone());
                    rest.memory = Some(memory);
                }
            }
            if now.iter().any(|place| !(rest.known[place].0 <= level)) {
                break;
            }
            open = later;
        }
        let most = |places: &Vec<Place>| {
            let found = places.iter().map(|place| rest.known.get(place).map_or(f64::INFINITY, |known| known.0));
            found.fold(0.0, f64::max)
        };
        let most: Vec<f64> = places.iter().map(most).collect();
        match most.iter().position(|&most| !(most <= level)) {
            Some(place) => Err(place),
            None => Ok(most),
        }
    }

    fn ask(&self, rest: &Rest, &(support, corner): &Place, level: f64) -> Option<(f64, Memory)> {
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
