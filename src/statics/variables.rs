//! The variables of a link: which cones its connector is made of, and what each
//! variable does.
//!
//! Knows connectors, nothing of bodies or of what is asked of the program.

use crate::spatial::{Vec3, Wrench};

use super::blocks::Link;
use super::connector::Model;
use super::groups::{Cone, Form, Group};
use super::program::{Program, Purpose};
use super::structure::Structure;

impl Program {
    /// Adds the variables of a link, by its index in the block.
    pub(super) fn add_link(&mut self, structure: &Structure, index: usize, link: Link) {
        let (force, share) = (self.scales.link[index], self.shares[index]);
        match link {
            Link::Contact(i) => {
                self.add_friction_cone(index, structure.contacts[i].friction, [0.0; 2], force);
            }
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[i].connector];
                let strength = connector.strength * share;
                match &connector.model {
                    Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                        let axes = [(2, 1.0), (0, *a), (1, *b), (3, *c), (4, *d), (5, *e)];
                        self.add_group(index, Cone::Lorentz, Form::Axes(axes), 6, force);
                        self.rest_at(strength);
                        self.add_preload(index, Wrench::new(-Vec3::z() * strength, Vec3::zeros()));
                    }
                    Model::Patch { friction, points } => {
                        for &point in points {
                            self.add_friction_cone(index, *friction, point, force);
                            self.rest_at(strength / points.len() as f64);
                        }
                        self.add_preload(index, Wrench::new(-Vec3::z() * strength, Vec3::zeros()));
                    }
                    Model::Box { shear, tension, compression, bending, torsion } => {
                        let limits = [
                            (shear[0], shear[0]),
                            (shear[1], shear[1]),
                            (*tension, *compression),
                            (bending[0], bending[0]),
                            (bending[1], bending[1]),
                            (*torsion, *torsion),
                        ];
                        self.add_box(index, &limits.map(|(opening, closing)| (opening * share, closing * share)));
                    }
                }
            }
        }
    }

    /// The force of one contact point in the plane z = 0 of the link's frame.
    fn add_friction_cone(&mut self, link: usize, friction: f64, at: [f64; 2], scale: f64) {
        let form = Form::Point { at, friction };
        if friction > 0.0 {
            self.add_group(link, Cone::Lorentz, form, 3, scale);
        } else {
            self.add_group(link, Cone::NonNegative, form, 1, scale);
        }
    }

    fn add_box(&mut self, link: usize, limits: &[(f64, f64); 6]) {
        let lever = self.lever_of(link);
        let mut preload = [0.0; 6];
        for (component, &(negative, positive)) in limits.iter().enumerate() {
            let scale = self.scales.link[link] * if component < 3 { 1.0 } else { lever };
            let along = |factor| Form::Axes([(component, factor); 6]);
            match (negative.is_finite(), positive.is_finite()) {
                (false, false) => {
                    self.add_group(link, Cone::Free, along(1.0), 1, scale);
                }
                (true, false) => {
                    self.add_group(link, Cone::NonNegative, along(1.0), 1, scale);
                    self.rest_at(negative);
                    preload[component] -= negative;
                }
                (false, true) => {
                    self.add_group(link, Cone::NonNegative, along(-1.0), 1, scale);
                    self.rest_at(positive);
                    preload[component] += positive;
                }
                (true, true) if negative == 0.0 && positive == 0.0 => {}
                (true, true) => {
                    let slack = self.add_group(link, Cone::NonNegative, along(1.0), 1, scale);
                    self.rest_at(negative);
                    preload[component] -= negative;
                    self.tie(link, slack, scale, negative + positive);
                    self.rest_at(positive);
                }
            }
        }
        let [a, b, c, d, e, f] = preload;
        self.add_preload(link, Wrench::new(Vec3::new(a, b, c), Vec3::new(d, e, f)));
    }

    /// Adds the row `p + q = t width` that ties a box component's two slacks.
    fn tie(&mut self, link: usize, slack: usize, scale: f64, width: f64) {
        let row = self.rows();
        let width = -width / scale;
        let (fixed, growing) = if self.held[link] { (width, 0.0) } else { (0.0, width * self.t_scale) };
        self.load.push(fixed);
        self.row_factor.push(1.0 / scale);
        self.preload.push(growing);
        let one = self.groups.last_mut().expect("the slack that is tied");
        one.tie_row = Some(row);
        let other = self.add_group(link, Cone::NonNegative, Form::Slack, 1, scale);
        let other = self.groups.last_mut().filter(|group| group.first == other).expect("just added");
        (other.tie_row, other.ties) = (Some(row), Some(slack));
    }

    /// Adds a group of variables; returns the first one's index.
    fn add_group(&mut self, link: usize, cone: Cone, form: Form, len: usize, scale: f64) -> usize {
        let first = self.variables;
        self.variables += len;
        self.groups.push(Group { cone, first, len, link, form, scale, rest: 0.0, tie_row: None, ties: None });
        first
    }

    /// Says at what `strength` the group just added rests.
    fn rest_at(&mut self, strength: f64) {
        if let (Purpose::Utilisation, Some(group)) = (self.purpose, self.groups.last_mut()) {
            group.rest = strength * self.t_scale / group.scale;
        }
    }

    fn add_preload(&mut self, link: usize, local: Wrench) {
        if local == Wrench::ZERO {
            return;
        }
        match self.purpose {
            Purpose::Utilisation if self.held[link] => {
                let Wrench { force: f, torque: m } = local;
                for side in self.sides[link].iter().flatten() {
                    side.push(&[f.x, f.y, f.z, m.x, m.y, m.z], &mut self.load);
                }
                self.held_local[link] = local;
            }
            Purpose::Utilisation => {
                let Wrench { force: f, torque: m } = local * self.t_scale;
                for side in self.sides[link].iter().flatten() {
                    side.push(&[f.x, f.y, f.z, m.x, m.y, m.z], &mut self.preload);
                }
                self.preload_local[link] = local;
            }
            // A preload of any size, along z as in every model that has one.
            Purpose::Support => {
                let along = Form::Axes([(2, -1.0); 6]);
                self.add_group(link, Cone::NonNegative, along, 1, self.scales.link[link]);
            }
        }
    }
}
