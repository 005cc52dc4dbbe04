//! The page of a demonstration.

use std::fmt::Write;
use std::path::Path;

use calibench_cameras::{ReadOptions, read_camera_with};
use calibench_images::read_photo;
use calibench_model::NamedCamera;
use calibench_model::camera::CameraModel;
use calibench_model::convert::{DifferenceOptions, difference};
use calibench_report::{Illustration, Look, found, plain, story};

use super::{BLURRED, CAMERA, CORNERS, Done, PHOTOGRAPHS, TRUTH, TWICE, photograph};
use crate::failure::Failure;
use crate::inputs::read_measured;

/// Lines of an answer that a page and a terminal show.
const LINES: usize = 24;
/// The corners that a picture names.
const NAMED: usize = 3;
/// What a camera says of itself holds where it is off by no more than this many standard deviations: in 99 of 100 cases.
const HOLDS: f64 = 2.6;

/// An answer, or its beginning.
pub fn shortened(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let shown: String = lines.iter().take(LINES).map(|line| format!("{line}\n")).collect();
    if lines.len() > LINES { format!("{shown}... ({} lines more)\n", lines.len() - LINES) } else { shown }
}

/// The page: every step with its command, what was said, and pictures; then the parameters beside the truth.
pub fn page(folder: &Path, done: &[Done]) -> Result<String, Failure> {
    let camera = |name: &str| -> Result<NamedCamera, Failure> {
        let cameras = read_camera_with(&folder.join(name), &ReadOptions::default())?.cameras;
        cameras.into_iter().next().ok_or_else(|| Failure::input(format!("{}: holds no camera", folder.join(name).display())))
    };
    let (calibrated, truth) = (camera(CAMERA)?, camera(TRUTH.0)?);
    let options = DifferenceOptions { rotation: true, compensation: false, ..DifferenceOptions::default() };
    let off = difference(&calibrated.camera, &truth.camera, &options)?.spread.rms_px;
    let stated = done.iter().find_map(|one| known_px(&one.said));
    let is_sound = stated.is_some_and(|sigma| off <= HOLDS * sigma);
    let said = stated.map_or_else(
        || "it does not say how well it is known".to_owned(),
        |sigma| format!("it said of itself {} px (standard deviation over the frame)", plain(sigma)),
    );
    let lead = format!("The calibrated camera is {} px RMS from the true one over the frame, after the best rotation; {said}.", plain(off));
    let mut text = String::from("# calibench demo\n\n");
    for (place, Done { step, said, code }) in done.iter().enumerate() {
        let ended = if *code == 3 { "\nExit code 3: something is in doubt, and it is said above.\n" } else { "" };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "## {}. {}\n\n{}\n\n```console\n$ calibench {}\n{}```\n{ended}",
            place + 1,
            step.title,
            step.about,
            step.command,
            shortened(said)
        );
        if step.command.starts_with("detect") {
            for (file, caption) in pictured() {
                let _ = writeln!(text, "![{caption}]({file})\n");
            }
        }
        for folder in ["judged", "calibrated"] {
            if step.command.ends_with(folder) {
                let _ = writeln!(text, "All of it, with pictures that answer: [{folder}/report.html]({folder}/report.html).\n");
            }
        }
    }
    text.push_str(&beside(&calibrated, &truth));
    text.push_str(NEXT);
    Ok(story("From a board to a camera, and how far to trust it", (&lead, is_sound), &text, &pictures(folder)?))
}

/// How well `calibrate` says that the camera is known, px over the frame: its file has no place for correlations, without which that would be far too much.
fn known_px(said: &str) -> Option<f64> {
    let line = said.lines().find_map(|line| line.strip_prefix("known to "))?;
    line.split_once(" px over the frame")?.0.parse().ok()
}

/// The parameters of both cameras.
fn beside(calibrated: &NamedCamera, truth: &NamedCamera) -> String {
    let truths = truth.camera.parameters();
    let mut text =
        String::from("\n| parameter | true | calibrated | standard deviation | off by, in standard deviations |\n|---|--:|--:|--:|--:|\n");
    for parameter in calibrated.camera.parameters() {
        let Some(true_one) = truths.iter().find(|truth| truth.name == parameter.name) else { continue };
        let sigma = sigma(calibrated, parameter.name);
        let in_sigmas = sigma.filter(|sigma| *sigma > 0.0).map(|sigma| format!("{:.1}", (parameter.value - true_one.value) / sigma));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            parameter.name,
            digits(true_one.value),
            digits(parameter.value),
            sigma.map_or_else(String::new, plain),
            in_sigmas.unwrap_or_default()
        );
    }
    text + "\nParameters make up for each other: what counts is how far the cameras differ over the frame.\n\n"
}

/// The standard deviation of a parameter, as the file states it.
fn sigma(camera: &NamedCamera, name: &str) -> Option<f64> {
    let covariance = camera.covariance.as_ref()?;
    let place = covariance.parameters.iter().position(|known| known == name)?;
    Some(covariance.values.get(place * (covariance.parameters.len() + 1))?.sqrt())
}

/// To a thousandth, or of small numbers to four digits behind their zeros.
fn digits(value: f64) -> String {
    if value.abs() >= 1.0 { format!("{value:.3}") } else { format!("{value:.6}") }
}

/// The photographs that are shown, with their captions.
fn pictured() -> [(String, String); 3] {
    let of = |number: usize, caption: &str| (photograph(number), format!("{}: {caption}", photograph(number)));
    [
        of(1, "what was found"),
        of(BLURRED, "blurred: what was found, if anything, is less certain"),
        of(TWICE, "it is there twice, and is counted once"),
    ]
}

fn pictures(folder: &Path) -> Result<Vec<Illustration>, Failure> {
    let points = read_measured(&folder.join(CORNERS))?;
    let one = |(file, caption): (String, String)| {
        let of_it = points.rows().filter(|row| row.image == file).enumerate();
        let look = |place: usize| if place < NAMED { Look::First } else { Look::Plain };
        let marks: Vec<_> = of_it.map(|(place, row)| (row.target.to_owned(), row.start.position, look(place))).collect();
        let image = read_photo(&folder.join(PHOTOGRAPHS).join(&file))?.image;
        Ok((file, caption, found(&image, &marks)))
    };
    pictured().into_iter().map(one).collect()
}

/// What to do now.
const NEXT: &str = "
## Your own photographs

Print the board at 100 %, glue it on something flat, and take a dozen photographs with one camera, one zoom and one focus: tilted, turned, into every corner of the frame. Then

```console
$ calibench judge FOLDER --board 9x6:25 --report judged
$ calibench calibrate FOLDER --board 9x6:25 -o camera.yaml --report calibrated
$ calibench convert camera.yaml --to colmap -o cameras.txt
```
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_answers_are_cut_and_say_so() {
        assert_eq!(shortened("a\nb\n"), "a\nb\n");
        let long: String = (0..30).map(|line| format!("{line}\n")).collect();
        assert!(shortened(&long).ends_with("23\n... (6 lines more)\n"));
    }
}
