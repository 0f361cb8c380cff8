//! Planar blocks, with three balances per body instead of six.
//!
//! A block is planar when a reflection in a plane maps it onto itself and every body
//! onto itself: centres of mass, loads and links lie in the plane, points beside it in
//! pairs. With a field its mirror image holds too, and so does their mean, which has no
//! force across the plane and no torque within it: those unknowns and balances are left out,
//! the two points of a pair become one, and a friction cone becomes a wedge.
//!
//! What comes back is a field of the block itself, and proved there: data
//! that are planar up to a tolerance only cost nothing but that.
//!
//! Knows columns and bodies, nothing of how they are solved.

mod halves;
mod mirror;
#[cfg(test)]
mod tests;

use crate::spatial::Vec3;

use super::chains::has_long_chains;
use super::conic::Iterate;
use super::parts::Part;
use super::program::{Program, Purpose};
use super::reductions::Reductions;
use halves::{Kept, pair, split};
use mirror::{Mirror, SAME, size};

/// Why a block is solved with six balances per body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NotPlanar {
    /// Planar blocks were not asked for, or cannot be used.
    NotAskedFor,
    /// Its long chains are condensed, and that in space.
    Chains,
    /// No plane holds all its centres of mass.
    Bodies,
    /// A load, or what its links are preloaded with, acts across the plane of its centres of mass.
    Loads,
    /// The connection or contact with this index among the block's links has no mirror image:
    /// it stands askew, or beside the plane without another one opposite.
    Link(usize),
}

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

impl Planar {
    /// `parts` are those of `program`.
    ///
    /// # Errors
    /// Why it is not planar, or not to be solved in its plane.
    pub(super) fn new(program: &Program, parts: &[Part<6>], reductions: Reductions) -> Result<Self, NotPlanar> {
        if reductions.chains && has_long_chains(program) {
            return Err(NotPlanar::Chains);
        }
        if !reductions.planar || program.purpose != Purpose::Utilisation {
            return Err(NotPlanar::NotAskedFor);
        }
        let mut why = NotPlanar::Bodies;
        for normal in candidates(program) {
            match Self::across(program, parts, normal) {
                Ok(planar) => return Ok(planar),
                // A plane that holds the loads as well comes nearer.
                Err(reason) if !matches!(why, NotPlanar::Link(_)) => why = reason,
                Err(_) => {}
            }
        }
        Err(why)
    }

    /// Tries the plane across `normal`.
    fn across(program: &Program, parts: &[Part<6>], normal: Vec3) -> Result<Self, NotPlanar> {
        let mirror = Mirror::new(normal);
        let bodies = program.scales.force.len();
        let by_body = |rows: &[f64]| rows[..6 * bodies].as_chunks::<6>().0.to_vec();
        let project = |rows: &[[f64; 6]]| -> Option<Vec<[f64; 3]>> {
            let largest = rows.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            rows.iter().map(|row| (size(&mirror.odd(row)) <= SAME * largest).then(|| mirror.even(row))).collect()
        };
        // With what rests t's column has nothing across the plane; without, latches have.
        let mut preload = by_body(&program.preload);
        let mut planar = Self {
            axes: mirror.axes,
            parts: Vec::with_capacity(parts.len()),
            loads: project(&by_body(&program.load)).ok_or(NotPlanar::Loads)?,
            preload: Vec::new(),
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
                Some(slack) => planar.slack(part, slack),
                None => match split(&mirror, part) {
                    Some(kept) => kept,
                    None => {
                        let (twin, kept) = pair(&mirror, parts, index, &paired).ok_or(NotPlanar::Link(part.link))?;
                        paired[twin] = true;
                        kept
                    }
                },
            };
            let Kept { ends, len, sources } = kept;
            if len == 0 {
                planar.origins[part.first] = Origin::Resting(part.rest);
                for (body, columns) in part.ends.iter().flatten() {
                    for (row, entry) in preload[*body].iter_mut().zip(&columns[0]) {
                        *row += entry * part.rest;
                    }
                }
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
        planar.preload = project(&preload).ok_or(NotPlanar::Loads)?;
        Ok(planar)
    }

    /// What is kept of a slack that only ties `slack`: everything or nothing.
    fn slack(&self, part: &Part<6>, slack: usize) -> Kept {
        let len = match self.origins[slack] {
            Origin::Variable(..) => 1,
            Origin::Resting(_) => 0,
        };
        Kept { ends: [None, None], len, sources: vec![(part.first, 0, 1.0)] }
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

/// Normals of planes that all centres of mass lie in: the one across them, or, where
/// these are in a row, those along the axes of the first link.
fn candidates(program: &Program) -> Vec<Vec3> {
    let (Some(first), Some(frame)) = (program.coms.first(), program.frames.first()) else { return Vec::new() };
    let arms = || program.coms.iter().map(|com| com - first);
    let longest = arms().fold(Vec3::zeros(), |a, b| if b.norm_squared() > a.norm_squared() { b } else { a });
    let wide = arms().map(|arm| longest.cross(&arm));
    let across = wide.fold(Vec3::zeros(), |a, b| if b.norm_squared() > a.norm_squared() { b } else { a });
    if across.norm() > SAME * longest.norm_squared() {
        let normal = across.normalize();
        let beside = arms().any(|arm| !(arm.dot(&normal).abs() <= SAME * longest.norm()));
        return if beside { Vec::new() } else { vec![normal] };
    }
    let axes = frame.axes.column_iter().map(Vec3::from);
    axes.filter(|axis| axis.dot(&longest).abs() <= SAME * longest.norm()).collect()
}
