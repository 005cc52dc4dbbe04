//! Tests that cross crates.

fn main() {}
