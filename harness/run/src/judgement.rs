//! Judging the photographs of a scenario.

use std::path::Path;

use calibench_cameras::published_camera;
use calibench_files::NewFolder;
use calibench_images::size_of;
use calibench_judge::{Field, Material, Options, judge, stated_sigma};
use calibench_model::camera::ImageSize;
use calibench_records::compressor::Compressor;
use calibench_records::judgement::{RECORDED_JUDGEMENT, Row, measure, write_rows};
use calibench_records::names::kept_image;
use calibench_records::points::RunInfo;
use calibench_records::results::Trial;
use calibench_scenario::{JudgementPlan, PhotographsSubject, Subject};

use crate::{Plan, RunError};

/// Judges what `trial` holds of the photographs of `plan`, if its scenario asks for it, and writes the rows into `folder`, where the images are.
///
/// What stands in the way is a row.
///
/// # Errors
/// What the file system refuses.
pub fn write_judgement(folder: &NewFolder, plan: &Plan<'_>, run: &RunInfo, trial: &Trial) -> Result<(), RunError> {
    let Subject::Photographs(PhotographsSubject { judgement: Some(wanted), .. }) = &plan.scenario.subject else { return Ok(()) };
    let rows = rows(folder.path(), plan, wanted, trial).unwrap_or_else(|why| vec![Row::without("", "", "unavailable", &why)]);
    Ok(folder.write(RECORDED_JUDGEMENT, |file| {
        let mut table = Compressor::new(file);
        write_rows(&mut table, run, &rows)?;
        table.finish()
    })?)
}

fn rows(folder: &Path, plan: &Plan<'_>, wanted: &JudgementPlan, trial: &Trial) -> Result<Vec<Row>, String> {
    let Subject::Photographs(subject) = &plan.scenario.subject else { return Err("these are no photographs".into()) };
    if let Some(why) = plan.missing() {
        return Err(why);
    }
    let sizes = subject.files.iter().map(|file| size(&kept_image(folder, file)).map(|size| (file, size)));
    let sizes = sizes.collect::<Result<Vec<_>, _>>()?;
    let Some((_, size)) = sizes.first().copied() else { return Err("there is no photograph".into()) };
    if let Some((file, other)) = sizes.iter().find(|(_, other)| *other != size) {
        let [a, b] = [size, *other].map(|size| format!("{} x {} px", size.width, size.height));
        return Err(format!("{file} has {b}, the first photograph {a}: photographs of one camera have one size"));
    }
    let published = wanted.published.as_ref().map(|file| published_camera(&plan.data.join(&subject.folder).join(file), file, size));
    let material = Material::new(trial, &plan.method_infos(), Field::Board { board: subject.board, side: wanted.side }, size);
    let options = Options {
        models: wanted.models.clone(),
        pitch_um: wanted.pitch_um,
        splits: wanted.splits,
        seed: plan.seed,
        name: plan.scenario.drawn.clone(),
        published: published.as_ref().and_then(|camera| Some(camera.as_ref().ok()?.camera)),
        published_sigma: published.as_ref().and_then(|camera| stated_sigma(camera.as_ref().ok()?)),
    };
    let mut rows = judge(&material, &options).map_err(|error| error.to_string())?;
    if let Some(Err(why)) = published {
        rows.push(Row::without(measure::PUBLISHED, "", "unavailable", &why));
    }
    Ok(rows)
}

fn size(path: &Path) -> Result<ImageSize, String> {
    size_of(path).map_err(|error| format!("the size of a photograph cannot be read: {error}"))
}
