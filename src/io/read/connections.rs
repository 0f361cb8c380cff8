//! Which ports are connected.

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::wire;
use super::module_type::refuse;
use super::names::Names;
use crate::robot::{Face, FaceConnection, Port};

/// Stands for a port that was not understood, so that lists keep their order.
const UNKNOWN: Port = Port { module: usize::MAX, face: Face::NegX };

/// The connections of a list, in its order, with stand-ins for what was not understood.
pub(super) fn listed(
    list: &[wire::PairConnection],
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Vec<FaceConnection> {
    let read = |(index, wire): (usize, &wire::PairConnection)| {
        let place = place.index(index);
        let (ports, place) = match wire {
            wire::PairConnection::Pair(ports) => (ports, place),
            wire::PairConnection::Rolled(rolled) => {
                check_roll(rolled, &place, findings);
                (&rolled.ports, place.key("ports"))
            }
        };
        let [a, b] = ports_of(ports, modules, &place, findings).map(|port| port.unwrap_or(UNKNOWN));
        FaceConnection::new(a, b)
    };
    list.iter().enumerate().map(read).collect()
}

fn check_roll(wire: &wire::RolledConnection, place: &Place<'_>, findings: &mut Findings) {
    for (key, present) in [("direction", wire.direction.is_some()), ("spin_deg", wire.spin_deg.is_some())] {
        if present {
            refuse(
                &place.key(key),
                "faces engage nowhere else",
                "it is for ports on a surface: leave it out",
                findings,
            );
        }
    }
    if let Some(roll) = wire.roll_deg.filter(|roll| roll.0 % 90.0 != 0.0) {
        let message = format!("faces engage at multiples of 90 degrees, found {}", roll.0);
        findings.add(&place.key("roll_deg"), codes::OUT_OF_RANGE, message, "write 0, 90, 180 or 270".to_string());
    }
}

/// Two ports that stand in a list at `place`.
pub(super) fn ports_of(
    texts: &[String; 2],
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> [Option<Port>; 2] {
    [0, 1].map(|index| port(&texts[index], modules, &place.index(index), findings))
}

/// The two parts of a port that is written `MODULE:PORT`; `which` says in a hint what the second one is.
pub(super) fn parts<'t>(
    text: &'t str,
    which: &str,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<(&'t str, &'t str)> {
    let parts = text.rsplit_once(':');
    if parts.is_none() {
        let message = format!("expected a port, found \"{}\"", clipped(text));
        findings.add(place, codes::BAD_PORT, message, format!("a port is a module's id, a colon and {which}"));
    }
    parts
}

/// The port that is written `MODULE:FACE`.
fn port(text: &str, modules: &Names<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<Port> {
    let (module, face) = parts(text, "one of its own faces, e.g. \"a:+z\"", place, findings)?;
    let found = Face::from_name(face);
    if found.is_none() {
        let meant =
            Face::from_name(&format!("+{face}")).map(|meant| format!("did you mean `{module}:{}`?", meant.name()));
        let hint = meant.unwrap_or_else(|| "the faces are `-x`, `+x`, `-y`, `+y`, `-z` and `+z`".to_string());
        findings.add(place, codes::BAD_PORT, format!("`{}` is not a face of a cube", clipped(face)), hint);
    }
    let module = modules.find(module, place, findings);
    Some(Port { module: module?, face: found? })
}
