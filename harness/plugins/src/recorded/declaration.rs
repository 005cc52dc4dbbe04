//! The `[[method]]` tables of a file of plug-ins.

use calibench_diagnostics::Problem;
use calibench_model::{CornerPoint, PixelPoint};
use serde::Deserialize;
use toml::Spanned;

use crate::declaration::no_name;

/// A declared file of positions.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Its name among the methods.
    pub name: String,
    /// What it is, in a line.
    pub about: String,
    /// Where the way of measuring is published.
    pub source: String,
    /// The version of what measured.
    pub version: String,
    /// The file, seen from that of the declaration.
    pub file: String,
    /// What its position (0, 0) is.
    pub origin: Origin,
    /// Which images were measured.
    pub images: Images,
}

/// What the position (0, 0) of a file is.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// The centre of the first pixel.
    #[default]
    Centre,
    /// Its outer corner.
    Corner,
}

impl Origin {
    /// A position of the file as ours.
    pub fn position(self, at: PixelPoint) -> PixelPoint {
        match self {
            Self::Centre => at,
            Self::Corner => CornerPoint { x: at.x, y: at.y }.to_pixel(),
        }
    }
}

/// Which images were measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Images {
    /// Those of a folder that `render` wrote, seen from the file of the declaration.
    Rendered(String),
    /// The photographs of this scenario.
    Photographs(String),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wire {
    name: Spanned<String>,
    about: Option<String>,
    source: Option<String>,
    version: Option<String>,
    file: Spanned<String>,
    #[serde(default)]
    origin: Origin,
    images: Option<Spanned<String>>,
    photographs: Option<Spanned<String>>,
}

/// The checked declaration of `file`; mistakes are added to `problems`.
pub(crate) fn checked(wire: Wire, file: &str, problems: &mut Vec<Problem>) -> Option<Recording> {
    let before = problems.len();
    let Wire { name, about, source, version, file: positions, origin, images, photographs } = wire;
    problems.extend(no_name(&name));
    if positions.as_ref().is_empty() {
        problems.push(Problem::new(positions.span(), "expected the file of positions, as in \"mine.csv\""));
    }
    let images = match (images, photographs) {
        (Some(folder), None) => Some(Images::Rendered(folder.into_inner())),
        (None, Some(scenario)) => Some(Images::Photographs(scenario.into_inner())),
        (None, None) => {
            let help = "`images`: the folder that `calibench render` wrote and that was measured; or `photographs`: the name of a scenario of photographs";
            problems.push(Problem::new(name.span(), "does not say which images were measured").help(help));
            None
        }
        (Some(_), Some(scenario)) => {
            problems.push(Problem::new(scenario.span(), "`photographs` stands beside `images`; expected one of them"));
            None
        }
    };
    let images = images.filter(|_| problems.len() == before)?;
    Some(Recording {
        about: about.unwrap_or_else(|| format!("{}, positions of a file", name.as_ref())),
        source: source.unwrap_or_else(|| file.to_owned()),
        version: version.unwrap_or_else(|| "0".to_owned()),
        name: name.into_inner(),
        file: positions.into_inner(),
        origin,
        images,
    })
}
