//! Several modules on their way at once: whether their ways are apart, what holds them, and their worst margin.

use std::sync::atomic::{AtomicU64, Ordering};

use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use crate::geometry::{Motion, Solid};
use crate::reconfigure::assembly::{Assembler, Engagement, Moment, Moving};
use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::replay::legality::Path;
use crate::robot::{Configuration, Placement};
use crate::spatial::{Pose, Vec3};
use crate::statics::{Bracket, Question, assess};

use super::Because;

/// Distance in cells between the samples of a translation before refinement, as the planner samples one.
const CELL_STEP: f64 = 1.0 / 8.0;

/// Around the worst sample, a translation is refined until samples are closer than this, in cells.
const CELL_RESOLUTION: f64 = 1.0 / 64.0;

/// Angle in degrees between the samples of a turn before refinement.
const TURN_STEP: f64 = 15.0;

/// Around the worst sample, a turn is refined until samples are closer than this, in degrees.
const TURN_RESOLUTION: f64 = 1.5;

/// Angle in degrees that one box around a turning module covers.
const BOX_DEGREES: f64 = 3.0;

/// Share of a module's size by which boxes may overlap and still count as apart: the rounding of their corners.
const ROUNDING: f64 = 1e-6;

/// A box along the world's axes: its lowest and its highest corner, in m.
type Room = [Vec3; 2];

/// Whether the ways of two modules are apart, whatever their phases. `false` is not sure.
pub fn are_apart(state: &Configuration, a: &Path, b: &Path) -> bool {
    let tolerance = ROUNDING * state.pitch();
    let rooms = [a, b].map(|path| rooms(state, path));
    rooms[0].iter().all(|[low, high]| {
        rooms[1].iter().all(|[other_low, other_high]| {
            let gap = (low - other_high).sup(&(other_low - high));
            gap.max() >= -tolerance
        })
    })
}

/// Boxes that between them hold a module all along its way.
fn rooms(state: &Configuration, path: &Path) -> Vec<Room> {
    let start = state.pose(path.module);
    let shape = &state.module_type(path.module).body().shape;
    let corners = |phase: f64| Solid::new(shape.clone(), path.motion.pose(&start, phase)).vertices();
    match &path.motion {
        Motion::Translation { .. } => vec![room(corners(0.0).into_iter().chain(corners(1.0)), 0.0)],
        Motion::Rotation { centre, axis, angle } => {
            let radius = corners(0.0).iter().map(|p| axis.cross(&(p - centre)).norm()).fold(0.0, f64::max);
            let parts = (angle.abs().to_degrees() / BOX_DEGREES).ceil().max(1.0);
            // Within half a part a corner goes no farther than its arc is long.
            let reach = radius * angle.abs() / parts / 2.0;
            (0..parts as u32).map(|part| room(corners((f64::from(part) + 0.5) / parts).into_iter(), reach)).collect()
        }
    }
}

/// The box around points, larger by `reach` all round.
fn room(points: impl Iterator<Item = Vec3>, reach: f64) -> Room {
    let [low, high] = points.fold([Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)], |[low, high], p| {
        [low.inf(&p), high.sup(&p)]
    });
    [low.add_scalar(-reach), high.add_scalar(reach)]
}

/// What holds the robot together while these modules move; [`Because::HoldsTheOther`] where one would move along
/// another that moves as well.
pub fn engaged(state: &Configuration, paths: &[Path]) -> Result<Vec<Engagement>, Because> {
    let is_moving = |module: &usize| paths.iter().any(|path| path.module == *module);
    let resting = state.connections.iter().filter(|connection| !connection.modules().iter().any(is_moving));
    let mut engaged: Vec<Engagement> = resting.map(|connection| Engagement::face(state, connection)).collect();
    for path in paths {
        for held in path.engaged.iter().filter(|held| held.modules().contains(&path.module)) {
            if held.modules().iter().all(is_moving) {
                return Err(Because::HoldsTheOther);
            }
            engaged.push(*held);
        }
    }
    Ok(engaged)
}

/// A sample: the phase of each move, and the margin there.
type Sample = (Vec<f64>, Bracket);

/// Asks the oracle about states in which modules move at once.
pub struct Ways<'a> {
    /// From states to structures.
    pub assembler: Assembler<'a>,
    /// Margin that every state must have.
    pub least: f64,
    /// Structures that the oracle has assessed.
    pub solves: AtomicU64,
}

