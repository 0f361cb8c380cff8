//! The stiffness of a block's links, assembled over its bodies.
//!
//! `M = sum B K B'` over the links, with K a link's 6 x 6 stiffness in its own
//! frame and B its action on the balances of its two bodies. A chain of bodies
//! that hang between two links each passes one unknown wrench on: such bodies
//! are left out of the matrix, their links act in series, and what is eliminated
//! are flexibilities that add up, however long the chain. They are added as
//! roots, `F = G G'`, by orthogonal transformations: at the limit of a cone a
//! flexibility spans more decades than a sum of squares can hold.
//!
//! Knows where links act and how stiff they are, nothing of cones.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector};
use smallvec::SmallVec;

use crate::spatial::Vec3;

use super::frame::LinkFrame;
use super::maps::{Side, Sides};
use super::program::Program;
use super::series::Stacked;
use super::stiffness::Stiffness;

/// Least pivot of a chain's root, as a share of the largest.
const LEAST_PIVOT: f64 = 1e-14;

/// Bodies of a chain from which on it is condensed: shorter ones are eliminated
/// faster than they are added up, and lose nothing.
const LONG: usize = 8;

/// A junction, by number, and the action on its balance of the wrench that arrives
/// there; `None` on the ground.
type End<const D: usize> = Option<(usize, SMatrix<f64, D, D>)>;

/// A series of links from one junction, or the ground, to another, over bodies that
/// nothing else holds.
struct Chain<const D: usize> {
    links: Vec<Passage<D>>,
    /// Bodies between the links, one fewer than links.
    bodies: Vec<Between<D>>,
    /// The junctions at the two ends, with the wrench that runs through the chain.
    ends: [End<D>; 2],
    /// Root of the stiffness between the ends, and in a chain of several the root
    /// of every link's flexibility, all for the wrench in the first link's frame.
    root: SMatrix<f64, D, D>,
    flexibility: Vec<SMatrix<f64, D, D>>,
    /// How the roots were stacked: from the flexibilities before each link and its
    /// own to those up to it.
    stacked: Vec<Stacked<D>>,
}

/// A link of a chain: its index, and its wrench when that of the first link is 1.
struct Passage<const D: usize> {
    link: usize,
    wrench: SMatrix<f64, D, D>,
}

/// A body of a chain: its index, and the wrench, in the first link's frame, that
/// a load on its scaled balance rows adds to the links behind it.
struct Between<const D: usize> {
    body: usize,
    load: SMatrix<f64, D, D>,
}

/// Loads with the bodies in chains eliminated.
#[derive(Default)]
pub(super) struct Condensed<const D: usize> {
    /// By junction, D rows each.
    pub junctions: Vec<f64>,
    /// Per chain of several links: the wrench with both ends held.
    held: Vec<SVector<f64, D>>,
    /// Per link of those chains: what the loads before it add.
    added: Vec<SVector<f64, D>>,
}

impl<const D: usize> Condensed<D> {
    /// Takes away `factor` times what `other` adds within chains.
    pub(super) fn subtract_within(&mut self, other: &Self, factor: f64) {
        for (held, other) in self.held.iter_mut().zip(&other.held) {
            *held -= other * factor;
        }
        for (added, other) in self.added.iter_mut().zip(&other.added) {
            *added -= other * factor;
        }
    }
}

/// The links of a block as springs.
pub(super) struct Network<const D: usize> {
    /// Number of each body among the junctions.
    junction: Vec<Option<usize>>,
    /// Links that are no part of a chain, with the junctions at their ends.
    singles: Vec<(usize, [End<D>; 2])>,
    chains: Vec<Chain<D>>,
    matrix: Stiffness<D>,
}

