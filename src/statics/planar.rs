//! Planar blocks, with three balances per body instead of six.
//!
//! A block is planar when a reflection in a plane maps it onto itself and every body
//! onto itself: centres of mass, loads and links lie in the plane, points beside it in
//! pairs. With a field its mirror image holds too, and so does their mean, which has no
//! force across the plane and no torque within it: those unknowns and balances are left out,
//! the two points of a pair become one, and a friction cone becomes a wedge.
//!
//! What comes back is a field of the block itself, and proved there: data
//! that are planar up to [`SAME`] only cost nothing but that.
//!
//! Knows columns and bodies, nothing of how they are solved.

use crate::spatial::Vec3;

use super::conic::Iterate;
use super::parts::Part;
use super::program::{Cone, Program, Purpose};

/// Largest share of a column or load across the plane, or the other way round.
const SAME: f64 = 1e-9;

/// Rows of a body's balance, or of its motion, in space.
type Six = [f64; 6];

/// Columns of a group at one end of its link, with the body there.
type End = Option<(usize, [Six; 6])>;

/// Both ends of it.
type Ends = [End; 2];

/// A block's program in its plane.
pub(super) struct Planar {
    /// In the plane `(e_1, e_2)`, with n across.
    axes: [Vec3; 3],
    pub parts: Vec<Part<3>>,
    pub loads: Vec<[f64; 3]>,
    pub preload: Vec<[f64; 3]>,
    /// Where each variable of the program comes from.
    origins: Vec<Origin>,
    /// Number of tie rows.
    ties: usize,
}

/// What becomes of a variable.
#[derive(Clone, Copy, Debug)]
enum Origin {
    /// A planar variable times a factor.
    Variable(usize, f64),
    /// It only holds what acts across the plane: this times t.
    Resting(f64),
}

/// How a vector behaves in the reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parity {
    Even,
    Odd,
    Neither,
}

impl Planar {
    /// `parts` are those of `program`. `None` when the block is not planar.
    pub(super) fn new(program: &Program, parts: &[Part<6>]) -> Option<Self> {
        if program.purpose != Purpose::Utilisation {
            return None;
        }
        candidates(program).into_iter().find_map(|normal| Self::across(program, parts, normal))
    }

    /// Tries the plane across `normal`.
    fn across(program: &Program, parts: &[Part<6>], normal: Vec3) -> Option<Self> {
        let mirror = Mirror::new(normal);
        let bodies = program.scales.force.len();
        let project = |rows: &[f64]| -> Option<Vec<[f64; 3]>> {
            let (rows, _) = rows[..6 * bodies].as_chunks::<6>();
            let largest = rows.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            rows.iter().map(|row| (size(&mirror.odd(row)) <= SAME * largest).then(|| mirror.even(row))).collect()
        };
        let mut planar = Self {
            axes: mirror.axes,
            parts: Vec::with_capacity(parts.len()),
            loads: project(&program.load)?,
            preload: project(&program.preload)?,
            origins: vec![Origin::Resting(0.0); program.variables],
            ties: program.rows() - 6 * bodies,
        };
        let mut paired = vec![false; parts.len()];
        let mut variables = 0;
        for (index, part) in parts.iter().enumerate() {
            if paired[index] {
                continue;
            }
            let kept = match part.ties {
                Some(slack) => planar.slack(part, slack)?,
                None => match split(&mirror, part) {
                    Some(kept) => kept,
                    None => {
                        let (twin, kept) = pair(&mirror, parts, index)?;
                        paired[twin] = true;
                        kept
                    }
                },
            };
            let Kept { ends, len, sources } = kept;
            if len == 0 {
                planar.origins[part.first] = Origin::Resting(part.rest);
                continue;
            }
            for (variable, kept, factor) in sources {
                planar.origins[variable] = Origin::Variable(variables + kept, factor);
            }
            let ties = part.ties.map(|slack| match planar.origins[slack] {
                Origin::Variable(slack, _) => slack,
                Origin::Resting(_) => unreachable!("else this one would rest too"),
            });
            let ends = ends.map(|end| end.map(|(body, columns)| (body, columns.map(|column| mirror.even(&column)))));
            planar.parts.push(Part {
                cone: part.cone,
                first: variables,
                len,
                link: part.link,
                ends,
                axes: None,
                rest: part.rest,
                start: part.start,
                inset: part.inset,
                tie_row: part.tie_row,
                ties,
            });
            variables += len;
        }
        Some(planar)
    }

    /// What is kept of a slack that only ties `slack`: everything or nothing.
    fn slack(&self, part: &Part<6>, slack: usize) -> Option<Kept> {
        let len = match self.origins[slack] {
            Origin::Variable(..) => 1,
            Origin::Resting(_) => 0,
        };
        Some(Kept { ends: [None, None], len, sources: vec![(part.first, 0, 1.0)] })
    }

