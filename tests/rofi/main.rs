//! Files of the RoFI platform: what each says, and that they say the same.

#[path = "../support/rofi_pairs.rs"]
mod rofi_pairs;
mod step_model;

use std::collections::BTreeSet;

use serde_json::{Value, json};
use steadfast::io::{
    Form, Problem, SourceFile, no_references, read_checkable, read_linkage, read_problem, write_linkage, write_rofi,
};
use steadfast::robot::linkage::Linkage;
use steadfast::robot::rofi::CELL;
use steadfast::spatial::{Pose, Vec3};

use rofi_pairs::pairs;

const FORMS: [Form; 3] = [Form::RofiWorld, Form::RofiText, Form::RofiVoxels];

fn read(text: impl Into<Vec<u8>>) -> Linkage {
    read_linkage(&SourceFile::new("robot", text), &no_references).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Integer vectors, to compare worlds by.
type Cell = [i64; 3];

/// A shoe of a voxel world: its cell, the way to its module's other shoe, the axis of its X docks, and the way
/// that its -Z dock looks.
type Shoe = [Cell; 4];

fn unit(axis: usize, is_positive: bool) -> Cell {
    let mut cell = [0; 3];
    cell[axis] = if is_positive { 1 } else { -1 };
    cell
}

fn shoe(body: &Value) -> Shoe {
    let axis = ["X", "Y", "Z"].iter().position(|name| body["body_dir"]["axis"] == *name).unwrap();
    let direction = unit(axis, body["body_dir"]["is_positive"].as_bool().unwrap());
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (x, other) = if body["shoe_rotated"].as_bool().unwrap() { (last, next) } else { (next, last) };
    let looks = match body["joint_pos"].as_i64().unwrap() {
        0 => direction.map(|c| -c),
        angle => unit(other, angle > 0),
    };
    let cell: Vec<_> = body["pos"].as_array().unwrap().iter().map(|c| c.as_i64().unwrap()).collect();
    [[cell[0], cell[1], cell[2]], direction, unit(x, true), looks]
}

/// The 24 rotations, each as the image of a vector.
fn rotations() -> Vec<[(usize, i64); 3]> {
    let mut all = Vec::new();
    for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
        let even = order[1] == (order[0] + 1) % 3;
        for signs in 0..8 {
            let signs = [0, 1, 2].map(|bit| if signs >> bit & 1 == 1 { -1 } else { 1 });
            let is_proper = signs.iter().product::<i64>() == if even { 1 } else { -1 };
            if is_proper {
                all.push([0, 1, 2].map(|i| (order[i], signs[i])));
            }
        }
    }
    all
}

/// The voxels of a world, the same for all worlds that differ by a displacement, by names or by which half is which.
fn canonical(voxels: &Value) -> BTreeSet<Shoe> {
    let shoes: Vec<_> = voxels["bodies"].as_array().unwrap().iter().map(shoe).collect();
    let all = rotations();
    assert_eq!(all.len(), 24);
    let turned = all.iter().map(|rotation| {
        let turn = |v: Cell| rotation.map(|(axis, sign)| v[axis] * sign);
        let turned: Vec<Shoe> = shoes.iter().map(|shoe| shoe.map(turn)).collect();
        let least = [0, 1, 2].map(|i| turned.iter().map(|shoe| shoe[0][i]).min().unwrap());
        let moved = turned.into_iter().map(|[cell, direction, x, looks]| {
            [[0, 1, 2].map(|i| cell[i] - least[i]), direction, x.map(i64::abs), looks]
        });
        moved.collect::<BTreeSet<_>>()
    });
    turned.min().unwrap()
}

fn voxels(linkage: &Linkage) -> Value {
    serde_json::from_str(&write_rofi(linkage, Form::RofiVoxels).unwrap_or_else(|why| panic!("{why:?}"))).unwrap()
}

/// Some worlds of our own, in all three formats' reach.
fn worlds() -> Vec<Linkage> {
    let texts = [
        "C\nM 1 0 0 0\n",
        "C\nM 1 90 -90 90\nM 2 0 90 270\nE 1 B -Z E -Z A 2\n",
        "# an arm\nC\n\nM 7 0 0 -90\nM 3 -90 0 180\nM 5 0 90 0\nE 7 A +X W -Z B 3\nE 3 0 1 3 2 1 5\n",
        "M 0 0 90 0\nM 1 0 0 0\nM 2 90 0 0\nM 3 0 -90 0\nM 4 0 0 0\nM 5 -90 0 0\nE 0 1 2 0 2 0 1\nE 1 1 2 0 2 0 2\n\
         E 2 1 2 0 2 0 3\nE 3 1 2 0 2 0 4\nE 4 1 2 0 2 0 5\nE 5 1 2 0 2 0 0\n",
    ];
    texts.map(read).into()
}

