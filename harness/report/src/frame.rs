//! The frame of the images as a drawing board.

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::Canvas;
use crate::field::{Area, BOTTOM, LEFT, MAP, RIGHT, TOP, write};

/// A map of the frame: where it lies in the picture, and how large.
#[derive(Clone, Copy)]
pub(crate) struct Map {
    size: ImageSize,
    corner: (i32, i32),
    /// Width and height, px of the picture.
    pub(crate) extent: (u32, u32),
}

impl Map {
    /// A map `width` px wide whose upper left corner lies at `corner`.
    pub(crate) fn new(size: ImageSize, corner: (u32, u32), width: u32) -> Self {
        let height = (f64::from(width) * f64::from(size.height) / f64::from(size.width)).round().max(20.0) as u32;
        Self { size, corner: (corner.0 as i32, corner.1 as i32), extent: (width, height) }
    }

    /// The one map of a picture, with room for axes, a title, a legend and a scale; and the picture.
    pub(crate) fn alone(size: ImageSize, title: &str) -> (Self, Canvas) {
        let map = Self::new(size, (LEFT, TOP), MAP);
        let mut canvas = Canvas::new(LEFT + map.extent.0 + RIGHT, TOP + map.extent.1 + BOTTOM);
        canvas.text(title, 20, (LEFT, TOP / 2));
        (map, canvas)
    }

    /// A place of the frame in the picture.
    pub(crate) fn place(&self, at: PixelPoint) -> (i32, i32) {
        let corner = at.to_corner();
        let part = |value: f64, size: u32, px: u32| (value / f64::from(size) * f64::from(px)).round() as i32;
        (self.corner.0 + part(corner.x, self.size.width, self.extent.0), self.corner.1 + part(corner.y, self.size.height, self.extent.1))
    }

    /// Cell (column, row) of a grid over the frame, in the picture.
    pub(crate) fn cell(&self, (column, row): (usize, usize), (columns, rows): (usize, usize)) -> [(i32, i32); 2] {
        let edge = |i: usize, n: usize, px: u32| (i as f64 / n as f64 * f64::from(px)).round() as i32;
        let at = |c: usize, r: usize| (self.corner.0 + edge(c, columns, self.extent.0), self.corner.1 + edge(r, rows, self.extent.1));
        [at(column, row), at(column + 1, row + 1)]
    }

    /// A node (column, row) of a grid over the frame, in the picture; it stands in the middle of its cell.
    pub(crate) fn node(&self, (column, row): (f64, f64), (columns, rows): (usize, usize)) -> (i32, i32) {
        let middle = |i: f64, n: usize, px: u32| ((i + 0.5) / n as f64 * f64::from(px)).round() as i32;
        (self.corner.0 + middle(column, columns, self.extent.0), self.corner.1 + middle(row, rows, self.extent.1))
    }

    /// How far a place of the picture is inside the frame, px of the picture.
    pub(crate) fn inside_by(&self, (x, y): (i32, i32)) -> f64 {
        let (x, y) = (x - self.corner.0, y - self.corner.1);
        f64::from(x.min(y).min(self.extent.0 as i32 - x).min(self.extent.1 as i32 - y))
    }

    /// The frame's outline.
    pub(crate) fn outline(&self, area: &Area<'_>) {
        let (left, up) = self.corner;
        let corners = [(left, up), (left + self.extent.0 as i32, up + self.extent.1 as i32)];
        area.draw(&Rectangle::new(corners, BLACK)).ok();
    }

    /// Outline and axes in px.
    pub(crate) fn axes(&self, area: &Area<'_>) {
        self.outline(area);
        let (left, up) = self.corner;
        let (width, height) = (self.extent.0 as i32, self.extent.1 as i32);
        for i in 0..=4 {
            let part = f64::from(i) / 4.0;
            let (column, row) = ((part * f64::from(self.size.width)).round(), (part * f64::from(self.size.height)).round());
            write(area, &format!("{column}"), (left + width * i / 4, up + height + 14), HPos::Center);
            write(area, &format!("{row}"), (left - 8, up + height * i / 4), HPos::Right);
        }
        write(area, "x, px", (left + width / 2, up + height + 34), HPos::Center);
        write(area, "y, px", (left - 8, up - 14), HPos::Right);
    }
}
