//! The stages that need no other row: most of them.

use calibench_random::{Key, Purpose, stream};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::convert::Converter;
use super::demosaic::Demosaic;
use super::electrons::{Electrons, Wells};
use super::filter::{ColourFilter, scale_colours};
use super::normal::fill_normal;
use super::shading::shade;
use super::{Clipped, Frame, Noise, Sensor};

/// The streams of one image: each row has its own part of each.
struct Streams {
    noise: ChaCha8Rng,
    electrons: ChaCha8Rng,
    prnu: ChaCha8Rng,
    dsnu: ChaCha8Rng,
    rows: ChaCha8Rng,
}

impl Streams {
    fn new(key: Key<'_>) -> Self {
        let camera = Key { trial: 0, view: "", target: "", ..key };
        Self {
            noise: stream(key, Purpose::SensorNoise),
            electrons: stream(key, Purpose::Electrons),
            prnu: stream(camera, Purpose::Prnu),
            dsnu: stream(camera, Purpose::Dsnu),
            rows: stream(key, Purpose::RowNoise),
        }
    }
}

fn of_row(stream: &ChaCha8Rng, y: usize) -> ChaCha8Rng {
    let mut rng = stream.clone();
    rng.set_stream(y as u64);
    rng
}

/// What one thread needs for a row beside the row.
struct Scratch {
    normals: Vec<f32>,
    read_out: Vec<f32>,
    full: Vec<u8>,
}

impl Sensor {
    /// Exposes the rows of `rows` from row `first_row` of an image of `frame`: all stages before the demosaic, or if there is none, before JPEG.
    ///
    /// The same bytes whatever rows are exposed together. `key` is the image's.
    pub fn expose_rows(&self, rows: &mut [f32], first_row: usize, frame: Frame, key: Key<'_>) -> Clipped {
        let streams = Streams::new(key);
        let n = frame.width;
        let mut scratch = Scratch { normals: vec![0.0; n], read_out: vec![0.0; n], full: vec![0; n] };
        let each = rows.chunks_mut(n.max(1)).enumerate();
        each.map(|(i, row)| self.expose_row(row, first_row + i, frame, &streams, &mut scratch)).sum()
    }

    fn expose_row(&self, row: &mut [f32], y: usize, frame: Frame, streams: &Streams, scratch: &mut Scratch) -> Clipped {
        let design = &self.design;
        shade(design.vignetting, design.gradient, row, y, frame);
        if design.exposure != 1.0 {
            scale(row, design.exposure as f32);
        }
        if design.veil != 0.0 {
            let veil = design.veil as f32;
            row.iter_mut().for_each(|light| *light += veil);
        }
        if let Some(filter) = &design.filter {
            filter.apply(row, y);
        }
        let (mut black, mut per_unit) = (0.0, 1.0);
        scratch.full.fill(0);
        match &design.noise {
            Noise::None => {}
            Noise::White { sigma, prnu } => {
                respond(row, *prnu, &streams.prnu, y, &mut scratch.normals);
                add_normal(row, *sigma, &streams.noise, y, &mut scratch.normals);
            }
            Noise::Electrons(electrons) => {
                collect(electrons, electrons.wells(design.converter), row, y, streams, scratch);
                (black, per_unit) = electrons.scale(design.converter);
            }
        }
        let clipped = match design.converter {
            Some(bits) => Converter::new(bits, black, per_unit).convert(row, &scratch.full),
            None => {
                if per_unit != 1.0 {
                    scale(row, per_unit as f32);
                }
                Clipped { low: 0, high: scratch.full.iter().map(|&full| u64::from(full)).sum() }
            }
        };
        if self.is_finished_whole() { clipped } else { clipped + self.finish_row(row) }
    }

    /// Takes the black level away and balances the colours of row `y` of the mosaic.
    pub(super) fn balance_row(&self, demosaic: &Demosaic, filter: &ColourFilter, row: &mut [f32], y: usize) {
        self.take_black(row);
        scale_colours(row, filter.pattern.row(y), demosaic.balance(filter));
    }

    /// Gamma and output levels.
    pub(super) fn finish_row(&self, row: &mut [f32]) -> Clipped {
        let design = &self.design;
        let mut clipped = Clipped::default();
        if let Some(gamma) = design.gamma {
            if design.demosaic.is_none() {
                self.take_black(row);
            }
            for grey in row.iter_mut() {
                clipped.low += u64::from(*grey < 0.0);
                clipped.high += u64::from(*grey > 1.0);
                *grey = gamma.encode(f64::from(grey.clamp(0.0, 1.0))) as f32;
            }
        }
        let output = design.output.or(design.jpeg.map(|_| 8)).or(design.tables.map(|_| 8));
        let changed = self.is_finished_whole() || design.gamma.is_some();
        match output {
            Some(bits) if changed || output != design.converter => clipped + Converter::new(bits, 0.0, 1.0).convert_plain(row),
            _ => clipped,
        }
    }

    fn take_black(&self, row: &mut [f32]) {
        let Noise::Electrons(electrons) = &self.design.noise else { return };
        let (black, _) = electrons.scale(self.design.converter);
        if black > 0.0 {
            let stretch = (1.0 / (1.0 - black)) as f32;
            row.iter_mut().for_each(|grey| *grey = (*grey - black as f32) * stretch);
        }
    }
}

/// Light to electrons as they are read out of row `y`.
fn collect(electrons: &Electrons, wells: Wells, row: &mut [f32], y: usize, streams: &Streams, scratch: &mut Scratch) {
    let Scratch { normals, read_out, full } = scratch;
    let (at_white, dark) = (electrons.at_white as f32, electrons.dark as f32);
    respond(row, electrons.prnu, &streams.prnu, y, normals);
    row.iter_mut().for_each(|light| *light = light.max(0.0) * at_white + dark);
    fill_normal(&mut of_row(&streams.noise, y), normals);
    wells.fill(row, normals, full, &mut of_row(&streams.electrons, y), read_out);
    add_normal(row, electrons.dsnu, &streams.dsnu, y, normals);
    if electrons.row > 0.0 {
        let z: f64 = StandardNormal.sample(&mut of_row(&streams.rows, y));
        let offset = (electrons.row * z) as f32;
        row.iter_mut().for_each(|value| *value += offset);
    }
}

/// Light as photosites of unequal response see it.
fn respond(row: &mut [f32], prnu: f64, stream: &ChaCha8Rng, y: usize, normals: &mut [f32]) {
    let prnu = prnu as f32;
    if prnu > 0.0 {
        fill_normal(&mut of_row(stream, y), normals);
        row.iter_mut().zip(&*normals).for_each(|(light, z)| *light = (*light * (1.0 + prnu * z)).max(0.0));
    }
}

fn add_normal(row: &mut [f32], sigma: f64, stream: &ChaCha8Rng, y: usize, normals: &mut [f32]) {
    if sigma > 0.0 {
        fill_normal(&mut of_row(stream, y), normals);
        let sigma = sigma as f32;
        row.iter_mut().zip(&*normals).for_each(|(value, z)| *value += sigma * z);
    }
}

fn scale(row: &mut [f32], factor: f32) {
    row.iter_mut().for_each(|grey| *grey *= factor);
}
