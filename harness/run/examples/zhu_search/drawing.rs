//! The eight images, drawn in many ways.

use calibench_model::{Image, PixelPoint, Scene};
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::testfield::{Figure4, Join, Zhu};

use crate::grid::Grid;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawing {
    /// The grey value at the pixel's centre.
    Hard,
    /// The exact mean over the pixel.
    Area,
    /// The same after a Gaussian blur, px.
    Blurred(f64),
}

/// All of a drawing but how two lines join.
#[derive(Clone, Copy, Debug)]
pub struct Picturing {
    pub drawing: Drawing,
    /// Whether the corner lies at a pixel's centre rather than between four.
    pub at_centre: bool,
    pub stroke: f64,
    /// Width of the pen that draws the outline, px; 0.02 decides that pixels on it are drawn.
    pub pen: f64,
    /// Whether one edge is along +x rather than the bisector.
    pub edge_along_x: bool,
}

impl Picturing {
    /// Every way of drawing.
    pub fn all() -> Vec<Self> {
        let drawings = [Drawing::Hard, Drawing::Area, Drawing::Blurred(0.5), Drawing::Blurred(0.7), Drawing::Blurred(1.0)];
        let mut all = Vec::new();
        for drawing in drawings {
            for at_centre in [false, true] {
                for edge_along_x in [false, true] {
                    for pen in [0.0, 0.02, 0.5, 0.9, 1.1, 1.42] {
                        all.extend([1.0, 2.0, 3.0].map(|stroke| Self { drawing, at_centre, stroke, pen, edge_along_x }));
                    }
                }
            }
        }
        all
    }

    pub fn picture(&self, figure: Figure4, join: Join) -> Grid {
        let side = 60 - usize::from(self.at_centre);
        let middle = (side - 1) as f64 / 2.0;
        let at = PixelPoint::new(middle, middle);
        let (stroke, pen, edge_along_x) = (self.stroke, self.pen, self.edge_along_x);
        let scene = Zhu { side, at, arm: 24.0, stroke, pen, edge_along_x, join, ..Zhu::default() }.scene(figure).expect("a figure");
        let image = match self.drawing {
            Drawing::Hard => calibench_synth::draw(&scene),
            Drawing::Area => render(&scene, 0.0),
            Drawing::Blurred(blur) => render(&scene, blur),
        };
        Grid { side, values: image.grey().iter().map(|grey| f64::from(*grey)).collect() }
    }
}

fn render(scene: &Scene, blur: f64) -> Image<'static> {
    let optics = Optics { blur, ..Optics::default() };
    Renderer::new(&optics, scene.width, scene.height).expect("optics").render(&Picture::from(scene), &[])
}
