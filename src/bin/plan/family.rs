//! What planning, verifying and reporting have to know of a family of robots.

use std::fmt::Display;

use steadfast::io::{
    LatticeProblem, LinkageProblem, PartialOrderReport, PlanDocument, Unwritable, write_linkage_partial_order,
    write_linkage_plan, write_partial_order, write_plan,
};
use steadfast::reconfigure::linkage::assembly::{BodyOf, Held, Touched};
use steadfast::reconfigure::linkage::{self, Half};
use steadfast::reconfigure::partial_order::{OrderError, OrderOptions, PartialOrder, partial_order};
use steadfast::reconfigure::replay::{Replay, appraise, replay};
use steadfast::reconfigure::{self, Action, Event, Options, Plan, Refusal, Report, solve};
use steadfast::robot::linkage::{Linkage, MICRO, Port, Spot};
use steadfast::robot::{Cell, Configuration, FaceConnection};

/// A planning problem of one family of robots.
pub trait Family: Sized + Sync {
    /// What its modules do.
    type Action: Clone + Send;
    /// What names one of its connections.
    type Connection: Copy + PartialEq + Send;
    /// What its modules can hit.
    type Touched: Display;

    /// Searches.
    ///
    /// # Errors
    /// What cannot be planned for.
    fn solve(&self, options: &Options, on_event: &mut OnEvent<'_, Self>) -> Result<Answer<Self>, Refusal>;

    /// Checks a plan by code that shares no decision with the search.
    ///
    /// # Errors
    /// What cannot be replayed.
    fn replay(
        &self,
        plan: &Plan<Self::Action, Self::Connection>,
        required: f64,
    ) -> Result<Replay<Self::Connection, Self::Touched>, Refusal>;

    /// The plan with its margins over time and with what a stronger bottleneck would gain.
    ///
    /// # Errors
    /// What cannot be replayed.
    fn appraise(
        &self,
        plan: &Plan<Self::Action, Self::Connection>,
        replay: &Replay<Self::Connection, Self::Touched>,
    ) -> Result<Plan<Self::Action, Self::Connection>, Refusal>;

    /// The id of a module of the start.
    fn id(&self, module: usize) -> &str;

    /// A plan file.
    ///
    /// # Errors
    /// What no file can say.
    fn write(&self, report: &Answer<Self>) -> Result<String, Unwritable>;

    /// Which actions of a plan may run at the same time.
    ///
    /// # Errors
    /// A plan that does not hold in its own order, or what cannot be assessed.
    fn partial_order(&self, plan: &PlanOf<Self>, options: &OrderOptions) -> Result<OrderOf<Self>, BrokenOf<Self>>;

    /// A `partial-order/1` document about the best plan of a plan file.
    ///
    /// # Errors
    /// What no file can say.
    fn write_order(
        document: &DocumentOf<Self>,
        report: &PartialOrderReport<'_, Self::Touched>,
    ) -> Result<String, Unwritable>;

    /// The margin that the start requires.
    fn required(&self) -> f64;

    /// Whether an action moves modules.
    fn is_move(action: &Self::Action) -> bool;

    /// What an action does, in a few words.
    fn action(&self, action: &Self::Action) -> String;

    /// What holds, e.g. `connection a:+x - b:-x`.
    fn held(&self, held: &Self::Connection) -> String;

    /// What a module hits.
    fn touched(&self, touched: &Self::Touched) -> String;
}

/// What a search answers to a problem.
pub type Answer<F> = Report<<F as Family>::Action, <F as Family>::Connection>;

/// What a replay says of a plan.
pub type Check<F> = Replay<<F as Family>::Connection, <F as Family>::Touched>;

/// A plan.
pub type PlanOf<F> = Plan<<F as Family>::Action, <F as Family>::Connection>;

/// A plan file once read.
pub type DocumentOf<F> = PlanDocument<F, <F as Family>::Action, <F as Family>::Connection>;

/// The partial order of a plan.
pub type OrderOf<F> = PartialOrder<<F as Family>::Touched>;

/// Why a plan has no partial order.
pub type BrokenOf<F> = OrderError<<F as Family>::Touched>;

/// What looks at a running search.
pub type OnEvent<'e, F> = dyn FnMut(&Event<<F as Family>::Action, <F as Family>::Connection>) + 'e;

impl Family for LatticeProblem {
    type Action = Action;
    type Connection = FaceConnection;
    type Touched = reconfigure::assembly::Touched;

    fn solve(&self, options: &Options, on_event: &mut OnEvent<'_, Self>) -> Result<Report, Refusal> {
        solve(&self.start, &self.goal, options, on_event)
    }

    fn replay(&self, plan: &Plan, required: f64) -> Result<Replay, Refusal> {
        replay(&self.start, &self.goal, plan, required)
    }

    fn appraise(&self, plan: &Plan, replay: &Replay) -> Result<Plan, Refusal> {
        appraise(&self.start, &self.goal, plan, replay)
    }

    fn id(&self, module: usize) -> &str {
        &self.start.modules[module].id
    }

    fn write(&self, report: &Report) -> Result<String, Unwritable> {
        write_plan(&PlanDocument::new(self.clone(), report))
    }

    fn partial_order(&self, plan: &Plan, options: &OrderOptions) -> Result<PartialOrder, OrderError> {
        partial_order(&self.start, plan, options)
    }

