//! The cells of the atlas as data: for a page on which one asks for one's own blur, noise, tilt, size or room.

use calibench_records::description::Axis;
use calibench_records::statistics::running::Running;
use serde_json::{Value, json};

use super::choose::{Candidate, MOST_FAILURES, Verdict};
use super::load::Part;
use super::page::Group;
use super::{Parts, rows};
use crate::speeds::Speeds;
use crate::sweep::{axis_number, titled};

/// What is asked, a question a group of the page; its rows are those of the page, with the same candidates and verdicts. Groups that ask for a speed
/// are none of their own: speed is asked for with every question.
pub(super) fn data(groups: &[Group], verdicts: &[Verdict], parts: &Parts, speeds: &Speeds) -> Value {
    let mut next = verdicts.iter();
    let mut questions = Vec::new();
    for group in groups {
        let verdicts: Vec<&Verdict> = next.by_ref().take(group.rows.len()).collect();
        let Some(part) = parts.get(&group.scenario).filter(|_| group.rows.iter().any(|row| !row.asks_for_speed)) else { continue };
        questions.push(question(group, &verdicts, part, speeds));
    }
    json!({ "most": MOST_FAILURES, "questions": questions })
}

fn question(group: &Group, verdicts: &[&Verdict], part: &Part, speeds: &Speeds) -> Value {
    let rows: Vec<Value> = group.rows.iter().zip(verdicts).map(|(row, verdict)| of_row(row, verdict)).collect();
    let row_of = |cell: usize| group.rows.iter().position(|row| row.cells.contains(&cell));
    let cells: Vec<(usize, usize)> = (0..part.sweep.cells.len()).filter_map(|cell| Some((cell, row_of(cell)?))).collect();
    // A question whose rows share cells is one of rows alone.
    let axes = if cells.is_empty() { Vec::new() } else { axes(part) };
    let columns = columns(part, speeds, &cells);
    json!({ "title": group.title, "about": group.about.replace('`', ""), "axes": axes, "cells": columns, "rows": rows })
}

/// A sweep's axes in the words and units of its plots.
fn axes(part: &Part) -> Vec<Value> {
    let of = |axis: &Axis| {
        let values: Vec<Option<f64>> =
            axis.values.iter().map(|value| value.number.map(|number| rounded(axis_number(axis, number)))).collect();
        json!({ "title": titled(axis), "values": values })
    };
    part.sweep.sweep.axes.iter().map(of).collect()
}

/// Where each cell lies on the axes, the row that it belongs to, and each method there.
fn columns(part: &Part, speeds: &Speeds, cells: &[(usize, usize)]) -> Value {
    let sweep = &part.sweep.sweep;
    let all: Vec<Vec<Candidate>> = cells.iter().map(|(cell, _)| rows::candidates(part, speeds, &[*cell])).collect();
    let first = all.first().map_or(&[][..], Vec::as_slice);
    let figure = |of: &dyn Fn(&Candidate) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
        all.iter().map(|candidates| candidates.iter().map(|one| of(one).filter(|value| value.is_finite()).map(rounded)).collect()).collect()
    };
    json!({
        "at": cells.iter().map(|(cell, _)| &sweep.cells[*cell].places).collect::<Vec<_>>(),
        "row": cells.iter().map(|(_, row)| row).collect::<Vec<_>>(),
        "names": first.iter().map(|one| &one.name).collect::<Vec<_>>(),
        "speed": first.iter().map(|one| one.speed.map(rounded)).collect::<Vec<_>>(),
        "rmse": figure(&|one| Some(one.rmse())),
        "low": figure(&|one| interval(&one.losses).map(|(low, _)| low)),
        "high": figure(&|one| interval(&one.losses).map(|(_, high)| high)),
        "failed": figure(&|one| Some(one.failures())),
    })
}

fn of_row(row: &rows::Row, verdict: &Verdict) -> Value {
    let column = |of: &dyn Fn(&Candidate) -> Value| row.candidates.iter().map(of).collect::<Vec<_>>();
    json!({
        "title": row.title,
        "take": verdict.best,
        "ties": verdict.ties,
        "names": column(&|one| json!(one.name)),
        // Whole, not rounded: their order is the page's.
        "rmse": column(&|one| json!(Some(one.rmse()).filter(|value| value.is_finite()))),
        "failed": column(&|one| json!(one.failures())),
        "speed": column(&|one| json!(one.speed)),
    })
}

/// The 95 % interval of the RMSE, from the scatter of the mean squared errors of the trials; `None` of fewer than two trials.
fn interval(losses: &[f64]) -> Option<(f64, f64)> {
    let mut sums = Running::default();
    losses.iter().for_each(|loss| sums.add(*loss));
    let (mean, half) = (sums.mean()?, sums.half()?);
    Some(((mean - half).max(0.0).sqrt(), (mean + half).sqrt()))
}

/// Four digits: what a reader sees.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_that_of_the_mean_squared_error() {
        // Three trials of 1, 2, 3 px^2: mean 2, deviation 1, t(0.975, 2) = 4.3027; half 2.484.
        let (low, high) = interval(&[1.0, 2.0, 3.0]).unwrap();
        assert!(low == 0.0 && (high - (2.0 + 4.3027 / 3.0_f64.sqrt()).sqrt()).abs() < 1e-4, "{low} {high}");
        assert_eq!(interval(&[1.0]), None);
        assert_eq!([0.012_344_9, 12_345.0, 2.0].map(rounded), [0.012_34, 12_340.0, 2.0]);
    }
}
