//! Voronoi cells in a box, by cutting along perpendicular bisectors (Okabe, Boots, Sugihara, Chiu, "Spatial
//! tessellations", 2nd ed., 2000, 4.2).

use super::polygon::{Point, clipped};

/// Cells of distinct sites in a box [m], counter-clockwise.
pub(super) fn cells(sites: &[Point], [low, high]: [Point; 2]) -> Vec<Vec<Point>> {
    let mut order: Vec<usize> = (0..sites.len()).collect();
    order.sort_by(|&a, &b| sites[a][0].total_cmp(&sites[b][0]));
    let corners = vec![low, [high[0], low[1]], high, [low[0], high[1]]];
    let mut cells = vec![Vec::new(); sites.len()];
    for (rank, &k) in order.iter().enumerate() {
        cells[k] = cell(sites, &order, rank, corners.clone());
    }
    cells
}

/// Sites beyond twice the farthest remaining corner do not cut the cell.
fn cell(sites: &[Point], order: &[usize], rank: usize, mut corners: Vec<Point>) -> Vec<Point> {
    let own = sites[order[rank]];
    let farthest = |corners: &[Point]| {
        let squares = corners.iter().map(|c| (c[0] - own[0]).powi(2) + (c[1] - own[1]).powi(2));
        squares.fold(0.0, f64::max).sqrt()
    };
    let mut reach = farthest(&corners);
    let (mut below, mut above) = (rank, rank + 1);
    loop {
        let left = if below > 0 { own[0] - sites[order[below - 1]][0] } else { f64::INFINITY };
        let right = if above < order.len() { sites[order[above]][0] - own[0] } else { f64::INFINITY };
        if left.min(right) > 2.0 * reach {
            return corners;
        }
        let other = if left <= right {
            below -= 1;
            sites[order[below]]
        } else {
            above += 1;
            sites[order[above - 1]]
        };
        let way = [other[0] - own[0], other[1] - own[1]];
        let square = way[0] * way[0] + way[1] * way[1];
        if square < 4.0 * reach * reach {
            let middle = [0, 1].map(|d| 0.5 * (own[d] + other[d]));
            corners = clipped(&corners, way, way[0] * middle[0] + way[1] * middle[1]);
            reach = farthest(&corners);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::polygon::area;
    use super::*;

    /// Reference: every fifth of 200 cells, from another program (see the file).
    #[test]
    fn cells_are_those_of_a_table() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/ice/voronoi.csv");
        let text = std::fs::read_to_string(file).unwrap();
        let rows: Vec<Vec<f64>> = (text.lines().skip_while(|l| !l.starts_with(|c: char| c.is_ascii_digit())))
            .map(|l| l.split(',').map(|f| f.parse().unwrap()).collect())
            .collect();
        let sites: Vec<Point> = rows.iter().map(|r| [r[0], r[1]]).collect();
        let cells = cells(&sites, [[0.0, 0.0], [50.0, 50.0]]);
        let (mut all, mut compared) = (0.0, 0);
        for (row, cell) in rows.iter().zip(&cells) {
            let (area, centroid) = area(cell);
            all += area;
            if let [_, _, exact, sides, x, y] = row[..] {
                compared += 1;
                assert_eq!(cell.len(), sides as usize, "{row:?}");
                assert!((area / exact - 1.0).abs() < 1e-10, "{row:?} {area}");
                let off = (centroid[0] - x).abs().max((centroid[1] - y).abs());
                assert!(off < 1e-8, "{row:?} {centroid:?}");
            }
        }
        assert_eq!(compared, 40);
        assert!((all - 2500.0).abs() < 1e-9, "{all}");
    }

    #[test]
    fn few_sites() {
        let of = |sites: &[Point]| -> Vec<f64> {
            cells(sites, [[0.0, 0.0], [2.0, 1.0]]).iter().map(|c| area(c).0).collect()
        };
        assert_eq!(of(&[[0.3, 0.3]]), [2.0]);
        assert_eq!(of(&[[1.5, 0.5], [0.5, 0.5]]), [1.0, 1.0]);
    }
}
