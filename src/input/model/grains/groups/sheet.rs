//! Sheets of floes bonded across their common faces.

use super::polygon::{Point, sides};
use crate::model::grains::bonds::BondPart;
use trackbed_dem::bond::Face;

/// Shortest bonded side over √(cell area).
const SHORT: f64 = 1e-3;

#[derive(Clone, Copy, Debug)]
pub(super) struct Floe {
    /// Body index.
    pub body: usize,
    /// Centre of mass in plan [m].
    pub centre: Point,
}

/// Bonds floes whose cells share a side. `cells` and `floes` like `sites`; removed floes are `None`.
pub(super) fn join(
    sites: &[Point],
    cells: &[Vec<Point>],
    floes: &[Option<Floe>],
    thickness: f64,
    kind: usize,
    bonds: &mut BondPart,
) {
    for ([i, j], [p, q]) in shared(sites, cells) {
        let (Some(a), Some(b)) = (floes[i], floes[j]) else { continue };
        bonds.join_face([a.body, b.body], kind, face([a.centre, b.centre], [p, q], thickness));
    }
}

fn face([a, b]: [Point; 2], [p, q]: [Point; 2], thickness: f64) -> Face {
    let way = [0, 1].map(|d| a[d] - b[d]);
    let length = libm::hypot(way[0], way[1]);
    // From face to centres.
    let middle = [0, 1].map(|d| 0.5 * (p[d] + q[d]));
    let from = |centre: Point| (0..2).map(|d| (centre[d] - middle[d]) * way[d] / length).sum::<f64>();
    Face { size: [libm::hypot(q[0] - p[0], q[1] - p[1]), thickness], offset: from(a) + from(b) }
}

/// Pairs of sites with a common side, ascending.
fn shared(sites: &[Point], cells: &[Vec<Point>]) -> Vec<([usize; 2], [Point; 2])> {
    let mut order: Vec<usize> = (0..sites.len()).collect();
    order.sort_by(|&a, &b| sites[a][0].total_cmp(&sites[b][0]));
    let mut found = Vec::new();
    for (i, cell) in cells.iter().enumerate() {
        let size = super::polygon::area(cell).0.sqrt();
        for [p, q] in sides(cell) {
            let way = [q[0] - p[0], q[1] - p[1]];
            let length = libm::hypot(way[0], way[1]);
            if length < SHORT * size {
                continue;
            }
            // The neighbour is the mirror image.
            let normal = [way[1] / length, -way[0] / length];
            let off = (p[0] - sites[i][0]) * normal[0] + (p[1] - sites[i][1]) * normal[1];
            let image = [0, 1].map(|d| sites[i][d] + 2.0 * off * normal[d]);
            let near = 1e-4 * size;
            let first = order.partition_point(|&k| sites[k][0] < image[0] - near);
            let candidates = order[first..].iter().take_while(|&&k| sites[k][0] <= image[0] + near);
            let neighbour = candidates.copied().find(|&k| (sites[k][1] - image[1]).abs() <= near);
            if let Some(j) = neighbour.filter(|j| *j > i) {
                found.push(([i, j], [p, q]));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::voronoi::cells;
    use super::*;
    use trackbed_dem::random::Random;

    #[test]
    fn sides_are_shared() {
        let mut random = Random::new(4, 0);
        let sites: Vec<Point> =
            (0..500).map(|_| [random.uniform() * 40.0, random.uniform() * 25.0]).collect();
        let cells = cells(&sites, [[0.0, 0.0], [40.0, 25.0]]);
        let length = |[p, q]: [Point; 2]| libm::hypot(q[0] - p[0], q[1] - p[1]);
        let all: f64 = cells.iter().flat_map(|c| sides(c)).map(length).sum();
        let shared = shared(&sites, &cells);
        let inner: f64 = shared.iter().map(|(_, side)| length(*side)).sum();
        assert!((all - 2.0 * inner - 130.0).abs() < 1e-2, "{all} {inner}");
        // About three per cell (Euler).
        assert!((1350..1500).contains(&shared.len()), "{}", shared.len());
    }

    #[test]
    fn faces_lie_between_their_floes() {
        for turn in [0.0, 0.7, 2.5] {
            let (sin, cos) = (libm::sin(turn), libm::cos(turn));
            let at = |x: f64, y: f64| [5.0 + cos * x - sin * y, -2.0 + sin * x + cos * y];
            let face = face([at(1.0, 0.0), at(-3.0, 0.0)], [at(0.0, -0.7), at(0.0, 1.3)], 0.5);
            assert!((face.size[0] - 2.0).abs() < 1e-12 && face.size[1] == 0.5, "{face:?}");
            assert!((face.offset + 2.0).abs() < 1e-12, "{face:?}");
        }
    }
}
