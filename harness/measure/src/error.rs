//! Why there is no such method.

use thiserror::Error;

use crate::kinds::KindsError;

/// A method or parameter that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MethodError {
    /// No method has this name.
    #[error("no method is called `{name}`; known are {}", known.join(", "))]
    UnknownMethod {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// The method has no such parameter.
    #[error("`{method}` has no parameter `{key}`; {}", if known.is_empty() { "it has none".to_owned() } else { format!("it has {}", known.join(", ")) })]
    UnknownParameter {
        /// The method.
        method: String,
        /// What was asked for.
        key: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A value outside its domain.
    #[error("`{key}` of `{method}` must be {expected}, found {found}")]
    Domain {
        /// The method.
        method: String,
        /// The parameter.
        key: String,
        /// Values that are allowed.
        expected: String,
        /// The value that was given.
        found: String,
    },
    /// A parameter given twice.
    #[error("`{key}` of `{method}` is given twice")]
    Twice {
        /// The method.
        method: String,
        /// The parameter.
        key: String,
    },
    /// Kinds of targets that it cannot be limited to.
    #[error("`{method}`: {error}")]
    Kinds {
        /// The method.
        method: String,
        /// What is wrong with them.
        error: KindsError,
    },
    /// A method from outside whose files are wrong.
    #[error("`{method}`: {problem}")]
    File {
        /// The method.
        method: String,
        /// What is wrong, with its place.
        problem: String,
    },
    /// Not of the form `name:key=value,key=value`.
    #[error(
        "`{text}` is no method: expected `name` or `name:key=value,key=value`, as in `forstner:window=11`, or kinds of targets before it, as in \
         `disc+square=centroid`"
    )]
    Form {
        /// The text that was given.
        text: String,
    },
}
