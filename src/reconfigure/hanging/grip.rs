//! How well one module holds another.

use crate::reconfigure::assembly::{Assembler, Engagement, Moving, Transient};
use crate::robot::{Configuration, Environment, Module, Requirement};
use crate::spatial::Vec3;
use crate::statics::{Bracket, Question, assess};

/// One module that holds another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// The module that holds, by its index.
    pub support: usize,
    /// Utilisation of what the two hold each other by while the other hangs on nothing else and
    /// this one does not give way.
    pub utilisation: Bracket,
    /// Where the weight of the module that is held acts, in W, in m.
    pub weight_at: Vec3,
}

/// The best of the single grips on a module: of all modules that a state's engagements connect it to, the one that
/// alone would hold it with the smallest proved utilisation; of equals the first.
///
/// `None` when nothing holds it or when it carries loads of its own, which nothing here accounts for.
pub fn best_grip(configuration: &Configuration, state: &Transient, module: usize) -> Option<Grip> {
    if configuration.loads.iter().any(|load| load.module == module) {
        return None;
    }
    let own = state.engaged.iter().filter(|engagement| engagement.modules().contains(&module));
    let grips = own.filter_map(|engagement| grip(configuration, state, module, engagement));
    grips.reduce(|best, next| if next.utilisation.upper < best.utilisation.upper { next } else { best })
}

/// The grip of one engagement.
fn grip(configuration: &Configuration, state: &Transient, module: usize, held: &Engagement) -> Option<Grip> {
    let support = held.modules().into_iter().find(|&other| other != module)?;
    let pair = pair(configuration, support, module);
    let local = |index: usize| usize::from(index == module);
    let engaged = match *held {
        Engagement::Face { modules, towards } => Engagement::Face { modules: modules.map(local), towards },
        Engagement::Hinge { parent, child, frame } => {
            Engagement::Hinge { parent: local(parent), child: local(child), frame }
        }
    };
    let moving = state.moving.filter(|moving| moving.module == module).map(|moving| Moving { module: 1, ..moving });
    let placements = [state.placements[support], state.placements[module]];
    let assembly = Assembler::new(&pair).assemble(&Transient { placements: &placements, moving, engaged: &[engaged] });
    let assessment = assess(&assembly.structure, Question::VALUE).ok()?;
    let weight_at = assembly.structure.bodies[1].com;
    Some(Grip { support, utilisation: assessment.utilisation, weight_at })
}

/// The two modules alone, in empty space, the first one held.
fn pair(configuration: &Configuration, support: usize, module: usize) -> Configuration {
    let of = |index: usize, fixed| Module { fixed, id: String::new(), ..configuration.modules[index].clone() };
    Configuration {
        catalogue: configuration.catalogue.clone(),
        gravity: configuration.gravity,
        environment: Environment {
            module_friction: configuration.environment.module_friction,
            ..Environment::default()
        },
        modules: vec![of(support, true), of(module, false)],
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}
