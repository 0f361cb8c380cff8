//! The families of stiff and extreme structures, and which of their members are
//! tested.

use crate::families::{
    Measures, cantilever, cantilever_loop, chain, clamped, hang, incline, ladder, ladder_frame, lognormal, measured,
    off_centre, overhang, pins, resting, row, scaled_to, seesaw, series, sheared, slab, towed, tripod, turned,
    two_chains,
};
use steadfast::statics::Structure;

/// How long a member takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Belongs to every run.
    Small,
    /// Only when asked for.
    Large,
}

/// A structure and its utilisation, infinite where no strength helps.
pub type Known = (Structure, f64);

/// One structure of a family.
pub struct Member {
    pub family: &'static str,
    pub name: String,
    pub size: Size,
    /// Whether the bracket is as narrow as users are promised: not where the data
    /// themselves are at the edge of what numbers can say.
    pub narrow: bool,
    pub make: Box<dyn Fn() -> Known + Send + Sync>,
}

/// Collects a family's members.
struct Family<'m> {
    name: &'static str,
    members: &'m mut Vec<Member>,
}

impl Family<'_> {
    fn add(&mut self, name: impl Into<String>, make: impl Fn() -> Known + Send + Sync + 'static) {
        self.sized(Size::Small, name, make);
    }

    fn sized(&mut self, size: Size, name: impl Into<String>, make: impl Fn() -> Known + Send + Sync + 'static) {
        let (family, name, make) = (self.name, name.into(), Box::new(make));
        self.members.push(Member { family, name, size, narrow: true, make });
    }

    /// One whose bracket need not be narrow unless `narrow`.
    fn add_if_narrow(
        &mut self,
        narrow: bool,
        name: impl Into<String>,
        make: impl Fn() -> Known + Send + Sync + 'static,
    ) {
        let (family, name, make) = (self.name, name.into(), Box::new(make));
        self.members.push(Member { family, name, size: Size::Small, narrow, make });
    }
}

