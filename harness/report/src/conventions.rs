//! What each common mistake in converting a camera costs: px over the frame, mm on an object.

use std::fs;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use calibench_model::camera::{Camera, Fold, ImageSize, Photogrammetric, fold};
use calibench_model::convert::{
    ConvertError, ConvertOptions, Difference, DifferenceOptions, Mistake, Region, Tangential, Target, Vector, convert, difference,
    from_naive, mistaken,
};
use rayon::prelude::*;
use serde::Deserialize;

use super::canvas::Canvas;
use super::field::Field;
use super::markdown::{MarkdownTable, contents};
use super::{Places, ReportError};
use crate::composed::Composed;
use crate::markdown::plain;

/// The family of this report.
pub const FAMILY: &str = "conventions";

/// The cameras of a paper: `reference/cameras/*.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cameras {
    title: String,
    source: String,
    width: u32,
    height: u32,
    pitch_um: f64,
    wrong_pitch_um: f64,
    distance_m: f64,
    read_as: String,
    camera: Vec<Printed>,
}

/// A camera as printed: photogrammetric by the direct conversion.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Printed {
    name: String,
    #[serde(default)]
    note: Option<String>,
    c_mm: f64,
    x0_mm: f64,
    y0_mm: f64,
    k: [f64; 3],
    p: [f64; 2],
}

/// The report.
///
/// # Errors
/// A file of cameras that cannot be read, a camera that cannot be converted.
pub(crate) fn compose(places: &Places) -> Result<Composed, ReportError> {
    let (mut body, mut pictures, mut prices) = (String::new(), Vec::new(), Vec::new());
    for path in files(&places.cameras)? {
        section(&read(&path)?, &mut body, &mut pictures, &mut prices)?;
    }
    let text = format!("# {FAMILY}\n\n{}{INTRODUCTION}{}{body}", overview(&prices), contents(&body));
    Ok(Composed::page(format!("{}\n", text.trim_end()), pictures))
}

/// What each mistake costs on each camera, in a sentence and a table: RMS px over the frame as it is.
fn overview(prices: &[(String, Priced)]) -> String {
    let rms = |price: &Price| price.as_ref().ok().map(|(raw, _)| raw.spread.rms_px);
    let Some((_, first)) = prices.first() else { return String::new() };
    let names: Vec<&str> = first.rows.iter().map(|(name, _)| name.as_str()).collect();
    let header: Vec<&str> = std::iter::once("mistake, RMS px").chain(prices.iter().map(|(camera, _)| camera.as_str())).collect();
    let mut table = MarkdownTable::new(&header);
    let mut costs: Vec<(&str, f64)> = Vec::new();
    for (place, name) in names.iter().enumerate() {
        let row: Vec<Option<f64>> = prices.iter().map(|(_, priced)| priced.rows.get(place).and_then(|(_, price)| rms(price))).collect();
        if place > 0 {
            costs.extend(row.iter().flatten().map(|cost| (*name, *cost)));
        }
        let cells = row.into_iter().map(|cost| cost.map_or_else(|| "none".to_owned(), plain));
        table.row(std::iter::once((*name).to_owned()).chain(cells));
    }
    costs.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (Some(least), Some(most)) = (costs.first(), costs.last()) else { return String::new() };
    format!(
        "Each of {} common mistakes in converting a camera costs between {} px RMS over the frame ({}) and {} px ({}), on {} published cameras.\n\n{}\n",
        names.len() - 1,
        plain(least.1),
        least.0,
        plain(most.1),
        most.0,
        prices.len(),
        table.render()
    )
}

const INTRODUCTION: &str = "Made by `calibench report conventions` from the published cameras. A calibration is worth nothing in the wrong convention: here each common mistake is made alone, \
    on cameras of a published comparison, and priced. `calibench convert` makes none of them.\n\n\
    For each camera the tool's own model (ideal to distorted) is taken as true. The pixels of the frame are led to rays by it, the rays back to pixels by the \
    mistaken camera; the difference is given as it is, and after the best rotation, which no exterior orientation can tell from the camera. RMS and maximum over the frame, \
    in px; and the maximum in mm on an object, across the line of sight.\n\n";

