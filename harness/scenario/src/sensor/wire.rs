//! The `[sensor]` table as it is written.

use schemars::JsonSchema;
use serde::Deserialize;

use super::numbers::{
    Coefficient, ConverterBits, Current, Decibel, Electron, Exposure, Factor, GammaExponent, Gradient, Jitter, Numbers, Offset, Percent,
    Positive, Quality, QuantumEfficiency, Radius, Sensitivity, Sharpening, ShoulderGain, ShoulderStart, Smoothing, TableStep, Time,
};
use crate::wire::{Bits, GreyNoise, Position};

/// What becomes of the light behind the photosites' apertures. Every key is a stage that may be left out.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorWire {
    /// Fall-off of the light [a1, a2, a3]: 1 + a1 t + a2 t^2 + a3 t^3, t the square of the radius in half diagonals, at the pixel's centre.
    pub vignetting: Option<Numbers<Coefficient, 3>>,
    /// true: natural fall-off, cos^4 of the ray's angle at the camera's principal distance. Not beside `vignetting`.
    pub cos4: Option<bool>,
    /// Where the fall-off is centred [x, y], px. Default: the camera's principal point, or the centre of the frame.
    pub vignetting_centre: Option<Position>,
    /// Illumination gradient [x, y]: change of the light per pixel, as a fraction of that at the frame's centre.
    pub gradient_per_pixel: Option<Numbers<Gradient, 2>>,
    /// Illumination gradient [x, y]: change of the light across the whole frame. Not beside `gradient_per_pixel`.
    pub gradient_across: Option<Numbers<Gradient, 2>>,
    /// Grey value of a target of reflectance 1, fraction of full scale. Default 1.
    pub exposure: Option<Exposure>,
    /// Bayer filter: `rggb`, `bggr`, `grbg` or `gbrg`, the first two photosites of the first two rows.
    pub filter: Option<Filter>,
    /// Signal of a grey target behind red, green and blue [r, g, b], relative to the light before the filter. Default [1, 1, 1].
    pub filter_sensitivity: Option<Numbers<Sensitivity, 3>>,

    /// White noise: its standard deviation, fraction of full scale. One of the four descriptions of the noise.
    pub grey_noise: Option<GreyNoise>,
    /// White noise from 20 lg(difference of the lightest and the darkest level of the testfield / standard deviation), dB. One of the four descriptions of the noise.
    pub snr_contrast_db: Option<Decibel>,
    /// White noise from 20 lg(mean of the lightest and the darkest level of the testfield / standard deviation), dB. One of the four descriptions of the noise.
    pub snr_mean_db: Option<Decibel>,

    /// Saturation capacity, e-: the noise is described by electrons, one of the four descriptions.
    pub full_well: Option<Positive>,
    /// Electrons that grey value 1 after exposure collects, e-. Default: `full_well`, or from `photons`.
    pub electrons: Option<Positive>,
    /// Photons on a photosite at grey value 1 after exposure, with `quantum_efficiency`. Not beside `electrons`.
    pub photons: Option<Positive>,
    /// Electrons per photon, with `photons`.
    pub quantum_efficiency: Option<QuantumEfficiency>,
    /// Photo response non-uniformity PRNU1288, %, with any description of the noise. The same in all views and trials.
    pub prnu: Option<Percent>,
    /// Dark current, e-/s, with `exposure_time`. It has shot noise.
    pub dark_current: Option<Current>,
    /// Exposure time, s, with `dark_current`.
    pub exposure_time: Option<Time>,
    /// Dark signal non-uniformity DSNU1288, e-. The same in all views and trials.
    pub dsnu: Option<Electron>,
    /// Read noise sigma_d0: standard deviation, e-.
    pub read_noise: Option<Electron>,
    /// Noise common to a row, new in each row of each image, e-.
    pub row_noise: Option<Electron>,
    /// System gain K, DN/e-, with `adc_bits`. Default: a full well is the converter's top.
    pub gain: Option<Positive>,
    /// Black level, DN, with `adc_bits`; below half of the converter's levels. Default 0. Gamma and demosaic take it away.
    pub black_level: Option<Offset>,

    /// Bits of the analogue-digital converter: 8, 10, 12, 14 or 16. Default: no quantisation, no clipping.
    pub adc_bits: Option<ConverterBits>,
    /// Bilinear demosaic to `grey` (0.299 R + 0.587 G + 0.114 B) or `green`, with `filter`. Default: the mosaic stays.
    pub demosaic: Option<DemosaicWire>,
    /// Factors of red, green and blue before the demosaic. Default: those that make a grey target grey.
    pub white_balance: Option<Numbers<Factor, 3>>,
    /// Smoothing of the developed image, as against noise: standard deviation of a Gaussian, px, 0 to 5, on signal and noise alike. Default 0.
    pub smoothing: Option<Smoothing>,
    /// Sharpening of the developed image: amount a of an unsharp mask, in + a (in - Gaussian of it), -0.9 to 5. Default 0.
    pub sharpening: Option<Sharpening>,
    /// With `sharpening`: standard deviation of its Gaussian, px. Default 1.
    pub sharpening_radius: Option<Radius>,
    /// Gamma: grey is light to the power of 1 / gamma. Default: linear.
    pub gamma: Option<GammaExponent>,
    /// true: the curve of sRGB. Not beside `gamma`.
    pub srgb: Option<bool>,
    /// A shoulder as of films, { start, gain }: grey is `gain` times light up to `start`, and beyond it ever less, towards 1. Not beside `gamma` or `srgb`.
    pub shoulder: Option<ShoulderWire>,
    /// Bits of the image: 8, 12 or 16. Default: as the converter has it, or 8 with `jpeg_quality`.
    pub bits: Option<Bits>,
    /// Quality of a JPEG that the image goes through, 1 to 100.
    pub jpeg_quality: Option<Quality>,
    /// The quantisation table of a JPEG that the image goes through, 64 numbers row by row, 1 to 255 each. Not beside `jpeg_quality`.
    pub jpeg_tables: Option<Numbers<TableStep, 64>>,
    /// Row jitter: standard deviation of the shift of each row along x, px. Default 0.
    pub row_jitter: Option<Jitter>,
}

/// A shoulder of the curve from light to grey.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct ShoulderWire {
    /// Grey value at which it begins.
    pub start: ShoulderStart,
    /// Slope of the curve below that.
    pub gain: ShoulderGain,
}

/// A Bayer pattern.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Filter {
    /// Red green, green blue.
    Rggb,
    /// Blue green, green red.
    Bggr,
    /// Green red, blue green.
    Grbg,
    /// Green blue, red green.
    Gbrg,
}

/// What the mosaic becomes.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum DemosaicWire {
    /// The weighted sum of the colours.
    Grey,
    /// The green colour.
    Green,
}
