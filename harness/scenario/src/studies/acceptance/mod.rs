//! `[acceptance]`: what a network's measuring must keep, decided in every trial as `accept` decides it.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

pub use calibench_accept::points::Classes;
use calibench_accept::{Limit, Rule};

pub(crate) use read::{read_classes, read_lengths};

/// Calibrated lengths that every trial measures.
#[derive(Clone, Debug, PartialEq)]
pub struct TestLines {
    /// Of each measurement line the targets on it, by their places in the field: a length goes from the first to each other one.
    pub lines: Vec<Vec<usize>>,
    /// The standard uncertainty of a calibrated length, object units; 0 where it is taken as exact.
    pub sigma: f64,
    /// The limit of errors, object units.
    pub limit: Limit,
    /// When an error is taken as within or beyond it.
    pub rule: Rule,
    /// Diagonal of the measuring volume, object units.
    pub diagonal: f64,
}

impl TestLines {
    /// The targets at the ends of each length, with the place of its line.
    pub fn lengths(&self) -> impl Iterator<Item = (usize, [usize; 2])> {
        let of = |(line, targets): (usize, &Vec<usize>)| {
            let from = targets[0];
            targets[1..].iter().map(move |&to| (line, [from, to])).collect::<Vec<_>>()
        };
        self.lines.iter().enumerate().flat_map(of)
    }
}
