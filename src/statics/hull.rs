//! Convex hulls of a few points in a plane.

/// Relative distance within which a point counts as on the hull's boundary.
const BOUNDARY: f64 = 1e-9;

/// The convex hull's corners, anticlockwise, without collinear points.
/// One point for coinciding, two for collinear input; none for none.
pub(super) fn convex_hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter().copied());
    hull.extend(half(&mut sorted.iter().rev().copied()));
    hull
}

/// An edge of a hull around the origin: outward unit normal and distance from
/// the origin in m.
pub(super) struct Edge {
    pub normal: [f64; 2],
    pub distance: f64,
}

/// Edges of the hull of `points`, with a distance of exactly 0 where the origin
/// lies on the edge up to rounding. A degenerate hull (a segment or a point) is
/// a polygon without area: its edges appear once for either side.
pub(super) fn edges(points: &[[f64; 2]]) -> Vec<Edge> {
    let hull = convex_hull(points);
    let size = size(points);
    let mut edges = Vec::with_capacity(hull.len().max(4));
    let mut push = |normal: [f64; 2], through: [f64; 2]| {
        let distance = normal[0] * through[0] + normal[1] * through[1];
        edges.push(Edge { normal, distance: if distance.abs() <= BOUNDARY * size { 0.0 } else { distance } });
    };
    match hull.as_slice() {
        [] => {}
        [point] => {
            for normal in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
                push(normal, *point);
            }
        }
        [a, b] => {
            let along = direction(*a, *b);
            push(along, *b);
            push([-along[0], -along[1]], *a);
            push([along[1], -along[0]], *a);
            push([-along[1], along[0]], *a);
        }
        corners => {
            for (i, a) in corners.iter().enumerate() {
                let along = direction(*a, corners[(i + 1) % corners.len()]);
                push([along[1], -along[0]], *a);
            }
        }
    }
    edges
}

/// Whether the origin lies in the convex hull of `points`, boundary included.
pub(super) fn origin_in_hull(points: &[[f64; 2]]) -> bool {
    !points.is_empty() && edges(points).iter().all(|edge| edge.distance >= 0.0)
}

/// Largest distance of a point from the origin.
pub(super) fn size(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max)
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn direction(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy);
    [dx / length, dy / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_has_four_edges_around_the_origin() {
        let square = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [0.2, 0.3], [1.0, 0.0]];
        let edges = edges(&square);
        assert_eq!(edges.len(), 4);
        assert!(edges.iter().all(|edge| (edge.distance - 1.0).abs() < 1e-15));
        assert!(origin_in_hull(&square));
    }

    #[test]
    fn origin_outside_or_on_the_boundary() {
        assert!(!origin_in_hull(&[[1.0, 0.0], [2.0, 1.0], [2.0, -1.0]]));
        assert!(origin_in_hull(&[[0.0, 1.0], [0.0, -1.0], [1.0, 0.0]]));
        assert!(origin_in_hull(&[[0.0, 0.0]]));
        assert!(!origin_in_hull(&[[0.1, 0.0]]));
        assert!(origin_in_hull(&[[-1.0, 0.0], [2.0, 0.0]]));
        assert!(!origin_in_hull(&[[-1.0, 0.1], [2.0, 0.1]]));
        assert!(!origin_in_hull(&[]));
    }
}
