//! What the rows of a table have in common, and what may stand in it once.

use std::collections::HashSet;

use crate::cells::{Cells, RecordError};

/// Columns that are the same in all rows, as what tells the run.
pub(crate) struct Shared<const N: usize> {
    columns: [usize; N],
    first: Option<[String; N]>,
}

impl<const N: usize> Shared<N> {
    pub(crate) const fn new(columns: [usize; N]) -> Self {
        Self { columns, first: None }
    }

    /// # Errors
    /// A row of another run than the first one.
    pub(crate) fn check(&mut self, row: &Cells<'_>) -> Result<(), RecordError> {
        let first = self.first.get_or_insert_with(|| self.columns.map(|column| row.text(column).to_owned()));
        let differs = self.columns.iter().zip(first).find(|(column, first)| row.text(**column) != **first);
        differs.map_or(Ok(()), |(column, first)| Err(row.other(*column, first)))
    }
}

/// What a trial has said: trials rise, and each says a thing once.
#[derive(Default)]
pub(crate) struct Once<const N: usize> {
    trial: Option<u64>,
    said: HashSet<[usize; N]>,
}

impl<const N: usize> Once<N> {
    /// Whether the trial of `number`, which `column` holds, begins with this row.
    ///
    /// # Errors
    /// A trial that comes after a later one.
    pub(crate) fn trial(&mut self, row: &Cells<'_>, column: usize, number: u64) -> Result<bool, RecordError> {
        match self.trial {
            Some(trial) if trial == number => Ok(false),
            Some(trial) if trial > number => Err(row.other(column, &format!("{trial} or more"))),
            _ => {
                self.trial = Some(number);
                self.said.clear();
                Ok(true)
            }
        }
    }

    /// Whether `what` was not said in this trial before.
    pub(crate) fn is_new(&mut self, what: [usize; N]) -> bool {
        self.said.insert(what)
    }
}
