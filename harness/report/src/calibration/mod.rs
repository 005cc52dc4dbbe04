//! A calibration as a page with pictures and tables, and as a summary for a terminal.

mod csv;
mod limits;
mod page;
mod pictures;
mod sets_page;
mod tables;

pub use page::{summary, write_report};

#[cfg(test)]
mod tests;
