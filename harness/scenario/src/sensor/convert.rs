//! A `[sensor]` table to a sensor: which keys go together, and which do not.

use std::collections::BTreeMap;
use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_model::PixelPoint;
use calibench_synth::sensor::{
    ColourFilter, Demosaic, DemosaicTo, Design, Electrons, FallOff, Gamma, Gradient, Noise, Pattern, Per, Processing, Sensor, SensorError,
    Vignetting,
};

use super::numbers::{self, Numbers};
use super::setup::{SensorSetup, Surroundings};
use super::wire::{DemosaicWire, Filter, SensorWire};
use crate::section::Section;

/// The ways to describe noise: the first key of each says that it is meant, the others belong to it.
const NOISES: [&[&str]; 4] = [
    &["grey_noise"],
    &["snr_contrast_db"],
    &["snr_mean_db"],
    &[
        "full_well",
        "electrons",
        "photons",
        "quantum_efficiency",
        "dark_current",
        "exposure_time",
        "dsnu",
        "read_noise",
        "row_noise",
        "gain",
        "black_level",
    ],
];

/// Keys that exclude each other.
const EXCLUSIVE: [(&str, &str); 7] = [
    ("vignetting", "cos4"),
    ("gradient_per_pixel", "gradient_across"),
    ("electrons", "photons"),
    ("gamma", "srgb"),
    ("gamma", "shoulder"),
    ("srgb", "shoulder"),
    ("jpeg_quality", "jpeg_tables"),
];

/// Keys that say nothing without another.
const NEEDS: [(&str, &[&str]); 10] = [
    ("sharpening_radius", &["sharpening"]),
    ("vignetting_centre", &["vignetting", "cos4"]),
    ("filter_sensitivity", &["filter"]),
    ("photons", &["quantum_efficiency"]),
    ("quantum_efficiency", &["photons"]),
    ("dark_current", &["exposure_time"]),
    ("exposure_time", &["dark_current"]),
    ("demosaic", &["filter"]),
    ("white_balance", &["demosaic"]),
    ("gain", &["adc_bits"]),
];

/// Which keys a table has, and where.
pub(super) struct Keys {
    table: Range<usize>,
    at: BTreeMap<String, Range<usize>>,
}

impl Keys {
    pub(super) fn of(section: &Section<'_>) -> Self {
        let at = section.table.keys().map(|key| (key.get_ref().to_string(), key.span())).collect();
        Self { table: section.span.clone(), at }
    }

    fn has(&self, key: &str) -> bool {
        self.at.contains_key(key)
    }

    fn problem(&self, key: &str, message: String) -> Problem {
        Problem::new(self.at.get(key).unwrap_or(&self.table).clone(), message)
    }

    /// Problems of keys that are beside others which exclude them, or without others which they need.
    fn check(&self, problems: &mut Vec<Problem>) {
        for (one, other) in EXCLUSIVE {
            if self.has(one) && self.has(other) {
                problems.push(self.problem(other, format!("`{other}` beside `{one}`: expected one of them")));
            }
        }
        for (key, needed) in NEEDS.into_iter().chain([("black_level", ["adc_bits"].as_slice())]) {
            if self.has(key) && !needed.iter().any(|needed| self.has(needed)) {
                let needed = needed.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(" or ");
                problems.push(self.problem(key, format!("`{key}` without {needed}: expected both or none")));
            }
        }
        let described: Vec<&str> = NOISES.iter().filter_map(|keys| keys.iter().copied().find(|key| self.has(key))).collect();
        for other in described.iter().skip(1) {
            let problem = self.problem(other, format!("`{other}` beside `{}`: expected one description of the noise", described[0]));
            problems.push(problem.help("`grey_noise`, `snr_contrast_db`, `snr_mean_db`, or `full_well` with the other keys of electrons"));
        }
        if self.has("prnu") && described.is_empty() {
            let problem = self.problem("prnu", "`prnu` without a description of the noise".to_owned());
            problems.push(problem.help("beside `grey_noise`, `snr_contrast_db`, `snr_mean_db` or `full_well`"));
        }
        if let [key] = described[..]
            && NOISES[3].contains(&key)
            && key != "full_well"
        {
            let problem = self.problem(key, format!("`{key}` without `full_well`"));
            problems.push(problem.help("`full_well`: saturation capacity of a photosite, e-"));
        }
    }
}

