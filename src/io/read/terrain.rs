//! Shapes of obstacles, and what points and triangles must be to make one.

use std::sync::Arc;

use super::super::codes::{self, Code};
use super::super::document::Resolve;
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::wire::{self, Real};
use super::rotation::vector;
use super::stl_and_obj;
use crate::robot::{HeightField, Hull, LARGEST, Mesh, Shape, ShapeFault, Terrain};
use crate::spatial::Vec3;

/// The shape of an obstacle.
pub(super) fn terrain(
    wire: &wire::Terrain,
    place: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Terrain> {
    match wire {
        wire::Terrain::Cuboid { half_extents_m } => {
            Some(Shape::Cuboid { half_extents: Vec3::from(half_extents_m.map(|half| half.0)) }.into())
        }
        wire::Terrain::Cylinder { radius_m, height_m } => {
            Some(Shape::Cylinder { radius: radius_m.0, height: height_m.0 }.into())
        }
        wire::Terrain::Ball { radius_m } => Some(Shape::Ball { radius: radius_m.0 }.into()),
        wire::Terrain::Convex { points_m } => {
            hull(points_m, &place.key("convex").key("points_m"), findings).map(Terrain::Solid)
        }
        wire::Terrain::Plane {} => Some(Terrain::HalfSpace),
        wire::Terrain::HeightField { cell_m, heights_m } => {
            let place = place.key("height_field");
            let heights = heights_m.iter().map(|row| row.iter().map(|height| height.0).collect()).collect();
            match HeightField::new(cell_m.map(|side| side.0), heights) {
                Ok(field) => Some(Terrain::HeightField(Arc::new(field))),
                Err(fault) => {
                    let place = match fault {
                        ShapeFault::Uneven { row } => place.key("heights_m").index(row),
                        _ => place,
                    };
                    report(fault, "heights", &place, findings);
                    None
                }
            }
        }
        wire::Terrain::Mesh(wire) => {
            mesh(wire, &place.key("mesh"), resolve, findings).map(|mesh| Terrain::Mesh(Arc::new(mesh)))
        }
    }
}

/// The hull of points.
pub(super) fn hull(points: &[[Real; 3]], place: &Place<'_>, findings: &mut Findings) -> Option<Shape> {
    match Hull::new(points.iter().copied().map(vector).collect()) {
        Ok(hull) => Some(Shape::Convex(Arc::new(hull))),
        Err(fault) => {
            report(fault, "points", place, findings);
            None
        }
    }
}

fn mesh(wire: &wire::Mesh, place: &Place<'_>, resolve: Resolve<'_>, findings: &mut Findings) -> Option<Mesh> {
    match (&wire.file, &wire.vertices_m, &wire.triangles) {
        (Some(name), None, None) => {
            let scale = wire.scale.map_or(1.0, |scale| scale.0);
            of_file(name, scale, &place.key("file"), resolve, findings)
        }
        (None, Some(vertices), Some(triangles)) if wire.scale.is_none() => {
            match Mesh::new(vertices.iter().copied().map(vector).collect(), triangles.clone()) {
                Ok(mesh) => Some(mesh),
                Err(fault) => {
                    let place = match fault {
                        ShapeFault::NoVertex { triangle } => place.key("triangles").index(triangle),
                        _ => place.clone(),
                    };
                    report(fault, "triangles", &place, findings);
                    None
                }
            }
        }
        _ => {
            let message = "a mesh has either a `file`, with a `scale` if need be, or `vertices_m` and `triangles`";
            let hint = r#"e.g. {"file": "terrain.stl", "scale": 0.001}"#.to_string();
            findings.add(place, codes::MIXED, message, hint);
            None
        }
    }
}

fn of_file(name: &str, scale: f64, place: &Place<'_>, resolve: Resolve<'_>, findings: &mut Findings) -> Option<Mesh> {
    let kind = match name.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase()).as_deref() {
        Some("stl") => stl_and_obj::Kind::Stl,
        Some("obj") => stl_and_obj::Kind::Obj,
        _ => {
            let message = format!("`{}` is neither an .stl nor an .obj file", clipped(name));
            findings.add(place, codes::UNSUPPORTED, message, "convert the mesh to one of these".to_string());
            return None;
        }
    };
    let file = match resolve(place.file(), name) {
        Ok(file) => file,
        Err(problem) => {
            let message = format!("cannot read `{}`: {problem}", clipped(name));
            let hint = "the path is relative to the file that names it".to_string();
            findings.add(place, codes::UNREADABLE, message, hint);
            return None;
        }
    };
    let (vertices, triangles) = stl_and_obj::read(&file, kind, findings)?;
    match Mesh::new(vertices.into_iter().map(|p| p * scale).collect(), triangles) {
        Ok(mesh) => Some(mesh),
        Err(fault) => {
            let (code, message, hint) = describe(fault, "triangles");
            findings.add_in_file(&file, code, message, hint);
            None
        }
    }
}

fn report(fault: ShapeFault, items: &str, place: &Place<'_>, findings: &mut Findings) {
    // What is too short was said when the form was checked.
    if !matches!(fault, ShapeFault::TooFew { .. } | ShapeFault::NotPositive) {
        let (code, message, hint) = describe(fault, items);
        findings.add(place, code, message, hint.to_string());
    }
}

fn describe(fault: ShapeFault, items: &str) -> (Code, String, &'static str) {
    match fault {
        ShapeFault::OutOfBounds => (
            codes::OUT_OF_RANGE,
            format!("coordinates must be numbers up to {LARGEST:e} m in magnitude"),
            "lengths are in metres: check the unit",
        ),
        ShapeFault::NotPositive => (codes::OUT_OF_RANGE, "must be more than 0".to_string(), "a length is positive"),
        ShapeFault::TooFew { least: 1 } => {
            (codes::WRONG_LENGTH, format!("there are no {items}"), "is it the right file?")
        }
        ShapeFault::TooFew { least } => {
            (codes::WRONG_LENGTH, format!("there must be at least {least} {items}"), "is it the right file?")
        }
        ShapeFault::TooMany { most } => (
            codes::TOO_LARGE,
            format!("more than {most} {items} are not read"),
            "simplify it, or cut it to what is near the robot",
        ),
        ShapeFault::Flat if items == "points" => (
            codes::NO_SHAPE,
            "the points lie in a plane".to_string(),
            "a solid has thickness: add a point beside the plane",
        ),
        ShapeFault::Flat => (
            codes::NO_SHAPE,
            "no triangle has an area".to_string(),
            "each triangle has three different vertices that are not in line",
        ),
        ShapeFault::Uneven { .. } => (
            codes::WRONG_LENGTH,
            "the row is not as long as the first".to_string(),
            "the grid is a rectangle: every row has as many heights",
        ),
        ShapeFault::NoVertex { .. } => (
            codes::OUT_OF_RANGE,
            "the triangle names a vertex that there is not".to_string(),
            "vertices are counted from 0",
        ),
    }
}
