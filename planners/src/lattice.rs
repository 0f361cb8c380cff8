//! Displacements, and the sums of some of them. It does not know what is displaced.

/// How far along each axis. Axes along which nothing can be displaced stay 0.
pub type Displacement = [i64; 3];

/// One displacement after another.
pub(crate) fn sum(a: Displacement, b: Displacement) -> Displacement {
    std::array::from_fn(|i| a[i] + b[i])
}

/// What leads from the second displacement to the first.
pub(crate) fn difference(a: Displacement, b: Displacement) -> Displacement {
    std::array::from_fn(|i| a[i] - b[i])
}

/// All sums of whole multiples of some displacements: a subgroup of Z^3.
///
/// Kept as a basis in echelon form: of `rows[i]`, if there is one, all components before `i` are zero and component `i` is
/// positive; components above the leading one of a later row are reduced by it, which keeps all of them small.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Lattice {
    rows: [Option<Displacement>; 3],
}

impl Lattice {
    /// Whether a displacement is one of the sums.
    pub fn contains(&self, displacement: Displacement) -> bool {
        self.remainder(displacement) == [0; 3]
    }

    /// Adds a displacement to those that are summed.
    pub fn insert(&mut self, displacement: Displacement) {
        let mut new = displacement;
        for axis in 0..3 {
            if new[axis] == 0 {
                continue;
            }
            let Some(mut row) = self.rows[axis].take() else {
                self.rows[axis] = Some(if new[axis] < 0 { new.map(|c| -c) } else { new });
                new = [0; 3];
                break;
            };
            // Euclid's algorithm: what the two sum to stays the same.
            while new[axis] != 0 {
                let times = row[axis].div_euclid(new[axis]);
                (row, new) = (new, std::array::from_fn(|i| row[i] - times * new[i]));
            }
            self.rows[axis] = Some(if row[axis] < 0 { row.map(|c| -c) } else { row });
        }
        debug_assert_eq!(new, [0; 3], "every component has been taken by a row");
        self.reduce();
    }

    /// What is left of a displacement when whole multiples of the rows are taken from it: the same for all that differ
    /// by a sum.
    fn remainder(&self, displacement: Displacement) -> Displacement {
        let mut left = displacement;
        for (axis, row) in self.rows.iter().enumerate() {
            if let Some(row) = row {
                let times = left[axis].div_euclid(row[axis]);
                left = std::array::from_fn(|i| left[i] - times * row[i]);
            }
        }
        left
    }

    fn reduce(&mut self) {
        for axis in (0..3).rev() {
            if let Some(row) = self.rows[axis].take() {
                let later =
                    Lattice { rows: self.rows.map(|other| other.filter(|other| other[..=axis] == [0; 3][..=axis])) };
                self.rows[axis] = Some(later.remainder(row));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums with coefficients of up to 8 either way, by trying all.
    fn is_small_sum(of: &[Displacement], wanted: Displacement) -> bool {
        match of {
            [] => wanted == [0; 3],
            [first, rest @ ..] => {
                (-8..=8).any(|times| is_small_sum(rest, difference(wanted, first.map(|c| times * c))))
            }
        }
    }

    /// A generator of small numbers, the same on every machine.
    fn draws(seed: u64) -> impl Iterator<Item = i64> {
        let next =
            |state: &u64| Some(state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
        std::iter::successors(next(&seed), next).map(|state| (state >> 33) as i64 % 9 - 4)
    }

    #[test]
    fn sums_are_contained_and_nothing_else_is() {
        for seed in 0..200 {
            let mut draw = draws(seed);
            let mut vector = || -> Displacement { std::array::from_fn(|_| draw.next().unwrap_or_default()) };
            let of: Vec<Displacement> = (0..seed % 4).map(|_| vector()).collect();
            let mut lattice = Lattice::default();
            of.iter().for_each(|&displacement| lattice.insert(displacement));
            for &a in &of {
                assert!(lattice.contains(a) && lattice.contains(a.map(|c| -7 * c)), "{of:?}");
                assert!(of.iter().all(|&b| lattice.contains(difference(a.map(|c| 3 * c), b))), "{of:?}");
            }
            for _ in 0..40 {
                let wanted = vector();
                if is_small_sum(&of, wanted) {
                    assert!(lattice.contains(wanted), "{wanted:?} of {of:?}");
                }
            }
            // In the other direction: every row is a sum, since the rows have the determinant of any basis of the same.
            let volume = |v: &[Displacement]| match v {
                [a, b, c] => {
                    (0..3).map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3])).sum()
                }
                _ => 0_i64,
            };
            let rows: Vec<Displacement> = lattice.rows.into_iter().flatten().collect();
            if volume(&of) != 0 {
                assert_eq!(volume(&of).abs(), volume(&rows), "{of:?}");
            }
        }
    }

    #[test]
    fn in_one_dimension_it_is_the_greatest_common_divisor() {
        let mut lattice = Lattice::default();
        assert!(lattice.contains([0; 3]) && !lattice.contains([1, 0, 0]));
        for step in [12, -18, 30] {
            lattice.insert([0, step, 0]);
        }
        assert!((-40..40).all(|x| lattice.contains([0, x, 0]) == (x % 6 == 0)));
        assert!(!lattice.contains([1, 6, 0]) && !lattice.contains([0, 6, 1]));
    }
}
