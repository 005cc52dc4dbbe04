//! Why a command fails.

use std::io::{self, IsTerminal};

use calibench_diagnostics::Problems;
use calibench_model::escape;
use calibench_project::ProjectError;

/// Why a command ends with another exit code than 0.
pub enum Failure {
    /// A gate failed and has said why: exit code 1.
    Gate,
    /// A result that is doubtful, and says why: exit code 3.
    Doubt,
    /// Bad input, or output that cannot be written: exit code 2.
    Input(String),
    /// The same, as a picture with colours.
    Picture(String),
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Input(error.to_string())
    }
}

impl Failure {
    /// Bad input, in words.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(message.into())
    }
}

/// What is wrong with a project; mistakes in a file as a picture of the lines that they are about.
pub fn project_failure(error: ProjectError) -> Failure {
    match error {
        ProjectError::Problems(problems) => Failure::Picture(picture(&problems)),
        other => other.into(),
    }
}

fn picture(problems: &Problems) -> String {
    let count = problems.problems.len();
    let noun = if count == 1 { "mistake" } else { "mistakes" };
    format!("{count} {noun} in {}\n{}", escape::name(&problems.file), problems.picture(io::stderr().is_terminal()))
}
