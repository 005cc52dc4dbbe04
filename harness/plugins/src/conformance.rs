//! What every plug-in must do: one check for all, for those who write one.

use calibench_measure::conformance::chess_corner;
use calibench_measure::{Configured, Operator};
use calibench_model::{Image, PixelPoint, Rejection, Start};

use crate::declaration::Mode;

/// What one check found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What was tried.
    pub what: &'static str,
    /// What was wrong, if anything was.
    pub wrong: Option<String>,
}

/// What one try finds wrong.
type Try = fn(&dyn Operator) -> Result<(), String>;

const SIDE: usize = 91;

fn image(dx: f64, dy: f64, width: usize, height: usize) -> Image<'static> {
    let middle = (SIDE / 2) as f64;
    let grey = |x, y| chess_corner(x as f64 - middle - dx, y as f64 - middle - dy);
    let mut image = Image::from_fn(width, height, grey);
    image.grey_mut().iter_mut().for_each(|grey| *grey = (*grey * 255.0).round() / 255.0);
    image
}

fn middle(dx: f64, dy: f64) -> Start {
    let middle = (SIDE / 2) as f64;
    Start::at(PixelPoint::new(middle + dx, middle + dy))
}

/// Tries a plug-in on small images: whether it answers, answers the same again, as many as were asked, on other sizes of images, and keeps to its word when an
/// image shows nothing. How accurate it is, scenarios tell.
pub fn check(method: &Configured, mode: &Mode) -> Vec<Finding> {
    let starts = match mode {
        Mode::Stream => "it starts and says its version",
        Mode::Folder { .. } => "there is such a program",
    };
    let operator = match &method.operator {
        Ok(operator) => operator.as_ref(),
        Err(why) => return vec![Finding { what: starts, wrong: Some(why.clone()) }],
    };
    let tries: [(&'static str, Try); 6] = [
        ("a chess corner is found within 3 px", found),
        ("the same image gives the same answer", same),
        ("a shift by whole pixels shifts the answer", shifted),
        ("many points are answered in the order in which they are asked", many),
        ("an image of another size is read whole", other_size),
        ("an image that shows nothing is no reason to fail", nothing),
    ];
    let start = Finding { what: starts, wrong: None };
    let tried = tries.into_iter().map(|(what, check)| Finding { what, wrong: check(operator).err() });
    std::iter::once(start).chain(tried).collect()
}

/// The reason with what was told, which says more.
fn failed(operator: &dyn Operator, rejection: Rejection) -> String {
    let told = operator.notes();
    if told.is_empty() { rejection.meaning().to_owned() } else { told.join("; ") }
}

fn measured(operator: &dyn Operator, image: &Image, start: &Start) -> Result<PixelPoint, String> {
    operator.measure(image, start).map(|found| found.position).map_err(|rejection| failed(operator, rejection))
}

fn near(found: PixelPoint, expected: PixelPoint, tolerance: f64) -> Result<(), String> {
    let distance = found.distance(expected);
    let said = || format!("found ({:.3}, {:.3}), expected ({:.3}, {:.3})", found.x, found.y, expected.x, expected.y);
    if distance <= tolerance { Ok(()) } else { Err(said()) }
}

fn found(operator: &dyn Operator) -> Result<(), String> {
    let found = measured(operator, &image(0.0, 0.0, SIDE, SIDE), &middle(0.9, 0.7))?;
    near(found, middle(0.31, -0.17).position, 3.0)
}

fn same(operator: &dyn Operator) -> Result<(), String> {
    let image = image(0.0, 0.0, SIDE, SIDE);
    let [first, second] = [(); 2].map(|()| measured(operator, &image, &middle(0.9, 0.7)));
    near(second?, first?, 0.0)
}

fn shifted(operator: &dyn Operator) -> Result<(), String> {
    let first = measured(operator, &image(0.0, 0.0, SIDE, SIDE), &middle(0.9, 0.7))?;
    let second = measured(operator, &image(3.0, -5.0, SIDE, SIDE), &middle(3.9, -4.3))?;
    near(second, PixelPoint::new(first.x + 3.0, first.y - 5.0), 1e-3)
}

fn many(operator: &dyn Operator) -> Result<(), String> {
    let image = image(0.0, 0.0, SIDE, SIDE);
    let alone = measured(operator, &image, &middle(0.9, 0.7))?;
    // Those in the corners of the image may be rejected.
    let starts = [middle(-40.0, -40.0), middle(40.0, -40.0), middle(0.9, 0.7), middle(-40.0, 40.0), middle(40.0, 40.0)];
    let answers = operator.measure_all(&image, &starts);
    near(answers[2].map_err(|rejection| failed(operator, rejection))?.position, alone, 1e-3)
}

fn other_size(operator: &dyn Operator) -> Result<(), String> {
    let first = measured(operator, &image(0.0, 0.0, SIDE, SIDE), &middle(0.9, 0.7))?;
    let second = measured(operator, &image(0.0, 0.0, SIDE + 30, SIDE + 7), &middle(0.9, 0.7))?;
    near(second, first, 0.05)
}

fn nothing(operator: &dyn Operator) -> Result<(), String> {
    let flat = Image::from_fn(SIDE, SIDE, |_, _| 128.0 / 255.0);
    match operator.measure(&flat, &middle(0.0, 0.0)) {
        Err(rejection @ (Rejection::Malformed | Rejection::TooSlow | Rejection::Ended | Rejection::Raised)) => {
            Err(format!("{}; expected null for a point that cannot be measured", failed(operator, rejection)))
        }
        _ => Ok(()),
    }
}
