//! Which ports are connected, and how they engage.

use nalgebra::Vector3;

use super::super::super::findings::{Findings, Place};
use super::super::super::json::clipped;
use super::super::super::{codes, wire};
use super::super::angle::{MICRO, steps};
use super::super::connections::parts;
use super::super::faults;
use super::super::module_type::refuse;
use super::super::names::Names;
use super::super::rotation::direction;
use crate::robot::linkage::{Code, Connection, Linkage, Port, Spot, orientations_between};
use crate::robot::{Catalogue, Fault, PortPlace};
use crate::spatial::Vec3;

/// Angle in rad up to which a direction or a spin is that of where the modules are: what ports may be off and still meet.
const SAME: f64 = 1e-5;

/// A connection of a list.
pub(super) struct Listed {
    pub(super) connection: Connection,
    said: Said,
}

/// What a file says of how two ports engage.
enum Said {
    /// Nothing, of two ports at points: they engage at angle 0 where nothing else decides.
    AtZero,
    /// Nothing, where a direction would be needed to place one by the other.
    Nothing,
    /// This.
    Code(Code),
}

impl Listed {
    /// How one port engages with the other, where that places it.
    pub(super) fn code(&self) -> Option<Code> {
        match self.said {
            Said::AtZero => Some(Code::Docked { roll: 0 }),
            Said::Nothing => None,
            Said::Code(code) => Some(code),
        }
    }

    /// Reports where the modules are not as the file says that they engage.
    pub(super) fn compare(&self, linkage: &Linkage, place: &Place<'_>, findings: &mut Findings) {
        let Said::Code(said) = self.said else { return };
        if linkage.engagement(&self.connection).is_none() {
            return; // the ports do not meet at all, which is said elsewhere
        }
        let actual = linkage.code(&self.connection);
        let (same, is) = match (said, actual) {
            (Code::OnSurface(said), Code::OnSurface(actual)) => {
                let d = actual.direction();
                let is = format!(
                    "direction [{:.6}, {:.6}, {:.6}] and spin {:.6}",
                    d.x,
                    d.y,
                    d.z,
                    f64::from(actual.spin()) / MICRO
                );
                (said.rotation().angle_to(&actual.rotation()) <= SAME, is)
            }
            (said, Code::Docked { roll }) => {
                let angles = f64::from(linkage.orientations(&self.connection));
                (said == actual, format!("an angle of {} degrees", f64::from(roll) * 360.0 / angles))
            }
            (Code::Docked { .. }, Code::OnSurface(_)) => return,
        };
        if !same {
            let message = format!("the modules are where their ports engage at {is}");
            let hint =
                "leave it out where both modules have a place, or leave the place of one of them out".to_string();
            findings.add(place, codes::APART, message, hint);
        }
    }
}

/// Reads connections between modules of these types.
pub(super) struct Reader<'a> {
    pub(super) modules: &'a Names<'a>,
    /// The type of every module, where it is known.
    pub(super) kinds: &'a [Option<usize>],
    pub(super) catalogue: &'a Catalogue,
}

