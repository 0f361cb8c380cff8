//! Laws of meshes and height fields as what is around a solid: against the solids and planes that they describe.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::geometry::surface::Surface;
use crate::robot::{Environment, HeightField, Mesh, Obstacle, Terrain};

/// The triangles of a box, outwards.
fn box_mesh(half: &Vec3) -> Mesh {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Mesh::new(corners(half), triangles.collect()).unwrap()
}

fn around(shape: Terrain, pose: Pose) -> Surroundings {
    Surroundings::new(&Environment {
        obstacles: vec![Obstacle { shape, pose, friction: 0.5 }],
        ..Environment::default()
    })
}

fn any_heights() -> impl Strategy<Value = HeightField> {
    prop::collection::vec(prop::collection::vec(-0.5..0.5, 6), 5)
        .prop_map(|heights| HeightField::new([0.7, 0.9], heights).unwrap())
}

proptest! {
    #[test]
    fn a_mesh_of_a_box_is_a_box(
        a in any_solid(0.5), half in prop::array::uniform3(0.2..1.0), pose in any_pose(0.5), towards in any_direction(),
        motion in any_motion(), away in any_vector(3.0),
    ) {
        let half = Vec3::from(half);
        let cuboid = Solid::new(Shape::Cuboid { half_extents: half }, pose);
        let mesh = around(Terrain::Mesh(Arc::new(box_mesh(&half))), pose);
        let (near, direction) = brought_to_touch(&a, &cuboid, &towards);
        let of_mesh = mesh.contacts(&near, TOUCH);
        match contact(&near, &cuboid, TOUCH) {
            _ if touch_along_more(&near, &cuboid, &-direction) => {}
            Some(of_box) => {
                prop_assert_eq!(of_mesh.len(), 1, "{:?}", of_box);
                let of_mesh = &of_mesh[0].1;
                prop_assert!((of_mesh.normal - of_box.normal).norm() < 1e-4);
                prop_assert!(same_points(&of_mesh.points, &of_box.points, 1e-4), "{of_mesh:?} {of_box:?}");
            }
            None => prop_assert!(of_mesh.is_empty(), "{of_mesh:?}"),
        }

        let skin = SKIN * a.size();
        prop_assert!(mesh.overlaps(&near, skin).is_empty());
        if !of_mesh.is_empty() {
            prop_assert!(!mesh.overlaps(&shifted(&near, direction * 3.0 * skin), skin).is_empty());
        }
        let inside = Solid::new(Shape::Ball { radius: 0.05 }, pose);
        prop_assert_eq!(mesh.overlaps(&inside, 1e-5), [Surrounding::Obstacle(0)]);

        let start = shifted(&a, away);
        let hits = [first_collision(&start, &motion, &cuboid), mesh.first_collision(&start, &motion).map(|(phase, _)| phase)];
        prop_assert!((hits[0].unwrap_or(2.0) - hits[1].unwrap_or(2.0)).abs() < 1e-3, "{hits:?}");
    }

    #[test]
    fn a_floor_of_triangles_carries_what_a_plane_carries(
        shape in any_shape(), turn in any_rotation(), pose in any_pose(1.0), at in prop::array::uniform2(2.0..5.0), cell in 0.2..1.5,
    ) {
        let field = HeightField::new([cell, 1.3 * cell], vec![vec![0.0; 40]; 40]).unwrap();
        let floor = around(Terrain::HeightField(Arc::new(field)), pose);
        let plane = around(Terrain::HalfSpace, pose);
        let lowest = |solid: &Solid| -Figure::new(solid).reach(&-Vec3::z());
        let solid = Solid::new(shape, Pose::from_parts(Vec3::new(at[0], at[1], 0.0).into(), turn));
        for upright in [true, false] {
            let solid = if upright { Solid::new(solid.shape.clone(), solid.pose.translation.into()) } else { solid.clone() };
            let resting = moved(&shifted(&solid, Vec3::z() * -lowest(&solid)), &pose);
            let (on_floor, on_plane) = (floor.contacts(&resting, TOUCH), plane.contacts(&resting, TOUCH));
            prop_assert_eq!((on_floor.len(), on_plane.len()), (1, 1));
            prop_assert!((on_floor[0].1.normal - on_plane[0].1.normal).norm() < 1e-9);
            prop_assert!(same_points(&on_floor[0].1.points, &on_plane[0].1.points, 3.0 * TOUCH), "{on_floor:?} {on_plane:?}");
        }
    }

    #[test]
    fn contacts_with_a_height_field_lie_on_it_and_on_the_solid(
        a in any_solid(0.2), field in any_heights(), at in prop::array::uniform2(0.7..2.5),
    ) {
        let surface = Surface::of_height_field(&field, &Pose::identity());
        // Down from above until the sweep says that it arrives, then out of its skin.
        let start = shifted(&a, Vec3::new(at[0], at[1], 6.0));
        let around = around(Terrain::HeightField(Arc::new(field)), Pose::identity());
        let down = Motion::Translation { by: Vec3::z() * -8.0 };
        let (phase, _) = around.first_collision(&start, &down).expect("there is ground");
        let arrived = Solid::new(a.shape.clone(), down.pose(&start.pose, phase));
        let skin = SKIN * a.size();
        prop_assert!(around.overlaps(&shifted(&arrived, Vec3::z() * 40.0 * skin), skin).is_empty());
        prop_assert!(!around.overlaps(&shifted(&arrived, Vec3::z() * -10.0 * skin), 0.9 * skin).is_empty());
        // Its own surface within ten skins carries it somewhere.
        let tolerance = 10.0 * skin;
        let patches = surface.contacts(&arrived, tolerance);
        for patch in &patches {
            prop_assert!((patch.normal.norm() - 1.0).abs() < 1e-9);
            for p in &patch.points {
                prop_assert!(outside(&arrived, p).abs() < 3.0 * tolerance, "{}", outside(&arrived, p));
                let down = surface.triangles.iter().map(|t| (p - t.corners[0]).dot(&t.normal)).map(f64::abs).fold(f64::INFINITY, f64::min);
                prop_assert!(down < 3.0 * tolerance);
            }
        }
    }
}

