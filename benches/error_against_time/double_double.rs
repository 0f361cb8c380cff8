//! Numbers of two `f64` (106 bits, 32 decimal digits) that a solver can be run with.
//!
//! Sums, products, quotients and square roots are those of Dekker (1971) and Knuth as
//! collected by Hida, Li and Bailey (2001). What a second-order cone solver does
//! not use has the accuracy of `f64` only.

use std::cmp::Ordering;
use std::fmt;
use std::num::FpCategory;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Sub, SubAssign};

use num_traits::{Float, FloatConst, FromPrimitive, Num, NumCast, One, ToPrimitive, Zero};

/// The unevaluated sum of two numbers, the second at most half a unit in the
/// last place of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b` exactly, where `|a| >= |b|`. What is not finite stays a plain number.
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: if high.is_finite() { b - (high - a) } else { 0.0 } }
}

/// `a + b` exactly.
fn sum(a: f64, b: f64) -> DoubleDouble {
    if a.abs() >= b.abs() { ordered_sum(a, b) } else { ordered_sum(b, a) }
}

/// `a b` exactly.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble { high, low: if high.is_finite() { a.mul_add(b, -high) } else { 0.0 } }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl From<DoubleDouble> for f64 {
    fn from(value: DoubleDouble) -> Self {
        value.high
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let once = ordered_sum(high.high, high.low + low.high);
        ordered_sum(once.high, once.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let main = product(self.high, other.high);
        ordered_sum(main.high, main.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        if !first.is_finite() || !other.high.is_finite() {
            return first.into();
        }
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let last = (rest - other * second.into()).high / other.high;
        ordered_sum(first, second) + last.into()
    }
}

impl Rem for DoubleDouble {
    type Output = Self;
    fn rem(self, other: Self) -> Self {
        self - (self / other).trunc() * other
    }
}

macro_rules! assigning {
    ($($operator:ident $method:ident $by:ident),*) => {$(
        impl $operator for DoubleDouble {
            fn $method(&mut self, other: Self) {
                *self = self.$by(other);
            }
        }
    )*};
}

assigning!(AddAssign add_assign add, SubAssign sub_assign sub, MulAssign mul_assign mul, DivAssign div_assign div,
    RemAssign rem_assign rem);

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            decided => decided,
        }
    }
}

impl fmt::Display for DoubleDouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.high, f)
    }
}

impl fmt::LowerExp for DoubleDouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::LowerExp::fmt(&self.high, f)
    }
}

impl Zero for DoubleDouble {
    fn zero() -> Self {
        0.0.into()
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for DoubleDouble {
    fn one() -> Self {
        1.0.into()
    }
}

impl Num for DoubleDouble {
    type FromStrRadixErr = <f64 as Num>::FromStrRadixErr;

    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        f64::from_str_radix(text, radix).map(Into::into)
    }
}

impl ToPrimitive for DoubleDouble {
    fn to_i64(&self) -> Option<i64> {
        self.high.to_i64()
    }

    fn to_u64(&self) -> Option<u64> {
        self.high.to_u64()
    }

    fn to_f64(&self) -> Option<f64> {
        Some((*self).into())
    }
}

impl NumCast for DoubleDouble {
    fn from<T: ToPrimitive>(value: T) -> Option<Self> {
        value.to_f64().map(Into::into)
    }
}

impl FromPrimitive for DoubleDouble {
    fn from_i64(value: i64) -> Option<Self> {
        Some((value as f64).into())
    }

    fn from_u64(value: u64) -> Option<Self> {
        Some((value as f64).into())
    }

    fn from_f64(value: f64) -> Option<Self> {
        Some(value.into())
    }
}

macro_rules! as_f64 {
    (constants of $source:ident: $($name:ident)*) => {
        $(fn $name() -> Self { <f64 as $source>::$name().into() })*
    };
    (properties $($name:ident)*) => {
        $(fn $name(self) -> bool { Float::$name(self.high) })*
    };
    (functions $($name:ident)*) => {
        $(fn $name(self) -> Self { Float::$name(self.high).into() })*
    };
    (pairings $($name:ident)*) => {
        $(fn $name(self, other: Self) -> Self { Float::$name(self.high, other.high).into() })*
    };
}

impl FloatConst for DoubleDouble {
    as_f64!(constants of FloatConst: E FRAC_1_PI FRAC_1_SQRT_2 FRAC_2_PI FRAC_2_SQRT_PI FRAC_PI_2 FRAC_PI_3
        FRAC_PI_4 FRAC_PI_6 FRAC_PI_8 LN_10 LN_2 LOG10_E LOG2_E PI SQRT_2);
}

impl Float for DoubleDouble {
    as_f64!(constants of Float: nan infinity neg_infinity neg_zero min_value min_positive_value max_value);
    as_f64!(properties is_nan is_infinite is_finite is_normal is_sign_positive is_sign_negative);
    as_f64!(functions floor ceil round trunc signum exp exp2 ln log2 log10 cbrt sin cos tan asin acos atan
        exp_m1 ln_1p sinh cosh tanh asinh acosh atanh);
    as_f64!(pairings powf log atan2);

    fn epsilon() -> Self {
        (f64::EPSILON * f64::EPSILON).into()
    }

    fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        if !(root > 0.0 && root.is_finite()) {
            return root.into();
        }
        // One Newton step doubles the digits.
        ordered_sum(root, (self - product(root, root)).high / (2.0 * root))
    }

    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    fn max(self, other: Self) -> Self {
        if self > other || other.is_nan() { self } else { other }
    }

    fn min(self, other: Self) -> Self {
        if self < other || other.is_nan() { self } else { other }
    }

    fn powi(self, exponent: i32) -> Self {
        let power = (0..exponent.unsigned_abs()).fold(Self::one(), |power, _| power * self);
        if exponent < 0 { power.recip() } else { power }
    }

    fn recip(self) -> Self {
        Self::one() / self
    }

    fn fract(self) -> Self {
        self - self.trunc()
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }

    fn abs_sub(self, other: Self) -> Self {
        (self - other).max(Self::zero())
    }

    fn hypot(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }

    fn classify(self) -> FpCategory {
        self.high.classify()
    }

    fn integer_decode(self) -> (u64, i16, i8) {
        Float::integer_decode(self.high)
    }
}
