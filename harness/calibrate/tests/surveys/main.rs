//! Calibrations of networks with a known truth.

mod network;
mod points;
mod shapes;
mod starts;
mod surveys;
