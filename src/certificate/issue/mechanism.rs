//! Prepares the oracle's mechanism for the checker.

use crate::spatial::{Twist, Vec3};
use crate::statics::{Anchor, Structure};

use super::super::Mechanism;
use super::super::balance::movable;

/// Motions of a link, relative to the fastest, below which its two bodies count as
/// moving as one; tried in turn. The last two for a collapse alone: where the loads of
/// any motion without resistance do work, the motion need not be the fastest.
const AS_ONE: [f64; 6] = [1e-12, 1e-9, 1e-7, 0.0, 1e-5, 1e-3];

/// How much faster things open, relative to the fastest motion of a link; tried in turn,
/// the last three for a collapse alone.
const OPENING: [f64; 10] = [0.0, 4e-15, 1e-13, 1e-11, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3, 1e-2];

/// Mechanisms near the given one (a twist per body, of its centre of mass), the
/// nearest first.
pub(super) fn prepare<'s>(
    structure: &'s Structure,
    twists: &'s [Twist],
    collapse: bool,
) -> impl Iterator<Item = Mechanism> + 's {
    let links = links(structure);
    let (as_one, opening) = if collapse { (&AS_ONE[..], &OPENING[..]) } else { (&AS_ONE[..4], &OPENING[..7]) };
    as_one.iter().flat_map(move |threshold| {
        let grouped = Grouped::new(structure, twists, &links, *threshold);
        opening.iter().map(move |opening| grouped.opened(*opening))
    })
}

/// A connection or contact: its child or body first, where it is, and the direction in
/// W in which the first side moves away from the second.
struct Link {
    ends: [Option<usize>; 2],
    at: Vec3,
    away: Vec3,
}

fn links(structure: &Structure) -> Vec<Link> {
    let ends = |a: Anchor, b: Anchor| [movable(structure, a), movable(structure, b)];
    let connections = structure.connections.iter().map(|connection| Link {
        ends: ends(connection.child, connection.parent),
        at: connection.frame.translation.vector,
        away: connection.frame.rotation * Vec3::z(),
    });
    let contacts = structure.contacts.iter().map(|contact| Link {
        ends: ends(Anchor::Body(contact.body), contact.against),
        at: contact.position,
        away: contact.normal,
    });
    connections.chain(contacts).collect()
}

/// Bodies that move as one, with the twist of each group about one point.
struct Grouped {
    about: Vec3,
    /// Group of each body; group 0 stays at rest.
    group: Vec<usize>,
    twists: Vec<Twist>,
    /// Translation of each group by which it moves away from what it hangs from.
    away: Vec<Vec3>,
    /// Speed of the fastest link.
    fastest: f64,
}

impl Grouped {
    fn new(structure: &Structure, twists: &[Twist], links: &[Link], threshold: f64) -> Self {
        let velocity = |end: Option<usize>, at: &Vec3| {
            end.map_or(Twist::ZERO, |body| twists[body].moved(&(at - structure.bodies[body].com)))
        };
        let motion = |link: &Link| {
            let [a, b] = link.ends.map(|end| velocity(end, &link.at));
            let reach = link.ends.into_iter().flatten().map(|body| (link.at - structure.bodies[body].com).norm());
            (a.linear - b.linear).norm() + (a.angular - b.angular).norm() * reach.fold(0.0, f64::max)
        };
        let motions: Vec<f64> = links.iter().map(motion).collect();
        let fastest = motions.iter().copied().fold(0.0, f64::max);
        let moves = |index: usize| motions[index] > threshold * fastest;
        let about = (0..links.len()).filter(|index| motions[*index] == fastest).map(|index| links[index].at).next();
        let about = about.unwrap_or_default();

        let group = groups(structure, links, &moves);
        let count = group.iter().copied().max().unwrap_or(0) + 1;
        let mut group_twists = vec![None; count];
        group_twists[0] = Some(Twist::ZERO);
        for (body, group) in group.iter().enumerate() {
            let arm = about - structure.bodies[body].com;
            group_twists[*group].get_or_insert_with(|| twists[body].moved(&arm));
        }
        let twists = group_twists.into_iter().map(|twist| twist.unwrap_or(Twist::ZERO)).collect();
        let away = explosion(links, &group, count);
        Self { about, group, twists, away, fastest }
    }

    /// The mechanism with every group moving away from what it hangs from.
    fn opened(&self, opening: f64) -> Mechanism {
        let twist = |group: &usize| {
            let twist = &self.twists[*group];
            Twist::new(twist.linear + self.away[*group] * (opening * self.fastest), twist.angular)
        };
        Mechanism { about: self.about, twists: self.group.iter().map(twist).collect() }
    }
}

/// Numbers the sets of bodies that links without motion join; 0 is what the ground holds.
fn groups(structure: &Structure, links: &[Link], moves: &dyn Fn(usize) -> bool) -> Vec<usize> {
    let count = structure.bodies.len();
    let mut neighbours = vec![Vec::new(); count + 1];
    let slot = |end: Option<usize>| end.map_or(0, |body| body + 1);
    for (_, link) in links.iter().enumerate().filter(|(index, _)| !moves(*index)) {
        let [a, b] = link.ends.map(slot);
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    let mut group = vec![usize::MAX; count + 1];
    for (body, data) in structure.bodies.iter().enumerate() {
        if data.fixed {
            group[body + 1] = 0;
        }
    }
    let mut next = 0;
    for start in 0..=count {
        if group[start] != usize::MAX {
            continue;
        }
        group[start] = next;
        let mut waiting = vec![start];
        while let Some(here) = waiting.pop() {
            for &other in &neighbours[here] {
                if group[other] == usize::MAX {
                    group[other] = next;
                    waiting.push(other);
                }
            }
        }
        next += 1;
    }
    group.split_off(1)
}

/// A translation for each group by which it moves away from the groups between it and
/// the ground: opens most of what may open.
fn explosion(links: &[Link], group: &[usize], count: usize) -> Vec<Vec3> {
    let of = |end: Option<usize>| end.map_or(0, |body| group[body]);
    let mut neighbours = vec![Vec::new(); count];
    for link in links {
        let [a, b] = link.ends.map(of);
        if a != b {
            neighbours[a].push((b, -link.away));
            neighbours[b].push((a, link.away));
        }
    }
    let mut away = vec![None; count];
    for start in 0..count {
        if away[start].is_some() {
            continue;
        }
        away[start] = Some(Vec3::zeros());
        let mut order = vec![start];
        let mut next = 0;
        while next < order.len() {
            let here = order[next];
            next += 1;
            let base = away[here].unwrap_or_default();
            let mut pushed: Vec<(usize, Vec3)> = Vec::new();
            for &(other, direction) in &neighbours[here] {
                if away[other].is_none() {
                    match pushed.iter_mut().find(|(group, _)| *group == other) {
                        Some((_, sum)) => *sum += direction,
                        None => pushed.push((other, direction)),
                    }
                }
            }
            for (other, direction) in pushed {
                away[other] = Some(base + direction.try_normalize(1e-9).unwrap_or_default());
                order.push(other);
            }
        }
    }
    away.into_iter().map(Option::unwrap_or_default).collect()
}
