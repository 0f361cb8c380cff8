//! Maps of positions against closed forms and against the robot put there.

use crate::reconfigure::linkage::action::Half;
use crate::reconfigure::linkage::assembly::assemble;
use crate::reconfigure::linkage::assembly_tests::{GRAVITY, arm};
use crate::reconfigure::linkage::motion_range::{NotABridge, Turning, motion_range};
use crate::robot::Catalogue;
use crate::robot::linkage::{Code, Connection, Linkage, MICRO, Port, Spot};
use crate::spatial::{Pose, Vec3};
use crate::statics::{Question, assess};

use super::{module, robot};

#[test]
fn a_joint_is_worth_what_its_torque_leaves() {
    let turning = |carried| Turning::Rotate { module: 0, joint: 0, carried };
    let range = motion_range(&arm(5.0), turning(Half::Child), 15.0).expect("a bridge");
    assert_eq!(range.stands.len(), 13);
    for stand in &range.stands {
        let expected = 1.0 - 2.0 * GRAVITY * 0.1 * stand.at[0].to_radians().cos() / 5.0;
        assert!((stand.margin.lower - expected).abs() < 1e-9, "{stand:?}");
    }
    assert_eq!(motion_range(&arm(5.0), turning(Half::Parent), 15.0), Err(NotABridge::Fixed));
}

/// A mast on a held node that carries an arm with a hand, and the connection of arm and elbow.
fn crane() -> (Linkage, Connection) {
    let catalogue = Catalogue::freesn();
    let at = |z: f64, x: f64| Pose::translation(x, 0.0, z);
    let sideways = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_2);
    let mut modules = vec![
        module(&catalogue, "node", 0, at(0.0, 0.0), &[]),
        module(&catalogue, "strut", 1, at(0.1035, 0.0), &[]),
        module(&catalogue, "node", 2, at(0.207, 0.0), &[]),
        module(&catalogue, "strut", 3, at(0.207, 0.1035) * sideways, &[]),
        module(&catalogue, "node", 4, at(0.207, 0.207), &[]),
    ];
    modules[0].fixed = true;
    let mut linkage = robot(catalogue, modules);
    linkage.gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    let connection = *linkage.connections.iter().find(|c| c.modules() == [2, 3]).expect("the elbow holds the arm");
    (linkage, connection)
}

#[test]
fn a_strut_is_worth_what_the_robot_is_with_it_there() {
    let (linkage, connection) = crane();
    let range = motion_range(&linkage, Turning::Roll { connection, carried: 3 }, 45.0).expect("a bridge");
    // 8 azimuths at 45, 90 and 135 degrees, one at either pole.
    assert_eq!(range.stands.len(), 26);
    let Code::OnSurface(from) = linkage.code(&connection) else { panic!("a strut on a node") };
    assert_eq!([f64::from(from.azimuth()), f64::from(from.polar())].map(|a| a / f64::from(MICRO)), range.present);
    for stand in &range.stands {
        let [azimuth, polar] = stand.at.map(|angle| angle as i32 * MICRO);
        let mut codes: Vec<Code> = linkage.connections.iter().map(|c| linkage.code(c)).collect();
        let index = linkage.connections.iter().position(|c| *c == connection).expect("engaged");
        codes[index] = Code::OnSurface(Spot::new(azimuth, polar, from.spin()));
        let mut there = linkage.clone();
        for (module, pose) in there.modules.iter_mut().zip(linkage.placed_by(&codes)) {
            module.pose = pose;
        }
        let answer = assess(&assemble(&there).structure, Question::VALUE).expect("sound");
        assert_eq!(answer.verdict, stand.verdict);
        assert!((answer.margin().lower - stand.margin.lower).abs() < 1e-6, "{stand:?} {:?}", answer.margin());
        // Straight down the arm would be in the mast.
        assert_eq!(stand.overlaps, polar == 180 * MICRO || polar == 135 * MICRO, "{stand:?}");
    }
}

#[test]
fn what_is_no_bridge_has_no_range() {
    let (mut linkage, connection) = crane();
    let carried = |carried| motion_range(&linkage, Turning::Roll { connection, carried }, 45.0);
    assert_eq!(carried(2).map(drop), Err(NotABridge::Fixed));
    assert_eq!(carried(0).map(drop), Err(NotABridge::NoRoll));
    let elsewhere = Connection::new(Port { module: 0, port: 0 }, Port { module: 3, port: 0 });
    assert_eq!(
        motion_range(&linkage, Turning::Roll { connection: elsewhere, carried: 3 }, 45.0).map(drop),
        Err(NotABridge::NoRoll)
    );
    linkage.connections.retain(|c| *c != connection);
    let opened = motion_range(&linkage, Turning::Roll { connection, carried: 3 }, 45.0);
    assert_eq!(opened.map(drop), Err(NotABridge::NoRoll));
}
