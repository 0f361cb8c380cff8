//! How far a force can grow, block by block: one cone program each.
//!
//! The force passes through the blocks between its body and the ground; every other block is as
//! it was. The farthest force of a block comes from the program of the module's header, and
//! is proved here like any other field (see `bracket`).

use crate::spatial::Twist;

use super::super::attempts::ATTEMPTS;
use super::super::best::Best;
use super::super::blocks::{Block, Link, cut};
use super::super::bracket::Problem;
use super::super::conic::{self, Iterate};
use super::super::loads::{BodyLoad, lump, own_loads};
use super::super::program::{Program, Purpose};
use super::super::reductions::Reductions;
use super::super::rigid_links::Merged;
use super::super::solve_block::converged;
use super::super::structure::Structure;
use super::Start;
use super::line::Line;

/// How far one may go from the start, in N: proved from inside and from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub inner: f64,
    pub outer: f64,
    /// A force that means something to the structure.
    pub typical: f64,
}

/// Relative width of a reach that is narrow enough: a tenth of what users are told to expect.
pub(super) const NARROW: f64 = 1e-7;

/// Share of a typical force below which differences do not matter.
const NEGLIGIBLE: f64 = 1e-3;

impl Reach {
    /// What its width is measured by.
    pub(super) fn size(&self, start: &Start) -> f64 {
        let outer = if self.outer.is_finite() { self.outer } else { self.inner };
        outer.max(start.force.abs()).max(NEGLIGIBLE * self.typical)
    }

    pub(super) fn is_narrow(&self, start: &Start) -> bool {
        self.outer - self.inner <= NARROW * self.size(start)
    }
}

/// Inset with which a program is solved, see [`conic::Attempt`].
const INSET: f64 = 1e-8;

/// Rounds of measuring the force anew by what was found, and how far off makes it worth one.
const ROUNDS: usize = 3;
const FAR: f64 = 30.0;

/// Largest force, as a multiple of the typical one, at which a proof is tried.
const LARGEST: f64 = 1e9;

/// What rounding of a few operations may take from a bound.
const ROUNDED: f64 = 1e-14;

/// How far the force may grow from `start` in the direction of `sign` with utilisations of at
/// most `limit`.
pub(super) fn reach(line: &Line<'_>, start: &Start, sign: f64, limit: f64) -> Reach {
    let merged = |structure: Structure| Merged::new(&structure).map_or(structure, |merged| merged.structure);
    let (structure, alone) = (merged(line.at(start.force)), merged(line.alone(sign)));
    let pieces = cut(&structure);
    let base = lump(&structure, &pieces.blocks, own_loads(&structure));
    let unit = lump(&structure, &pieces.blocks, own_loads(&alone));
    let mut sum = Reach { inner: f64::INFINITY, outer: f64::INFINITY, typical: 0.0 };
    if pieces.afloat.iter().any(|&root| !unit[root].is_zero()) {
        // Nothing leads to the ground: one force alone keeps it in balance.
        return Reach { inner: 0.0, outer: 0.0, typical: base.iter().map(size).fold(0.0, f64::max) };
    }
    let mut scratch = [vec![BodyLoad::ZERO; unit.len()], vec![BodyLoad::ZERO; unit.len()]];
    for block in &pieces.blocks {
        if block.bodies.iter().all(|&body| unit[body].is_zero()) {
            continue;
        }
        let pushed = Pushed { structure: &structure, block, base: &base, unit: &unit, limit, start: start.utilisation };
        let found = pushed.reach(&mut scratch);
        sum.inner = sum.inner.min(found.inner);
        sum.outer = sum.outer.min(found.outer);
        sum.typical = sum.typical.max(found.typical);
    }
    sum
}

/// Size of a load's force.
fn size(load: &BodyLoad) -> f64 {
    load.force_size.norm()
}

/// A block that the force passes through.
struct Pushed<'a> {
    structure: &'a Structure,
    block: &'a Block,
    base: &'a [BodyLoad],
    /// Under the force of 1 N alone.
    unit: &'a [BodyLoad],
    limit: f64,
    /// What the block needs at most at the start.
    start: f64,
}

