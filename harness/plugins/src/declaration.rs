//! The file that declares plug-ins.

use std::collections::BTreeMap;
use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_measure::Parameter;
use calibench_measure::parameter::Domain;
use serde::Deserialize;
use toml::Spanned;

use crate::starts::{self, Starts};

/// A declared plug-in.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Its name among the methods.
    pub name: String,
    /// What it does, in a line.
    pub about: String,
    /// Where it is published.
    pub source: String,
    /// The program and its arguments; those that name a file beside the declaration are that file.
    pub command: Vec<String>,
    /// How it is asked.
    pub mode: Mode,
    /// Its parameters. Their texts live as long as the program, as those of built-in methods do.
    pub parameters: Vec<Parameter>,
    /// Which grey values it gets.
    pub grey: Grey,
    /// Whether it gets approximate positions.
    pub starts: Starts,
    /// How long it may take for an image, s.
    pub seconds: f64,
    /// How much memory it may have, bytes.
    pub memory: u64,
    /// The environment that its program and libraries are in: a folder with `bin`, by its name among those of the league; `None` for the system's own.
    pub environment: Option<String>,
}

/// How a plug-in is asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mode {
    /// By its standard input, image by image.
    Stream,
    /// By files; it is started for each image.
    Folder {
        /// Its version, which it cannot say itself.
        version: String,
    },
}

/// How grey values are written, row by row.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Grey {
    /// A byte a pixel, 0 to 255.
    #[default]
    Gray8,
    /// Two bytes a pixel, 0 to 65535: in a stream the lower one first, in a folder PNG.
    #[serde(alias = "gray16")]
    Gray16le,
    /// Four bytes a pixel, IEEE single precision, the lowest first, 0 to 1: the values as they are.
    Gray32f,
}

