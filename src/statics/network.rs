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

use nalgebra::{Matrix3, Matrix6, Vector6};

use crate::spatial::Vec3;

use super::frame::LinkFrame;
use super::maps::{Side, Sides};
use super::program::Program;
use super::series::Stacked;
use super::stiffness::Stiffness;

/// Least pivot of a chain's root, as a share of the largest.
const LEAST_PIVOT: f64 = 1e-14;

/// A series of links from one junction, or the ground, to another.
struct Chain {
    links: Vec<Passage>,
    /// Bodies between the links, one fewer than links.
    bodies: Vec<Between>,
    /// The junctions at the two ends: number there, and the action on its balance
    /// of the wrench that runs through the chain.
    ends: [Option<(usize, Matrix6<f64>)>; 2],
    /// Root of the stiffness between the ends, and in a chain of several the root
    /// of every link's flexibility, all for the wrench in the first link's frame.
    root: Matrix6<f64>,
    flexibility: Vec<Matrix6<f64>>,
    /// How the roots were stacked: from the flexibilities before each link and its
    /// own to those up to it.
    stacked: Vec<Stacked>,
}

/// A link of a chain: its index, and its wrench when that of the first link is 1.
struct Passage {
    link: usize,
    wrench: Matrix6<f64>,
}

/// A body of a chain: its index, and the wrench, in the first link's frame, that
/// a load on its scaled balance rows adds to the links behind it.
struct Between {
    body: usize,
    load: Matrix6<f64>,
}

/// Loads with the bodies in chains eliminated.
pub(super) struct Condensed {
    /// By junction, six rows each.
    pub junctions: Vec<f64>,
    /// Per chain of several links: the wrench with both ends held.
    held: Vec<Vector6<f64>>,
    /// Per link of those chains: what the loads before it add.
    added: Vec<Vector6<f64>>,
}

