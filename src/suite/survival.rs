//! Times of runs some of which were cut off.
//!
//! A run that was ended at 30 s would have taken at least 30 s: leaving it out, or counting it as 30 s, makes a planner
//! look faster than it is. The product-limit estimator (E. L. Kaplan, P. Meier: "Nonparametric estimation from
//! incomplete observations", J. Amer. Statist. Assoc. 53 (1958), 457-481) uses exactly what is known. It takes for
//! granted that a run's being cut off says nothing about how much longer it would have taken than others that were still
//! running; where all are cut off at one time limit nothing is taken for granted.

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// When it ended, in s.
    pub seconds: f64,
    /// Whether it ended by reaching what was waited for, rather than being cut off.
    pub reached: bool,
}

/// A step of the share of runs that have reached what was waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// From this time on, in s.
    pub seconds: f64,
    /// The share, from 0 to 1.
    pub share: f64,
}

/// The share of runs that have reached what was waited for, over time: a step at each time at which one did.
///
/// At a time t with d of the n runs that were not over before reaching it, the share that has not is multiplied by
/// 1 - d/n. Runs that are cut off at t count among the n.
pub fn reached_over_time(observations: &[Observation]) -> Vec<Step> {
    let mut sorted = observations.to_vec();
    sorted.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let mut left = 1.0;
    let mut steps: Vec<Step> = Vec::new();
    let mut index = 0;
    while index < sorted.len() {
        let seconds = sorted[index].seconds;
        let running = sorted.len() - index;
        let at_once = sorted[index..].iter().take_while(|other| other.seconds == seconds);
        let (together, reached) = at_once.fold((0, 0), |(all, reached), o| (all + 1, reached + usize::from(o.reached)));
        if reached > 0 {
            left *= 1.0 - reached as f64 / running as f64;
            steps.push(Step { seconds, share: 1.0 - left });
        }
        index += together;
    }
    steps
}

/// The time by which half of the runs have reached what was waited for; `None` where less than half ever did, so that
/// nothing is known about it but that it is longer than the limit.
pub fn median(observations: &[Observation]) -> Option<f64> {
    reached_over_time(observations).into_iter().find(|step| step.share >= 0.5 - 1e-12).map(|step| step.seconds)
}

/// The middle of some values, of an even number the lower one, so that it is one of them; infinite ones count.
/// `None` of none.
pub fn lower_median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied()
}

/// Interval that holds the probability behind `hits` of `tries` with 95 % confidence (E. B. Wilson: "Probable
/// inference, the law of succession, and statistical inference", J. Amer. Statist. Assoc. 22 (1927), 209-212). From 0 to
/// 1 without tries.
pub fn wilson(hits: usize, tries: usize) -> [f64; 2] {
    /// Quantile of the normal distribution that leaves 2.5 % above it.
    const Z: f64 = 1.959_963_984_540_054;
    if tries == 0 {
        return [0.0, 1.0];
    }
    let (n, p) = (tries as f64, hits as f64 / tries as f64);
    let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    [(centre - half).max(0.0), (centre + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observations(times: &[(f64, bool)]) -> Vec<Observation> {
        times.iter().map(|&(seconds, reached)| Observation { seconds, reached }).collect()
    }

    #[test]
    fn the_remission_times_of_the_textbooks() {
        // E. J. Freireich et al., Blood 21 (1963), the group under 6-mercaptopurine, with the estimate as it is
        // printed in D. R. Cox, D. Oakes: "Analysis of survival data" (1984), table 1.1 and section 4.2.
        let reached = [6.0, 6.0, 6.0, 7.0, 10.0, 13.0, 16.0, 22.0, 23.0];
        let cut_off = [6.0, 9.0, 10.0, 11.0, 17.0, 19.0, 20.0, 25.0, 32.0, 32.0, 34.0, 35.0];
        let all: Vec<_> = reached.map(|t| (t, true)).into_iter().chain(cut_off.map(|t| (t, false))).collect();
        let steps = reached_over_time(&observations(&all));
        let printed =
            [(6.0, 0.857), (7.0, 0.807), (10.0, 0.753), (13.0, 0.690), (16.0, 0.627), (22.0, 0.538), (23.0, 0.448)];
        assert_eq!(steps.len(), printed.len());
        for (step, (seconds, surviving)) in steps.iter().zip(printed) {
            assert_eq!(step.seconds, seconds);
            assert!((1.0 - step.share - surviving).abs() < 6e-4, "{step:?}");
        }
        assert_eq!(median(&observations(&all)), Some(23.0));
    }

    #[test]
    fn with_one_limit_it_is_the_share_that_is_solved() {
        let runs = observations(&[(1.0, true), (30.0, false), (2.0, true), (30.0, false)]);
        let steps = reached_over_time(&runs);
        assert_eq!(steps, [Step { seconds: 1.0, share: 0.25 }, Step { seconds: 2.0, share: 0.5 }]);
        assert_eq!(median(&runs), Some(2.0));
        // One more that is cut off, and less than half are solved: no median, not the mean of what is known.
        let more = observations(&[(1.0, true), (30.0, false), (2.0, true), (30.0, false), (30.0, false)]);
        assert_eq!(median(&more), None);
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn medians_of_plain_values_are_values() {
        assert_eq!(lower_median(&[]), None);
        assert_eq!(lower_median(&[3.0]), Some(3.0));
        assert_eq!(lower_median(&[f64::INFINITY, 1.0, 2.0]), Some(2.0));
        assert_eq!(lower_median(&[4.0, 1.0, f64::INFINITY, 2.0]), Some(2.0));
    }

    #[test]
    fn wilsons_interval() {
        // Worked by hand: p = 1/2, n = 10, z^2 = 3.8415: centre 0.5, half width
        // 1.96 / 1.38415 sqrt(0.025 + 0.0096037) = 0.26342.
        let [low, high] = wilson(5, 10);
        assert!((low - 0.23658).abs() < 2e-5 && (high - 0.76342).abs() < 2e-5, "{low} {high}");
        // All of 4: from 1 / (1 + z^2 / 4) = 0.51011.
        let [low, high] = wilson(4, 4);
        assert!((low - 0.51011).abs() < 2e-5 && high == 1.0, "{low} {high}");
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
