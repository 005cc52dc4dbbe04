//! How well the coded field's targets are located among their neighbours and lines, and alone on a wall:
//! `cargo run --release -p calibench-cli --example location [rolls] [method ...]`.
//!
//! The recordings of Vosselman & Förstner (`scenarios/vosselman-1988/recordings.toml`) at 46 and 26 dB, and the same targets in the same places with nothing near.
//! RMSE per axis, px, from the reference point's image, of discs from the centre of their ellipse; own over empirical standard deviation; lost, %. Of `lsm`, too,
//! how many steps it takes alone until one moves the position by less than 0.01 px.

use std::collections::BTreeMap;

use calibench_measure::{Operator, Registry};
use calibench_model::camera::{Camera, ImageSize, Photogrammetric};
use calibench_model::testfield::{Curve, PlatePoint, Testfield};
use calibench_model::{Image, Start};
use calibench_random::{Key, Purpose, stream};
use calibench_synth::optics::Optics;
use calibench_synth::pointing::{Hand, MapError};
use calibench_synth::raster::Renderer;
use calibench_synth::sensor::{Design, Noise, Sensor};
use calibench_synth::stations::{Aim, Stand, StandBend, Station};
use calibench_synth::testfield::Coded;
use calibench_synth::view::{TargetTruth, View, Visibility};

const SIDE: u32 = 240;
const KEY: Key<'static> = Key { seed: 1988, of: "location", trial: 0, view: "", target: "" };
const LEVELS: [f64; 2] = [46.0, 26.0];
const TURNS: [f64; 4] = [0.0, 90.0, 180.0, 270.0];
/// Targets of a square, and groups of squares, of which two are far from each other.
const APART: (usize, usize) = (16, 4);
const MOST_STEPS: usize = 8;

/// What was found of one type of target.
#[derive(Clone, Copy, Default)]
struct Sum {
    count: f64,
    lost: f64,
    squares: f64,
    own: f64,
}

impl Sum {
    fn rmse(&self) -> f64 {
        (self.squares / self.count / 2.0).sqrt()
    }

    fn lost(&self) -> f64 {
        100.0 * self.lost / (self.count + self.lost)
    }
}

/// Method, phi (degrees), type, level and whether alone.
type Cell = (usize, u32, String, usize, bool);

struct Setting {
    field: Testfield,
    camera: Camera,
    optics: Optics,
    renderer: Renderer,
}

impl Setting {
    fn new() -> Self {
        let field = Coded { bend: None, ..Coded::paper() }.generate(KEY).expect("the paper's field");
        let size = ImageSize { width: SIDE, height: SIDE };
        let (k, p, b) = ([0.0; 3], [0.0; 2], [0.0; 2]);
        let camera = Camera::Photogrammetric(Photogrammetric { size, pitch_um: 27.0, c: 57.5, x0: 0.0, y0: 0.0, k, p, b });
        let optics = Optics { blur: 0.6, aperture: 0.8, ..Optics::default() };
        let renderer = Renderer::new(&optics, SIDE as usize, SIDE as usize).expect("optics in range");
        Self { field, camera, optics, renderer }
    }

    fn stations(&self, rolls: usize) -> Vec<Station> {
        let radians = |degrees: &[f64]| degrees.iter().map(|d| d.to_radians()).collect();
        let bend = Some(StandBend { peak: 0.8, reach: 250.0, across: 0.0 });
        let (phis, turns, rolls) = (radians(&[0.0, 30.0, 45.0]), radians(&TURNS), radians(&TURNS[..rolls.clamp(1, 4)]));
        let aim = Aim::of(&self.field).expect("a field that faces one way");
        Stand { phis, turns, rolls, distance: 4440.0, bend }.generate(&aim, &self.field).expect("stations before the field")
    }

    fn view<'a>(&'a self, field: &'a Testfield, station: &'a Station) -> View<'a> {
        View { field, camera: &self.camera, local: None, pose: &station.pose }
    }

    /// The image without noise, and the truth.
    fn image(&self, field: &Testfield, station: &Station) -> (Image<'static>, Vec<TargetTruth>) {
        let view = self.view(field, station);
        let seen = view.seen(self.optics.reach()).expect("a field in view");
        (self.renderer.render(&seen.picture().expect("outlines in view"), &[]), seen.truth())
    }
}

/// The targets' numbers and the images in which they are: all in one, and with nothing near them.
fn scenes(setting: &Setting, field: &Testfield, station: &Station) -> Vec<(Vec<usize>, bool, Image<'static>)> {
    let near = |at: PlatePoint, size: f64, curve: &Curve| match curve {
        Curve::Line { from, .. } => (from[0] - at[0]).hypot(from[1] - at[1]) < 0.75 * size,
        Curve::Arc { centre, .. } => (centre[0] - at[0]).hypot(centre[1] - at[1]) < 1e-6,
    };
    let mut scenes = vec![((0..field.targets.len()).collect(), false, setting.image(field, station).0)];
    for group in 0..APART.0 * APART.1 {
        // Every other square of every other row, and in it one target.
        let parity = |index: usize| (index / APART.0 % 4 % 2) + 2 * (index / APART.0 / 4 % 2);
        let chosen: Vec<usize> =
            (0..field.targets.len()).filter(|&index| index % APART.0 == group / APART.1 && parity(index) == group % APART.1).collect();
        let mut plate = field.plates[0].clone();
        plate.areas.retain(|area| chosen.iter().any(|&i| near(field.targets[i].at, field.targets[i].size, &area.outline.0[0])));
        let alone = Testfield { plates: vec![plate], targets: Vec::new(), background: field.background };
        scenes.push((chosen, true, setting.image(&alone, station).0));
    }
    scenes
}

