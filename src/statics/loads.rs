//! What every body has to hold: its own weight and loads, and what hangs from it.

use crate::spatial::{Vec3, Wrench};

use super::blocks::{Block, Vertex};
use super::demand::WrenchError;
use super::structure::Structure;
use super::tolerances::ROUNDING;

/// A load wrench on a body about its centre of mass, in W, with the sizes of
/// the terms that went into it, and a bound on the rounding errors in it.
///
/// The bound follows the sums as they are formed (running error analysis, Higham
/// 2002, section 3.3): along a chain of 100 000 modules it stays four orders below
/// what the number of terms and their sizes would allow.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyLoad {
    pub wrench: Wrench,
    /// Per component, the sum of the magnitudes of all its terms, in N.
    pub force_size: Vec3,
    /// Per component, the sum of the magnitudes of all its terms, in N m.
    pub torque_size: Vec3,
    /// What rounding took from the force and is known: forces add up exactly, or
    /// their errors would turn into torques along the whole chain.
    rest: Vec3,
    /// Bound on the other rounding errors so far.
    rounding: WrenchError,
}

impl BodyLoad {
    pub(super) const ZERO: Self = Self {
        wrench: Wrench::ZERO,
        rest: Vec3::new(0.0, 0.0, 0.0),
        force_size: Vec3::new(0.0, 0.0, 0.0),
        torque_size: Vec3::new(0.0, 0.0, 0.0),
        rounding: WrenchError { force: Vec3::new(0.0, 0.0, 0.0), torque: Vec3::new(0.0, 0.0, 0.0) },
    };

    /// Adds a force and torque that act at `lever` from the centre of mass.
    pub(super) fn add(&mut self, force: &Vec3, torque: &Vec3, lever: &Vec3) {
        let mut term = Self { wrench: Wrench::new(*force, *torque), ..Self::ZERO };
        (term.force_size, term.torque_size) = (force.abs(), torque.abs());
        // A weight is a product itself.
        term.rounding.force = force.abs() * f64::EPSILON;
        *self += term.moved(lever);
    }

    /// A weight, the product of mass and gravity.
    fn weight(force: Vec3) -> Self {
        let mut load = Self { force_size: force.abs(), ..Self::ZERO };
        load.wrench.force = force;
        load.rounding.force = load.force_size * f64::EPSILON;
        load
    }

    /// The same load about a point that `lever` leads from.
    #[inline(always)]
    pub(super) fn moved(&self, lever: &Vec3) -> Self {
        let wrench = self.wrench.moved(lever);
        let products = cross_size(lever, &self.wrench.force.abs()) * 2.0 + wrench.torque.abs();
        let carried = self.rounding.torque + cross_size(lever, &(self.rounding.force + self.rest.abs()));
        Self {
            wrench,
            torque_size: self.torque_size + cross_size(lever, &self.force_size),
            rounding: WrenchError { torque: carried + products * f64::EPSILON, ..self.rounding },
            ..*self
        }
    }

    /// `factor` times the same load.
    pub(super) fn times(&self, factor: f64) -> Self {
        let size = factor.abs();
        let WrenchError { force, torque } = self.rounding;
        Self {
            wrench: self.wrench * factor,
            force_size: self.force_size * size,
            torque_size: self.torque_size * size,
            rest: self.rest * factor,
            // Each product is rounded once.
            rounding: WrenchError {
                force: (force + self.wrench.force.abs() * f64::EPSILON) * size,
                torque: (torque + self.wrench.torque.abs() * f64::EPSILON) * size,
            },
        }
    }

    /// Whether there is nothing to hold.
    pub(super) fn is_zero(&self) -> bool {
        self.wrench == Wrench::ZERO
    }

    /// Bound on the error of each component, a turn into another frame included.
    pub(super) fn error(&self) -> WrenchError {
        let (force, torque) = (self.wrench.force.abs() * ROUNDING, self.wrench.torque.abs() * ROUNDING);
        WrenchError { force: self.rounding.force + self.rest.abs() + force, torque: self.rounding.torque + torque }
    }
}

impl std::ops::AddAssign for BodyLoad {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        let (before, other_force) = (self.wrench.force, other.wrench.force);
        self.wrench += other.wrench;
        self.rest += other.rest + lost(&before, &other_force, &self.wrench.force);
        let force = self.wrench.force;
        self.wrench.force += self.rest;
        self.rest = lost(&force, &self.rest, &self.wrench.force);
        self.force_size += other.force_size;
        self.torque_size += other.torque_size;
        self.rounding.force += other.rounding.force + self.wrench.force.abs() * (f64::EPSILON * f64::EPSILON * 4.0);
        self.rounding.torque += other.rounding.torque + self.wrench.torque.abs() * f64::EPSILON;
    }
}

