//! Angles that are meant to be whole numbers of something.

/// Micro-degrees in a degree.
pub(super) const MICRO: f64 = 1e6;

/// How far from a whole number of steps an angle may be: steps and angles written
/// with six decimals.
const ON_STEP: f64 = 1e-5;

/// Most steps from 0: far more than any joint has, and exact in every computation.
const MOST: f64 = 1e6;

/// How many steps make an angle, both in degrees; `None` where no whole number does.
pub(super) fn steps(degrees: f64, step: f64) -> Option<i32> {
    let steps = degrees / step;
    let whole = steps.round();
    ((steps - whole).abs() <= ON_STEP && whole.abs() <= MOST).then_some(whole as i32)
}

#[cfg(test)]
mod tests {
    use super::steps;

    #[test]
    fn only_whole_steps_count() {
        assert_eq!(steps(-90.0, 22.5), Some(-4));
        assert_eq!(steps(51.428571, 360.0 / 7.0), Some(1));
        assert_eq!(steps(50.0, 360.0 / 7.0), None);
        assert_eq!(steps(1e300, 1e-300), None);
        assert_eq!(steps(0.0, 5e-324), Some(0));
    }
}
