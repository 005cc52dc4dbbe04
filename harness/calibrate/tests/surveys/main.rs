//! Calibrations of networks with a known truth.

mod network;
mod starts;
mod surveys;
