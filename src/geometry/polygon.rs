//! Intersection of convex figures in a plane: polygons, segments, points.

/// A point in the plane.
pub(super) type Point2 = nalgebra::Vector2<f64>;

/// Corners of the convex hull, counter-clockwise, from the leftmost (then
/// lowest) point; points within `tolerance` of a corner are left out. One or two
/// points are the hull of themselves.
pub(super) fn convex_hull(mut points: Vec<Point2>, tolerance: f64) -> Vec<Point2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut distinct: Vec<Point2> = Vec::with_capacity(points.len());
    for point in points {
        if distinct.iter().all(|kept| (kept - point).norm() > tolerance) {
            distinct.push(point);
        }
    }
    if distinct.len() < 3 {
        return distinct;
    }
    let lower = half_hull(distinct.iter().copied(), tolerance);
    let upper = half_hull(distinct.iter().rev().copied(), tolerance);
    lower[..lower.len() - 1].iter().chain(&upper[..upper.len() - 1]).copied().collect()
}

/// Andrew's monotone chain: the part of the hull to the right of the walk.
fn half_hull(points: impl Iterator<Item = Point2>, tolerance: f64) -> Vec<Point2> {
    let mut chain: Vec<Point2> = Vec::new();
    for point in points {
        while let [.., a, b] = chain[..] {
            let base = point - a;
            // Height of the middle point over the chord, to its right.
            if base.perp(&(b - a)) < -tolerance * base.norm() {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain
}

/// The part of a convex figure (corners in order; a segment or a point) inside
/// a counter-clockwise convex polygon (Sutherland and Hodgman, CACM 1974).
pub(super) fn clip(figure: Vec<Point2>, polygon: &[Point2], tolerance: f64) -> Vec<Point2> {
    let mut inside = figure;
    for (i, &from) in polygon.iter().enumerate() {
        let along = (polygon[(i + 1) % polygon.len()] - from).normalize();
        let height = |p: &Point2| along.perp(&(p - from));
        let mut kept = Vec::with_capacity(inside.len() + 2);
        for (j, p) in inside.iter().enumerate() {
            let q = &inside[(j + 1) % inside.len()];
            let (hp, hq) = (height(p), height(q));
            if hp >= -tolerance {
                kept.push(*p);
            }
            if (hp < -tolerance && hq > tolerance) || (hp > tolerance && hq < -tolerance) {
                kept.push(p + (q - p) * (hp / (hp - hq)));
            }
        }
        inside = kept;
    }
    inside
}

/// Where two segments cross, if they do within `tolerance` of their ends;
/// `None` when they are parallel.
pub(super) fn crossing(a: [Point2; 2], b: [Point2; 2], tolerance: f64) -> Option<Point2> {
    let (along_a, along_b) = (a[1] - a[0], b[1] - b[0]);
    let (length_a, length_b) = (along_a.norm(), along_b.norm());
    let turn = along_a.perp(&along_b);
    let parallel = turn.abs() <= tolerance * length_a.min(length_b);
    if parallel {
        return None;
    }
    let share_a = (b[0] - a[0]).perp(&along_b) / turn;
    let share_b = (b[0] - a[0]).perp(&along_a) / turn;
    let within = |share: f64, length: f64| {
        let slack = tolerance / length;
        -slack <= share && share <= 1.0 + slack
    };
    (within(share_a, length_a) && within(share_b, length_b)).then(|| a[0] + along_a * share_a)
}

/// The common part of two segments on one line, within `tolerance`; empty when
/// they are not on one line or do not reach each other.
pub(super) fn common_of_segments(a: [Point2; 2], b: [Point2; 2], tolerance: f64) -> Vec<Point2> {
    let along = (a[1] - a[0]).normalize();
    if b.iter().any(|p| along.perp(&(p - a[0])).abs() > tolerance) {
        return Vec::new();
    }
    let at = |p: &Point2| along.dot(&(p - a[0]));
    let low = at(&b[0]).min(at(&b[1])).max(0.0);
    let high = at(&b[0]).max(at(&b[1])).min(at(&a[1]));
    if high < low - tolerance {
        return Vec::new();
    }
    vec![a[0] + along * low, a[0] + along * high]
}

/// Distance of a point from a segment.
pub(super) fn distance_to_segment(p: &Point2, from: Point2, to: Point2) -> f64 {
    let along = to - from;
    let share = ((p - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - from - along * share).norm()
}

/// How far a point is inside a counter-clockwise convex polygon: its distance from the
/// nearest side's line; negative outside.
pub(super) fn depth_within(p: &Point2, polygon: &[Point2]) -> f64 {
    let side = |i: usize| {
        let from = polygon[i];
        (polygon[(i + 1) % polygon.len()] - from).normalize().perp(&(p - from))
    };
    (0..polygon.len()).map(side).fold(f64::INFINITY, f64::min)
}
