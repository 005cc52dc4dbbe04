//! What of the answer of `calibrate` stands on a certificate. Keys that are not known are passed over.

use serde::Deserialize;

#[derive(Deserialize)]
pub struct Answer {
    #[serde(default)]
    pub doubts: Vec<String>,
    #[serde(default)]
    pub suspected: Vec<Suspect>,
    #[serde(default)]
    pub untested: Vec<String>,
    #[serde(default)]
    pub warnings: Vec<String>,
    #[serde(default)]
    pub datum: String,
    pub counts: Counts,
    pub sigma_px: f64,
    pub sigma_is_assumed: bool,
    pub sigma0: Option<f64>,
    pub rms_px: f64,
    pub cameras: Vec<Calibrated>,
    #[serde(default)]
    pub lengths: Vec<Length>,
    pub board: Board,
}

#[derive(Deserialize)]
pub struct Suspect {
    pub what: String,
}

#[derive(Deserialize)]
pub struct Counts {
    pub images: usize,
    pub image_points: usize,
    pub not_in_full: usize,
    pub targets: usize,
    pub control_points: usize,
    pub observations: usize,
    pub unknowns: usize,
    pub redundancy: i64,
}

#[derive(Deserialize)]
pub struct Calibrated {
    pub name: String,
    pub camera: Camera,
    pub over_frame: Option<OverFrame>,
    pub solved: Vec<Solved>,
}

#[derive(Deserialize)]
pub struct Camera {
    pub convention: String,
    pub size: Size,
    pub pitch_um: Option<f64>,
    pub parameters: Vec<Parameter>,
    pub covariance: Option<Covariance>,
}

#[derive(Deserialize)]
pub struct Size {
    pub width: u32,
    pub height: u32,
}

#[derive(Deserialize)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    pub unit: String,
    pub sigma: Option<f64>,
}

#[derive(Deserialize)]
pub struct Covariance {
    pub parameters: Vec<String>,
    pub values: Vec<Vec<f64>>,
}

impl Covariance {
    /// The other parameter that is most correlated with one, and how much.
    pub fn most(&self, parameter: &str) -> Option<(&str, f64)> {
        let variance = |i: usize| self.values.get(i)?.get(i).copied().filter(|v| *v > 0.0);
        let row = self.parameters.iter().position(|name| name == parameter)?;
        let own = variance(row)?;
        let rho = |other: usize| Some((self.parameters[other].as_str(), self.values[row].get(other)? / (own * variance(other)?).sqrt()));
        (0..self.parameters.len()).filter(|other| *other != row).filter_map(rho).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }
}

#[derive(Clone, Copy, Deserialize)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the answer")]
pub struct OverFrame {
    pub formal_px: Option<f64>,
    pub by_images_px: Option<f64>,
    pub limit_px: f64,
}

#[derive(Deserialize)]
pub struct Solved {
    pub parameter: String,
    pub sigma_by_images: Option<f64>,
}

#[derive(Deserialize)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the answer")]
pub struct Length {
    pub targets: [String; 2],
    pub length: f64,
    pub sigma: f64,
    pub measured: Option<f64>,
}

#[derive(Deserialize)]
pub struct Board {
    pub shape: String,
    pub why: Option<String>,
    pub bend: Option<[f64; 3]>,
    pub sigma: Option<[f64; 3]>,
    pub p: Option<f64>,
    /// What is stated of the print's scale.
    pub scale: Option<Scale>,
    /// What is stated of each coordinate of a point of the board, object units.
    pub print_noise: Option<f64>,
}

#[derive(Clone, Copy, Deserialize)]
pub struct Scale {
    pub value: f64,
    pub sigma: f64,
}
