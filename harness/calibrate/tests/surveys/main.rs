//! Calibrations of networks with a known truth.

mod network;
mod shapes;
mod starts;
mod surveys;
