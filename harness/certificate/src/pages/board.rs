//! What the camera was calibrated against, and what is known of that.

use super::{TEXT, Told, paragraph};
use crate::digits::with_uncertainty;
use crate::document::Paper;

pub(super) fn write(paper: &mut Paper, y: f64, told: &Told<'_>) -> f64 {
    let answer = told.answer;
    let mut words = match &told.certificate.record.board {
        Some(board) => {
            let stated = board.stated.iter().map(|stated| {
                let (value, sigma) = with_uncertainty(stated.value, stated.sigma);
                format!("{} {value} \u{b1} {sigma} {}", stated.what, stated.unit)
            });
            let stated: Vec<String> = stated.collect();
            let stated = if stated.is_empty() { String::new() } else { format!(" Stated: {}.", stated.join("; ")) };
            let exact = if board.exact.is_empty() { String::new() } else { format!(" Taken as exact: {}; lengths take their scale from it.", board.exact.join(", ")) };
            format!("Board {}.{stated}{exact}", board.name)
        }
        None if answer.counts.control_points == 0 => "No control: a free network; what scale it has comes of distances, if any.".into(),
        None => format!("{} control points; those without standard deviations in their file are taken as exact.", answer.counts.control_points),
    };
    let bend = answer.board.bend.zip(answer.board.sigma).map(|(bend, sigma)| {
        let one = |i: usize| {
            let (value, sigma) = with_uncertainty(bend[i], sigma[i]);
            format!("{value} \u{b1} {sigma} {}", ["along u", "along v", "twist"][i])
        };
        [0, 1, 2].map(one).join(", ")
    });
    let p = answer.board.p.map_or(String::new(), |p| format!(" (p {p:.3})"));
    match (answer.board.shape.as_str(), bend) {
        ("flat", Some(bend)) => words += &format!(" Flatness: a bend of {bend} (object units) is not told from none{p}; taken as flat."),
        ("bent", Some(bend)) => words += &format!(" Bent by {bend} (object units){p}: adjusted with the camera."),
        ("untested", _) => words += &format!(" Flatness: not tested{}.", answer.board.why.as_ref().map_or(String::new(), |why| format!(": {why}"))),
        _ => {}
    }
    paragraph(paper, y, TEXT, &words, 4)
}
