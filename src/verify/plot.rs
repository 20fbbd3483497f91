//! Errors over their tolerances.

use super::cell::{Cell, Column};
use super::matrix::Matrix;
use trackbed_io::plot::{Axis, Curve, Level, Plot, Style};

/// Errors below it are drawn at it.
const LEAST: f64 = 1e-6;

/// Draws |error|/tolerance of all rows, one series per program with results; rows are numbered from 1.
pub fn errors(matrix: &Matrix) -> Plot {
    let point = |k: usize, cell: &Cell| match cell {
        Cell::Computed { error, .. } => {
            let ratio = error.abs() / matrix.plan.rows[k].quantity.tolerance;
            Some([(k + 1) as f64, ratio.max(LEAST)])
        }
        _ => None,
    };
    let curve = |(c, column): (usize, &Column)| {
        let points = column.cells.iter().enumerate().filter_map(|(k, cell)| point(k, cell)).collect();
        Curve::new(column.title.clone(), points, Style { colour: c, dash: 0, line: false, marks: true })
    };
    Plot {
        title: "Errors of the verification cases".into(),
        x: Axis::new("row", ""),
        y: Axis::new("error over its tolerance", "1").logarithmic(),
        curves: matrix.columns.iter().enumerate().map(curve).filter(|c| !c.points.is_empty()).collect(),
        level: Some(Level { name: "tolerance".into(), y: 1.0, tolerance: 0.0 }),
    }
}