impl Reader<'_> {
    /// The connections of a list, as far as they are understood.
    pub(super) fn listed(
        &self,
        list: &[wire::PairConnection],
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Vec<Listed> {
        let read = |(index, wire): (usize, &wire::PairConnection)| {
            let place = place.index(index);
            let (texts, ports_at) = match wire {
                wire::PairConnection::Pair(ports) => (ports, place.clone()),
                wire::PairConnection::Rolled(rolled) => (&rolled.ports, place.key("ports")),
            };
            let kind = |module: usize| self.kinds.get(module).copied().flatten();
            let ports =
                [0, 1].map(|i| port(&texts[i], self.modules, self.catalogue, kind, &ports_at.index(i), findings));
            let [a, b] = [ports[0]?, ports[1]?];
            let connection = Connection::new(a, b);
            let kinds = [a, b].map(|port| Some([kind(port.module)?, port.port]));
            let fits = self.catalogue.connector_between(kinds[0]?, kinds[1]?).is_some();
            if a.module == b.module || !fits {
                let fault = if a.module == b.module { Fault::SelfConnection } else { Fault::PortsDoNotFit };
                faults::of_place(fault, &[], &place, findings);
                return None;
            }
            let rolled = match wire {
                wire::PairConnection::Pair(_) => None,
                wire::PairConnection::Rolled(rolled) => Some(rolled),
            };
            let said = self.said(rolled, &connection, &place, findings)?;
            Some(Listed { connection, said })
        };
        list.iter().enumerate().filter_map(read).collect()
    }

    fn said(
        &self,
        rolled: Option<&wire::RolledConnection>,
        connection: &Connection,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Said> {
        let places = connection.ports.map(|port| {
            let kind = self.kinds[port.module].expect("a port that was found is of a known type");
            &self.catalogue.module_types[kind].ports[port.port].place
        });
        let at_points = places.iter().all(|place| matches!(place, PortPlace::Point { .. }));
        let angles = at_points.then(|| orientations_between(places[0], places[1]));
        let Some(wire) = rolled else { return Some(if angles.is_some() { Said::AtZero } else { Said::Nothing }) };
        let keys = [
            (
                "direction",
                wire.direction.is_some() && angles.is_some(),
                "two ports at points engage at an angle: write `roll_deg`",
            ),
            (
                "spin_deg",
                wire.spin_deg.is_some() && angles.is_some(),
                "two ports at points engage at an angle: write `roll_deg`",
            ),
            ("roll_deg", wire.roll_deg.is_some() && angles.is_none(), "on a surface write `direction` and `spin_deg`"),
        ];
        for (key, misplaced, hint) in keys {
            if misplaced {
                refuse(&place.key(key), "these ports do not engage so", hint, findings);
            }
        }
        let Some(angles) = angles else { return self.on_surface(wire, place, findings) };
        let Some(roll) = wire.roll_deg else { return Some(Said::AtZero) };
        let step = 360.0 / f64::from(angles);
        let Some(roll) = steps(roll.0, step) else {
            let message = format!("these ports engage at multiples of {step} degrees, found {}", roll.0);
            findings.add(
                &place.key("roll_deg"),
                codes::OUT_OF_RANGE,
                message,
                "the angle is counted from the ports' x axes".to_string(),
            );
            return None;
        };
        Some(Said::Code(Code::Docked { roll: roll.rem_euclid(angles as i32) }))
    }

    fn on_surface(&self, wire: &wire::RolledConnection, place: &Place<'_>, findings: &mut Findings) -> Option<Said> {
        let Some(towards) = wire.direction else {
            if wire.spin_deg.is_some() {
                let hint = "a port turns about the `direction` in which it sits on the ball";
                findings.add(&place.key("direction"), codes::MISSING_KEY, "the key is missing", hint.to_string());
            }
            return Some(Said::Nothing);
        };
        let towards = direction(towards, &place.key("direction"), findings)?;
        let spin = match wire.spin_deg {
            Some(degrees) => micro(degrees.0, &place.key("spin_deg"), findings)?,
            None => 0,
        };
        Some(Said::Code(Code::OnSurface(spot(&towards, spin))))
    }
}

/// The spot in this direction (unit), turned by a spin in micro-degrees.
fn spot(towards: &Vec3, spin: i32) -> Spot {
    let micro = |angle: f64| (angle.to_degrees() * MICRO).round() as i32;
    let across = Vector3::new(towards.x, towards.y, 0.0).norm();
    let azimuth = if across > 0.0 { micro(towards.y.atan2(towards.x)) } else { 0 };
    Spot::new(azimuth, micro(across.atan2(towards.z)), spin)
}

/// An angle in micro-degrees, which must not be more than a turn.
fn micro(degrees: f64, place: &Place<'_>, findings: &mut Findings) -> Option<i32> {
    if !(degrees.abs() <= 360.0) {
        let message = format!("an angle is at most a turn, found {degrees}");
        findings.add(place, codes::OUT_OF_RANGE, message, "write it between -360 and 360".to_string());
        return None;
    }
    Some((degrees * MICRO).round() as i32)
}

/// The spot of three angles in degrees, as plans write it.
pub(in super::super) fn angles(degrees: [wire::Real; 3], place: &Place<'_>, findings: &mut Findings) -> Option<Spot> {
    let keys = ["azimuth_deg", "polar_deg", "spin_deg"];
    let [azimuth, polar, spin] = [0, 1, 2].map(|i| micro(degrees[i].0, &place.key(keys[i]), findings));
    Some(Spot::new(azimuth?, polar?, spin?))
}

/// The port that is written `MODULE:PORT`, of a module whose type `kind` knows.
pub(in super::super) fn port(
    text: &str,
    modules: &Names<'_>,
    catalogue: &Catalogue,
    kind: impl Fn(usize) -> Option<usize>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Port> {
    let (module, name) = parts(text, "the name of one of its ports, e.g. \"a:top\"", place, findings)?;
    let module = modules.find(module, place, findings)?;
    let kind = &catalogue.module_types[kind(module)?];
    let ports = kind.ports.iter().map(|port| port.name.as_str()).collect::<Vec<_>>();
    let Some(port) = ports.iter().position(|known| *known == name) else {
        let message = format!("`{}` is not a port of a module of type `{}`", clipped(name), clipped(&kind.name));
        let hint = super::super::super::suggest::hint(name, "ports", ports);
        findings.add(place, codes::BAD_PORT, message, hint);
        return None;
    };
    Some(Port { module, port })
}
