//! OpenCV's FileStorage in YAML.

use calibench_model::NamedCamera;
use saphyr_parser::{Event, Parser, Span, StrInput};

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::number::{scientific, shortened};
use crate::source::Source;
use crate::tree::{self, Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions, opencv};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opencv-yaml",
    tool: "OpenCV",
    versions: "FileStorage YAML:1.0 of 2.4 to 5; lists of lists, as Python's yaml writes them",
    extension: "yml",
    words: "rows cols dt data camera_matrix distortion_coefficients image_width image_height opencv",
    verified: Some("OpenCV's FileStorage reads what is written, number for number"),
    many: false,
    states_size: true,
    recognise,
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::Variances },
    half_space: true,
    named_matrices: true,
    ..PLAIN
};

/// Values at most: each takes memory.
const MOST_VALUES: usize = 1_000_000;
/// Depth of nesting at most.
const MOST_DEPTH: usize = 32;

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |key: &str| source.text.lines().any(|line| line.starts_with(key));
    let tagged = source.text.contains("!!opencv-matrix") || source.text.contains("!!opencv-nd-matrix");
    // As Python's yaml writes NumPy's lists.
    let listed = || source.xml.is_none() && has("camera_matrix:") && !has("distortion_model:") && opencv_lists(source.text);
    if source.xml.is_some() || !(tagged || source.text.starts_with("%YAML") || listed()) {
        return Err("neither a `%YAML` line at the top nor a `!!opencv-matrix`, nor `camera_matrix:` in lists".into());
    }
    // The first line alone is that of other tools' YAML, too; camodocal's may hold OpenCV's matrices.
    let others = has("model_type:") || (!tagged && (has("distortion_model:") || has("cam0:")));
    if others { Err("has the keys of another tool".into()) } else { Ok(()) }
}

/// Whether `camera_matrix` is rows of numbers.
fn opencv_lists(text: &str) -> bool {
    let matrix =
        |root: Entry| root.key("camera_matrix").is_ok_and(|matrix| matrix.is_some_and(|matrix| matches!(matrix.value, Value::List(_))));
    tree(text).is_ok_and(matrix)
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    opencv::read(&tree(source.text)?, options)
}

/// The tree of a FileStorage, or of any YAML.
pub(crate) fn tree(text: &str) -> Result<Entry, CameraFileError> {
    // OpenCV writes `%YAML:1.0`, which is no directive of YAML's.
    let (body, skipped) = match text.split_once('\n') {
        Some((first, rest)) if first.starts_with("%YAML") => (rest, version(first).map(|()| 1)?),
        _ => (text, 0),
    };
    let mut builder = Builder { parser: Parser::new_from_str(body), skipped, values: 0 };
    loop {
        let (event, span) = builder.next()?;
        match event {
            Event::StreamStart | Event::DocumentStart(_) => {}
            Event::StreamEnd | Event::DocumentEnd => return Err(CameraFileError::new("holds no value; expected a camera")),
            other => return builder.entry(other, span, 0),
        }
    }
}

fn version(line: &str) -> Result<(), CameraFileError> {
    let version = line.trim_start_matches("%YAML").trim_start_matches(':').trim();
    if version.starts_with("1.") {
        return Ok(());
    }
    Err(CameraFileError::new(format!("YAML version `{}` is not known; expected 1.0", shortened(version))).on_line(1))
}

/// Builds values from the parser's events; nothing is expanded.
struct Builder<'a> {
    parser: Parser<'a, StrInput<'a>>,
    /// Lines before the parser's first.
    skipped: usize,
    values: usize,
}

impl<'a> Builder<'a> {
    fn next(&mut self) -> Result<(Event<'a>, Span), CameraFileError> {
        match self.parser.next_event() {
            Some(Ok(event)) => Ok(event),
            Some(Err(error)) => {
                let at = error.marker();
                let problem = format!("not well-formed YAML: {}", shortened(error.info()));
                Err(CameraFileError::new(problem).on_line(at.line() + self.skipped).in_column(at.col() + 1))
            }
            None => Err(CameraFileError::new("ends too early")),
        }
    }

    fn entry(&mut self, event: Event<'a>, span: Span, depth: usize) -> Result<Entry, CameraFileError> {
        let line = span.start.line() + self.skipped;
        let refused = |problem: &str| Err(CameraFileError::new(problem).on_line(line));
        self.values += 1;
        if self.values > MOST_VALUES {
            return refused(&format!("more than {MOST_VALUES} values; expected a camera"));
        }
        if depth > MOST_DEPTH {
            return refused(&format!("more than {MOST_DEPTH} values inside each other; expected a camera"));
        }
        let value = match event {
            Event::Scalar(text, ..) => Value::Scalar(text.into_owned()),
            Event::SequenceStart(..) => Value::List(self.list(depth)?),
            Event::MappingStart(..) => tree::map(self.map(depth)?)?,
            Event::Alias(_) => return refused("references (`*name`) are refused; expected values"),
            _ => return refused("expected a value"),
        };
        Ok(Entry { line, value })
    }

    fn list(&mut self, depth: usize) -> Result<Vec<Entry>, CameraFileError> {
        let mut entries = Vec::new();
        loop {
            match self.next()? {
                (Event::SequenceEnd, _) => return Ok(entries),
                (event, span) => entries.push(self.entry(event, span, depth + 1)?),
            }
        }
    }

    fn map(&mut self, depth: usize) -> Result<Vec<(String, Entry)>, CameraFileError> {
        let mut entries = Vec::new();
        loop {
            let (event, span) = self.next()?;
            let key = match event {
                Event::MappingEnd => return Ok(entries),
                Event::Scalar(text, ..) => text.into_owned(),
                _ => return Err(CameraFileError::new("expected a name").on_line(span.start.line() + self.skipped)),
            };
            let (event, span) = self.next()?;
            entries.push((key, self.entry(event, span, depth + 1)?));
        }
    }
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera = opencv::written(&cameras[0].camera, &FORMAT)?;
    let mut out = String::from("%YAML:1.0\n---\n");
    if !cameras[0].name.is_empty() {
        out.push_str(&format!("camera_name: {}\n", quoted(&cameras[0].name)));
    }
    out.push_str(&format!("image_width: {}\nimage_height: {}\n", camera.size.width, camera.size.height));
    out.push_str(&format!("fisheye_model: {}\n", u8::from(camera.fisheye)));
    out.push_str(&matrix("camera_matrix", 3, &camera.matrix));
    out.push_str(&matrix("distortion_coefficients", camera.distortion.len(), &camera.distortion));
    out.extend(camera.xi.map(|xi| matrix("xi", 1, &[xi])));
    out.extend(opencv::written_spreads(&cameras[0]).iter().map(|(name, sigmas)| matrix(name, sigmas.len(), sigmas)));
    Ok(out)
}

pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out + "\""
}

pub(crate) fn matrix(name: &str, rows: usize, data: &[f64]) -> String {
    let columns = data.len() / rows;
    let lines: Vec<String> =
        data.chunks(columns.max(3)).map(|row| row.iter().map(|&v| scientific(v)).collect::<Vec<_>>().join(", ")).collect();
    let data = lines.join(",\n       ");
    format!("{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n   data: [ {data} ]\n")
}
