//! What is wrong with a file, and where.

use std::fmt;
use std::ops::Range;

use calibench_model::escape;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use thiserror::Error;

/// One mistake in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// What was found and what was expected.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

impl Problem {
    /// A problem without further help.
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, message: message.into(), help: None }
    }

    /// The same problem with help.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// The same problem, with the nearest of `known` names as help if one is near.
    #[must_use]
    pub fn nearest<'a>(self, name: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(name, known) {
            Some(near) => self.help(format!("did you mean `{near}`?")),
            None => self,
        }
    }
}

/// The name in `known` that `name` was most likely meant to be.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let scored = known.into_iter().map(|candidate| (strsim::jaro_winkler(name, candidate), candidate));
    scored.filter(|(score, _)| *score > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, candidate)| candidate)
}

/// All that is wrong with one file.
#[derive(Clone, Debug, Error)]
pub struct Problems {
    /// The file, as the user named it.
    pub file: String,
    /// Its text.
    pub text: String,
    /// At least one problem, in the order of the text.
    pub problems: Vec<Problem>,
}

impl Problems {
    /// Line and column, counted from 1, of byte `offset`.
    pub fn place(&self, offset: usize) -> (usize, usize) {
        let before = &self.text[..self.text.floor_char_boundary(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// The problems with the lines that they are about, for a terminal; `colour` if it shows colours.
    pub fn picture(&self, colour: bool) -> String {
        let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
        let handler = GraphicalReportHandler::new_themed(theme).with_width(120);
        let mut picture = String::new();
        for problem in &self.problems {
            let source = NamedSource::new(escape::name(&self.file), escape::in_place(&self.text));
            let problem = &Problem {
                span: problem.span.clone(),
                message: escape::message(&problem.message).into_owned(),
                help: problem.help.as_deref().map(|help| escape::message(help).into_owned()),
            };
            // Writing to a String cannot fail.
            let _ = handler.render_report(&mut picture, &Picture { problem, source });
        }
        picture
    }
}

/// `file:line:column: message` for each problem.
impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            let (line, column) = self.place(problem.span.start);
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}:{line}:{column}: {}", escape::name(&self.file), escape::message(&problem.message))?;
            if let Some(help) = &problem.help {
                write!(f, " ({})", escape::message(help))?;
            }
        }
        Ok(())
    }
}

#[derive(Debug)]
struct Picture<'a> {
    problem: &'a Problem,
    source: NamedSource<String>,
}

impl fmt::Display for Picture<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem.message)
    }
}

impl std::error::Error for Picture<'_> {}

impl Diagnostic for Picture<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.problem.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(std::iter::once(LabeledSpan::underline(self.problem.span.clone()))))
    }
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Three digits, without an exponent where that is readable.
pub fn plain(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if (-4..6).contains(&magnitude) { format!("{value:.*}", (2 - magnitude).max(0) as usize) } else { format!("{value:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_from_one_and_in_characters() {
        let problems = Problems { file: "f".into(), text: "ä = 1\nüö = 2\n".into(), problems: Vec::new() };
        assert_eq!(problems.place(0), (1, 1));
        assert_eq!(problems.place(7), (2, 1));
        assert_eq!(problems.place(11), (2, 3));
        assert_eq!(problems.place(1000), (3, 1));
    }

    #[test]
    fn a_file_does_not_command_the_terminal() {
        let text = "name = \"\u{1b}[2Jwiped\u{9b}31m\"\n".to_owned();
        let problems = vec![Problem::new(0..4, "found `\u{1b}[2J`").help("\u{7}")];
        let problems = Problems { file: "f\u{1b}]0;x.toml".into(), text, problems };
        for shown in [problems.picture(false), problems.to_string()] {
            assert!(!shown.chars().any(|c| c.is_control() && c != '\n'), "{shown:?}");
        }
        assert!(problems.picture(false).contains("name = \"?[2Jwiped??31m\""), "{}", problems.picture(false));
    }

    #[test]
    fn only_near_names_are_proposed() {
        assert_eq!(nearest("windw", ["width", "window"]), Some("window"));
        assert_eq!(nearest("zzz", ["width", "window"]), None);
    }
}