#[test]
fn text_is_read_as_the_platform_reads_it() {
    let linkage = read("C\nM 1 0 0 0\nM 4 0 90 90\nE 1 B -Z N +X A 4\n");
    let ids: Vec<_> = linkage.modules.iter().map(|module| module.id.as_str()).collect();
    assert_eq!(ids, ["1", "4"]);
    assert_eq!(linkage.modules[0].pose, Pose::identity());
    assert_eq!(linkage.modules[1].joints, [0, 1, 1]);
    assert_eq!(linkage.catalogue.name, "rofi");
    assert_eq!(linkage.gravity, Vec3::zeros());
    // In text the name +X is number 0, which is the component A-X.
    let [from, to] = linkage.connections[0].ports;
    let name = |port: usize| linkage.catalogue.module_types[0].ports[port].name.as_str();
    assert_eq!((name(from.port), name(to.port)), ("B-Z", "A-X"));
    assert_eq!(linkage, read("C\nM 1 0 0 0\nM 4 0 90 90\nE 1 1 2 0 0 0 4\n"));
    // Shoe A of module 4 is a cell beyond shoe B of module 1.
    let centre = linkage.modules[1].pose.translation.vector;
    assert!((centre - Vec3::new(0.0, 0.0, 2.0 * CELL)).norm() < 1e-12, "{centre}");
}

#[test]
fn a_ring_that_does_not_close_is_told_and_one_that_does_is_read() {
    let ring = &worlds()[3];
    assert_eq!((ring.modules.len(), ring.connections.len()), (6, 6));
    assert_eq!(ring.touching(), ring.connections);
    let text = write_rofi(ring, Form::RofiText).unwrap().replace("M 5 -90", "M 5 90");
    let problems = read_linkage(&SourceFile::new("open", text), &no_references).unwrap_err();
    assert!(problems.to_string().contains("the two docks do not meet so"), "{problems}");
}

#[test]
fn a_pad_is_fixed_and_places_what_stands_on_it() {
    let world = json!({
        "modules": [
            {"id": 12, "type": "universal", "alpha": 0, "beta": 0, "gamma": 0},
            {"id": 42, "type": "pad", "width": 6, "height": 3}
        ],
        "moduleJoints": [{"from": {"id": 12, "connector": "A-X"}, "to": {"id": 42, "connector": 16}, "orientation": "South"}],
        "spaceJoints": [{"point": [1, 2, 3], "joint": {"type": "rigid", "sourceToDestination": "identity", "positions": []},
            "to": {"id": 42, "component": 1}}]
    });
    let linkage = read(world.to_string());
    assert!((linkage.modules[1].pose.translation.vector / CELL - Vec3::new(1.0, 2.0, 2.0)).norm() < 1e-12);
    assert!(linkage.modules[1].fixed && !linkage.modules[0].fixed);
    assert_eq!(linkage.catalogue.name, "rofi with pad-6x3");
    // Dock 16 is at (0, 5, 1) from dock 0, and the module a cell before it.
    let centre = linkage.modules[0].pose.translation.vector / CELL;
    assert!((centre - Vec3::new(0.0, 7.0, 3.0)).norm() < 1e-9, "{centre}");
    let again = read(write_rofi(&linkage, Form::RofiWorld).unwrap());
    assert_same_robot(&again, &linkage);
}

/// The same modules in the same places, up to rounding.
fn assert_same_robot(found: &Linkage, expected: &Linkage) {
    assert_eq!(found.catalogue, expected.catalogue);
    assert_eq!(found.connections, expected.connections);
    for (a, b) in found.modules.iter().zip(&expected.modules) {
        assert_eq!((&a.id, a.module_type, &a.joints, a.fixed), (&b.id, b.module_type, &b.joints, b.fixed));
        let apart = b.pose.inverse() * a.pose;
        assert!(apart.translation.vector.norm() < 1e-9 && apart.rotation.angle() < 1e-7, "{apart}");
    }
}

#[test]
fn joints_at_other_angles_have_a_catalogue_with_a_finer_step() {
    let linkage = read("C\nM 1 45 0 0\nM 2 0 -30 0\nE 1 B -Z N -Z A 2\n");
    assert_eq!(linkage.catalogue.name, "rofi in steps of 15 degrees");
    assert_eq!(linkage.modules[0].joints, [3, 0, 0]);
    assert_eq!(linkage.modules[1].joints, [0, -2, 0]);
    assert_same_robot(&read(write_rofi(&linkage, Form::RofiWorld).unwrap()), &linkage);
    let reasons = write_rofi(&linkage, Form::RofiVoxels).unwrap_err();
    assert_eq!(reasons.len(), 2, "{reasons:?}");
    assert!(reasons[0].contains("right angles"), "{reasons:?}");
}

#[test]
fn every_format_says_the_same() {
    for linkage in worlds() {
        let expected = canonical(&voxels(&linkage));
        for first in FORMS {
            let once = read(write_rofi(&linkage, first).unwrap());
            assert_eq!(canonical(&voxels(&once)), expected);
            for second in FORMS {
                let twice = read(write_rofi(&once, second).unwrap());
                assert_eq!(canonical(&voxels(&twice)), expected, "{first:?} {second:?}");
                assert_eq!(twice.connections.len(), linkage.connections.len());
            }
        }
        assert_same_robot(&read(write_rofi(&linkage, Form::RofiText).unwrap()), &linkage);
        assert_same_robot(&read(write_rofi(&linkage, Form::RofiWorld).unwrap()), &linkage);
        assert_eq!(read(write_linkage(&linkage).unwrap()), linkage);
    }
}