/// What the rounded `sum` of `a` and `b` lacks, exactly (Knuth's two-sum).
fn lost(a: &Vec3, b: &Vec3, sum: &Vec3) -> Vec3 {
    let part = sum - a;
    (a - (sum - part)) + (b - part)
}

/// Per component, the size of the products in `lever x force`.
pub(super) fn cross_size(lever: &Vec3, force_size: &Vec3) -> Vec3 {
    let (r, f) = (lever.abs(), force_size);
    Vec3::new(r.y * f.z + r.z * f.y, r.z * f.x + r.x * f.z, r.x * f.y + r.y * f.x)
}

/// Gravity and external loads on every body, about its centre of mass.
pub(super) fn own_loads(structure: &Structure) -> Vec<BodyLoad> {
    let weigh = |mass: f64| BodyLoad::weight(structure.gravity * mass);
    let mut loads: Vec<BodyLoad> = structure.bodies.iter().map(|body| weigh(body.mass)).collect();
    for load in &structure.loads {
        let com = structure.bodies[load.body].com;
        let lever = load.at.map_or_else(Vec3::zeros, |at| at - com);
        loads[load.body].add(&load.force, &load.torque, &lever);
    }
    loads
}

/// Blocks whose roots are fetched at a time.
const TOGETHER: usize = 32;

/// Adds to every body what hangs from it through the blocks it is root of.
/// `blocks` come root first, so the last ones are lumped first.
pub(super) fn lump(structure: &Structure, blocks: &[Block], mut loads: Vec<BodyLoad>) -> Vec<BodyLoad> {
    for some in blocks.rchunks(TOGETHER) {
        fetch(structure, some, &loads);
        for block in some.iter().rev() {
            if let Vertex::Body(root) = block.root {
                let com = structure.bodies[root].com;
                let passed_on = |body: usize| loads[body].moved(&(structure.bodies[body].com - com));
                let (first, others) = block.bodies.split_first().expect("a block has a body");
                let mut total = passed_on(*first);
                for &body in others {
                    total += passed_on(body);
                }
                loads[root] += total;
            }
        }
    }
    loads
}

/// Looks at the roots of `blocks`. Those of a large structure lie anywhere in memory, which
/// answers many requests in about the time of one, but only where they come close together.
fn fetch(structure: &Structure, blocks: &[Block], loads: &[BodyLoad]) {
    for block in blocks {
        if let Vertex::Body(root) = block.root {
            let (load, com) = (&loads[root], &structure.bodies[root].com);
            // One number of every 64 bytes.
            let looked_at = load.wrench.force.x + load.force_size.y + load.rest.z + load.rounding.torque.z;
            std::hint::black_box(looked_at + com.sum());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forces of whole newtons at levers of whole metres are exact; with both in
    /// tenths the same sums differ from them by rounding alone.
    #[test]
    fn rounding_stays_within_its_bound() {
        let (tenth, count) = (0.1_f64, 2000);
        let (mut exact, mut rounded) = (BodyLoad::ZERO, BodyLoad::ZERO);
        for i in 0..count {
            let part = |seed: i32| Vec3::from_fn(|k, _| f64::from((seed * (7 + 4 * k as i32)) % 11 - 5));
            let (force, torque, lever) = (part(i), part(i * i + 3), part(i + 5));
            exact.add(&force, &torque, &lever);
            rounded.add(&(force * tenth), &(torque * (tenth * tenth)), &(lever * tenth));
            exact = exact.moved(&lever);
            rounded = rounded.moved(&(lever * tenth));
        }
        // Tenths are not exact themselves: twice the input's rounding, in every term.
        let input = 4.0 * f64::EPSILON;
        let force_off = (rounded.wrench.force - exact.wrench.force * tenth).abs();
        let torque_off = (rounded.wrench.torque - exact.wrench.torque * (tenth * tenth)).abs();
        let error = rounded.error();
        for k in 0..3 {
            assert!(force_off[k] <= error.force[k] + input * rounded.force_size[k]);
            assert!(torque_off[k] <= error.torque[k] + input * rounded.torque_size[k]);
            // Errors grow with the sums, which partly cancel; sizes and their number with
            // all terms: at most a five-hundredth of what those would allow.
            assert!(error.torque[k] <= 2e-3 * f64::from(count) * f64::EPSILON * rounded.torque_size[k]);
        }
    }
}
