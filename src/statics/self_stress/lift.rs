//! Whether lifting opens every contact.

use crate::spatial::Vec3;

use super::super::blocks::{Block, Link, Vertex, ends};
use super::super::clusters::Clusters;
use super::super::structure::Structure;

/// How much faster than friction needs a contact has to open, relative to the motion.
const CLEARLY: f64 = 1e-9;

/// Whether lifting each body by the height of what it is connected to opens every contact, so that only loads
/// press. Without gravity there is no height.
pub(super) fn opens(structure: &Structure, block: &Block) -> bool {
    let Some(up) = (-structure.gravity).try_normalize(0.0) else { return false };
    let clusters = Clusters::new(structure, block, |_, link| matches!(link, Link::Connection(_)));
    let mut centres = vec![(0.0, 0.0); clusters.count()];
    for &body in &block.bodies {
        if let Some(cluster) = clusters.of_body(block, body) {
            centres[cluster].0 += structure.bodies[body].com.dot(&up);
            centres[cluster].1 += 1.0;
        }
    }
    let contacts = block.links.iter().filter_map(|link| match link {
        Link::Contact(i) => Some(structure.contacts[*i].position.dot(&up)),
        Link::Connection(_) => None,
    });
    let lowest = contacts.fold(f64::INFINITY, f64::min);
    let height = |vertex: Vertex| match vertex {
        Vertex::Body(body) if vertex != block.root => clusters.of_body(block, body).map_or(0.0, |cluster| {
            let (sum, count) = centres[cluster];
            sum / count - lowest
        }),
        _ => 0.0,
    };
    block.links.iter().all(|&link| match link {
        Link::Connection(_) => true,
        Link::Contact(i) => {
            let contact = &structure.contacts[i];
            let [here, there] = ends(structure, link).map(height);
            let lifted: Vec3 = up * (here - there);
            let opening = lifted.dot(&contact.normal);
            let sliding = (lifted - contact.normal * opening).norm();
            opening - contact.friction * sliding > CLEARLY * (here.abs() + there.abs())
        }
    })
}