fn files(folder: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let at = |error: std::io::Error| calibench_files::at(folder, &error);
    let entries = fs::read_dir(folder).map_err(at)?;
    let mut files: Vec<PathBuf> = entries.map(|entry| Ok(entry.map_err(at)?.path())).collect::<std::io::Result<_>>()?;
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<Cameras, ReportError> {
    let text = calibench_files::bounded::text(path).map_err(|error| calibench_files::at(path, &error))?;
    toml::from_str(&text).map_err(|error| {
        let problems = vec![Problem::new(error.span().unwrap_or(0..0), error.message())];
        ReportError::Cameras(Problems { file: path.display().to_string(), text, problems })
    })
}

fn section(
    cameras: &Cameras,
    text: &mut String,
    pictures: &mut Vec<(String, Canvas)>,
    prices: &mut Vec<(String, Priced)>,
) -> Result<(), ReportError> {
    let Cameras { title, source, width, height, pitch_um, distance_m, read_as, .. } = cameras;
    text.push_str(&format!(
        "## {title}\n\n{source}.\n\n{read_as}\n\nImages of {width} x {height} px, pixel pitch {pitch_um} um, object at {distance_m} m.\n\n"
    ));
    let all = cameras.camera.par_iter().map(|printed| price(cameras, printed)).collect::<Result<Vec<_>, _>>()?;
    for (printed, priced) in cameras.camera.iter().zip(all) {
        text.push_str(&format!("### {}\n\n", printed.name));
        if let Some(note) = &printed.note {
            text.push_str(&format!("{note}\n\n"));
        }
        if let Some(fold) = &priced.fold {
            text.push_str(&format!(
                "**The printed polynomial folds over inside the frame**, {} px ({} mm) from the image of the axis: {:.2} % of the frame have no ray, and the camera is no truth there. \
                 Everything below holds within {} px.\n\n",
                plain(fold.radius_px),
                plain(fold.radius_px * pitch_um * 1e-3),
                100.0 * fold.share,
                plain(fold.radius_px * Region::INSIDE_FOLD)
            ));
        }
        text.push_str(&priced.table(*distance_m));
        let name = format!("{}.png", printed.name.to_lowercase().replace(' ', "-"));
        let (shown, vectors) = priced.shown();
        let size = (*width, *height);
        let picture = Field::of(&format!("{}: {shown}", printed.name), size, vectors.iter().map(|v| (v.at, (v.dx, v.dy)))).picture();
        text.push_str(&format!("\n![{}: {shown}]({name})\n\n", printed.name));
        pictures.push((name, picture));
        prices.push((printed.name.clone(), priced));
    }
    Ok(())
}

/// A camera and what mistakes cost it: the mistake, as it is and after the best rotation.
struct Priced {
    fold: Option<Fold>,
    rows: Vec<(String, Price)>,
}

/// The two differences, as it is and rotated, or why a camera is so wrong that nothing can be compared.
type Price = Result<(Difference, Difference), ConvertError>;

fn price(cameras: &Cameras, printed: &Printed) -> Result<Priced, ReportError> {
    let Cameras { pitch_um, wrong_pitch_um, .. } = *cameras;
    let size = ImageSize { width: cameras.width, height: cameras.height };
    let Printed { c_mm: c, x0_mm: x0, y0_mm: y0, k, p, .. } = *printed;
    let converted = Photogrammetric { size, pitch_um, c, x0, y0, k, p, b: [0.0; 2] };
    let truth = from_naive(&converted, Target::metashape(), Tangential::Converted)?;
    let fold = fold(&truth);
    let region = Region::inside_fold(&truth);
    let options = ConvertOptions { region, accept: true, ..ConvertOptions::default() };
    let compare =
        |wrong: &Camera, rotation| difference(&truth, wrong, &DifferenceOptions { region, rotation, ..DifferenceOptions::default() });
    let mistakes = [
        ("k / c^n and P / c taken as the inverse (Table 2)", Mistake::Naive),
        ("p1 and p2 swapped", Mistake::TangentialSwapped),
        ("y not turned upwards (y0, p2)", Mistake::VerticalNotFlipped),
        ("correction added instead of subtracted", Mistake::SignOfCorrection),
        ("half a pixel: corner taken as centre", Mistake::HalfPixel),
        ("wrong pixel pitch throughout", Mistake::WrongPitch { pitch_um: wrong_pitch_um }),
        ("wrong pixel pitch for the focal length alone", Mistake::WrongPitchOfC { pitch_um: wrong_pitch_um }),
        ("sign of x0", Mistake::SignOfX0),
        ("sign of y0", Mistake::SignOfY0),
        ("principal point from the corner taken as from the centre", Mistake::PrincipalPointFromCorner),
    ];
    let right = convert(&truth, Target::photogrammetric(pitch_um), &options)?.camera;
    let Camera::Photogrammetric(own) = right else { return Err(ConvertError::NotInTable.into()) };
    let both = |wrong: &Camera| -> Price { Ok((compare(wrong, false)?, compare(wrong, true)?)) };
    let mut rows = vec![("none: converted by a fit".to_owned(), both(&right))];
    for (name, mistake) in mistakes {
        let wrong: Camera = mistaken(&truth, &own, mistake)?.into();
        rows.push((name.to_owned(), both(&wrong)));
    }
    Ok(Priced { fold, rows })
}

impl Priced {
    fn table(&self, distance_m: f64) -> String {
        let mut table = MarkdownTable::new(&[
            "mistake",
            "RMS px",
            "max px",
            "RMS px, rotated",
            "max px, rotated",
            "max mm on the object, rotated",
            "not comparable",
        ]);
        for (name, price) in &self.rows {
            let (raw, turned) = match price {
                Ok(price) => price,
                Err(why) => {
                    let cells = [name.clone(), String::new(), String::new(), String::new(), String::new(), String::new(), why.to_string()];
                    table.row(cells);
                    continue;
                }
            };
            let mm = turned.on_object(turned.spread.max_px, distance_m * 1e3);
            let left_out = if turned.not_comparable > 0.0 { format!("{:.1} %", 100.0 * turned.not_comparable) } else { String::new() };
            let figures = [raw.spread.rms_px, raw.spread.max_px, turned.spread.rms_px, turned.spread.max_px, mm].map(plain);
            table.row(std::iter::once(name.clone()).chain(figures).chain([left_out]));
        }
        table.render()
    }

    /// What the picture shows: the direct conversion after the best rotation.
    fn shown(&self) -> (&str, &[Vector]) {
        let shown = self.rows.iter().filter_map(|(name, price)| Some((name.as_str(), &price.as_ref().ok()?.1)));
        let row = shown.clone().find(|(name, _)| name.contains("Table 2")).or(shown.clone().next());
        row.map_or(("nothing", &[]), |(name, turned)| (name, turned.vectors.as_slice()))
    }
}
