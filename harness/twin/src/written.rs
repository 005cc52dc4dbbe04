//! A twin as a scenario.

use std::fmt::Write as _;

use calibench_model::Pose;

use crate::design::Design;
use crate::look::{INK, PAPER};

/// Below this share of a square neither ragged edges nor spread ink are written.
const NOTHING: f64 = 1e-5;
/// A blur in the corners that is less than this times that in the middle is the same.
const LEAST_RISE: f64 = 1.05;
/// How many times wider a tail is than the blur in the corners.
const TAIL: f64 = 2.5;
/// Correlation length of ragged edges, px: that of the pieces by which they are measured.
const RAGGED_LENGTH: f64 = 2.0;

/// What a twin pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Why it is there.
    pub why: String,
    /// Where it comes from.
    pub source: String,
    /// The name of the camera's file.
    pub camera: String,
    /// The name of the board's file.
    pub board: String,
    /// Rows of inner corners.
    pub rows: usize,
    /// Inner corners in a row.
    pub columns: usize,
    /// The side of a square, object units.
    pub square: f64,
    /// The names of the views, and their poses.
    pub stations: Vec<(String, Pose)>,
    /// The luminance quantisation table of the photographs' JPEG, row by row.
    pub tables: Option<[u8; 64]>,
    /// Bits of the images.
    pub bits: u32,
    /// The side of a square in the images, px.
    pub side: f64,
    /// The seed.
    pub seed: u64,
}

/// The scenario of a twin as TOML: what it pictures, and what it is made of.
pub fn written(scene: &Scene, design: &Design) -> String {
    let mut text = head(scene, design);
    testfield(&mut text, scene, design);
    imaging(&mut text, scene, design);
    let gain = gain(design);
    for ((name, pose), view) in scene.stations.iter().zip(&design.views) {
        let [omega, phi, kappa] = pose.angles().map(f64::to_degrees);
        let smear = view.smear();
        let light = &view.light;
        _ = write!(
            text,
            "\n[[station]]\nname = {name:?}\nat = [{}, {}, {}]\nangles = [{omega}, {phi}, {kappa}]\nblur = {:.4}\n",
            pose.centre.x, pose.centre.y, pose.centre.z, smear.blur
        );
        if let Some([dx, dy]) = smear.motion {
            _ = writeln!(text, "motion = [{dx:.4}, {dy:.4}]");
        }
        let [gx, gy] = light.gradient;
        _ = writeln!(
            text,
            "exposure = {:.5}\nveil = {:.5}\ngradient_across = [{gx:.5}, {gy:.5}]",
            light.exposure / gain,
            light.veil / gain
        );
    }
    text
}

fn head(scene: &Scene, design: &Design) -> String {
    // What changes from square to square: poses do not take it up.
    let correlation = scene.side.max(10.0 * design.local);
    let local = if design.local > 0.0 {
        format!("\n[camera.local]\nsigma = {:.5}\ncorrelation = {correlation:.2}\neach_trial = false\n", design.local)
    } else {
        String::new()
    };
    format!(
        "why = {:?}\nsource = {:?}\nseed = {}\ntrials = 1\n\n[camera]\nfile = {:?}\n{local}\n[pointing]\ndetector = \"board\"\n\n[[method]]\nname = \"parametric_corner\"\n",
        scene.why, scene.source, scene.seed, scene.camera
    )
}

fn testfield(text: &mut String, scene: &Scene, design: &Design) {
    _ = write!(
        text,
        "\n[testfield]\nkind = \"board\"\nunit = \"mm\"\nboard = \"chessboard:{}x{}:{}\"\ncorners = {:?}\nmargin = {}\npaper = {PAPER}\nink = {INK}\nbackground = 0.4\n",
        scene.columns, scene.rows, scene.square, scene.board, scene.square
    );
    if design.ink_spread.abs() > NOTHING {
        _ = writeln!(text, "ink_spread = {:.3e}", design.ink_spread * scene.square);
    }
    if design.raggedness.sqrt() > NOTHING {
        let length = RAGGED_LENGTH / scene.side * scene.square;
        _ = writeln!(text, "ragged = {:.3e}\nragged_length = {length:.3e}", design.raggedness.sqrt() * scene.square);
    }
}

fn imaging(text: &mut String, scene: &Scene, design: &Design) {
    let blurs = design.views.iter().map(|view| view.smear().blur);
    let middle = calibench_model::median(blurs).unwrap_or(0.5).max(0.12);
    let corner = (middle * middle + design.corner.max(0.0)).sqrt().min(15.0 * middle);
    _ = writeln!(text, "\n[optics]\nblur = {middle:.4}");
    if corner > LEAST_RISE * middle {
        _ = writeln!(text, "corner_blur = {corner:.4}");
    }
    if design.halo < -1e-4 {
        _ = writeln!(text, "tail = {:.4}\ntail_blur = {:.4}", -design.halo, TAIL * corner);
    }
    let gain = gain(design);
    let (dark, slope) = (design.noise.dark / (gain * gain), design.noise.slope / gain);
    let deepest = if scene.bits > 8 || design.tone.is_bent() { 16 } else { 12 };
    text.push_str("\n[sensor]\n");
    if slope > 0.02 * dark && slope > 1e-9 {
        let electrons = 1.0 / slope;
        _ = writeln!(text, "full_well = {electrons:.1}\nread_noise = {:.3}", (dark.sqrt() * electrons).max(0.01));
    } else {
        _ = writeln!(text, "grey_noise = {:.6}", dark.sqrt());
    }
    _ = writeln!(text, "adc_bits = {deepest}\nbits = {}", if scene.bits > 8 { 16 } else { 8 });
    if design.demosaiced {
        text.push_str("filter = \"rggb\"\ndemosaic = \"grey\"\n");
    }
    if design.tone.is_bent() {
        _ = writeln!(text, "shoulder = {{ start = {:.4}, gain = {gain} }}", 1.0 - design.tone.shoulder);
    }
    if design.smoothing > 0.05 {
        _ = writeln!(text, "smoothing = {:.4}", design.smoothing);
    }
    if design.halo > 1e-4 {
        _ = writeln!(text, "sharpening = {:.4}", design.halo);
    }
    if let Some(tables) = &scene.tables {
        let rows: Vec<String> =
            tables.chunks(8).map(|row| format!("    {},", row.iter().map(u8::to_string).collect::<Vec<_>>().join(", "))).collect();
        _ = writeln!(text, "jpeg_tables = [\n{}\n]", rows.join("\n"));
    }
}

/// How many times the white of the images the brightest light is that the sensor holds: what a shoulder needs.
fn gain(design: &Design) -> f64 {
    if design.tone.is_bent() { 4.0 } else { 1.0 }
}
