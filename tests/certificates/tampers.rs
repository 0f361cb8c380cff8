//! Ways of making a certificate false: each makes a claim untrue or breaks a field
//! that the proof rests on. What would leave a valid proof (claiming less, a better
//! mechanism) is none of them.

use nalgebra::Unit;
use steadfast::certificate::{Carried, Certificate, check};
use steadfast::spatial::{Rotation, Twist, Vec3};
use steadfast::statics::{Anchor, Bracket, Load, Model, Verdict};

use crate::random::Random;

/// A way of tampering; `None` where a certificate has nothing of the kind.
pub type Tamper = fn(Certificate, &mut Random) -> Option<Certificate>;

/// Every way, with its name.
pub const ALL: [(&str, Tamper); 24] = [
    ("lower end raised", lower_raised),
    ("upper end lowered", upper_lowered),
    ("another verdict", another_verdict),
    ("another claim", another_claim),
    ("stress left out", stress_left_out),
    ("mechanism left out", mechanism_left_out),
    ("lists cut short", cut_short),
    ("connection force changed", connection_changed),
    ("contact force changed", contact_changed),
    ("twist changed", twist_changed),
    ("mechanism reversed", reversed),
    ("mechanism at rest", at_rest),
    ("loads scaled", loads_scaled),
    ("loads reversed", loads_reversed),
    ("load added", load_added),
    ("strengths lowered", strengths_lowered),
    ("strengths raised", strengths_raised),
    ("mass changed", mass_changed),
    ("centre of mass moved", com_moved),
    ("contact moved", contact_moved),
    ("friction lowered", friction_lowered),
    ("friction raised", friction_raised),
    ("connection moved", connection_moved),
    ("connection turned", connection_turned),
];

fn share(random: &mut Random) -> f64 {
    random.decade(1e-3, 1.0)
}

fn movable(c: &Certificate, anchor: Anchor) -> Option<usize> {
    match anchor {
        Anchor::Body(i) if !c.structure.bodies[i].fixed => Some(i),
        Anchor::Body(_) | Anchor::World => None,
    }
}

/// Largest extent of the structure in m.
fn size(c: &Certificate) -> f64 {
    let points = c.structure.bodies.iter().map(|body| body.com);
    let points = points.chain(c.structure.connections.iter().map(|connection| connection.frame.translation.vector));
    let points: Vec<Vec3> = points.chain(c.structure.contacts.iter().map(|contact| contact.position)).collect();
    points.iter().map(|p| (p - points[0]).norm()).fold(0.0, f64::max)
}

/// Net force in W that a connection carries.
fn carried(c: &Certificate, index: usize) -> Option<Vec3> {
    let local = match &c.stress.as_ref()?.connections[index] {
        Carried::Wrench(wrench) => wrench.force,
        Carried::Points { preload, forces } => forces.iter().sum::<Vec3>() - Vec3::z() * *preload,
    };
    Some(c.structure.connections[index].frame.rotation * local)
}

/// Largest force in N anywhere, in the fields or as a load.
fn largest_force(c: &Certificate) -> Option<f64> {
    let stress = c.stress.as_ref()?;
    let gravity = c.structure.gravity.norm();
    let loads = c.structure.bodies.iter().map(|body| body.mass * gravity);
    let loads = loads.chain(c.structure.loads.iter().map(|load| load.force.norm()));
    let carried = stress.connections.iter().flat_map(|carried| match carried {
        Carried::Wrench(wrench) => vec![wrench.force.norm()],
        Carried::Points { preload, forces } => forces.iter().map(Vec3::norm).chain([*preload]).collect(),
    });
    Some(loads.chain(carried).chain(stress.contacts.iter().map(Vec3::norm)).fold(0.0, f64::max))
}

/// A body that needs balance and weighs as much as most.
fn weighty(c: &Certificate, random: &mut Random) -> Option<usize> {
    let heaviest = c.structure.bodies.iter().map(|body| body.mass).fold(0.0, f64::max);
    let body = random.below(c.structure.bodies.len());
    let data = &c.structure.bodies[body];
    let loaded = c.structure.loads.iter().any(|load| load.body == body);
    (!data.fixed && data.mass > 0.1 * heaviest && c.structure.gravity.norm() > 0.0 && !loaded).then_some(body)
}

/// A vector of unit length at right angles to another one.
fn across(v: &Vec3, random: &mut Random) -> Option<Vec3> {
    v.cross(&random.vector()).try_normalize(1e-3 * v.norm())
}

fn lower_raised(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let lower = &mut c.utilisation.lower;
    *lower += random.decade(1e-9, 1.0) * lower.max(1.0);
    (c.verdict != Verdict::WholeBodyUnstable).then_some(c)
}

/// Below what the forces prove, which can be less than is claimed.
fn upper_lowered(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let proved = check(&c).ok()?.utilisation.upper;
    let upper = &mut c.utilisation.upper;
    let held = *upper > 0.0 && upper.is_finite();
    *upper = upper.min(proved) * (1.0 - random.decade(1e-12, 0.9));
    held.then_some(c)
}

