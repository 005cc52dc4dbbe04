//! Words on standard error. Names come from files of others: what would command the terminal is escaped.

/// As `eprintln!`, for messages.
macro_rules! say {
    ($($message:tt)*) => {
        eprintln!("{}", calibench_model::escape::message(&format!($($message)*)))
    };
}
