//! Which modules can hold each other where they are, pair by pair, remembered.
//!
//! Knows places; does not know what is engaged.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use crate::robot::linkage::{Connection, Linkage, Module, Port};
use crate::robot::{Environment, Requirement};
use crate::spatial::Vec3;

use super::arrangement::Arrangement;
use super::moves::View;
use super::places::{Place, PlaceId};
use super::problem::Problem;

/// The ports of two modules that meet, first module first.
type Meeting = Arc<[[usize; 2]]>;

/// Meetings of the modules of one problem.
#[derive(Debug)]
pub struct Contacts<'a> {
    problem: &'a Problem,
    known: Mutex<HashMap<[PlaceId; 2], Meeting>>,
}

impl<'a> Contacts<'a> {
    /// Nothing is known yet.
    pub fn new(problem: &'a Problem) -> Self {
        Self { problem, known: Mutex::new(HashMap::new()) }
    }

    /// Approximate memory of what is known, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let known = self.known.lock().expect("no thread panics while it holds what is known");
        // A meeting of one pair of ports, with the counts of its `Arc`, is an allocation of its own.
        known.capacity() * (size_of::<([PlaceId; 2], Meeting)>() + 1) * 8 / 7 + known.len() * 48
    }

    /// The robot of an arrangement with every possible connection engaged.
    pub fn saturated(&self, arrangement: &Arrangement, modules: Vec<Arc<Place>>) -> View {
        let mut known = self.known.lock().expect("no thread panics while it holds what is known");
        let mut connections = Vec::new();
        for (b, second) in modules.iter().enumerate() {
            for (a, first) in modules[..b].iter().enumerate() {
                if self.are_apart(first, second) {
                    continue;
                }
                let pair = [arrangement.0[a], arrangement.0[b]];
                let ports = known.entry(pair).or_insert_with(|| self.meeting([first, second]));
                let connection = |ports: &[usize; 2]| {
                    Connection::new(Port { module: a, port: ports[0] }, Port { module: b, port: ports[1] })
                };
                connections.extend(ports.iter().map(connection));
            }
        }
        connections.sort_unstable();
        View { classes: Arc::clone(&self.problem.classes), modules, connections }
    }

    /// Whether two modules are farther apart than any of their ports reach.
    fn are_apart(&self, a: &Place, b: &Place) -> bool {
        let reach: f64 = [a, b].map(|place| self.problem.classes[place.class].reach).iter().sum();
        (a.pose.translation.vector - b.pose.translation.vector).norm_squared() > reach * reach
    }

    fn meeting(&self, places: [&Arc<Place>; 2]) -> Meeting {
        let pair = pair(self.problem, places);
        pair.touching().iter().map(|connection| connection.ports.map(|port| port.port)).collect()
    }
}

/// Two modules as a robot of their own.
fn pair(problem: &Problem, places: [&Arc<Place>; 2]) -> Linkage {
    let module = |(index, place): (usize, &Arc<Place>)| Module {
        id: index.to_string(),
        module_type: problem.classes[place.class].module_type,
        pose: place.pose,
        joints: place.joints.to_vec(),
        fixed: false,
    };
    Linkage {
        catalogue: Arc::clone(&problem.start.catalogue),
        gravity: Vec3::zeros(),
        environment: Environment::default(),
        modules: places.into_iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}
