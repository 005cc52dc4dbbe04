//! What the camera was calibrated against, and what is known of that.

use super::{TEXT, Told, paragraph};
use crate::digits::{three, with_uncertainty};
use crate::document::Paper;

pub(super) fn write(paper: &mut Paper, y: f64, told: &Told<'_>) -> f64 {
    let answer = told.answer;
    let mut words = match &told.certificate.record.board {
        Some(board) => {
            let scale = answer.board.scale.map(|scale| {
                let (value, sigma) = with_uncertainty(scale.value, scale.sigma);
                format!("scale of the print {value} \u{b1} {sigma}")
            });
            let places = answer
                .board
                .print_noise
                .map(|sigma| format!("places of its points \u{b1} {} object units in each coordinate", three(sigma)));
            let exact: Vec<&str> = [(&scale, "scale of the print"), (&places, "places of its points")]
                .into_iter()
                .filter(|(stated, _)| stated.is_none())
                .map(|(_, what)| what)
                .collect();
            let stated: Vec<String> = [scale, places].into_iter().flatten().collect();
            let stated = if stated.is_empty() { String::new() } else { format!(" Stated: {}.", stated.join("; ")) };
            let exact = if exact.is_empty() { String::new() } else { format!(" Taken as exact: {}.", exact.join(", ")) };
            format!("Board {board}.{stated}{exact} Lengths take their scale from it.")
        }
        None if answer.counts.control_points == 0 => "No control: a free network; what scale it has comes of distances, if any.".into(),
        None => {
            format!("{} control points; those without standard deviations in their file are taken as exact.", answer.counts.control_points)
        }
    };
    let bend = answer.board.bend.zip(answer.board.sigma).map(|(bend, sigma)| {
        let one = |i: usize| {
            let (value, sigma) = with_uncertainty(bend[i], sigma[i]);
            format!("{value} \u{b1} {sigma} {}", ["along u", "along v", "twist"][i])
        };
        [0, 1, 2].map(one).join(", ")
    });
    let p = answer.board.p.map_or(String::new(), |p| if p < 0.001 { " (p < 0.001)".into() } else { format!(" (p {p:.3})") });
    match (answer.board.shape.as_str(), bend) {
        ("flat", Some(bend)) => words += &format!(" Flatness: a bend of {bend} (object units) is not told from none{p}; taken as flat."),
        ("bent", Some(bend)) => words += &format!(" Bent by {bend} (object units){p}: adjusted with the camera."),
        ("untested", _) => {
            words += &format!(" Flatness: not tested{}.", answer.board.why.as_ref().map_or(String::new(), |why| format!(": {why}")));
        }
        _ => {}
    }
    paragraph(paper, y, TEXT, &words, 4)
}
