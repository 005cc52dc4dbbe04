//! What a plug-in answers: a line of JSON.

use std::borrow::Cow;

use calibench_model::{Covariance, Measurement, PixelPoint, Rejection};
use serde::Deserialize;

/// What stands for infinity, which JSON does not have.
const HUGE: &str = "1e300";
/// A position further off, px, is taken for infinite.
const FARTHEST: f64 = 1e100;

/// What cannot be used, and what is said of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The reason that its points get.
    pub rejection: Rejection,
    /// In words.
    pub message: String,
}

impl Fault {
    pub fn new(rejection: Rejection, message: impl Into<String>) -> Self {
        Self { rejection, message: message.into() }
    }
}

/// The answer to the greeting.
#[derive(Debug, Deserialize)]
pub struct Greeted {
    /// The plug-in's own version.
    #[serde(default)]
    pub version: Option<Text>,
    /// Why it cannot run.
    #[serde(default)]
    pub error: Option<String>,
}

/// A text, or a number that stands for one.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub enum Text {
    Word(String),
    Number(serde_json::Number),
}

impl std::fmt::Display for Text {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Word(word) => f.write_str(word),
            Self::Number(number) => write!(f, "{number}"),
        }
    }
}

#[derive(Deserialize)]
struct Wire {
    #[serde(default)]
    image: Option<u64>,
    #[serde(default)]
    xy: Option<Vec<Option<Vec<Option<f64>>>>>,
    #[serde(default)]
    cov: Option<Vec<Option<Vec<Option<f64>>>>>,
    #[serde(default)]
    reasons: Option<Vec<Option<String>>>,
    #[serde(default)]
    names: Option<Vec<String>>,
    #[serde(default)]
    error: Option<String>,
}

/// What is said of each position, in the order of the answer, and what else has to be told.
#[derive(Debug, Default, PartialEq)]
pub struct Answer {
    pub points: Vec<Result<Measurement, Rejection>>,
    pub told: Vec<String>,
    /// Which points of a board these are; none where it was asked for none.
    pub names: Vec<String>,
}

/// The answer to the greeting.
pub fn greeted(line: &str) -> Result<Greeted, String> {
    serde_json::from_str(line).map_err(|error| format!("expected a line of JSON as {{\"version\": \"1\"}}, found {}: {error}", shown(line)))
}

/// Reads an answer about `asked` positions of image `number`, or of any number up to `most` where it was asked for none.
pub fn read(line: &str, number: u64, asked: Option<usize>, most: usize) -> Result<Answer, Fault> {
    let malformed = |message: String| Fault::new(Rejection::Malformed, message);
    let wire: Wire = serde_json::from_str(&without_nan(line)).map_err(|error| {
        malformed(format!("expected a line of JSON as {{\"image\": 1, \"xy\": [[1.5, 2.5], null]}}, found {}: {error}", shown(line)))
    })?;
    if let Some(error) = wire.error {
        return Err(Fault::new(Rejection::Raised, error));
    }
    let positions = wire.xy.ok_or_else(|| malformed("the answer has no `xy`".into()))?;
    if wire.image != Some(number) {
        // How many images a process was asked for before is chance, and what is told is none.
        let found = wire.image.map_or("none", |_| "another");
        return Err(malformed(format!("`image` must be that of the request, found {found}")));
    }
    let count = positions.len();
    match asked {
        Some(asked) if asked != count => return Err(malformed(format!("`xy` has {count} positions, asked for were {asked}"))),
        None if count > most => return Err(malformed(format!("{count} positions in one image; expected {most} at most"))),
        _ => {}
    }
    let lengths = [
        ("cov", wire.cov.as_ref().map(Vec::len)),
        ("reasons", wire.reasons.as_ref().map(Vec::len)),
        ("names", wire.names.as_ref().map(Vec::len)),
    ];
    for (name, length) in lengths {
        if let Some(length) = length.filter(|length| *length != count) {
            return Err(malformed(format!("`{name}` has {length} entries, `xy` has {count}")));
        }
    }
    let (covariances, reasons) = (wire.cov.unwrap_or_default(), wire.reasons.unwrap_or_default());
    let mut answer = Answer { names: wire.names.unwrap_or_default(), ..Answer::default() };
    for (index, position) in positions.into_iter().enumerate() {
        let covariance = covariances.get(index).and_then(Option::as_ref);
        answer.points.push(point(position, covariance).map_err(|fault| {
            let reason = reasons.get(index).and_then(Clone::clone);
            answer.told.extend(reason.or((fault.rejection != Rejection::Declined).then_some(fault.message)));
            fault.rejection
        }));
    }
    Ok(answer)
}

fn point(position: Option<Vec<Option<f64>>>, covariance: Option<&Vec<Option<f64>>>) -> Result<Measurement, Fault> {
    let Some(position) = position else { return Err(Fault::new(Rejection::Declined, "")) };
    let [x, y] = numbers(&position).ok_or_else(|| malformed("a position is not [x, y]"))?;
    let [Some(x), Some(y)] = [x, y] else { return Err(Fault::new(Rejection::Declined, "")) };
    let at = PixelPoint::new(x, y);
    if x.abs().max(y.abs()) > FARTHEST {
        return Err(malformed("a position is infinite"));
    }
    let Some(covariance) = covariance else { return Ok(Measurement { position: at, covariance: None }) };
    let [sxx, sxy, syy] = numbers(covariance).ok_or_else(|| malformed("a covariance is not [sxx, sxy, syy]"))?;
    let [Some(sxx), Some(sxy), Some(syy)] = [sxx, sxy, syy] else { return Ok(Measurement { position: at, covariance: None }) };
    let covariance = Covariance { sxx, sxy, syy };
    if !covariance.is_valid() {
        return Err(malformed("a covariance is none: expected sxx, syy > 0 and sxx syy > sxy^2"));
    }
    Ok(Measurement { position: at, covariance: Some(covariance) })
}

fn malformed(message: &str) -> Fault {
    Fault::new(Rejection::Malformed, message)
}

fn numbers<const N: usize>(values: &[Option<f64>]) -> Option<[Option<f64>; N]> {
    values.try_into().ok()
}

/// JSON has no NaN, but many a language writes one: null.
fn without_nan(line: &str) -> Cow<'_, str> {
    if !line.contains("NaN") && !line.contains("Infinity") {
        return Cow::Borrowed(line);
    }
    let mut out = String::with_capacity(line.len());
    let (mut rest, mut quoted) = (line, false);
    while let Some(c) = rest.chars().next() {
        let word = if quoted { None } else { [("NaN", "null"), ("Infinity", HUGE)].into_iter().find(|(word, _)| rest.starts_with(word)) };
        if let Some((word, json)) = word {
            out.push_str(json);
            rest = &rest[word.len()..];
            continue;
        }
        out.push(c);
        rest = &rest[c.len_utf8()..];
        match c {
            '"' => quoted = !quoted,
            '\\' if quoted => {
                out.extend(rest.chars().next());
                rest = &rest[rest.chars().next().map_or(0, char::len_utf8)..];
            }
            _ => {}
        }
    }
    Cow::Owned(out)
}

/// The beginning of a line, for a message.
pub fn shown(line: &str) -> String {
    let start: String = line.chars().take(60).collect();
    if line.is_empty() { "an empty line".into() } else { format!("`{start}{}`", if line.chars().count() > 60 { "..." } else { "" }) }
}