    fn write_order(document: &DocumentOf<Self>, report: &PartialOrderReport<'_>) -> Result<String, Unwritable> {
        write_partial_order(document, report)
    }

    fn required(&self) -> f64 {
        self.start.require.margin
    }

    fn is_move(action: &Action) -> bool {
        action.is_move()
    }

    fn action(&self, action: &Action) -> String {
        let id = |module: usize| &self.start.modules[module].id;
        match action {
            Action::Attach(pair) | Action::Detach(pair) => format!("{} {}", action.kind(), faces(&self.start, pair)),
            Action::Move { motion, module, support, to } => {
                let motion = &self.start.catalogue.motions[usize::from(*motion)].name;
                let about = support.map_or_else(String::new, |support| format!("about {} ", id(support)));
                format!("{motion:<6} {} {about}to {}", id(*module), cell(*to))
            }
        }
    }

    fn held(&self, held: &FaceConnection) -> String {
        format!("connection {}", faces(&self.start, held))
    }

    fn touched(&self, touched: &Self::Touched) -> String {
        touched.to_string()
    }
}

impl Family for LinkageProblem {
    type Action = linkage::Action;
    type Connection = Held;
    type Touched = Touched;

    fn solve(&self, options: &Options, on_event: &mut OnEvent<'_, Self>) -> Result<Answer<Self>, Refusal> {
        linkage::solve(&self.start, &self.goal, options, on_event)
    }

    fn replay(&self, plan: &Plan<linkage::Action, Held>, required: f64) -> Result<Replay<Held, Touched>, Refusal> {
        linkage::replay::replay(&self.start, &self.goal, plan, required)
    }

    fn appraise(
        &self,
        plan: &Plan<linkage::Action, Held>,
        replay: &Replay<Held, Touched>,
    ) -> Result<Plan<linkage::Action, Held>, Refusal> {
        linkage::replay::appraise(&self.start, &self.goal, plan, replay)
    }

    fn id(&self, module: usize) -> &str {
        &self.start.modules[module].id
    }

    fn write(&self, report: &Answer<Self>) -> Result<String, Unwritable> {
        write_linkage_plan(&PlanDocument::new(self.clone(), report))
    }

    fn partial_order(&self, plan: &PlanOf<Self>, options: &OrderOptions) -> Result<OrderOf<Self>, BrokenOf<Self>> {
        linkage::partial_order(&self.start, plan, options)
    }

    fn write_order(
        document: &DocumentOf<Self>,
        report: &PartialOrderReport<'_, Touched>,
    ) -> Result<String, Unwritable> {
        write_linkage_partial_order(document, report)
    }

    fn required(&self) -> f64 {
        self.start.require.margin
    }

    fn is_move(action: &linkage::Action) -> bool {
        action.is_move()
    }

    fn action(&self, action: &linkage::Action) -> String {
        use linkage::Action;
        let id = |module: usize| &self.start.modules[module].id;
        match *action {
            Action::Attach(pair) | Action::Detach(pair) => {
                format!("{} {}", action.kind(), ports(&self.start, pair.ports))
            }
            Action::Roll { connection, to, carried } => {
                let [a, b] = connection.ports;
                let (near, far) = if a.module == carried { (a, b) } else { (b, a) };
                format!("roll   {} over {} to {}", port(&self.start, near), id(far.module), spot(to))
            }
            Action::Rotate { module, joint, to, carried } => {
                let kind = &self.start.module_type(module).joints[joint];
                let side = match carried {
                    Half::Parent => ", the parent's side",
                    Half::Child => "",
                };
                let degrees = f64::from(to) * kind.step_degrees;
                format!("rotate {}.{} to {degrees}{side}", id(module), kind.name)
            }
        }
    }

    fn held(&self, held: &Held) -> String {
        match *held {
            Held::Ports(connection) => format!("connection {}", ports(&self.start, connection.ports)),
            Held::Joint { module, joint } => {
                let name = &self.start.module_type(module).joints[joint].name;
                format!("joint {}.{name}", self.start.modules[module].id)
            }
        }
    }

    fn touched(&self, touched: &Touched) -> String {
        match *touched {
            Touched::Body(BodyOf { module, body }) => {
                let (id, bodies) = (&self.start.modules[module].id, &self.start.module_type(module).bodies);
                if bodies.len() == 1 { id.clone() } else { format!("{id}.{}", bodies[body].name) }
            }
            Touched::Ground | Touched::Obstacle(_) => touched.to_string(),
        }
    }
}

/// `a:+x - b:-x`.
fn faces(start: &Configuration, connection: &FaceConnection) -> String {
    connection.ports.map(|port| format!("{}:{}", start.modules[port.module].id, port.face.name())).join(" - ")
}

/// `s:top - n:surface`.
fn ports(start: &Linkage, ports: [Port; 2]) -> String {
    ports.map(|found| port(start, found)).join(" - ")
}

fn port(start: &Linkage, port: Port) -> String {
    format!("{}:{}", start.modules[port.module].id, start.module_type(port.module).ports[port.port].name)
}

fn cell([x, y, z]: Cell) -> String {
    format!("[{x}, {y}, {z}]")
}

/// Azimuth, polar angle and spin in degrees.
fn spot(spot: Spot) -> String {
    let degrees = |micro: i32| f64::from(micro) / f64::from(MICRO);
    format!("{}/{}/{}", degrees(spot.azimuth()), degrees(spot.polar()), degrees(spot.spin()))
}
