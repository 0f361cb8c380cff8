//! The checker's arithmetic against exact arithmetic.
//!
//! Sums, products, quotients and roots of doubles are compared with their exact
//! values, of which rounding errors are computed without error: for a sum by Knuth's
//! two-sum, for the others by a fused multiplication and addition.

use crate::random::Random;
use steadfast::certificate::interval::{Axes, Interval, Vector, length};
use steadfast::spatial::Vec3;

const ROUNDS: usize = 200_000;

/// Any number within 60 decades, or a round one.
fn number(random: &mut Random) -> f64 {
    let size = match random.below(8) {
        0 => return 0.0,
        1 => random.below(5) as f64,
        2 => random.decade(1e-30, 1e30),
        _ => random.decade(1e-3, 1e3),
    };
    if random.chance(0.5) { -size } else { size }
}

/// An interval and a number in it.
fn held(random: &mut Random) -> (Interval, f64) {
    let (a, b) = (number(random), number(random));
    let width = if random.chance(0.5) { 0.0 } else { b.abs() };
    let interval = Interval { lower: a, upper: a + width };
    let inside = [interval.lower, interval.upper, f64::midpoint(interval.lower, interval.upper)][random.below(3)];
    (interval, inside)
}

/// Exact rounding error of `a + b` (Knuth 1969).
fn error_of_sum(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let other = sum - a;
    (a - (sum - other)) + (b - other)
}

#[test]
fn sums_hold_the_exact_sum() {
    let mut random = Random::new(1);
    for _ in 0..ROUNDS {
        let ((x, a), (y, b)) = (held(&mut random), held(&mut random));
        let (found, sum, error) = (x + y, a + b, error_of_sum(a, b));
        // Next to the sum the differences are exact.
        assert!(found.lower - sum <= error && error <= found.upper - sum, "{a:e} + {b:e} in {found:?}");
        let (found, sum, error) = (x - y, a - b, error_of_sum(a, -b));
        assert!(found.lower - sum <= error && error <= found.upper - sum, "{a:e} - {b:e} in {found:?}");
    }
}

#[test]
fn products_and_squares_hold_the_exact_product() {
    let mut random = Random::new(2);
    for _ in 0..ROUNDS {
        let ((x, a), (y, b)) = (held(&mut random), held(&mut random));
        // The sign of a*b - end, rounded once, is exact.
        let inside =
            |found: Interval, a: f64, b: f64| a.mul_add(b, -found.lower) >= 0.0 && a.mul_add(b, -found.upper) <= 0.0;
        assert!(inside(x * y, a, b), "{a:e} * {b:e} in {:?}", x * y);
        assert!(inside(x.square(), a, a) && x.square().lower >= 0.0, "{a:e} squared in {:?}", x.square());
    }
}

#[test]
fn quotients_hold_the_exact_quotient() {
    let mut random = Random::new(3);
    for _ in 0..ROUNDS {
        let ((x, a), (y, b)) = (held(&mut random), held(&mut random));
        let found = x / y;
        if b == 0.0 || (y.lower <= 0.0 && y.upper >= 0.0) {
            assert_eq!(found, Interval::ALL, "nothing is known of {a:e} / {b:e}");
            continue;
        }
        // end <= a / b exactly if end * b <= a, for positive b.
        let (a, b) = if b < 0.0 { (-a, -b) } else { (a, b) };
        let holds = found.lower.mul_add(b, -a) <= 0.0 && found.upper.mul_add(b, -a) >= 0.0;
        assert!(holds, "{a:e} / {b:e} in {found:?}");
    }
}

#[test]
fn roots_hold_the_exact_root() {
    let mut random = Random::new(4);
    for _ in 0..ROUNDS {
        let (x, a) = held(&mut random);
        let (found, a) = (x.sqrt(), a.max(0.0));
        let holds = found.lower.mul_add(found.lower, -a) <= 0.0 && found.upper.mul_add(found.upper, -a) >= 0.0;
        assert!(found.lower >= 0.0 && holds, "root of {a:e} in {found:?}");
    }
}

#[test]
fn results_are_tight() {
    let mut random = Random::new(5);
    for _ in 0..ROUNDS {
        let (a, b) = (number(&mut random), number(&mut random));
        let (x, y) = (Interval::exact(a), Interval::exact(b));
        let tight = |found: Interval| found.upper - found.lower <= 4.0 * f64::EPSILON * found.magnitude() + 1e-300;
        assert!(tight(x + y) && tight(x * y) && tight(x.sqrt()) && (b == 0.0 || tight(x / y)), "{a:e}, {b:e}");
    }
}

#[test]
fn what_is_no_number_proves_nothing() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Interval::exact(bad), Interval::ALL);
    }
    let (one, all) = (Interval::exact(1.0), Interval::ALL);
    let infinite = Interval { lower: f64::INFINITY, upper: f64::INFINITY };
    for found in [all + one, all - all, all * one, all * all, infinite - infinite, infinite * infinite - all] {
        assert_eq!(found, Interval::ALL);
    }
    assert!(length(&[all, one]).upper == f64::INFINITY && length(&[all, one]).lower <= 1.0);
    let largest = Interval::exact(f64::MAX);
    assert!((largest + largest).lower <= f64::MAX && (largest + largest).upper == f64::INFINITY);
}

#[test]
fn nothing_stays_nothing() {
    let x = Interval::exact(0.1);
    assert_eq!((x * Interval::ZERO, Interval::ZERO / x), (Interval::ZERO, Interval::ZERO));
    assert_eq!((x + Interval::ZERO, Interval::ZERO.sqrt()), (x, Interval::ZERO));
}

/// Axes hold those of the rotation, and undo themselves.
#[test]
fn axes_turn_vectors_as_rotations_do() {
    let mut random = Random::new(6);
    for _ in 0..2_000 {
        let (rotation, v) = (random.rotation(), random.vector());
        let axes = Axes::of(&rotation);
        let (there, expected) = (axes.to_world(&Vector::exact(&v)), rotation * v);
        let near = |found: &Vector, v: &Vec3| {
            let parts = [(found.x, v.x), (found.y, v.y), (found.z, v.z)];
            parts.iter().all(|(x, v)| x.upper - x.lower < 1e-14 && (f64::midpoint(x.lower, x.upper) - v).abs() < 1e-14)
        };
        assert!(near(&there, &expected), "{there:?} {expected:?}");
        let back = axes.to_local(&there);
        let holds = |x: Interval, v: f64| x.lower <= v && v <= x.upper && x.upper - x.lower < 1e-13;
        assert!(holds(back.x, v.x) && holds(back.y, v.y) && holds(back.z, v.z), "{back:?} {v:?}");
    }
}