    /// The iterate in space of one in the plane: forces `x` by planar variable, and twists.
    pub(super) fn in_space(&self, x: &[f64], motion: &[[f64; 3]], t: f64) -> Iterate {
        let origin = |origin: &Origin| match *origin {
            Origin::Variable(k, factor) => factor * x[k],
            Origin::Resting(rest) => rest * t,
        };
        let z = self.origins.iter().map(origin).collect();
        let [one, two, across] = self.axes;
        let mut v = Vec::with_capacity(6 * motion.len() + self.ties);
        for [a, b, c] in motion {
            v.extend((one * *a + two * *b).iter());
            v.extend((across * *c).iter());
        }
        v.resize(6 * motion.len() + self.ties, 0.0);
        Iterate { v, z, t }
    }
}

/// What the plane keeps of a group, or of two: columns in space, their number, and where the
/// program's variables come from, as `(variable, column, factor)`.
struct Kept {
    ends: Ends,
    len: usize,
    sources: Vec<(usize, usize, f64)>,
}

/// A reflection that leaves `e_1` and `e_2` as they are and turns n around.
struct Mirror {
    axes: [Vec3; 3],
}

impl Mirror {
    fn new(normal: Vec3) -> Self {
        let helper = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
        let one = normal.cross(&helper).normalize();
        Self { axes: [one, normal.cross(&one), normal] }
    }

    /// Forces in the plane and the torque across it, which a mirror image shares.
    fn even(&self, rows: &Six) -> [f64; 3] {
        let (force, torque) = halves(rows);
        let [one, two, across] = &self.axes;
        [force.dot(one), force.dot(two), torque.dot(across)]
    }

    /// The force across the plane and torques in it, which a mirror image has reversed.
    fn odd(&self, rows: &Six) -> [f64; 3] {
        let (force, torque) = halves(rows);
        let [one, two, across] = &self.axes;
        [torque.dot(one), torque.dot(two), force.dot(across)]
    }

    fn parity(&self, column: &[Six]) -> Parity {
        let (even, odd) = column.iter().fold((0.0_f64, 0.0_f64), |(even, odd), rows| {
            (even.max(size(&self.even(rows))), odd.max(size(&self.odd(rows))))
        });
        if odd <= SAME * even {
            Parity::Even
        } else if even <= SAME * odd {
            Parity::Odd
        } else {
            Parity::Neither
        }
    }
}

fn halves(rows: &Six) -> (Vec3, Vec3) {
    (Vec3::new(rows[0], rows[1], rows[2]), Vec3::new(rows[3], rows[4], rows[5]))
}

fn size(v: &[f64; 3]) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Normals of planes that the block may lie in: across its centres of mass, or, where
/// these are in a row, along the axes of its first link.
fn candidates(program: &Program) -> Vec<Vec3> {
    let (Some(first), Some(frame)) = (program.coms.first(), program.frames.first()) else { return Vec::new() };
    let arms = || program.coms.iter().map(|com| com - first);
    let longest = arms().fold(Vec3::zeros(), |a, b| if b.norm_squared() > a.norm_squared() { b } else { a });
    let wide = arms().map(|arm| longest.cross(&arm));
    let across = wide.fold(Vec3::zeros(), |a, b| if b.norm_squared() > a.norm_squared() { b } else { a });
    if across.norm() > SAME * longest.norm_squared() {
        return vec![across.normalize()];
    }
    let axes = frame.axes.column_iter().map(Vec3::from);
    axes.filter(|axis| axis.dot(&longest).abs() <= SAME * longest.norm()).collect()
}

/// The columns `k` at both ends.
fn columns(ends: &Ends, k: usize) -> Vec<Six> {
    ends.iter().flatten().map(|(_, columns)| columns[k]).collect()
}

/// Combines columns at both ends: for each kept column, factors of the group's.
fn combine(ends: &Ends, kept: &[Vec<(usize, f64)>]) -> Ends {
    ends.each_ref().map(|end| {
        let (body, columns) = end.as_ref()?;
        let mut combined = [[0.0; 6]; 6];
        for (target, factors) in combined.iter_mut().zip(kept) {
            for &(k, factor) in factors {
                for (sum, entry) in target.iter_mut().zip(&columns[k]) {
                    *sum += factor * entry;
                }
            }
        }
        Some((*body, combined))
    })
}

/// Unit factors for the columns `i` and `j` of a cone whose combination is as even
/// as any.
fn most_even(mirror: &Mirror, ends: &Ends, [i, j]: [usize; 2]) -> [f64; 2] {
    let (mut ii, mut ij, mut jj) = (0.0, 0.0, 0.0);
    for (a, b) in columns(ends, i).iter().zip(&columns(ends, j)) {
        for (a, b) in mirror.odd(a).iter().zip(&mirror.odd(b)) {
            ii += a * a;
            ij += a * b;
            jj += b * b;
        }
    }
    if ij.abs() <= SAME * SAME * ii.max(jj) {
        return if ii <= jj { [1.0, 0.0] } else { [0.0, 1.0] };
    }
    // The eigenvector of the smaller eigenvalue.
    let angle = 0.5 * (2.0 * ij).atan2(ii - jj) + std::f64::consts::FRAC_PI_2;
    [angle.cos(), angle.sin()]
}