impl Condensed {
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
pub(super) struct Network {
    /// Number of each body among the junctions.
    junction: Vec<Option<usize>>,
    chains: Vec<Chain>,
    matrix: Stiffness,
}

impl Network {
    /// The network of `program`'s links. With `in_series`, chains are condensed.
    pub(super) fn new(program: &Program, in_series: bool) -> Self {
        let bodies = program.scales.force.len();
        let mut incident: Vec<Vec<usize>> = vec![Vec::new(); bodies];
        for (link, sides) in program.sides.iter().enumerate() {
            for side in sides.iter().flatten() {
                incident[side.body].push(link);
            }
        }
        let passes = |links: &Vec<usize>| {
            in_series && links.len() == 2 && links[0] != links[1] && links.iter().all(|&link| program.in_series[link])
        };
        let mut count = 0;
        let junction: Vec<Option<usize>> = incident
            .iter()
            .map(|links| {
                (!passes(links)).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        let mut used = vec![false; program.sides.len()];
        let mut chains = Vec::new();
        for link in 0..program.sides.len() {
            // Begin where a chain begins: at a junction or the ground.
            let start = program.sides[link].iter().position(|side| side.is_none_or(|s| junction[s.body].is_some()));
            if let (Some(start), false) = (start, used[link]) {
                chains.push(walk(program, &junction, &incident, &mut used, link, start));
            }
        }
        let pairs = chains.iter().filter_map(|chain: &Chain| match &chain.ends {
            [Some((a, _)), Some((b, _))] => Some((*a, *b)),
            _ => None,
        });
        let matrix = Stiffness::new(count, pairs);
        Self { junction, chains, matrix }
    }

    /// Factorises for links of which `stiffness` is K, in their own frames, and
    /// `flexibility` the root G of its inverse, `K G G' = 1`.
    pub(super) fn factorise(&mut self, stiffness: &[Matrix6<f64>], flexibility: impl Fn(usize) -> Matrix6<f64>) {
        self.matrix.clear();
        for chain in &mut self.chains {
            if let [only] = &chain.links[..] {
                let stiffness = stiffness[only.link];
                let force = |end: &Option<(usize, Matrix6<f64>)>| end.map(|(at, map)| (at, map, map * stiffness));
                let [one, other] = [force(&chain.ends[0]), force(&chain.ends[1])];
                for (at, map, force) in [one, other].iter().flatten() {
                    self.matrix.add(*at, *at, &(force * map.transpose()).data.0);
                }
                if let (Some((i, map, _)), Some((j, _, force))) = (one, other) {
                    self.matrix.add(j, i, &(force * map.transpose()).data.0);
                }
                continue;
            }
            chain.flexibility.clear();
            chain.stacked.clear();
            let mut triangle = Matrix6::zeros();
            for Passage { link, wrench } in &chain.links {
                let root = wrench.tr_mul(&flexibility(*link));
                chain.stacked.push(Stacked::new(&mut triangle, root.transpose()));
                chain.flexibility.push(root);
            }
            chain.root = inverse(&triangle);
            let root = |end: &Option<(usize, Matrix6<f64>)>| end.map(|(at, map)| (at, map * chain.root));
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
        self.matrix.factorise();
    }

    /// The loads `rows` (six per body) as the junctions feel them.
    pub(super) fn condense(&self, rows: &[f64]) -> Condensed {
        let mut junctions = vec![0.0; 6 * self.matrix.bodies()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact(6)) {
            if let Some(k) = *number {
                junctions[6 * k..6 * k + 6].copy_from_slice(body);
            }
        }
        let (mut held, mut added) = (Vec::new(), Vec::new());
        for chain in self.chains.iter().filter(|chain| chain.links.len() > 1) {
            let mut sum = Vector6::zeros();
            added.push(sum);
            // The wrench with which the chain is stretched least: a least squares
            // problem, since weighing squares would cancel.
            let mut stretch = Vector6::zeros();
            let behind = chain.flexibility[1..].iter().zip(&chain.stacked[1..]);
            for (Between { body, load: map }, (flexibility, factor)) in chain.bodies.iter().zip(behind) {
                sum += map * Vector6::from_column_slice(&rows[6 * body..6 * body + 6]);
                stretch = factor.reduce(stretch, flexibility.tr_mul(&sum));
                added.push(sum);
            }
            let through = -(chain.root * stretch);
            for (end, wrench) in chain.ends.iter().zip([through, through + sum]) {
                if let Some((at, map)) = end {
                    for (row, value) in junctions[6 * at..6 * at + 6].iter_mut().zip(&(map * wrench)) {
                        *row -= value;
                    }
                }
            }
            held.push(through);
        }
        Condensed { junctions, held, added }
    }

    /// `a_I' M_II^-1 b_I`: the work of the loads within chains, their ends held.
    pub(super) fn work_within(&self, a: &Condensed, b: &Condensed) -> f64 {
        let several = self.chains.iter().filter(|chain| chain.links.len() > 1);
        let (mut added_a, mut added_b) = (a.added.iter(), b.added.iter());
        let mut work = 0.0;
        for (chain, (through_a, through_b)) in several.zip(a.held.iter().zip(&b.held)) {
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

    /// The motion of all bodies, six rows each, under the loads `loads`, when that
    /// of the junctions is known.
    ///
    /// `wrench` gets the wrench of every link in a chain of several, in its frame.
    pub(super) fn expand(
        &self,
        junctions: &[f64],
        loads: &Condensed,
        mut wrench: impl FnMut(usize, Vector6<f64>),
    ) -> Vec<f64> {
        let mut rows = vec![0.0; 6 * self.junction.len()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact_mut(6)) {
            if let Some(k) = *number {
                body.copy_from_slice(&junctions[6 * k..6 * k + 6]);
            }
        }
        let several = self.chains.iter().filter(|chain| chain.links.len() > 1);
        let mut added = &loads.added[..];
        for (chain, held) in several.zip(&loads.held) {
            let (own, others) = added.split_at(chain.links.len());
            added = others;
            let at_end = |end: &Option<(usize, Matrix6<f64>)>| {
                end.as_ref().map_or_else(Vector6::zeros, |(at, map)| {
                    map.tr_mul(&Vector6::from_column_slice(&junctions[6 * at..6 * at + 6]))
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
                rows[6 * body..6 * body + 6].copy_from_slice(load.tr_mul(&motion).as_slice());
            }
        }
        rows
    }

    /// `M^-1 rows`; `wrench` as in [`expand`](Self::expand).
    pub(super) fn solve(&self, rows: &[f64], wrench: impl FnMut(usize, Vector6<f64>)) -> Vec<f64> {
        let condensed = self.condense(rows);
        let junctions = self.backward(self.forward(&condensed.junctions));
        self.expand(&junctions, &condensed, wrench)
    }
}

/// Follows the chain that begins with `link` at its side `start`.
fn walk(
    program: &Program,
    junction: &[Option<usize>],
    incident: &[Vec<usize>],
    used: &mut [bool],
    link: usize,
    start: usize,
) -> Chain {
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
fn inverse(triangle: &Matrix6<f64>) -> Matrix6<f64> {
    let largest = triangle.diagonal().amax();
    let mut regular = *triangle;
    for k in 0..6 {
        let pivot = regular[(k, k)];
        if !(pivot.abs() > LEAST_PIVOT * largest) {
            regular[(k, k)] = (LEAST_PIVOT * largest).max(f64::MIN_POSITIVE.sqrt()).copysign(pivot);
        }
    }
    regular.solve_upper_triangular(&Matrix6::identity()).unwrap_or_else(Matrix6::zeros)
}

/// The root G of the inverse of a link's stiffness, `K G G' = 1`, where nothing
/// better than K itself is known.
pub(super) fn flexibility_root(stiffness: &Matrix6<f64>) -> Matrix6<f64> {
    // Forces and torques differ in unit: scale the diagonal to 1 first.
    let unit = stiffness.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
    let mut factor = Matrix6::from_fn(|r, c| if r >= c { stiffness[(r, c)] * unit[r] * unit[c] } else { 0.0 });
    for c in 0..6 {
        let pivot = factor[(c, c)].max(LEAST_PIVOT).sqrt();
        factor[(c, c)] = pivot;
        for r in c + 1..6 {
            factor[(r, c)] /= pivot;
        }
        for d in c + 1..6 {
            for r in d..6 {
                factor[(r, d)] -= factor[(r, c)] * factor[(d, c)];
            }
        }
    }
    Matrix6::from_diagonal(&unit) * inverse(&factor.transpose())
}