pub(super) fn setup(wire: &SensorWire, keys: &Keys, around: &Surroundings, problems: &mut Vec<Problem>) -> Option<SensorSetup> {
    let before = problems.len();
    keys.check(problems);
    let vignetting = vignetting(wire, keys, around, problems);
    let exposure = wire.exposure.map_or(1.0, |exposure| exposure.0);
    let noise = noise(wire, keys, around, exposure, problems);
    if problems.len() > before {
        return None;
    }
    let design = Design {
        vignetting,
        veil: 0.0,
        gradient: gradient(wire),
        exposure,
        filter: wire.filter.map(|filter| ColourFilter {
            pattern: pattern(filter),
            sensitivity: wire.filter_sensitivity.map_or([1.0; 3], |numbers| numbers.0.map(|s| s.0)),
        }),
        noise: noise?,
        converter: wire.adc_bits.map(|bits| bits.0),
        demosaic: wire.demosaic.map(|to| demosaic(to, wire)),
        processing: processing(wire),
        gamma: gamma(wire),
        output: wire.bits.map(|bits| bits.0),
        jpeg: wire.jpeg_quality.map(|quality| quality.0),
        tables: wire.jpeg_tables.map(|table| table.0.map(|step| step.0)),
    };
    let sensor = Sensor::new(design).map_err(|error| problems.push(refused(&error, keys))).ok()?;
    Some(SensorSetup { sensor, row_jitter: wire.row_jitter.map_or(0.0, |jitter| jitter.0) })
}

/// What the sensor refuses although each key is within its bounds.
fn refused(error: &SensorError, keys: &Keys) -> Problem {
    let key = match error {
        SensorError::JpegBits(_) => "bits",
        SensorError::OutOfRange { what: "the black level", .. } => "black_level",
        SensorError::OutOfRange { what: "the dark signal", .. } => "dark_current",
        SensorError::OutOfRange { what: "the full well", .. } => "full_well",
        SensorError::OutOfRange { what: "the electrons at white", .. } if keys.has("photons") => "photons",
        SensorError::OutOfRange { what: "the electrons at white", .. } => "electrons",
        SensorError::OutOfRange { what: "the gain", .. } => "gain",
        SensorError::OutOfRange { what: "the noise", .. } if keys.has("snr_mean_db") => "snr_mean_db",
        SensorError::OutOfRange { what: "the noise", .. } => "snr_contrast_db",
        _ => "",
    };
    keys.problem(key, error.to_string())
}

fn vignetting(wire: &SensorWire, keys: &Keys, around: &Surroundings, problems: &mut Vec<Problem>) -> Option<Vignetting> {
    let fall_off = match (wire.vignetting, wire.cos4) {
        (Some(numbers), _) => FallOff::Polynomial(numbers.0.map(|a| a.0)),
        (None, Some(true)) => match around.principal_distance {
            Some(c) => FallOff::Cos4 { c },
            None => {
                let problem = keys.problem("cos4", "`cos4` without a camera: its principal distance is not known".to_owned());
                problems.push(problem.help("give the fall-off as `vignetting = [a1, a2, a3]`"));
                return None;
            }
        },
        (None, _) => return None,
    };
    let stated = wire.vignetting_centre.map(|position| PixelPoint::new(position.0, position.1));
    Some(Vignetting { centre: stated.or(around.principal_point), fall_off })
}

fn gradient(wire: &SensorWire) -> Option<Gradient> {
    let of = |numbers: Numbers<numbers::Gradient, 2>, per| Gradient { x: numbers.0[0].0, y: numbers.0[1].0, per };
    let across = wire.gradient_across.map(|numbers| of(numbers, Per::Frame));
    wire.gradient_per_pixel.map(|numbers| of(numbers, Per::Pixel)).or(across)
}

