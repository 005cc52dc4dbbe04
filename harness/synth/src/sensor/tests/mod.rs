//! Each stage against theory.