fn another_verdict(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let all = [Verdict::Stable, Verdict::InternallyUnstable, Verdict::Undecided];
    let verdict = all[random.below(3)];
    let changed = c.verdict != verdict && c.verdict != Verdict::WholeBodyUnstable;
    c.verdict = verdict;
    changed.then_some(c)
}

/// A verdict with a bracket from which it follows, both false.
fn another_claim(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    (c.verdict, c.utilisation) = match c.verdict {
        Verdict::Stable if random.chance(0.5) => (Verdict::WholeBodyUnstable, Bracket::exact(f64::INFINITY)),
        Verdict::Stable => (Verdict::InternallyUnstable, Bracket::new(1.5, 2.0)),
        Verdict::InternallyUnstable | Verdict::WholeBodyUnstable | Verdict::Undecided => {
            (Verdict::Stable, Bracket::new(0.0, random.between(0.1, 0.9)))
        }
    };
    Some(c)
}

fn stress_left_out(mut c: Certificate, _: &mut Random) -> Option<Certificate> {
    (c.stress.take().is_some() && c.utilisation.upper.is_finite()).then_some(c)
}

fn mechanism_left_out(mut c: Certificate, _: &mut Random) -> Option<Certificate> {
    (c.mechanism.take().is_some() && c.utilisation.lower > 0.0).then_some(c)
}

fn cut_short(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let cut = match random.below(3) {
        0 => c.stress.as_mut()?.connections.pop().is_some(),
        1 => c.stress.as_mut()?.contacts.pop().is_some(),
        _ => c.mechanism.as_mut()?.twists.pop().is_some(),
    };
    cut.then_some(c)
}

fn connection_changed(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let amount = random.decade(1e-6, 1.0) * largest_force(&c)?;
    let lever = size(&c);
    let index = random.below(c.structure.connections.len().max(1));
    let connection = c.structure.connections.get(index)?;
    movable(&c, connection.parent).or(movable(&c, connection.child))?;
    let axis = random.below(3);
    match &mut c.stress.as_mut()?.connections[index] {
        Carried::Wrench(wrench) if random.chance(0.5) => wrench.torque[axis] += amount * lever,
        Carried::Wrench(wrench) => wrench.force[axis] -= amount,
        Carried::Points { preload, .. } if random.chance(0.3) => *preload += amount,
        Carried::Points { forces, .. } => {
            let point = random.below(forces.len());
            forces[point][axis] += amount;
        }
    }
    (amount > 0.0).then_some(c)
}

fn contact_changed(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let amount = random.decade(1e-6, 1.0) * largest_force(&c)?;
    let index = random.below(c.structure.contacts.len().max(1));
    let contact = c.structure.contacts.get(index)?;
    movable(&c, Anchor::Body(contact.body)).or(movable(&c, contact.against))?;
    c.stress.as_mut()?.contacts[index] += random.vector().try_normalize(0.1)? * amount;
    (amount > 0.0).then_some(c)
}

/// One body's motion changed so that a contact, a magnet or a face closes on it.
fn twist_changed(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let mechanism = c.mechanism.as_ref()?;
    let connections = c
        .structure
        .connections
        .iter()
        .filter(|connection| !matches!(c.structure.connectors[connection.connector].model, Model::Box { .. }));
    let connections =
        connections.map(|l| (l.child, l.parent, l.frame.translation.vector, l.frame.rotation * Vec3::z()));
    let contacts = c.structure.contacts.iter().map(|k| (Anchor::Body(k.body), k.against, k.position, k.normal));
    let links: Vec<_> = connections.chain(contacts).collect();
    let (first, second, at, away) = *links.get(random.below(links.len().max(1)))?;
    let velocity = |anchor: Anchor| {
        let twist = movable(&c, anchor).map_or(Twist::ZERO, |body| mechanism.twists[body]);
        twist.at(&(at - mechanism.about))
    };
    let fastest = mechanism.twists.iter().map(|twist| twist.at(&(at - mechanism.about)).norm()).fold(0.0, f64::max);
    let opening = (velocity(first) - velocity(second)).dot(&away).max(0.0);
    let change = away * (opening + random.decade(1e-6, 1.0) * fastest);
    let twists = &mut c.mechanism.as_mut()?.twists;
    match (first, second) {
        (Anchor::Body(body), _) if !c.structure.bodies[body].fixed => twists[body].linear -= change,
        (_, Anchor::Body(body)) if !c.structure.bodies[body].fixed => twists[body].linear += change,
        _ => return None,
    }
    (fastest > 0.0).then_some(c)
}

fn reversed(mut c: Certificate, _: &mut Random) -> Option<Certificate> {
    for twist in &mut c.mechanism.as_mut()?.twists {
        *twist = Twist::new(-twist.linear, -twist.angular);
    }
    Some(c)
}

fn at_rest(mut c: Certificate, _: &mut Random) -> Option<Certificate> {
    c.mechanism.as_mut()?.twists.fill(Twist::ZERO);
    Some(c)
}

