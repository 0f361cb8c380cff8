//! The Newton directions of a system: to the boundary, to the central path, and bent
//! towards it.
//!
//! Each finds what the elements' forces lack for balance and moves the bodies so that
//! they balance. Knows one factorisation, not how far to go.

use super::super::element::Rows;
use super::super::families::each;
use super::super::normal::Solution;
use super::{System, Tie, work};

/// Imbalance of a step, as a share of the complementarity that is aimed at, or of the whole gap
/// that is left if less is aimed at, above which it is corrected: below, it would change nothing.
const REFINE: f64 = 1e-3;

/// Rounds of correction, and the share of the imbalance that each must leave at most.
const REFINEMENTS: usize = 4;
const HELPS: f64 = 0.5;

/// How much longer a step is wished for when it is bent.
const FURTHER: f64 = 0.3;

impl<const D: usize> System<D> {
    /// The Newton direction to the boundary, as if nothing were in the way.
    pub(in super::super) fn predict(&mut self) {
        let mut rows = self.unbalanced();
        each!(self.families, iter_mut, element => element.predict(&mut rows));
        self.t.predict(&mut []);
        self.complete(rows, f64::INFINITY);
    }

    /// The Newton direction to complementarity `mu`, after [`predict`](Self::predict). A gap of
    /// about `left` will be left in any case.
    pub(in super::super) fn correct(&mut self, mu: f64, left: f64) {
        let mut rows = self.unbalanced();
        each!(self.families, iter_mut, element => element.correct(mu, &mut rows));
        self.t.correct(mu, &mut []);
        self.complete(rows, REFINE * mu.max(left));
    }

    /// Bends the step towards the central path of complementarity `mu`, where it would leave
    /// it if it were somewhat longer than `reach`, as far as that makes it longer
    /// (Gondzio 1996). The largest steps afterwards; `left` as in [`correct`](Self::correct).
    pub(in super::super) fn centre(&mut self, reach: [f64; 2], mu: f64, left: f64, shorten: f64) -> [f64; 2] {
        let wanted = reach.map(|step| (step + FURTHER).min(1.0));
        let dv = self.dv.clone();
        let changes: Vec<f64> = self.ties.iter().map(|tie| tie.change).collect();
        let mut rows = self.unbalanced();
        each!(self.families, iter_mut, element => element.centre(wanted, mu, &mut rows));
        self.t.centre(wanted, mu, &mut []);
        self.complete(rows, REFINE * mu.max(left));
        let bent = self.reach(shorten);
        if bent[0].min(bent[1]) > reach[0].min(reach[1]) {
            return bent;
        }
        each!(self.families, iter_mut, element => element.straighten());
        self.t.straighten();
        self.dv = dv;
        for (tie, change) in self.ties.iter_mut().zip(changes) {
            tie.change = change;
        }
        reach
    }

    fn unbalanced(&self) -> Vec<Rows<D>> {
        self.lacking.iter().map(|lacking| lacking.map(|value| -value)).collect()
    }

    /// Moves the bodies so that the forces of the step, `rows` without t's, balance, and
    /// again while more than `accuracy` is left and that helps.
    fn complete(&mut self, rows: Vec<Rows<D>>, accuracy: f64) {
        self.dv.fill([0.0; D]);
        for tie in &mut self.ties {
            tie.change = 0.0;
        }
        let mut rows = self.move_bodies(&rows);
        let mut before = f64::INFINITY;
        for _ in 0..if accuracy < f64::INFINITY { REFINEMENTS } else { 0 } {
            let left = self.left(&rows);
            if left <= accuracy || !(left <= HELPS * before) {
                return;
            }
            before = left;
            rows = self.move_bodies(&rows);
        }
    }

    /// Largest imbalance of the step, of which `rows` is without t's force.
    fn left(&self, rows: &[Rows<D>]) -> f64 {
        let t = self.t.dx[0];
        let balances = rows.as_flattened().iter().zip(self.preload.as_flattened());
        let balances = balances.map(|(row, preload)| (row + preload * t).abs());
        self.ties.iter().map(|tie| self.tie_force(tie).abs()).chain(balances).fold(0.0, f64::max)
    }

    /// What the step's forces amount to on a tie row, beyond what it lacked.
    fn tie_force(&self, tie: &Tie) -> f64 {
        let [p, q] = tie.pair.map(|index| self.families.one.elements[index].dx[0]);
        p + q + tie.preload * self.t.dx[0] - tie.lacking
    }

    /// Adds the motion that the forces `rows`, without t's, give to the bodies. The forces of the
    /// step, without t's, afterwards.
    fn move_bodies(&mut self, rows: &[Rows<D>]) -> Vec<Rows<D>> {
        let t = self.t.dx[0];
        let mut rows: Vec<Rows<D>> =
            rows.iter().zip(&self.preload).map(|(row, a)| std::array::from_fn(|k| row[k] + a[k] * t)).collect();
        let mut along = 0.0;
        for index in 0..self.ties.len() {
            let wanted = self.tie_force(&self.ties[index]);
            let tie = &mut self.ties[index];
            tie.wanted = wanted;
            tie.resting = self.families.one.elements[tie.pair[0]].dx[0];
            along += tie.preload * wanted / tie.weight;
            self.families.one.elements[tie.pair[0]].push(&[-tie.share * wanted], &mut rows);
        }
        let Solution { v, strength, carried } = self.normal.solve(rows.as_flattened(), along);
        let v = v.as_chunks::<D>().0;
        let single = &mut self.families.one.elements;
        let mut opening = work(&self.preload, v);
        for tie in &mut self.ties {
            let [one, other] = tie.pair;
            single[one].tied = 0.0;
            let left = tie.wanted - tie.preload * strength;
            let change = left / tie.weight - tie.share * single[one].pull(v)[0];
            opening += tie.preload * change;
            tie.change += change;
            (single[one].tied, single[other].tied) = (change, change);
        }
        let mut forces: Vec<Rows<D>> = self.lacking.iter().map(|lacking| lacking.map(|value| -value)).collect();
        each!(self.families, iter_mut, element => {
            element.follow(v);
            if !element.in_chain {
                element.push(&element.dx, &mut forces);
            }
        });
        // Forces of chains and of t are known better than their motion tells.
        self.t.ds[0] += opening;
        self.t.dx[0] -= strength;
        for (link, wrench) in carried {
            let chain = &self.in_chains[self.chained[link].expect("a link in a chain")];
            if let Some((index, axes)) = &chain.six {
                for (dx, (axis, factor)) in self.families.six.elements[*index].dx.iter_mut().zip(axes) {
                    *dx -= wrench[*axis] / factor;
                }
            }
            for &(index, (axis, factor)) in &chain.one {
                self.families.one.elements[index].dx[0] -= wrench[axis] / factor;
            }
        }
        for tie in &self.ties {
            let single = &mut self.families.one.elements;
            let [one, other] = tie.pair;
            if single[one].in_chain {
                let left = tie.wanted - tie.preload * strength;
                single[one].dx[0] -= tie.share * left;
                single[other].dx[0] -= left - (tie.resting - single[one].dx[0]);
            }
        }
        for chain in &self.in_chains {
            if let Some((index, _)) = chain.six {
                let element = &self.families.six.elements[index];
                element.push(&element.dx, &mut forces);
            }
            for &(index, _) in &chain.one {
                let element = &self.families.one.elements[index];
                element.push(&element.dx, &mut forces);
            }
        }
        for (dv, v) in self.dv.iter_mut().zip(v) {
            for (dv, v) in dv.iter_mut().zip(v) {
                *dv += v;
            }
        }
        forces
    }
}