#[test]
fn voxels_are_the_same_after_any_displacement() {
    for linkage in worlds() {
        let mut moved = linkage.clone();
        let turn = Pose::rotation(Vec3::new(0.3, -0.4, 1.2)) * Pose::translation(0.3, 0.2, 0.1);
        moved.modules.iter_mut().for_each(|module| module.pose = turn * module.pose);
        assert_eq!(canonical(&voxels(&moved)), canonical(&voxels(&linkage)));
    }
}

#[test]
fn both_spellings_of_voxels_are_read() {
    let voxels = voxels(&worlds()[1]);
    let old = voxels.to_string().replace("body_dir", "other_body_dir").replace("shoe_rotated", "is_shoe_rotated");
    assert_eq!(read(old), read(voxels.to_string()));
}

#[test]
fn what_a_format_cannot_express_is_told() {
    let mut linkage = worlds().remove(1);
    linkage.gravity = Vec3::new(0.0, 0.0, -9.81);
    linkage.modules[0].fixed = true;
    for form in FORMS {
        let reasons = write_rofi(&linkage, form).unwrap_err();
        assert!(reasons.iter().any(|reason| reason.contains("gravity")), "{reasons:?}");
        assert!(reasons.iter().any(|reason| reason.contains("`1` is fixed")), "{reasons:?}");
    }
    let cube = include_str!("../../problems/malformed/start.json");
    let reasons = write_rofi(&read(cube), Form::RofiText).unwrap_err();
    assert!(reasons.iter().any(|reason| reason.contains("`a` is a `cube`")), "{reasons:?}");
    assert!(reasons.iter().any(|reason| reason.contains("the ground")), "{reasons:?}");
}

#[test]
fn facing_docks_that_are_not_joined_are_no_voxels() {
    let mut ring = worlds().remove(3);
    ring.connections.pop();
    let reasons = write_rofi(&ring, Form::RofiVoxels).unwrap_err();
    assert!(reasons[0].contains("voxels join all docks that face each other"), "{reasons:?}");
}

#[test]
fn files_are_told_apart_by_their_content() {
    let linkage = worlds().remove(1);
    for form in FORMS {
        let file = SourceFile::new("no-ending", write_rofi(&linkage, form).unwrap());
        let Ok(steadfast::io::Checkable::Linkage(found)) = read_checkable(&file, &no_references) else {
            panic!("{form:?} is not checkable")
        };
        assert_eq!(found.modules.len(), 2);
        let Problem::Linkage(problem) = read_problem(&file, &file, &no_references).unwrap() else {
            panic!("{form:?} is no problem of linkages")
        };
        assert_eq!(problem.goal.linkage.catalogue, problem.start.catalogue);
        for other in FORMS {
            let goal = SourceFile::new("goal", write_rofi(&linkage, other).unwrap());
            assert!(read_problem(&file, &goal, &no_references).is_ok());
        }
    }
}

#[test]
fn start_and_goal_share_a_catalogue_that_has_what_either_needs() {
    let start = SourceFile::new("start", "C\nM 1 0 0 0\n");
    let goal = SourceFile::new("goal", "C\nM 1 0 30 0\n");
    let problem = read_problem(&start, &goal, &no_references).unwrap().into_linkage().unwrap();
    assert_eq!(problem.start.catalogue.name, "rofi in steps of 30 degrees");
    assert_eq!(problem.goal.linkage.modules[0].joints, [0, 1, 0]);
}

#[test]
fn a_configuration_and_a_file_of_the_platform_make_a_problem() {
    let mut start = worlds().remove(1);
    start.gravity = Vec3::new(0.0, 0.0, -9.81);
    let own = SourceFile::new("start", write_linkage(&start).unwrap());
    let goal = SourceFile::new("goal", "C\nM 1 0 0 0\nM 2 0 0 0\nE 1 B -Z E -Z A 2\n");
    let problem = read_problem(&own, &goal, &no_references).unwrap().into_linkage().unwrap();
    assert_eq!(problem.goal.linkage.gravity, start.gravity);
    let swapped = read_problem(&goal, &own, &no_references).unwrap_err();
    assert!(swapped.to_string().contains("gravity"), "{swapped}");
}

#[test]
fn the_pairs_are_sound_connected_robots_of_as_many_modules() {
    for (name, pair) in pairs() {
        for end in ["start", "goal"] {
            let linkage = read(pair[end].to_string());
            assert_eq!(linkage.modules.len() as i64, pair["modules"].as_i64().unwrap(), "{name}");
            assert_eq!(canonical(&voxels(&linkage)), canonical(&pair[end]), "{name}");
            for form in FORMS {
                let again = read(write_rofi(&linkage, form).unwrap());
                assert_eq!(canonical(&voxels(&again)), canonical(&pair[end]), "{name} {form:?}");
            }
        }
    }
}
