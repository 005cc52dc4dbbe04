//! Swept scenarios: their figures over what is swept, as curves, maps and tables.

mod axes;
mod curves;
mod layout;
mod map;
mod metric;
mod numbers;
mod section;
mod units;

pub use crate::load::sweep::{Gather, LoadedMethod, LoadedSweep, load, load_with};
pub use curves::curves;
pub use layout::{Choice, Dimension, Layout, LayoutError, cells};
pub use map::map;
pub use metric::{Estimate, Metric, share};
pub use numbers::write_numbers;
pub use section::{deviations, section};
pub use units::{shown as axis_number, titled};
