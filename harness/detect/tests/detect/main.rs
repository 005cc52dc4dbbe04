//! Boards in pictures that are drawn from their layouts, and in photographs.

mod chessboard;
mod circles;
mod conformance;
mod dotted;
mod photographs;
mod picture;
mod puzzle;
mod refusals;
mod several;
mod unknown;
mod wide;
