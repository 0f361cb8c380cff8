//! What a plane keeps of a group of variables, or of two that are each other's image.

use super::super::groups::Cone;
use super::super::parts::Part;
use super::mirror::{End, Ends, Mirror, Parity, SAME, Six, columns, combine, size};

/// What the plane keeps of a group, or of two: columns in space, their number, and where the
/// program's variables come from, as `(variable, column, factor)`.
pub(super) struct Kept {
    pub ends: Ends,
    pub len: usize,
    pub sources: Vec<(usize, usize, f64)>,
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
pub(super) fn split(mirror: &Mirror, part: &Part<6>) -> Option<Kept> {
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
pub(super) fn pair(mirror: &Mirror, parts: &[Part<6>], index: usize, paired: &[bool]) -> Option<(usize, Kept)> {
    let part = &parts[index];
    if part.len == 6 || part.cone == Cone::Free || part.tie_row.is_some() {
        return None;
    }
    // Shear across the plane is left out, so it must not act within it, as on the slopes of a groove.
    let [a, b] = along(mirror, part);
    let across = combine(&part.ends, &[vec![(1, -b), (2, a)]]);
    if part.len == 3 && mirror.parity(&columns(&across, 0)) != Parity::Odd {
        return None;
    }
    let in_plane = |part: &Part<6>| match part.len {
        1 => vec![vec![(0, 0.5)]],
        _ => {
            let [a, b] = along(mirror, part);
            vec![vec![(0, 0.5)], vec![(1, 0.5 * a), (2, 0.5 * b)]]
        }
    };
    let own = in_plane(part);
    let candidates = parts.iter().enumerate().skip(index + 1).filter(|(at, other)| {
        let bodies = |part: &Part<6>| part.ends.each_ref().map(|end| end.as_ref().map(|(body, _)| *body));
        !paired[*at] && other.len == part.len && other.ties.is_none() && bodies(other) == bodies(part)
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
