//! Tests that cross crates: see `calibench/main.rs`.
