//! What a plug-in is asked: a line of JSON and the grey values.

use calibench_measure::Sought;
use calibench_model::image::level;
use calibench_model::{Image, Start};
use serde_json::{Value, json};

use crate::declaration::Grey;

/// The version of the protocol.
pub const PROTOCOL: u32 = 1;

/// What a plug-in is asked for in an image.
#[derive(Clone, Copy)]
pub enum Wanted<'a> {
    /// An answer to each of these.
    Each(&'a [Start]),
    /// What there is.
    Anything,
    /// The points of a board, by name.
    Board(&'a Sought),
}

impl<'a> Wanted<'a> {
    /// The starts, if there are any.
    pub const fn starts(self) -> Option<&'a [Start]> {
        match self {
            Self::Each(starts) => Some(starts),
            Self::Anything | Self::Board(_) => None,
        }
    }

    /// How many positions the answer has, if that is known.
    pub fn count(self) -> Option<usize> {
        self.starts().map(<[Start]>::len)
    }

    /// The board.
    pub const fn board(self) -> Option<&'a Sought> {
        if let Self::Board(sought) = self { Some(sought) } else { None }
    }
}

/// The first line: which protocol, and the parameters.
pub fn greeting<'p>(parameters: impl Iterator<Item = (&'p str, f64)>) -> Vec<u8> {
    let parameters: serde_json::Map<String, Value> = parameters.map(|(name, value)| (name.to_owned(), plain(value))).collect();
    line(&json!({ "calibench": PROTOCOL, "parameters": parameters }))
}

/// The first line to a program that calibrates.
pub fn calibrations_greeting() -> Vec<u8> {
    line(&json!({ "calibench": PROTOCOL, "asks": "calibrations" }))
}

/// A whole number as one: many a language tells 11 from 11.0.
fn plain(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e15 { json!(value as i64) } else { json!(value) }
}

/// The line before the grey values of an image, which is counted so that no answer is taken for that to another.
pub fn head(number: u64, image: &Image, grey: Grey, wanted: Wanted<'_>) -> Vec<u8> {
    let bytes = image.grey().len() * bytes_of(grey);
    let mut request = json!({ "image": number, "width": image.width(), "height": image.height(), "format": grey.name(), "bytes": bytes });
    if let Some(Sought { board, layout }) = wanted.board() {
        request["board"] = json!(board.to_string());
        request["names"] = layout.points.iter().map(|point| json!(point.id)).collect();
    }
    if let Some(starts) = wanted.starts() {
        request["starts"] = starts.iter().map(|start| json!([start.position.x, start.position.y])).collect();
        if starts.iter().any(|start| start.kind.is_some()) {
            request["kinds"] = starts.iter().map(|start| json!(start.kind.map(calibench_model::TargetKind::name))).collect();
        }
        if starts.iter().any(|start| start.affine.is_some()) {
            request["axes"] = starts.iter().map(|start| json!(start.affine.map(|map| [map.axx, map.axy, map.ayx, map.ayy]))).collect();
        }
    }
    line(&request)
}

fn line(value: &Value) -> Vec<u8> {
    let mut line = value.to_string().into_bytes();
    line.push(b'\n');
    line
}

fn bytes_of(grey: Grey) -> usize {
    match grey {
        Grey::Gray8 => 1,
        Grey::Gray16le => 2,
        Grey::Gray32f => 4,
    }
}

/// The grey values as they are written.
pub fn body(image: &Image, grey: Grey) -> Vec<u8> {
    match grey {
        Grey::Gray8 => image.to_u8(),
        Grey::Gray16le => image.grey().iter().flat_map(|&grey| level(grey, u16::MAX).to_le_bytes()).collect(),
        Grey::Gray32f => image.grey().iter().flat_map(|grey| grey.to_le_bytes()).collect(),
    }
}

/// Whether the grey values lose something when they are written so.
pub fn rounds(image: &Image, grey: Grey) -> bool {
    let steps = match grey {
        Grey::Gray8 => 255.0_f32,
        Grey::Gray16le => 65535.0,
        Grey::Gray32f => return false,
    };
    image.grey().iter().any(|grey| {
        let level = grey * steps;
        !((level - level.round()).abs() <= 0.01 && *grey >= 0.0 && *grey <= 1.0)
    })
}
