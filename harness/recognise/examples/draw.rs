//! Draws what is found in a rendered image of the coded field, three times larger, as PPM:
//! `cargo run --release -p calibench-recognise --example draw -- OUT.ppm [BLUR [DECIBEL [PHI [ROLL]]]]`.
//!
//! Green: lines and labelled targets by their kind's first axis, longer than their size; red: what was rejected; blue: corners of whole squares.

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use std::io::Write as _;

use calibench_model::{Image, PixelPoint};
use calibench_recognise::{Classifier, Recogniser, Recognition};
use campaign::{Setting, shots};

const TIMES: usize = 3;
const GREEN: [u8; 3] = [0, 200, 0];
const RED: [u8; 3] = [230, 0, 0];
const BLUE: [u8; 3] = [0, 90, 255];

/// Pixels of three bytes.
struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    fn of(image: &Image) -> Self {
        let (width, height) = (TIMES * image.width(), TIMES * image.height());
        let grey = |at: usize| (255.0 * image.at(at % width / TIMES, at / width / TIMES)).clamp(0.0, 255.0) as u8;
        Self { width, height, pixels: (0..width * height).map(|at| [grey(at); 3]).collect() }
    }

    fn line(&mut self, from: PixelPoint, to: PixelPoint, colour: [u8; 3]) {
        let [from, to] = [from, to].map(PixelPoint::to_corner);
        let steps = (TIMES as f64 * (from.x - to.x).abs().max((from.y - to.y).abs())).ceil().max(1.0);
        for step in 0..=steps as usize {
            let t = step as f64 / steps;
            let [x, y] = [from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)].map(|v| (v * TIMES as f64).floor());
            if x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64 {
                self.pixels[y as usize * self.width + x as usize] = colour;
            }
        }
    }

    fn cross(&mut self, at: PixelPoint, half: f64, colour: [u8; 3]) {
        let off = |dx: f64, dy: f64| PixelPoint::new(at.x + dx, at.y + dy);
        self.line(off(-half, -half), off(half, half), colour);
        self.line(off(-half, half), off(half, -half), colour);
    }

    fn draw(&mut self, found: &Recognition) {
        found.lines.iter().for_each(|line| self.line(line.ends[0], line.ends[1], GREEN));
        for target in &found.targets {
            let (at, a) = (target.position, target.affine);
            self.line(at, PixelPoint::new(at.x + 0.7 * a.axx, at.y + 0.7 * a.ayx), GREEN);
            self.cross(at, 0.7, GREEN);
        }
        found.squares.iter().flat_map(|square| square.corners).for_each(|corner| self.cross(corner, 1.5, BLUE));
        found.rejected.iter().for_each(|rejected| self.cross(rejected.at, 2.0, RED));
    }

    fn write(&self, path: &str) -> std::io::Result<()> {
        let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
        write!(file, "P6\n{} {}\n255\n", self.width, self.height)?;
        file.write_all(self.pixels.as_flattened())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let path = arguments.first().ok_or("expected the name of the picture")?;
    let number = |place: usize, usual: f64| arguments.get(place).map_or(Ok(usual), |text| text.parse::<f64>());
    let (blur, decibel, phi, roll) = (number(1, 0.6)?, number(2, 26.0)?, number(3, 30.0)?, number(4, 20.0)?);
    let setting = Setting::paper(1, blur, decibel);
    let field = setting.testfield();
    let taken = shots(&setting, &field, &[(phi, [0.0, phi])], &[roll]);
    let mut canvas = Canvas::of(&taken[0].image);
    canvas.draw(&Recogniser::new(&field, Classifier::Modern)?.recognise(&taken[0].image)?);
    Ok(canvas.write(path)?)
}