fn loads_scaled(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let factor = 1.0 + share(random) * if random.chance(0.5) { 1.0 } else { -0.9 };
    let held = largest_force(&c)? > 0.0;
    c.structure.gravity *= factor;
    for load in &mut c.structure.loads {
        load.force *= factor;
        load.torque *= factor;
    }
    let weighs = c.structure.bodies.iter().any(|body| !body.fixed && body.mass > 0.0);
    (held && weighs && c.structure.gravity.norm() > 0.0).then_some(c)
}

fn loads_reversed(mut c: Certificate, _: &mut Random) -> Option<Certificate> {
    c.mechanism.as_ref()?;
    c.structure.gravity *= -1.0;
    for load in &mut c.structure.loads {
        load.force *= -1.0;
        load.torque *= -1.0;
    }
    Some(c)
}

fn load_added(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let amount = share(random) * largest_force(&c)?;
    let body = movable(&c, Anchor::Body(random.below(c.structure.bodies.len())))?;
    let force = random.vector().try_normalize(0.1)? * amount;
    c.structure.loads.push(Load { body, force, torque: Vec3::zeros(), at: None });
    (amount > 0.0).then_some(c)
}

fn strengthen(c: &mut Certificate, factor: f64) {
    for connector in &mut c.structure.connectors {
        connector.strength *= factor;
        if let Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
            for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
                *limit *= factor;
            }
        }
    }
}

fn strengths_lowered(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    strengthen(&mut c, 1.0 - random.decade(1e-9, 0.9));
    (c.stress.is_some() && c.utilisation.upper > 0.0).then_some(c)
}

fn strengths_raised(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    strengthen(&mut c, 1.0 + random.decade(1e-9, 10.0));
    (c.utilisation.lower > 0.0 && c.utilisation.lower.is_finite()).then_some(c)
}

fn mass_changed(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let body = weighty(&c, random)?;
    c.structure.bodies[body].mass *= 1.0 + share(random) * if random.chance(0.5) { 1.0 } else { -1.0 };
    c.stress.is_some().then_some(c)
}

fn com_moved(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let body = weighty(&c, random)?;
    let shift = across(&c.structure.gravity, random)? * (share(random) * size(&c));
    c.structure.bodies[body].com += shift;
    (c.stress.is_some() && shift.norm() > 0.0).then_some(c)
}

fn contact_moved(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let (index, largest) = (random.below(c.structure.contacts.len().max(1)), largest_force(&c)?);
    let force = *c.stress.as_ref()?.contacts.get(index)?;
    let contact = &c.structure.contacts[index];
    movable(&c, Anchor::Body(contact.body)).or(movable(&c, contact.against))?;
    let shift = across(&force, random)? * (share(random) * size(&c));
    c.structure.contacts[index].position += shift;
    (force.norm() > 1e-3 * largest).then_some(c)
}

fn friction_lowered(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let (index, largest) = (random.below(c.structure.contacts.len().max(1)), largest_force(&c)?);
    let force = *c.stress.as_ref()?.contacts.get(index)?;
    let contact = &mut c.structure.contacts[index];
    let pressing = force.dot(&contact.normal);
    let rubbing = (force - contact.normal * pressing).norm();
    contact.friction = rubbing / pressing * random.between(0.0, 0.999);
    (rubbing > 1e-3 * largest && pressing > 0.0).then_some(c)
}

fn friction_raised(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let index = random.below(c.structure.contacts.len().max(1));
    let contact = c.structure.contacts.get(index)?;
    let mechanism = c.mechanism.as_ref()?;
    let velocity = |anchor: Anchor| {
        let twist = movable(&c, anchor).map_or(Twist::ZERO, |body| mechanism.twists[body]);
        twist.at(&(contact.position - mechanism.about))
    };
    let velocity = velocity(Anchor::Body(contact.body)) - velocity(contact.against);
    let opening = velocity.dot(&contact.normal);
    let sliding = (velocity - contact.normal * opening).norm();
    c.structure.contacts[index].friction = opening.max(0.0) / sliding * random.between(1.001, 3.0) + 1e-3;
    (sliding > 1e-3 * velocity.norm() && sliding > 0.0).then_some(c)
}

/// A connection that carries a force worth mentioning, to a body that needs balance.
fn loaded_connection(c: &Certificate, random: &mut Random) -> Option<(usize, Vec3)> {
    let (index, largest) = (random.below(c.structure.connections.len().max(1)), largest_force(c)?);
    let connection = c.structure.connections.get(index)?;
    movable(c, connection.parent).or(movable(c, connection.child))?;
    let force = carried(c, index)?;
    (force.norm() > 1e-3 * largest).then_some((index, force))
}

fn connection_moved(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let (index, force) = loaded_connection(&c, random)?;
    let shift = across(&force, random)? * (share(random) * size(&c));
    c.structure.connections[index].frame.translation.vector += shift;
    (shift.norm() > 0.0).then_some(c)
}

fn connection_turned(mut c: Certificate, random: &mut Random) -> Option<Certificate> {
    let (index, force) = loaded_connection(&c, random)?;
    let turn = Rotation::from_axis_angle(&Unit::new_normalize(across(&force, random)?), share(random));
    let frame = &mut c.structure.connections[index].frame;
    frame.rotation = turn * frame.rotation;
    Some(c)
}