impl Network<6> {
    /// The network of `program`'s links. With `in_series`, long chains are condensed.
    pub(super) fn new(program: &Program, in_series: bool) -> Self {
        let bodies = program.scales.force.len();
        let incident = if in_series { incident(program) } else { Vec::new() };
        let within = if in_series { within_chains(program, &incident) } else { vec![false; bodies] };
        let mut count = 0;
        let junction: Vec<Option<usize>> = within
            .iter()
            .map(|within| {
                (!within).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        let mut used = vec![false; program.sides.len()];
        let (mut chains, mut singles) = (Vec::new(), Vec::new());
        for (link, sides) in program.sides.iter().enumerate() {
            // Begin where a chain begins: at a junction or the ground.
            let ends = sides.each_ref().map(|side| side.as_ref().is_none_or(|s| junction[s.body].is_some()));
            match ends {
                [true, true] => {
                    let end = |side: &Option<Side>| side.and_then(|s| Some((junction[s.body]?, s.map)));
                    singles.push((link, sides.each_ref().map(end)));
                }
                [false, false] => {}
                _ if used[link] => {}
                [start, _] => chains.push(walk(program, &junction, &incident, &mut used, link, usize::from(!start))),
            }
        }
        let joined = chains.iter().map(|chain| chain.ends.map(|end| end.map(|(at, _)| at)));
        let pairs = singles.iter().map(|(_, ends)| ends.map(|end| end.map(|(at, _)| at))).chain(joined);
        let matrix = Stiffness::new(count, pairs.filter_map(|[a, b]| Some((a?, b?))));
        Self { junction, singles, chains, matrix }
    }

    /// Factorises for links of which `stiffness` is K, in their own frames, and
    /// `flexibility` the root G of its inverse, `K G G' = 1`.
    pub(super) fn factorise(&mut self, stiffness: &[Matrix6<f64>], flexibility: impl Fn(usize) -> Matrix6<f64>) {
        self.matrix.clear();
        for (link, ends) in &self.singles {
            let stiffness = stiffness[*link];
            let force = |end: &End<6>| end.map(|(at, map)| (at, map, map * stiffness));
            let [one, other] = [force(&ends[0]), force(&ends[1])];
            for (at, map, force) in [one, other].iter().flatten() {
                self.matrix.add(*at, *at, &(force * map.transpose()).data.0);
            }
            if let (Some((i, map, _)), Some((j, _, force))) = (one, other) {
                self.matrix.add(j, i, &(force * map.transpose()).data.0);
            }
        }
        self.add_chains(flexibility);
        self.matrix.factorise();
    }
}

impl<const D: usize> Network<D> {
    /// A network of bodies of which `pairs` are joined, without chains.
    pub(super) fn plain(bodies: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        let matrix = Stiffness::new(bodies, pairs);
        Self { junction: (0..bodies).map(Some).collect(), singles: Vec::new(), chains: Vec::new(), matrix }
    }

    /// The number of a body among the junctions; `None` within a chain.
    pub(super) fn junction(&self, body: usize) -> Option<usize> {
        self.junction[body]
    }

    /// The links of all chains.
    pub(super) fn links_in_chains(&self) -> impl Iterator<Item = usize> {
        self.chains.iter().flat_map(|chain| chain.links.iter().map(|passage| passage.link))
    }

    /// The matrix over junctions.
    pub(super) fn matrix(&self) -> &Stiffness<D> {
        &self.matrix
    }

    /// The matrix over junctions, to be filled before [`factorise_with`](Self::factorise_with).
    pub(super) fn matrix_mut(&mut self) -> &mut Stiffness<D> {
        &mut self.matrix
    }

    /// Sets the matrix to zero.
    pub(super) fn clear(&mut self) {
        self.matrix.clear();
    }

    /// Factorises the matrix as it was filled, chains added, of whose links `flexibility`
    /// is the root G of the inverse stiffness, `K G G' = 1`.
    pub(super) fn factorise_with(&mut self, flexibility: impl Fn(usize) -> SMatrix<f64, D, D>) {
        self.add_chains(flexibility);
        self.matrix.factorise();
    }

    fn add_chains(&mut self, flexibility: impl Fn(usize) -> SMatrix<f64, D, D>) {
        for chain in &mut self.chains {
            chain.flexibility.clear();
            chain.stacked.clear();
            let mut triangle = SMatrix::zeros();
            for Passage { link, wrench } in &chain.links {
                let root = wrench.tr_mul(&flexibility(*link));
                chain.stacked.push(Stacked::new(&mut triangle, root.transpose()));
                chain.flexibility.push(root);
            }
            chain.root = inverse(&triangle);
            let root = |end: &End<D>| end.map(|(at, map)| (at, map * chain.root));
            let [one, other] = [root(&chain.ends[0]), root(&chain.ends[1])];
            for (at, root) in [one, other].iter().flatten() {
                self.matrix.add(*at, *at, &(root * root.transpose()).data.0);
            }
            if let (Some((i, a)), Some((j, b))) = (one, other) {
                let across = b * a.transpose();
                self.matrix.add(j, i, &across.data.0);
                if i == j {
                    self.matrix.add(i, i, &across.transpose().data.0);
                }
            }
        }
    }

    /// Number of wrenches that nothing determines: one per link outside chains, and
    /// one per chain.
    pub(super) fn unknown_wrenches(&self) -> usize {
        self.singles.len() + self.chains.len()
    }

    /// Number of chains.
    pub(super) fn chains(&self) -> usize {
        self.chains.len()
    }

    /// Bodies that are not within a chain.
    pub(super) fn junctions(&self) -> usize {
        self.matrix.bodies()
    }

    /// The loads `rows` (D per body) as the junctions feel them.
    pub(super) fn condense(&self, rows: &[f64]) -> Condensed<D> {
        let mut junctions = vec![0.0; D * self.matrix.bodies()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact(D)) {
            if let Some(k) = *number {
                junctions[D * k..D * k + D].copy_from_slice(body);
            }
        }
        let (mut held, mut added) = (Vec::new(), Vec::new());
        for chain in &self.chains {
            let mut sum = SVector::zeros();
            added.push(sum);
            // The wrench with which the chain is stretched least: a least squares
            // problem, since weighing squares would cancel.
            let mut stretch = SVector::zeros();
            let behind = chain.flexibility[1..].iter().zip(&chain.stacked[1..]);
            for (Between { body, load: map }, (flexibility, factor)) in chain.bodies.iter().zip(behind) {
                sum += map * SVector::from_column_slice(&rows[D * body..D * body + D]);
                stretch = factor.reduce(stretch, flexibility.tr_mul(&sum));
                added.push(sum);
            }
            let through = -(chain.root * stretch);
            for (end, wrench) in chain.ends.iter().zip([through, through + sum]) {
                if let Some((at, map)) = end {
                    for (row, value) in junctions[D * at..D * at + D].iter_mut().zip(&(map * wrench)) {
                        *row -= value;
                    }
                }
            }
            held.push(through);
        }
        Condensed { junctions, held, added }
    }

    /// `a_I' M_II^-1 b_I`: the work of the loads within chains, their ends held.
    pub(super) fn work_within(&self, a: &Condensed<D>, b: &Condensed<D>) -> f64 {
        let (mut added_a, mut added_b) = (a.added.iter(), b.added.iter());
        let mut work = 0.0;
        for (chain, (through_a, through_b)) in self.chains.iter().zip(a.held.iter().zip(&b.held)) {
            for ((flexibility, a), b) in chain.flexibility.iter().zip(&mut added_a).zip(&mut added_b) {
                work += flexibility.tr_mul(&(a + through_a)).dot(&flexibility.tr_mul(&(b + through_b)));
            }
        }
        work
    }

    /// `L^-1 x` over junctions, with `L L'` the factored matrix.
    pub(super) fn forward(&self, junctions: &[f64]) -> Vec<f64> {
        self.matrix.forward(junctions)
    }

    /// `L'^-1 y` over junctions.
    pub(super) fn backward(&self, y: Vec<f64>) -> Vec<f64> {
        self.matrix.backward(y)
    }

    /// The motion of all bodies, D rows each, under the loads `loads`, when that
    /// of the junctions is known.
    ///
    /// `wrench` gets the wrench of every link in a chain of several, in its frame.
    pub(super) fn expand(
        &self,
        junctions: &[f64],
        loads: &Condensed<D>,
        mut wrench: impl FnMut(usize, SVector<f64, D>),
    ) -> Vec<f64> {
        let mut rows = vec![0.0; D * self.junction.len()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact_mut(D)) {
            if let Some(k) = *number {
                body.copy_from_slice(&junctions[D * k..D * k + D]);
            }
        }
        let mut added = &loads.added[..];
        for (chain, held) in self.chains.iter().zip(&loads.held) {
            let (own, others) = added.split_at(chain.links.len());
            added = others;
            let at_end = |end: &End<D>| {
                end.as_ref().map_or_else(SVector::zeros, |(at, map)| {
                    map.tr_mul(&SVector::from_column_slice(&junctions[D * at..D * at + D]))
                })
            };
            let mut motion = at_end(&chain.ends[0]);
            let apart = motion + at_end(&chain.ends[1]);
            let through = chain.root * chain.root.tr_mul(&apart) + held;
            for (link, added) in chain.links.iter().zip(own) {
                wrench(link.link, link.wrench * (through + added));
            }
            for ((Between { body, load }, flexibility), added) in chain.bodies.iter().zip(&chain.flexibility).zip(own) {
                motion -= flexibility * flexibility.tr_mul(&(through + added));
                rows[D * body..D * body + D].copy_from_slice(load.tr_mul(&motion).as_slice());
            }
        }
        rows
    }

    /// `M^-1 rows`; `wrench` as in [`expand`](Self::expand).
    pub(super) fn solve(&self, rows: &[f64], wrench: impl FnMut(usize, SVector<f64, D>)) -> Vec<f64> {
        let condensed = self.condense(rows);
        let junctions = self.backward(self.forward(&condensed.junctions));
        self.expand(&junctions, &condensed, wrench)
    }
}

/// Whether there are chains worth condensing.
pub(super) fn has_long_chains(program: &Program) -> bool {
    within_chains(program, &incident(program)).contains(&true)
}

/// The links at each body.
fn incident(program: &Program) -> Vec<SmallVec<[usize; 4]>> {
    let mut incident = vec![SmallVec::new(); program.scales.force.len()];
    for (link, sides) in program.sides.iter().enumerate() {
        for side in sides.iter().flatten() {
            incident[side.body].push(link);
        }
    }
    incident
}

/// Which bodies hang between two links of a long chain each.
fn within_chains(program: &Program, incident: &[SmallVec<[usize; 4]>]) -> Vec<bool> {
    let passes = |links: &SmallVec<[usize; 4]>| {
        links.len() == 2 && links[0] != links[1] && links.iter().all(|&link| program.in_series[link])
    };
    let mut within: Vec<bool> = incident.iter().map(passes).collect();
    let mut seen = vec![false; within.len()];
    for body in 0..within.len() {
        if !within[body] || seen[body] {
            continue;
        }
        seen[body] = true;
        let mut run = vec![body];
        let mut next = 0;
        while let Some(&at) = run.get(next) {
            next += 1;
            for side in incident[at].iter().flat_map(|&link| program.sides[link].iter().flatten()) {
                if within[side.body] && !seen[side.body] {
                    seen[side.body] = true;
                    run.push(side.body);
                }
            }
        }
        if run.len() < LONG {
            for body in run {
                within[body] = false;
            }
        }
    }
    within
}

/// Follows the chain that begins with `link` at its side `start`.
fn walk(
    program: &Program,
    junction: &[Option<usize>],
    incident: &[SmallVec<[usize; 4]>],
    used: &mut [bool],
    link: usize,
    start: usize,
) -> Chain<6> {
    let first = &program.frames[link];
    // Sign of the first link's wrench when it runs through the current one.
    let mut through = 1.0;
    let end = |side: &Option<Side>, through: f64| {
        side.as_ref().and_then(|side| Some((junction[side.body]?, action(program, first, side, through))))
    };
    let begin = end(&program.sides[link][start], 1.0);
    let (mut links, mut bodies) = (Vec::new(), Vec::new());
    let (mut at, mut leaving) = (link, 1 - start);
    loop {
        used[at] = true;
        links.push(Passage { link: at, wrench: passage(first, &program.frames[at]) * through });
        let side = program.sides[at][leaving];
        let between = side.filter(|side| junction[side.body].is_none());
        let Some(side) = between else {
            let ends = [begin, end(&side, through)];
            return Chain { links, bodies, ends, root: Matrix6::zeros(), flexibility: Vec::new(), stacked: Vec::new() };
        };
        let next = incident[side.body].iter().copied().find(|&other| other != at).expect("it has two links");
        let sides: &Sides = &program.sides[next];
        let entered = sides.iter().position(|s| s.is_some_and(|s| s.body == side.body)).expect("it ends here");
        let sign = sides[entered].expect("just found").sign;
        through *= -side.sign / sign;
        bodies.push(Between { body: side.body, load: reaction(program, first, side.body, sign * through) });
        (at, leaving) = (next, 1 - entered);
    }
}

/// The wrench in the frame `to` of a wrench in the frame `from`.
fn passage(from: &LinkFrame, to: &LinkFrame) -> Matrix6<f64> {
    let turn = to.axes.tr_mul(&from.axes);
    let lever = to.axes.tr_mul(&((from.origin - to.origin).cross_matrix() * from.axes));
    blocks(&turn, &lever)
}

/// What the wrench in the frame `first` adds to the balance rows at `side`, `through` times.
fn action(program: &Program, first: &LinkFrame, side: &Side, through: f64) -> Matrix6<f64> {
    let mut map = blocks(&first.axes, &((first.origin - com(program, side.body)).cross_matrix() * first.axes));
    for (row, factor) in program.row_factor[6 * side.body..6 * side.body + 6].iter().enumerate() {
        map.row_mut(row).scale_mut(side.sign * through * factor);
    }
    map
}

/// The inverse of an [`action`] with the sign `sign`.
fn reaction(program: &Program, first: &LinkFrame, body: usize, sign: f64) -> Matrix6<f64> {
    let turn = first.axes.transpose();
    let mut map = blocks(&turn, &(turn * (com(program, body) - first.origin).cross_matrix()));
    for (column, factor) in program.row_factor[6 * body..6 * body + 6].iter().enumerate() {
        map.column_mut(column).scale_mut(sign / factor);
    }
    map
}

fn com(program: &Program, body: usize) -> Vec3 {
    program.coms[body]
}

/// `[turn 0; lever turn]`.
fn blocks(turn: &Matrix3<f64>, lever: &Matrix3<f64>) -> Matrix6<f64> {
    let mut map = Matrix6::zeros();
    map.fixed_view_mut::<3, 3>(0, 0).copy_from(turn);
    map.fixed_view_mut::<3, 3>(3, 0).copy_from(lever);
    map.fixed_view_mut::<3, 3>(3, 3).copy_from(turn);
    map
}

/// The inverse of an upper triangle; where that is singular to rounding, of one
/// that is not.
fn inverse<const D: usize>(triangle: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    let largest = triangle.diagonal().amax();
    let mut regular = *triangle;
    for k in 0..D {
        let pivot = regular[(k, k)];
        if !(pivot.abs() > LEAST_PIVOT * largest) {
            regular[(k, k)] = (LEAST_PIVOT * largest).max(f64::MIN_POSITIVE.sqrt()).copysign(pivot);
        }
    }
    regular.solve_upper_triangular(&SMatrix::identity()).unwrap_or_else(SMatrix::zeros)
}

/// The root G of the inverse of a link's stiffness, `K G G' = 1`, where nothing
/// better than K itself is known.
pub(super) fn flexibility_root<const D: usize>(stiffness: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    // Forces and torques differ in unit: scale the diagonal to 1 first.
    let unit = stiffness.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
    let mut factor =
        SMatrix::<f64, D, D>::from_fn(|r, c| if r >= c { stiffness[(r, c)] * unit[r] * unit[c] } else { 0.0 });
    for c in 0..D {
        let pivot = factor[(c, c)].max(LEAST_PIVOT).sqrt();
        factor[(c, c)] = pivot;
        for r in c + 1..D {
            factor[(r, c)] /= pivot;
        }
        for d in c + 1..D {
            for r in d..D {
                factor[(r, d)] -= factor[(r, c)] * factor[(d, c)];
            }
        }
    }
    SMatrix::<f64, D, D>::from_diagonal(&unit) * inverse::<D>(&factor.transpose())
}
