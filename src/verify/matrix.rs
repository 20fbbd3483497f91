//! Matrix of cases and programs.

use super::cell::{Cell, Column};
use super::plan::{Plan, Row};
use serde_json::{Value, json};

/// Cases and the columns of programs, trackbed first.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// Cases and programs.
    pub plan: Plan,
    /// Columns.
    pub columns: Vec<Column>,
}

/// Error of another program above the tolerance.
#[derive(Clone, Debug)]
pub struct Difference<'a> {
    /// Case.
    pub row: &'a Row,
    /// Program.
    pub column: &'a Column,
    /// Result.
    pub cell: &'a Cell,
    /// Explanation, if any.
    pub explanation: Option<&'a str>,
}

impl Matrix {
    /// Returns the cells of row `k` by column.
    pub fn cells(&self, k: usize) -> impl Iterator<Item = &Cell> {
        self.columns.iter().map(move |column| &column.cells[k])
    }

    /// Returns the own columns, the CPU first.
    pub fn own(&self) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|column| column.own)
    }

    /// Returns the own rows that fail, or have no value on the CPU.
    pub fn failed(&self) -> Vec<&Row> {
        let fails = |k: usize| {
            let mut states = self.own().map(|column| column.cells[k].passed());
            states.next() != Some(Some(true)) || states.any(|state| state == Some(false))
        };
        self.plan.rows.iter().enumerate().filter(|(k, _)| fails(*k)).map(|(_, row)| row).collect()
    }

    /// Returns the differences of the other programs above the tolerance.
    pub fn differences(&self) -> Vec<Difference<'_>> {
        let mut all = Vec::new();
        for column in self.columns.iter().filter(|column| !column.own) {
            for (row, cell) in self.plan.rows.iter().zip(&column.cells) {
                if cell.passed() == Some(false) {
                    let explanation = row.table.explained.get(&column.name).map(String::as_str);
                    all.push(Difference { row, column, cell, explanation });
                }
            }
        }
        all
    }

    /// Returns the content of `verify.json`.
    pub fn json(&self) -> Value {
        let row = |(k, row): (usize, &Row)| {
            let cells: serde_json::Map<String, Value> =
                self.columns.iter().map(|c| (c.name.clone(), json!(c.cells[k]))).collect();
            json!({
                "name": row.table.name,
                "group": row.table.group,
                "case": row.table.case,
                "scene": row.table.scene,
                "set": row.table.set,
                "unit": row.quantity.unit,
                "reference": row.reference,
                "formula": row.table.formula,
                "source": row.table.source,
                "norm": row.norm(),
                "tolerance": row.quantity.tolerance,
                "explained": row.table.explained,
                "cells": cells,
            })
        };
        let program = |column: &Column| {
            let (within, known) = column.score();
            let seconds: f64 = column.cells.iter().map(Cell::seconds).sum();
            json!({
                "name": column.name,
                "title": column.title,
                "version": column.version,
                "missing": column.missing,
                "within": within,
                "computed": known,
                "seconds": seconds,
            })
        };
        json!({
            "passed": self.failed().is_empty(),
            "programs": self.columns.iter().map(program).collect::<Vec<_>>(),
            "rows": self.plan.rows.iter().enumerate().map(row).collect::<Vec<_>>(),
        })
    }
}