impl Pushed<'_> {
    fn reach(&self, scratch: &mut [Vec<BodyLoad>; 2]) -> Reach {
        let typical = self.typical();
        let mut found = Reach { inner: 0.0, outer: f64::INFINITY, typical };
        let mut force = typical;
        for round in 0..ROUNDS {
            let program = self.program(force, scratch);
            let mut next = None;
            let own = std::iter::once_with(|| converged(&program, INSET, Reductions::ALL).map(|(iterate, _)| iterate));
            for iterate in own.chain(ATTEMPTS.iter().map(|attempt| conic::solve(&program, attempt))).flatten() {
                self.keep_outer(&program, &program.twists(&iterate.v), &mut found);
                if !(iterate.t > force / (LARGEST * typical)) {
                    continue;
                }
                let farthest = force / iterate.t;
                self.keep_inner(&program, iterate, farthest, scratch, &mut found);
                next = next.or(Some(farthest));
                if found.outer - found.inner <= NARROW * found.outer.min(farthest) {
                    return found;
                }
            }
            let far_off = |next: f64| next > FAR * force || next * FAR < force;
            match next {
                Some(next) if round + 1 < ROUNDS && far_off(next) => force = next,
                _ => break,
            }
        }
        found
    }

    /// A force that means something to the block: what its weakest connection holds, or else what loads it.
    fn typical(&self) -> f64 {
        let strengths = self.block.links.iter().filter_map(|&link| match link {
            Link::Connection(i) => {
                let connector = self.structure.connections[i].connector;
                Some(self.structure.connectors[connector].strength * self.limit)
            }
            Link::Contact(_) => None,
        });
        let weakest = strengths.fold(f64::INFINITY, f64::min);
        let loads = self.block.bodies.iter().map(|&body| size(&self.base[body])).fold(0.0, f64::max);
        if weakest.is_finite() {
            weakest.max(loads)
        } else if loads > 0.0 {
            loads
        } else {
            1.0
        }
    }

    /// The program with the force measured by `force`.
    fn program(&self, force: f64, [loads, both]: &mut [Vec<BodyLoad>; 2]) -> Program {
        for &body in &self.block.bodies {
            loads[body] = self.unit[body].times(force);
            both[body] = self.base[body];
            both[body] += loads[body];
        }
        let cancelled = self.block.bodies.iter().all(|&body| both[body].is_zero());
        let typical = if cancelled { &*loads } else { &*both };
        Program::of_factor(self.structure, self.block, [self.base, loads, typical], self.limit)
    }

    /// Keeps what a motion proves to be too much.
    fn keep_outer(&self, program: &Program, twists: &[Twist], found: &mut Reach) {
        let problem = Problem { structure: self.structure, block: self.block, loads: self.base, program };
        let Some((dissipation, _)) = problem.dissipation(twists) else { return };
        let (helping, helping_error) = problem.power(self.base, twists);
        let (pushing, pushing_error) = problem.power(self.unit, twists);
        let pushing = pushing - pushing_error;
        let resisting = self.limit * dissipation * (1.0 + ROUNDED) - helping + helping_error;
        if pushing > 0.0 && resisting >= 0.0 {
            found.outer = found.outer.min(resisting / pushing * (1.0 + ROUNDED));
        }
    }

    /// Keeps the force up to which an iterate's wrenches prove that the block stands.
    fn keep_inner(
        &self,
        program: &Program,
        mut iterate: Iterate,
        force: f64,
        [loads, _]: &mut [Vec<BodyLoad>; 2],
        found: &mut Reach,
    ) {
        for &body in &self.block.bodies {
            loads[body] = self.base[body];
            loads[body] += self.unit[body].times(force);
        }
        if self.block.bodies.iter().all(|&body| loads[body].is_zero()) {
            found.inner = found.inner.max(force);
            return;
        }
        let there = Program::new(self.structure, self.block, loads, Purpose::Utilisation);
        for z in &mut iterate.z {
            *z /= iterate.t;
        }
        let iterate = Iterate { t: 1.0, ..iterate }.measured(program, &there);
        let problem = Problem { structure: self.structure, block: self.block, loads, program: &there };
        let mut best = Best::new(self.structure, self.block, 0.0, Reductions::ALL);
        best.prove(&problem, &iterate);
        if best.lower > 0.0 {
            self.keep_outer(&there, &best.mechanism, found);
        }
        found.inner = found.inner.max(interpolated(force, best.upper, self.start, self.limit));
    }
}

/// The force up to which a utilisation of at most `limit` is proved where it is at most `start`
/// at none and at most `there` at `force`, by convexity.
pub(super) fn interpolated(force: f64, there: f64, start: f64, limit: f64) -> f64 {
    if there <= limit {
        force
    } else if there.is_finite() && start < limit {
        force * ((limit - start) / (there - start)) * (1.0 - ROUNDED)
    } else {
        0.0
    }
}