/// The noise that is described; `None` with a problem if the description refers to what is not known.
fn noise(wire: &SensorWire, keys: &Keys, around: &Surroundings, exposure: f64, problems: &mut Vec<Problem>) -> Option<Noise> {
    let prnu = wire.prnu.map_or(0.0, |percent| percent.0 / 100.0);
    if let Some(sigma) = wire.grey_noise {
        return Some(Noise::White { sigma: sigma.0, prnu });
    }
    let ratios = [
        ("snr_contrast_db", wire.snr_contrast_db, around.contrast, "the targets' contrast"),
        ("snr_mean_db", wire.snr_mean_db, around.mean, "the mean of the lightest and the darkest level"),
    ];
    for (key, ratio, signal, what) in ratios {
        let Some(ratio) = ratio else { continue };
        match signal.filter(|&signal| signal > 0.0) {
            Some(signal) => return Some(Noise::white_below(signal * exposure, ratio.0, prnu)),
            None => {
                let problem = keys.problem(key, format!("`{key}`: {what} is not known here, or zero"));
                problems.push(problem.help("describe the noise by `grey_noise` or `full_well`"));
                return None;
            }
        }
    }
    Some(wire.full_well.map_or(Noise::None, |well| Noise::Electrons(electrons(wire, well.0, prnu))))
}

fn electrons(wire: &SensorWire, full_well: f64, prnu: f64) -> Electrons {
    let of_photons = wire.photons.zip(wire.quantum_efficiency).map(|(photons, efficiency)| photons.0 * efficiency.0);
    Electrons {
        full_well,
        at_white: wire.electrons.map(|electrons| electrons.0).or(of_photons).unwrap_or(full_well),
        prnu,
        dark: wire.dark_current.zip(wire.exposure_time).map_or(0.0, |(current, time)| current.0 * time.0),
        dsnu: wire.dsnu.map_or(0.0, |electrons| electrons.0),
        read: wire.read_noise.map_or(0.0, |electrons| electrons.0),
        row: wire.row_noise.map_or(0.0, |electrons| electrons.0),
        gain: wire.gain.map(|gain| gain.0),
        black_level: wire.black_level.map_or(0.0, |level| level.0),
    }
}

fn pattern(filter: Filter) -> Pattern {
    match filter {
        Filter::Rggb => Pattern::Rggb,
        Filter::Bggr => Pattern::Bggr,
        Filter::Grbg => Pattern::Grbg,
        Filter::Gbrg => Pattern::Gbrg,
    }
}

fn demosaic(to: DemosaicWire, wire: &SensorWire) -> Demosaic {
    let to = match to {
        DemosaicWire::Grey => DemosaicTo::Grey,
        DemosaicWire::Green => DemosaicTo::Green,
    };
    Demosaic { to, white_balance: wire.white_balance.map(|numbers| numbers.0.map(|factor| factor.0)) }
}

fn gamma(wire: &SensorWire) -> Option<Gamma> {
    let shoulder = || wire.shoulder.as_ref().map(|shoulder| Gamma::Shoulder { start: shoulder.start.0, gain: shoulder.gain.0 });
    wire.gamma.map(|gamma| Gamma::Power(gamma.0)).or(wire.srgb.filter(|&srgb| srgb).map(|_| Gamma::Srgb)).or_else(shoulder)
}

fn processing(wire: &SensorWire) -> Option<Processing> {
    let smoothing = wire.smoothing.as_ref().map_or(0.0, |smoothing| smoothing.0);
    let sharpening = wire.sharpening.as_ref().map_or(0.0, |sharpening| sharpening.0);
    let radius = wire.sharpening_radius.as_ref().map_or(1.0, |radius| radius.0);
    (wire.smoothing.is_some() || wire.sharpening.is_some()).then_some(Processing { smoothing, sharpening, radius })
}