impl Grey {
    /// Its name in files and requests.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gray8 => "gray8",
            Self::Gray16le => "gray16le",
            Self::Gray32f => "gray32f",
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wire {
    name: Spanned<String>,
    about: Option<String>,
    source: Option<String>,
    command: Spanned<Vec<String>>,
    mode: Option<Spanned<String>>,
    version: Option<Spanned<String>>,
    #[serde(default)]
    parameters: BTreeMap<String, Spanned<ParameterWire>>,
    #[serde(default)]
    image: Grey,
    starts: Option<Spanned<String>>,
    radius: Option<Spanned<f64>>,
    boards: Option<Spanned<Vec<String>>>,
    origin: Option<Spanned<String>>,
    outwards: Option<Spanned<starts::Outwards>>,
    seconds: Option<Spanned<f64>>,
    memory: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterWire {
    default: toml::Value,
    min: toml::Value,
    max: toml::Value,
    #[serde(default)]
    odd: bool,
    about: Option<String>,
}

/// How long a plug-in may take for an image unless its file says otherwise, s.
const SECONDS: f64 = 30.0;
/// How much memory it may have unless its file says otherwise.
const MEMORY: &str = "2 GB";

/// What a program may take.
pub(crate) struct Limits {
    /// For a question, s.
    pub(crate) seconds: f64,
    /// Bytes.
    pub(crate) memory: u64,
}

impl Limits {
    /// Those that a file states, or the usual ones; mistakes are added to `problems`.
    pub(crate) fn checked(seconds: Option<&Spanned<f64>>, memory: Option<&Spanned<String>>, problems: &mut Vec<Problem>) -> Self {
        let limit = seconds.map_or(SECONDS, |seconds| *seconds.get_ref());
        if let Some(seconds) = seconds.filter(|_| !(limit > 0.0 && limit <= 86_400.0)) {
            problems.push(Problem::new(seconds.span(), format!("expected seconds from more than 0 to 86400, found {limit}")));
        }
        let text = memory.map_or(MEMORY, |memory| memory.get_ref().as_str());
        let bytes = bytes_of(text).unwrap_or_else(|| {
            let message = format!("`{text}` is no memory: expected as in \"2 GB\" or \"500 MB\"");
            problems.push(Problem::new(memory.map_or(0..0, Spanned::span), message));
            0
        });
        Self { seconds: limit, memory: bytes }
    }
}

/// The checked declaration of `file`; mistakes are added to `problems`.
pub(crate) fn checked(wire: Wire, file: &str, problems: &mut Vec<Problem>) -> Option<Declaration> {
    let before = problems.len();
    problems.extend(no_name(&wire.name));
    problems.extend(no_program(&wire.command));
    let Limits { seconds, memory } = Limits::checked(wire.seconds.as_ref(), wire.memory.as_ref(), problems);
    let mut wrong = |span: Range<usize>, message: String| problems.push(Problem::new(span, message));
    let Wire { name, about, source, command, mode, version, parameters, image, starts, radius, boards, origin, outwards, .. } = wire;
    let mode = mode_of(mode.as_ref(), version).unwrap_or_else(|(span, message)| {
        wrong(span, message);
        Mode::Stream
    });
    let starts = starts::checked(&starts::Wire { starts, radius, boards, origin, outwards }, &mut wrong);
    let mut declared = Vec::new();
    for (key, parameter) in parameters {
        match parameter_of(&key, parameter.as_ref()) {
            Ok(parameter) => declared.push(parameter),
            Err(message) => wrong(parameter.span(), message),
        }
    }
    (problems.len() == before).then(|| Declaration {
        about: about.unwrap_or_else(|| format!("{}, a plug-in", name.as_ref())),
        source: source.unwrap_or_else(|| file.to_owned()),
        name: name.into_inner(),
        command: command.into_inner(),
        mode,
        parameters: declared,
        grey: image,
        starts,
        seconds,
        memory,
        environment: None,
    })
}

fn mode_of(mode: Option<&Spanned<String>>, version: Option<Spanned<String>>) -> Result<Mode, (Range<usize>, String)> {
    match (mode.map_or("stream", |mode| mode.as_ref().as_str()), version) {
        ("folder", version) => Ok(Mode::Folder { version: version.map_or_else(|| "0".to_owned(), Spanned::into_inner) }),
        ("stream", None) => Ok(Mode::Stream),
        ("stream", Some(version)) => {
            Err((version.span(), "`version` is for mode = \"folder\": in a stream the program says it".to_owned()))
        }
        (other, _) => {
            let span = mode.map_or(0..0, Spanned::span);
            Err((span, format!("mode `{other}` is not known: expected \"stream\" or \"folder\"")))
        }
    }
}

/// What is wrong with a command, if it names no program.
pub(crate) fn no_program(command: &Spanned<Vec<String>>) -> Option<Problem> {
    let message = "expected the program and its arguments, as in [\"python3\", \"mine.py\"]";
    command.get_ref().first().is_none_or(String::is_empty).then(|| Problem::new(command.span(), message.to_owned()))
}

/// What is wrong with the name of a method, if it is none.
pub(crate) fn no_name(name: &Spanned<String>) -> Option<Problem> {
    let message = || format!("`{}` is no name of a method: expected small letters, digits and _, a letter first", name.as_ref());
    (!is_name(name.as_ref())).then(|| Problem::new(name.span(), message()))
}

/// Whether a text may be a method's name.
pub fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// Bytes from a text as `2 GB`: a kilobyte is 1000 of them.
fn bytes_of(text: &str) -> Option<u64> {
    let text = text.trim();
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let times = match unit.trim() {
        "kB" | "KB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        "TB" => 1e12,
        _ => return None,
    };
    let bytes = number.parse::<f64>().ok()? * times;
    (1e6..=1e15).contains(&bytes).then_some(bytes as u64)
}

fn parameter_of(key: &str, wire: &ParameterWire) -> Result<Parameter, String> {
    if !is_name(key) {
        return Err(format!("`{key}` is no name of a parameter: expected small letters, digits and _, a letter first"));
    }
    let whole = [&wire.default, &wire.min, &wire.max].into_iter().all(toml::Value::is_integer);
    let [default, min, max] = [("default", &wire.default), ("min", &wire.min), ("max", &wire.max)].map(|(name, value)| number(name, value));
    let (default, min, max) = (default?, min?, max?);
    let domain = match (whole, wire.odd) {
        (false, true) => return Err("`odd` is for whole numbers".into()),
        (false, false) => Domain::Real { min, max },
        (true, odd) => {
            let count = |value: f64| {
                if (0.0..=f64::from(u32::MAX)).contains(&value) {
                    Ok(value as u32)
                } else {
                    Err("whole numbers are not negative here: write 1.0 for a real one")
                }
            };
            let (min, max) = (count(min)?, count(max)?);
            if odd { Domain::Odd { min, max } } else { Domain::Whole { min, max } }
        }
    };
    if !domain.holds(default) {
        return Err(format!("the default must be {}, found {default}", domain.describe()));
    }
    let about = wire.about.clone().unwrap_or_else(|| "its own".to_owned());
    // As long as the program lives, like those of built-in methods.
    Ok(Parameter { name: leak(key.to_owned()), about: leak(about), domain, default, always_shown: key == "window" })
}

fn number(name: &str, value: &toml::Value) -> Result<f64, String> {
    let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    number.filter(|number| number.is_finite()).ok_or_else(|| format!("`{name}` must be a number"))
}

/// A text that lives as long as the program.
pub fn leak(text: String) -> &'static str {
    Box::leak(text.into_boxed_str())
}