/// The even half of a group in the plane. `None` if it does not come apart.
fn split(mirror: &Mirror, part: &Part<6>) -> Option<Kept> {
    let parity = |factors: &[(usize, f64)]| {
        let combined: Vec<Six> = columns(&combine(&part.ends, &[factors.to_vec()]), 0);
        mirror.parity(&combined)
    };
    let mut kept = Vec::new();
    match (parity(&[(0, 1.0)]), part.len) {
        (Parity::Even, _) => kept.push(vec![(0, 1.0)]),
        (Parity::Odd, 1) => {}
        (Parity::Odd | Parity::Neither, _) => return None,
    }
    let pairs: &[[usize; 2]] = match part.len {
        1 => &[],
        3 => &[[1, 2]],
        _ => &[[1, 2], [3, 4]],
    };
    for &[i, j] in pairs {
        let [a, b] = most_even(mirror, &part.ends, [i, j]);
        let even = vec![(i, a), (j, b)];
        if parity(&even) != Parity::Even || parity(&[(i, -b), (j, a)]) != Parity::Odd {
            return None;
        }
        kept.push(even);
    }
    if part.len == 6 && parity(&[(5, 1.0)]) != Parity::Odd {
        return None;
    }
    let sources = kept
        .iter()
        .enumerate()
        .flat_map(|(n, factors)| factors.iter().map(move |&(k, factor)| (part.first + k, n, factor)));
    Some(Kept { ends: combine(&part.ends, &kept), len: kept.len(), sources: sources.collect() })
}

/// A point beside the plane and its mirror image, later among `parts`, as one point
/// of which each has half: the image's index, and what is kept of both.
fn pair(mirror: &Mirror, parts: &[Part<6>], index: usize) -> Option<(usize, Kept)> {
    let part = &parts[index];
    if part.len == 6 || part.cone == Cone::Free || part.tie_row.is_some() {
        return None;
    }
    let in_plane = |part: &Part<6>| match part.len {
        1 => vec![vec![(0, 0.5)]],
        _ => {
            // Across the plane a pair has no force: what is left of a point is pressure and shear along it.
            let [a, b] = along(mirror, part);
            vec![vec![(0, 0.5)], vec![(1, 0.5 * a), (2, 0.5 * b)]]
        }
    };
    let own = in_plane(part);
    let candidates = parts.iter().enumerate().skip(index + 1).filter(|(_, other)| {
        let bodies = |part: &Part<6>| part.ends.each_ref().map(|end| end.as_ref().map(|(body, _)| *body));
        other.len == part.len && other.ties.is_none() && bodies(other) == bodies(part)
    });
    for (twin, other) in candidates {
        let mut others = in_plane(other);
        let ends = combine(&part.ends, &own);
        let mut images = combine(&other.ends, &others);
        if part.len == 3 && alike(mirror, &ends, &images, 1, -1.0) {
            others[1].iter_mut().for_each(|(_, factor)| *factor = -*factor);
            images = combine(&other.ends, &others);
        }
        if (0..own.len()).all(|k| alike(mirror, &ends, &images, k, 1.0)) {
            let sum = |one: &End, two: &End| {
                let ((body, a), (_, b)) = (one.as_ref()?, two.as_ref()?);
                let sum = |k: usize| std::array::from_fn(|r| a[k][r] + b[k][r]);
                Some((*body, std::array::from_fn(sum)))
            };
            let sources = |first: usize, kept: &[Vec<(usize, f64)>]| -> Vec<(usize, usize, f64)> {
                let factors = kept.iter().enumerate();
                factors.flat_map(|(n, f)| f.iter().map(move |&(k, factor)| (first + k, n, factor))).collect()
            };
            let mut both = sources(part.first, &own);
            both.extend(sources(other.first, &others));
            let ends = [sum(&ends[0], &images[0]), sum(&ends[1], &images[1])];
            return Some((twin, Kept { ends, len: own.len(), sources: both }));
        }
    }
    None
}

/// Unit factors of a point's two shear columns whose force is along the plane.
fn along(mirror: &Mirror, part: &Part<6>) -> [f64; 2] {
    let across = |k: usize| columns(&part.ends, k).first().map_or(0.0, |column| mirror.odd(column)[2]);
    let (a, b) = (across(2), -across(1));
    let length = a.hypot(b);
    if length > 0.0 { [a / length, b / length] } else { [1.0, 0.0] }
}

/// Whether column `k` of `b` is `sign` times the mirror image of that of `a`.
fn alike(mirror: &Mirror, a: &Ends, b: &Ends, k: usize, sign: f64) -> bool {
    columns(a, k).iter().zip(&columns(b, k)).all(|(a, b)| {
        let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = |a: [f64; 3], b: [f64; 3], sign: f64| size(&std::array::from_fn(|k| a[k] - sign * b[k]));
        off(mirror.even(a), mirror.even(b), sign).max(off(mirror.odd(a), mirror.odd(b), -sign)) <= SAME * largest
    })
}