fn starts(field: &Testfield, station: &Station, truth: &[TargetTruth]) -> Vec<Option<Start>> {
    let hand = Hand { sigma: 0.5, whole_pixels: true, map: MapError { turn: 5_f64.to_radians(), stretch: 0.1 } };
    let start = |index: usize| {
        let (target, truth) = (&field.targets[index], &truth[index]);
        let mut rng = stream(Key { view: &station.name, target: &target.id, ..KEY }, Purpose::Pointing);
        let at = hand.point(truth.at.filter(|_| truth.visibility == Visibility::Visible)?, &mut rng);
        Some(Start { kind: Some(target.kind), affine: Some(hand.map.apply(truth.affine?, &mut rng)), ..Start::at(at) })
    };
    (0..truth.len()).map(start).collect()
}

fn add(sum: &mut Sum, found: &Result<calibench_model::Measurement, calibench_model::Rejection>, truth: &TargetTruth) {
    let (Ok(found), Some(at)) = (found, truth.ellipse.map(|ellipse| ellipse.centre).or(truth.at)) else {
        sum.lost += 1.0;
        return;
    };
    sum.count += 1.0;
    sum.squares += found.position.distance(at).powi(2);
    sum.own += found.covariance.map_or(f64::NAN, |covariance| covariance.sxx + covariance.syy);
}

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let rolls = arguments.first().and_then(|text| text.parse().ok());
    if rolls.is_some() {
        arguments.remove(0);
    }
    let defaults = ["lsm:window=15", "lsm:window=15,sharpness=0,sigma=0.575", "lsm:window=13", "centroid_binary:window=13"];
    let methods = if arguments.is_empty() { defaults.map(String::from).to_vec() } else { arguments };
    let operator = |text: &str| -> Box<dyn Operator> {
        let configured = Registry::builtin().parse(text).unwrap_or_else(|error| panic!("{error}"));
        configured.operator.unwrap_or_else(|why| panic!("{text}: {why}"))
    };
    let operators: Vec<Box<dyn Operator>> = methods.iter().map(|text| operator(text)).collect();
    let stepping: Vec<Box<dyn Operator>> =
        (1..=MOST_STEPS).map(|steps| operator(&format!("lsm:window=15,epsilon=0.01,iterations={steps}"))).collect();
    let (mut sums, mut steps) = (BTreeMap::<Cell, Sum>::new(), BTreeMap::<(u32, usize), [usize; MOST_STEPS]>::new());
    let setting = Setting::new();
    for station in setting.stations(rolls.unwrap_or(4)) {
        let field = station.field(&setting.field);
        let phi = [0, 30, 45][usize::from(station.name.as_bytes()[1] - b'1')];
        let truth = setting.image(&field, &station).1;
        let starts = starts(&field, &station, &truth);
        for (number, (targets, alone, clean)) in scenes(&setting, &field, &station).into_iter().enumerate() {
            let targets: Vec<usize> = targets.into_iter().filter(|&index| starts[index].is_some()).collect();
            let list: Vec<Start> = targets.iter().filter_map(|&index| starts[index]).collect();
            for (level, decibel) in LEVELS.into_iter().enumerate() {
                let noise = Noise::white_below(0.8, decibel, 0.0);
                let sensor = Sensor::new(Design { noise, converter: Some(8), ..Design::default() }).expect("a sensor that can be");
                let view = format!("{}-{number}-{level}", station.name);
                let image = sensor.expose(clean.clone(), Key { view: &view, ..KEY }).expect("no file is written").image;
                for (method, operator) in operators.iter().enumerate() {
                    for (&index, found) in targets.iter().zip(operator.measure_all(&image, &list)) {
                        let id = &field.targets[index].id;
                        let kind = id[id.find('-').map_or(0, |dash| dash + 1)..id.len() - 2].to_owned();
                        add(sums.entry((method, phi, kind, level, alone)).or_default(), &found, &truth[index]);
                    }
                }
                if alone {
                    let counts = steps.entry((phi, level)).or_default();
                    for (count, operator) in counts.iter_mut().zip(&stepping) {
                        *count += operator.measure_all(&image, &list).iter().filter(|found| found.is_ok()).count();
                    }
                }
            }
        }
    }
    for (method, label) in methods.iter().enumerate() {
        println!("\n{label}\ntype            phi | 46 dB: beside  alone ratio own/emp lost % | 26 dB: beside  alone ratio own/emp lost %");
        for (phi, kind) in [0, 30, 45].into_iter().flat_map(|phi| types().map(move |kind| (phi, kind))) {
            let figures = [0, 1].map(|level| {
                let of = |alone| sums.get(&(method, phi, kind.clone(), level, alone)).copied().unwrap_or_default();
                let (beside, alone) = (of(false), of(true));
                let own = (beside.own / beside.squares).sqrt();
                format!("{:14.4} {:6.4} {:5.2} {own:7.2} {:6.2}", beside.rmse(), alone.rmse(), beside.rmse() / alone.rmse(), beside.lost())
            });
            println!("{kind:15} {phi:3} |{} |{}", figures[0], figures[1]);
        }
    }
    for ((phi, level), counts) in steps {
        let all = counts[MOST_STEPS - 1] as f64;
        let shares: Vec<String> = counts.iter().map(|&count| format!("{:.0} %", 100.0 * count as f64 / all)).collect();
        println!("alone, phi {phi}, {} dB: at rest within 0.01 px after 1, 2, ... steps: {}", LEVELS[level], shares.join(", "));
    }
}

fn types() -> impl Iterator<Item = String> {
    ["small", "large"].into_iter().flat_map(|size| ["square", "triangle", "cross", "disc"].map(|kind| format!("{size}-{kind}")))
}
