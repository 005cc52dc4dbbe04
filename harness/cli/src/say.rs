//! Words on standard error. Names come from files of others: what would command the terminal is escaped. Words that cannot be said, where standard error is full or
//! closed, change nothing of a command's result and of its exit code.

use std::fmt;
use std::io::{Write, stderr};

use calibench_model::escape;

/// As `eprintln!`, for messages.
macro_rules! say {
    ($($message:tt)*) => {
        crate::say::line(&format!($($message)*))
    };
}

/// Says a message, and ends the line.
pub fn line(message: &str) {
    plain(format_args!("{}\n", escape::message(message)));
}

/// Says words that are escaped already, as they are.
pub fn plain(words: impl fmt::Display) {
    stderr().lock().write_all(words.to_string().as_bytes()).ok();
}
