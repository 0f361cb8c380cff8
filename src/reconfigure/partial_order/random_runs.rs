//! Random runs of a plan that its order allows: when each action begins and ends.

use super::PartialOrder;

/// Small numbers that look random.
pub struct Draw(pub u64);

impl Draw {
    pub fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }

    pub fn share(&mut self) -> f64 {
        self.below(1 << 20) as f64 / f64::from(1 << 20)
    }
}

/// Whether one action has to wait for another, directly or not.
pub fn waits<T>(order: &PartialOrder<T>, action: usize, other: usize) -> bool {
    order.waits_for(action).iter().any(|&before| before == other || waits(order, before, other))
}

/// When each action of a plan begins and ends.
#[derive(Debug)]
pub struct Run {
    spans: Vec<[f64; 2]>,
}

impl Run {
    /// Actions take and wait as long as they please, but for what the order asks of them.
    pub fn random<T>(order: &PartialOrder<T>, actions: usize, draw: &mut Draw) -> Self {
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for action in 0..actions {
            let ready = order.waits_for(action).iter().map(|&before| spans[before][1]).fold(0.0, f64::max);
            let begin = ready + if draw.below(2) == 0 { 0.0 } else { draw.share() };
            spans.push([begin, begin + 0.05 + draw.share()]);
        }
        Self { spans }
    }

    /// Some moments until everything has ended.
    pub fn moments(&self, draw: &mut Draw) -> [f64; 8] {
        let end = self.spans.iter().map(|span| span[1]).fold(0.0, f64::max);
        [(); 8].map(|()| draw.share() * end)
    }

    /// The actions that count as done, in this order: releasing does when it begins, all else when it has ended.
    pub fn done(&self, now: f64, releases: impl Fn(usize) -> bool) -> Vec<usize> {
        let counts = |action: usize| self.spans[action][usize::from(!releases(action))];
        let mut done: Vec<usize> = (0..self.spans.len()).filter(|&action| counts(action) <= now).collect();
        done.sort_by(|&a, &b| counts(a).total_cmp(&counts(b)).then(a.cmp(&b)));
        done
    }

    /// The actions that have begun and not ended, each with the share of its time that is over.
    pub fn under_way(&self, now: f64) -> impl Iterator<Item = (usize, f64)> {
        let is_under_way = move |&(_, [begin, end]): &(usize, [f64; 2])| begin < now && now < end;
        let spans = self.spans.iter().copied().enumerate();
        spans.filter(is_under_way).map(move |(action, [begin, end])| (action, (now - begin) / (end - begin)))
    }
}
