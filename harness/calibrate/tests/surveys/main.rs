//! Calibrations of networks with a known truth.

mod boards;
mod broken;
mod doubts;
mod free;
mod gross;
mod known;
mod network;
mod next;
mod orientations;
mod pairs;
mod per_image;
mod planted;
mod points;
mod reconstructed;
mod resampled;
mod rigs;
mod shapes;
mod starts;
mod surveys;
mod suspects;
