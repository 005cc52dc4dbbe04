//! Rendered boards and simulated corners, whose truth is known.