type Fill = fn(&mut Family<'_>);

/// Every member of every family.
pub fn all() -> Vec<Member> {
    let mut members = Vec::new();
    let families: [(&'static str, Fill); 14] = [
        ("serial", serial),
        ("parallel", parallel),
        ("loops", loops),
        ("masses", masses),
        ("strengths", strengths),
        ("radii", radii),
        ("friction", friction),
        ("micro and giga", micro_and_giga),
        ("units", units),
        ("supports", supports),
        ("knife edges", knife_edges),
        ("rest", rest),
        ("redundant", redundant),
        ("log-normal", log_normal),
    ];
    for (name, fill) in families {
        fill(&mut Family { name, members: &mut members });
    }
    members
}

/// `Large` where `count` is above `limit`.
fn sized(count: usize, limit: usize) -> Size {
    if count > limit { Size::Large } else { Size::Small }
}

/// Serial chains to 100 000 modules.
fn serial(family: &mut Family<'_>) {
    for count in [1, 2, 10, 1000, 10_000, 100_000] {
        family.add(format!("cantilever {count}"), move || cantilever(count));
        family.add(format!("hanging {count}"), move || chain(&vec![0.5; count], &vec![1e3; count]));
        family.add(format!("hanging {count}, turned"), move || turned(chain(&vec![0.5; count], &vec![1e3; count]), 5));
    }
}

/// Two hanging chains with a common base, to 2 x 10 000.
fn parallel(family: &mut Family<'_>) {
    for count in [1, 10, 100, 300, 1000, 3000, 10_000] {
        let size = sized(count, PARALLEL);
        family.sized(size, format!("chains 2 x {count}"), move || two_chains(count, [0.4, 0.4], 1.0, 1000.0));
        family.sized(size, format!("chains 2 x {count}, turned"), move || {
            turned(two_chains(count, [0.4, 0.4], 1.0, 1000.0), 6)
        });
    }
}

const PARALLEL: usize = 3000;

/// Long cantilevers closed to a loop.
fn loops(family: &mut Family<'_>) {
    for count in [1, 3, 10, 30, 100, 300, 1000, 3000] {
        let size = sized(count, LOOPS);
        family.sized(size, format!("cantilever loop 2 x {count}"), move || cantilever_loop(count));
        family.sized(size, format!("cantilever loop 2 x {count}, turned"), move || turned(cantilever_loop(count), 7));
    }
    for count in [1, 2, 10, 30, 100] {
        family.add(format!("clamped {count}"), move || clamped(count));
    }
}

const LOOPS: usize = 1000;

/// Mass ratios of 1e6, 1e9 and 1e12.
fn masses(family: &mut Family<'_>) {
    for ratio in [1e3, 1e6, 1e9, 1e12] {
        family.add(format!("heavy over light {ratio:e}"), move || series([ratio, 1.0], [ratio, 20.0]));
        family.add(format!("light over heavy {ratio:e}"), move || series([1.0, ratio], [ratio, 20.0 * ratio]));
        for count in [1, 10, 50] {
            let chains = move |masses, base| scaled_to(two_chains(count, masses, base, 1.0), 0.7);
            family.add(format!("in turn {ratio:e}, 2 x {count}"), move || chains([1.0, ratio], 1.0));
            family.add(format!("heavy base {ratio:e}, 2 x {count}"), move || chains([1.0, 1.0], ratio));
            family.add(format!("light base {ratio:e}, 2 x {count}"), move || chains([1.0, 1.0], 1.0 / ratio));
        }
        family.add(format!("heavier downwards {ratio:e}"), move || {
            let masses: Vec<f64> = (0..=12).map(|i| ratio.powf(f64::from(i) / 12.0)).collect();
            scaled_to(ladder_frame(&masses, &[1.0; 13]), 1.3)
        });
        family.add(format!("lighter downwards {ratio:e}"), move || {
            let masses: Vec<f64> = (0..=12).map(|i| ratio.powf(-f64::from(i) / 12.0)).collect();
            scaled_to(ladder_frame(&masses, &[1.0; 13]), 1.3)
        });
    }
    family.add("weightless base", || two_chains(30, [1.0, 1.0], 0.0, 400.0));
    family.add("weightless in turn", || two_chains(30, [0.0, 1.0], 1.0, 400.0));
}

/// Strengths over 1e6 and 1e12 in one scene.
fn strengths(family: &mut Family<'_>) {
    for decades in [3, 6, 9, 12] {
        let graded = move |count: i32, sign: f64| -> Vec<f64> {
            (0..count).map(|i| 10_f64.powf(sign * f64::from(decades) * f64::from(i) / f64::from(count - 1))).collect()
        };
        for count in [2, 5, 13] {
            family.add(format!("row of {count} pairs over 1e{decades}"), move || {
                scaled_to(row(1.0, &graded(count, 1.0)), 0.9)
            });
            family.add(format!("stronger downwards, {count} over 1e{decades}"), move || {
                let masses = vec![1.0; count as usize];
                scaled_to(ladder_frame(&masses, &graded(count, 1.0)), 0.9)
            });
            family.add(format!("weaker downwards, {count} over 1e{decades}"), move || {
                let masses = vec![1.0; count as usize];
                scaled_to(ladder_frame(&masses, &graded(count, -1.0)), 1.2)
            });
        }
        family.add(format!("series over 1e{decades}"), move || {
            series([1.0, 10_f64.powi(-decades)], [20.0, 20.0 * 10_f64.powi(-decades)])
        });
    }
}

/// Radii down to 1e-6 m.
fn radii(family: &mut Family<'_>) {
    for radius in [1e-1, 1e-3, 1e-6, 1e-9] {
        for offset in [0.0, 0.02, 0.08, 0.2] {
            family.add(format!("off centre {offset}, radius {radius:e}"), move || off_centre(offset, radius));
        }
        family.add(format!("off centre 0.05, radius {radius:e}, turned"), move || turned(off_centre(0.05, radius), 8));
    }
}

/// Friction of 0, 1e-6 and 1e3 and what lies between.
fn friction(family: &mut Family<'_>) {
    for mu in [1e-6, 1e-3, 0.1, 0.5, 1.2, 10.0, 1e3] {
        let limit = f64::atan(mu).to_degrees();
        // Directions are meant up to 1e-12.
        for off in [1e-2, 1e-4, 1e-6].into_iter().filter(|off| off * mu / (1.0 + mu * mu) > 1e-11) {
            family.add(format!("incline {mu:e}, {off:e} below"), move || incline(mu, limit * (1.0 - off)));
            // Above a limit of nearly 90 degrees there is only the overhanging side.
            if limit * (1.0 + off) < 90.0 {
                family.add(format!("incline {mu:e}, {off:e} above"), move || incline(mu, limit * (1.0 + off)));
            }
        }
        family.add(format!("sheared {mu:e}"), move || sheared(mu));
        // Across the axes such a magnet holds a millionth of what it holds along them.
        family.add_if_narrow(mu >= 0.1, format!("sheared {mu:e}, turned"), move || turned(sheared(mu), 9));
    }
    for mu in [0.1, 0.5, 2.0] {
        let limit = f64::atan(0.5 / mu).to_degrees();
        for off in [1e-2, 1e-4, 1e-6] {
            family.add(format!("ladder {mu}, {off:e} above"), move || ladder(mu, limit * (1.0 + off)));
            family.add(format!("ladder {mu}, {off:e} below"), move || ladder(mu, limit * (1.0 - off)));
        }
    }
    for mu in [0.0, 1e-6, 0.4, 1.0, 1e3] {
        for pull in [0.3, 0.9, 2.0] {
            family.add(format!("towed {pull}, friction {mu:e}"), move || towed(mu, pull));
            family.add(format!("towed {pull}, friction {mu:e}, turned"), move || turned(towed(mu, pull), 10));
        }
        family.add(format!("seesaw, friction {mu:e}"), move || seesaw(1.0, 0.05, 0.2, mu));
        family.add(format!("seesaw, friction {mu:e}, turned"), move || turned(seesaw(1.0, 0.05, 0.2, mu), 11));
    }
}

type Sample = (&'static str, fn() -> Known);

/// One of every sort, for families that only change the measures.
fn samples() -> Vec<Sample> {
    vec![
        ("cantilever", || cantilever(12)),
        ("cantilever loop", || cantilever_loop(8)),
        ("chains", || two_chains(10, [0.4, 0.4], 1.0, 100.0)),
        ("off centre", || off_centre(0.05, 0.02)),
        ("seesaw", || seesaw(1.0, 0.05, 0.2, 0.5)),
        ("towed", || towed(0.4, 0.9)),
        ("pins", || pins(0.1, 0.4)),
        ("slab", || slab(4, 1)),
        ("ladder standing", || ladder(0.5, 50.0)),
        ("ladder falling", || ladder(0.5, 40.0)),
        ("stack standing", || overhang(6, 0.99)),
        ("stack falling", || overhang(6, 1.01)),
    ]
}

/// From 1e-9 kg and micrometres to 1e9 kg and kilometres.
fn micro_and_giga(family: &mut Family<'_>) {
    for (scale, length, mass) in [("micro", 1e-5, 1e-9), ("giga", 1e4, 1e9), ("dense", 1e-5, 1e3), ("thin", 1e4, 1e-3)]
    {
        for (name, sample) in samples() {
            let measures = Measures { length, mass, strength: mass };
            family.add(format!("{scale} {name}"), move || measured(sample(), &measures));
            family.add(format!("{scale} {name}, turned"), move || turned(measured(sample(), &measures), 12));
        }
    }
}

/// Millimetres, grams or kilonewtons taken for SI units, and all of them.
fn units(family: &mut Family<'_>) {
    for (unit, [length, mass, strength]) in [
        ("mm", [1e3, 1.0, 1.0]),
        ("g", [1.0, 1e3, 1.0]),
        ("t", [1.0, 1e-3, 1.0]),
        ("kN", [1.0, 1.0, 1e-3]),
        ("mN", [1.0, 1.0, 1e3]),
        ("mm, g and mN", [1e3, 1e3, 1e3]),
        ("km, t and kN", [1e-3, 1e-3, 1e-3]),
        ("mm, g and kN", [1e3, 1e3, 1e-3]),
    ] {
        for (name, sample) in samples() {
            family.add(format!("{name} in {unit}"), move || measured(sample(), &Measures { length, mass, strength }));
        }
    }
}

/// Three supports nearly in line.
fn supports(family: &mut Family<'_>) {
    for depth in [1e-1, 1e-3, 1e-6, 1e-9] {
        for share in [0.0, 1e-3, 0.3, 0.999, 1.0, 1.001, -0.001, 5.0] {
            // A nanometre in 0.2 m is at the edge: a share in the middle stays undecided.
            let size = if depth < 1e-6 && share == 0.3 { Size::Large } else { Size::Small };
            family.sized(size, format!("tripod {depth:e}, {share}"), move || tripod(depth, share));
            family.add_if_narrow(depth >= 1e-6, format!("pins {depth:e}, {share}"), move || pins(depth, share));
        }
        family.add(format!("seesaw {depth:e}"), move || seesaw(1.0, depth, 0.2, 0.5));
        family.add_if_narrow(depth >= 1e-6, format!("seesaw {depth:e} by {depth:e}"), move || {
            seesaw(1.0 / depth, 0.1, depth, 0.5)
        });
    }
}

/// t within 1e-3, 1e-6 and 1e-9 of 1, on either side.
fn knife_edges(family: &mut Family<'_>) {
    for off in [1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, -1e-9, -1e-8, -1e-7, -1e-6, -1e-5, -1e-3] {
        for (name, sample) in samples().into_iter().take(8) {
            family.add(format!("{name} {off:e}"), move || scaled_to(sample(), 1.0 + off));
        }
        family.add(format!("hanging {off:e}"), move || scaled_to(hang(1.0, 1.0, 3), 1.0 + off));
    }
    for count in [2, 6, 20, 50] {
        for off in [1e-2, 1e-3, 1e-5, 1e-7] {
            family.add(format!("stack of {count}, {off:e} inside"), move || overhang(count, 1.0 - off));
            family.add(format!("stack of {count}, {off:e} outside"), move || overhang(count, 1.0 + off));
        }
    }
}

/// No gravity and no loads.
fn rest(family: &mut Family<'_>) {
    for (name, sample) in samples() {
        family.add(name, move || resting(sample()));
    }
    family.add("clamped", || resting(clamped(10)));
    family.add("adrift", || {
        let (mut structure, truth) = resting(slab(3, 1));
        structure.connections.clear();
        (structure, truth)
    });
}

/// Thousands of redundant connections.
fn redundant(family: &mut Family<'_>) {
    for count in [2, 20, 200, 2000, 5000] {
        family.add(format!("hanging by {count}"), move || hang(1.0, 20.0 / count as f64, count));
    }
    for (side, links) in [(2, 1), (4, 4), (8, 1), (6, 20), (4, 100)] {
        let size = sized(side, SLAB);
        family.sized(size, format!("slab {side} x {side}, {links} links"), move || slab(side, links));
        family
            .sized(size, format!("slab {side} x {side}, {links} links, turned"), move || turned(slab(side, links), 13));
    }
    family.add("slab 20 x 20, 3 links", || slab(20, 3));
}

const SLAB: usize = 8;

/// Masses and strengths log-normal with deviation 3.
fn log_normal(family: &mut Family<'_>) {
    for seed in 0..20 {
        family.add(format!("chain of 1000, {seed}"), move || {
            chain(&lognormal(1000, 1.0, 3.0, seed), &lognormal(1000, 1e5, 3.0, seed + 100))
        });
        family
            .add(format!("row of 20 pairs, {seed}"), move || scaled_to(row(1.0, &lognormal(20, 1.0, 3.0, seed)), 0.8));
        for count in [5, 40] {
            family.add(format!("frame of {count}, {seed}"), move || {
                let masses = lognormal(count, 1.0, 3.0, seed);
                scaled_to(ladder_frame(&masses, &lognormal(count, 1.0, 3.0, seed + 200)), 1.1)
            });
        }
    }
}
