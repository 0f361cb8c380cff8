//! Soundness of catalogues.

use crate::statics::{Connector, Model};

use super::catalogue::Catalogue;
use super::module_type::ModuleType;
use super::problem::{Fault, Findings, Part, Problem};

/// Relative difference of lengths that are meant to be equal: the rounding of
/// decimal numbers and a division, a thousand times over.
const SAME_LENGTH: f64 = 1e-12;

impl Catalogue {
    /// Everything that is wrong with the catalogue, connectors first, then motions.
    pub fn problems(&self) -> Vec<Problem> {
        let mut findings = Findings(Vec::new());
        findings.distinct(Part::Connector, "name", self.connectors.iter().map(|c| c.name.as_str()));
        for (i, connector) in self.connectors.iter().enumerate() {
            check_connector(&mut findings, Part::Connector(i), connector);
        }
        self.check_motions(&mut findings);
        findings.distinct(Part::ModuleType, "name", self.module_types.iter().map(|t| t.name.as_str()));
        for (i, module_type) in self.module_types.iter().enumerate() {
            module_type.check(&mut findings, i, &self.connectors);
            self.check_module_type(&mut findings, Part::ModuleType(i), module_type);
            if let Some(lattice) = &module_type.lattice {
                self.check_motions_of(&mut findings, i, lattice);
            }
        }
        findings.0
    }

    fn check_module_type(&self, findings: &mut Findings, part: Part, module_type: &ModuleType) {
        let Some(lattice) = &module_type.lattice else { return };
        let body = module_type.body();
        if body.com.amax() > 0.0 {
            findings.add(part, "com", Fault::NotSymmetric);
        }
        findings.positive(part, "pitch", &[lattice.pitch]);
        let off = |h: &f64| (2.0 * h - lattice.pitch).abs() > SAME_LENGTH * lattice.pitch;
        let is_cell = body.shape.cuboid().is_some_and(|half_extents| {
            let positive = lattice.pitch > 0.0 && half_extents.iter().all(|h| *h > 0.0);
            !(positive && half_extents.iter().any(off))
        });
        if !is_cell {
            findings.add(part, "half_extents", Fault::NotACell);
        }
        if findings.in_range(part, "face", lattice.face, self.connectors.len())
            && !is_symmetric(&self.connectors[lattice.face].model)
        {
            findings.add(part, "face", Fault::NotSymmetric);
        }
        if let Some(hinge) = lattice.hinge
            && findings.in_range(part, "hinge", hinge, self.connectors.len())
            && !matches!(self.connectors[hinge].model, Model::Box { .. })
        {
            findings.add(part, "hinge", Fault::HingeNotBox);
        }
    }
}

fn check_connector(findings: &mut Findings, part: Part, connector: &Connector) {
    findings.positive(part, "strength", &[connector.strength]);
    match &connector.model {
        Model::Cone { friction, radius } => {
            findings.positive(part, "friction", friction);
            findings.positive(part, "radius", radius);
        }
        Model::Box { shear, tension, compression, bending, torsion } => {
            limits(findings, part, "shear", shear);
            limits(findings, part, "tension", &[*tension]);
            limits(findings, part, "compression", &[*compression]);
            limits(findings, part, "bending", bending);
            limits(findings, part, "torsion", &[*torsion]);
        }
        Model::Patch { friction, points } => {
            findings.not_negative(part, "friction", &[*friction]);
            if findings.finite(part, "points", points.as_flattened()) && !points.is_empty() && !surrounds_origin(points)
            {
                findings.add(part, "points", Fault::OriginOutsidePatch);
            }
        }
    }
}

/// Limits of a box: not negative, infinite where unlimited.
fn limits(findings: &mut Findings, part: Part, field: &'static str, values: &[f64]) {
    if values.iter().any(|v| v.is_nan()) {
        findings.add(part, field, Fault::NotFinite);
    } else if values.iter().any(|&v| v < 0.0) {
        findings.add(part, field, Fault::Negative);
    }
}

/// Whether a connector is unchanged by a quarter turn about its z axis.
fn is_symmetric(model: &Model) -> bool {
    match model {
        Model::Cone { friction, radius } => friction[0] == friction[1] && radius[0] == radius[1],
        Model::Box { shear, bending, .. } => shear[0] == shear[1] && bending[0] == bending[1],
        Model::Patch { points, .. } => {
            let same = |a: &[f64; 2], b: &[f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME_LENGTH);
            points.iter().all(|[x, y]| points.iter().any(|q| same(&[-y, *x], q)))
        }
    }
}

/// Whether the origin is in the convex hull of the points: no open half plane
/// through it holds all of them, so seen from it no gap between neighbouring
/// directions exceeds half a turn.
fn surrounds_origin(points: &[[f64; 2]]) -> bool {
    use std::f64::consts::{PI, TAU};
    if points.iter().any(|[x, y]| *x == 0.0 && *y == 0.0) {
        return true;
    }
    let mut angles: Vec<f64> = points.iter().map(|[x, y]| y.atan2(*x)).collect();
    angles.sort_by(f64::total_cmp);
    let across_the_cut = angles[0] + TAU - angles[angles.len() - 1];
    let widest = angles.windows(2).map(|pair| pair[1] - pair[0]).fold(across_the_cut, f64::max);
    widest <= PI + SAME_LENGTH
}