#[test]
fn what_touches_only_the_edge_of_a_step_stands_on_nothing() {
    let half = Vec3::repeat(0.5);
    let step = around(Terrain::Mesh(Arc::new(box_mesh(&half))), Pose::identity());
    let cube = |x: f64, z: f64| Solid::new(Shape::Cuboid { half_extents: half }, Pose::translation(x, 0.0, z));
    assert_eq!(step.contacts(&cube(1.0, 1.0), TOUCH), []);
    assert_eq!(step.contacts(&cube(1.0, 0.0), TOUCH).len(), 1);
    assert_eq!(step.contacts(&cube(0.3, 1.0), TOUCH)[0].1.points.len(), 4);
    // A slope and a floor that meet in a valley both carry what stands in it.
    let field = HeightField::new([1.0, 4.0], vec![vec![1.0, 0.0, 0.0], vec![1.0, 0.0, 0.0]]).unwrap();
    let valley = around(Terrain::HeightField(Arc::new(field)), Pose::translation(-1.0, -2.0, 0.0));
    let ball = Solid::new(Shape::Ball { radius: 1.0 }, Pose::translation((22.5f64).to_radians().tan(), 0.0, 1.0));
    let normals: Vec<Vec3> = valley.contacts(&ball, TOUCH).into_iter().map(|(_, patch)| patch.normal).collect();
    let slope = Vec3::new(1.0, 0.0, 1.0).normalize();
    assert_eq!(normals.len(), 2);
    assert!(same_points(&normals, &[slope, Vec3::z()], 1e-9), "{normals:?}");
}

#[test]
fn an_open_mesh_is_a_sheet_with_two_sides() {
    let corners = vec![Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, -2.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
    let sheet = around(Terrain::Mesh(Arc::new(Mesh::new(corners, vec![[0, 1, 2]]).unwrap())), Pose::identity());
    let cube = |z: f64| Solid::new(Shape::Cuboid { half_extents: Vec3::repeat(0.5) }, Pose::translation(0.0, 0.0, z));
    for (z, normal) in [(0.5, Vec3::z()), (-0.5, -Vec3::z())] {
        let found = sheet.contacts(&cube(z), TOUCH);
        assert_eq!((found.len(), found[0].1.normal, found[0].1.points.len()), (1, normal, 4));
        assert_eq!(sheet.overlaps(&cube(z), SKIN), []);
    }
    assert_eq!(sheet.overlaps(&cube(0.4), SKIN), [Surrounding::Obstacle(0)]);
    // Further on either side is free.
    assert_eq!(sheet.overlaps(&cube(-3.0), SKIN), []);
    let up = Motion::Translation { by: Vec3::z() * 3.0 };
    assert!(sheet.first_collision(&cube(-1.5), &up).is_some());
}