impl Ways<'_> {
    /// The worst margin while modules move along these paths out of a state, each at any phase; at rest without
    /// any. `Err` with what is wrong first.
    ///
    /// # Errors
    /// What the oracle refuses.
    pub fn worst(&self, state: &Configuration, paths: &[Path]) -> Result<Result<Bracket, Because>, Refusal> {
        let engaged = match engaged(state, paths) {
            Ok(engaged) => engaged,
            Err(because) => return Ok(Err(because)),
        };
        let placements: Vec<Placement> = state.modules.iter().map(|module| module.placement).collect();
        let starts: Vec<Pose> = paths.iter().map(|path| state.pose(path.module)).collect();
        let ask = |phases: &[f64]| {
            let moving = paths
                .iter()
                .zip(&starts)
                .zip(phases)
                .map(|((path, start), &phase)| Moving { module: path.module, pose: path.motion.pose(start, phase) });
            let moving: Vec<Moving> = moving.collect();
            self.margin(state, &Moment { placements: &placements, moving: &moving, engaged: &engaged })
        };
        let samplings: Vec<Sampling> = paths.iter().map(|path| Sampling::of(path, state.pitch())).collect();
        let mut samples: Vec<Sample> = Vec::new();
        let mut next = grid(&samplings);
        while !next.is_empty() {
            for together in next.chunks(4 * rayon::current_num_threads().max(1)) {
                let asked: Vec<_> = together.par_iter().map(|phases| ask(phases)).collect();
                for (phases, answer) in together.iter().zip(asked) {
                    match answer? {
                        Err(because) => return Ok(Err(because)),
                        Ok(margin) => samples.push((phases.clone(), margin)),
                    }
                }
            }
            next = refined(&samplings, &samples);
        }
        Ok(Ok(samples.iter().map(|(_, margin)| *margin).reduce(Bracket::min).expect("a grid has samples")))
    }

    fn margin(&self, state: &Configuration, moment: &Moment) -> Result<Result<Bracket, Because>, Refusal> {
        let assembly = self.assembler.assemble_moment(moment);
        if state.require.connected {
            let mut components = UnionFind::<usize>::new(state.modules.len());
            let held = assembly.connections.iter().map(|&i| moment.engaged[i].modules());
            let joined = held.filter(|&[a, b]| components.union(a, b)).count();
            if joined + 1 < state.modules.len() {
                return Ok(Err(Because::Disconnected));
            }
        }
        self.solves.fetch_add(1, Ordering::Relaxed);
        let margin = assess(&assembly.structure, Question::VALUE).map_err(Refusal::Structure)?.margin();
        Ok(if margin.lower >= self.least { Ok(margin) } else { Err(Because::Unstable) })
    }
}

/// How a way is sampled.
#[derive(Clone, Copy, Debug)]
struct Sampling {
    /// Equal steps before refinement.
    steps: u32,
    /// The distance in phase down to which the worst sample is refined.
    resolution: f64,
}

impl Sampling {
    fn of(path: &Path, pitch: f64) -> Self {
        let (length, step, resolution) = match &path.motion {
            Motion::Translation { by } => (by.norm() / pitch, CELL_STEP, CELL_RESOLUTION),
            Motion::Rotation { angle, .. } => (angle.abs().to_degrees(), TURN_STEP, TURN_RESOLUTION),
        };
        Self { steps: (length / step).round().max(1.0) as u32, resolution: resolution / length }
    }
}

/// The product of the phases of all paths before refinement.
fn grid(samplings: &[Sampling]) -> Vec<Vec<f64>> {
    samplings.iter().fold(vec![Vec::new()], |grid, &Sampling { steps, .. }| {
        let extended = |phases: &Vec<f64>| -> Vec<Vec<f64>> {
            let phase = |i: u32| phases.iter().copied().chain([f64::from(i) / f64::from(steps)]).collect();
            (0..=steps).map(phase).collect()
        };
        grid.iter().flat_map(extended).collect()
    })
}

/// What to ask next around the worst sample: half-way to the next samples along the phase of each path, where
/// those are farther than the resolution.
fn refined(samplings: &[Sampling], samples: &[Sample]) -> Vec<Vec<f64>> {
    let worst = samples.iter().min_by(|a, b| a.1.lower.total_cmp(&b.1.lower));
    let Some((worst, _)) = worst else { return Vec::new() };
    let mut next = Vec::new();
    for (along, &Sampling { resolution, .. }) in samplings.iter().enumerate() {
        let in_line = samples
            .iter()
            .map(|(phases, _)| phases)
            .filter(|phases| phases.iter().zip(worst).enumerate().all(|(i, (a, b))| i == along || a == b));
        let at = |phases: &Vec<f64>| phases[along];
        let here = worst[along];
        let below = in_line.clone().map(at).filter(|&phase| phase < here).fold(f64::NEG_INFINITY, f64::max);
        let above = in_line.map(at).filter(|&phase| phase > here).fold(f64::INFINITY, f64::min);
        for other in [below, above] {
            if other.is_finite() && (other - here).abs() >= resolution {
                let mut middle = worst.clone();
                middle[along] = f64::midpoint(here, other);
                next.push(middle);
            }
        }
    }
    next
}
