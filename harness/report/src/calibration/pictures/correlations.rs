//! The correlation matrix of the interior orientation.

use calibench_calibrate::Calibration;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::super::limits::CORRELATED;
use crate::Canvas;
use crate::field::write;

/// Side of a cell, room for names, room for the title, px of the picture.
const CELL: u32 = 56;
const NAMES: u32 = 60;
const TITLE: u32 = 50;

/// Rows of the interior orientation's covariance that are a camera's, and the names of its parameters.
pub(in super::super) fn own(calibration: &Calibration<'_>, camera: usize) -> (Vec<usize>, Vec<&'static str>) {
    let own = calibration.covariances.parameters.iter().enumerate().filter(|(_, (owner, _))| *owner == camera);
    own.map(|(place, (_, name))| (place, *name)).unzip()
}

/// A cell for each pair of a camera's parameters: blue for negative, orange for positive correlation. `None` for less than a pair.
pub(super) fn picture(calibration: &Calibration<'_>, camera: usize) -> Option<Canvas> {
    let all = calibration.covariances.correlations();
    let (places, names) = own(calibration, camera);
    if names.len() < 2 {
        return None;
    }
    let rho = |i: u32, j: u32| all[(places[i as usize], places[j as usize])];
    let n = names.len() as u32;
    let mut canvas = Canvas::new((NAMES + n * CELL + 20).max(420), TITLE + NAMES / 2 + n * CELL + 20);
    canvas.text("Correlations of the interior orientation", 18, (12, TITLE / 2));
    let corner = |i: u32| ((NAMES + i * CELL) as i32, (TITLE + NAMES / 2 + i * CELL) as i32);
    canvas.paint(|area| {
        for i in 0..n {
            let middle = (CELL / 2) as i32;
            write(area, names[i as usize], (corner(i).0 + middle, corner(0).1 - 12), HPos::Center);
            write(area, names[i as usize], (corner(0).0 - 8, corner(i).1 + middle), HPos::Right);
            for j in 0..n {
                let value = rho(i, j);
                let corners = [(corner(j).0, corner(i).1), (corner(j + 1).0, corner(i + 1).1)];
                area.draw(&Rectangle::new(corners, tint(value).filled())).ok();
                area.draw(&Rectangle::new(corners, RGBColor(200, 200, 200))).ok();
                write(area, &format!("{value:.2}"), (corner(j).0 + middle, corner(i).1 + middle), HPos::Center);
            }
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            if rho(i, j).abs() > CORRELATED {
                let corners = [(corner(j).0 + 1, corner(i).1 + 1), (corner(j + 1).0 - 1, corner(i + 1).1 - 1)];
                area.draw(&Rectangle::new(corners, BLACK.stroke_width(3))).ok();
            }
        }
    });
    Some(canvas)
}

/// White for none; full colours stay light enough for black digits.
pub(in super::super) fn tint(value: f64) -> RGBColor {
    let full = if value < 0.0 { (86.0, 180.0, 233.0) } else { (230.0, 159.0, 0.0) };
    let part = value.abs().min(1.0);
    let mix = |channel: f64| (255.0 + (channel - 255.0) * part).round() as u8;
    RGBColor(mix(full.0), mix(full.1), mix(full.2))
}
