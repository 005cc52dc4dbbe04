//! The pictures of printed cameras and of the network that their errors ask for.

use calibench_model::Pose;
use calibench_model::convert::ConvertError;
use calibench_records::description::{PlacedNetwork, Printed, Role, Station, Target, Views};
use calibench_records::figures::Quantity;
use nalgebra::Point3;

use super::grids::{self, Grid};
use super::maps::{conversions, distortions};
use super::tables::{ANGLES, STATION, value};
use crate::canvas::Pictures;
use crate::field::Field;
use crate::field_panels::panels;
use crate::load::adjustments::Summaries;
use crate::studies::network::pictures::plan::plan;

/// The title of a picture, which stands for it in words, and what has to be said beside it.
struct Caption {
    title: &'static str,
    said: &'static str,
}

const GRIDS: Caption = Caption {
    title: "What distortion does to a square grid",
    said: "dashed without distortion, solid as a camera has it, with the same principal distance and point",
};
const DISTORTION: Caption = Caption {
    title: "Distortion of each camera over the frame, px",
    said: "arrows lead from where a camera with the same principal distance and point, but without distortion, has a ray to where this one has it. One scale of colours and arrows for all",
};
const CONVERSION: Caption = Caption {
    title: "Direct conversion less exact over the frame, px, after the best rotation",
    said: "arrows lead from where a tool's own camera has a ray, which an exact conversion keeps, to where the printed one has it. One scale of colours and arrows for all. White: beyond nine tenths of the \
           radius at which the tool's own camera folds over",
};
const NETWORK: Caption = Caption {
    title: "Stations and check points of the network",
    said: "from above, with lines of sight, and the points from the front, as seen from the stations. Each drawing has one scale for both axes",
};

/// Pictures of a page under way: their text and their files.
pub(super) struct Drawn<'a> {
    stem: &'a str,
    pub(super) pictures: Pictures,
}

impl<'a> Drawn<'a> {
    pub(super) fn new(stem: &'a str) -> Self {
        Self { stem, pictures: Pictures::new() }
    }

    /// The text of a picture, if there is one.
    fn add(&mut self, name: &str, caption: &Caption, canvas: Option<crate::Canvas>) -> String {
        let Some(canvas) = canvas else { return String::new() };
        let file = format!("{}-{name}.png", self.stem);
        self.pictures.push((file.clone(), canvas));
        let Caption { title, said } = caption;
        format!("{title}: {said}.\n\n![{title}]({file})\n\n")
    }

    /// The grids, and in words how large each is drawn.
    fn grids(&mut self, grids: &[Grid]) -> String {
        let mut text = self.add("grids", &GRIDS, grids::picture(grids));
        let words: Vec<String> = grids.iter().map(|grid| format!("*{}*, {}", grid.name, grid.words())).collect();
        if !words.is_empty() {
            text.push_str(&format!("The longest displacements: {}.\n\n", words.join("; ")));
        }
        text
    }

    /// The grids and the maps of the cameras.
    pub(super) fn cameras(&mut self, printed: &Printed) -> String {
        let mut text = self.grids(&Grid::all(printed));
        for (name, caption, maps) in [("distortion", &DISTORTION, distortions(printed)), ("conversion", &CONVERSION, conversions(printed))]
        {
            let (fields, failed) = sorted(maps);
            text.push_str(&self.add(name, caption, panels(caption.title, &fields)));
            text.push_str(&failed);
        }
        text
    }

    /// The plan of the network.
    pub(super) fn network(&mut self, printed: &Printed, network: &PlacedNetwork, found: &Summaries) -> String {
        self.add("network", &NETWORK, plan(&views(printed, network, found)))
    }
}

/// The maps that there are, and a line for each of the others.
fn sorted(maps: Vec<(String, Result<Field, ConvertError>)>) -> (Vec<Field>, String) {
    let (mut fields, mut failed) = (Vec::new(), String::new());
    for (name, map) in maps {
        match map {
            Ok(field) => fields.push(field),
            Err(why) => failed.push_str(&format!("- `{name}` is not in this picture: {why}.\n\n")),
        }
    }
    (fields, failed)
}

/// Check points and stations; without stations where the network was not found.
pub(super) fn views(printed: &Printed, network: &PlacedNetwork, found: &Summaries) -> Views {
    let get = |station: usize, quantity: Quantity| value(found, &network.set, quantity.of(&[&station.to_string()]));
    let all = |station: usize, quantities: [Quantity; 3]| -> Option<[f64; 3]> {
        let values = quantities.map(|quantity| get(station, quantity));
        values.iter().all(Option::is_some).then(|| values.map(Option::unwrap_or_default))
    };
    let station = |number: usize| {
        let centre = all(number, STATION)?;
        let pose = Pose::from_angles(Point3::from(centre), all(number, ANGLES)?.map(f64::to_radians));
        // A camera looks along its -z.
        let sight = (-pose.rotation.row(2).transpose()).into();
        Some(Station { name: number.to_string(), centre, sight, second_step: false })
    };
    let target = |point: &calibench_records::description::CheckPoint| Target {
        id: point.name.clone(),
        kind: "point".into(),
        surveyed: point.at,
        role: Some(Role::Check),
    };
    Views {
        size: printed.size,
        unit: printed.unit.clone(),
        extent: None,
        normal: Some(network.from),
        stations: (1..).map_while(station).collect(),
        targets: printed.points.iter().map(target).collect(),
        room: None,
    }
}
