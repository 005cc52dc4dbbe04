//! Campaigns of images of the coded field, rendered, with their truth; and counts against it.

#![allow(dead_code, unreachable_pub)]

use std::collections::BTreeMap;

use calibench_model::camera::{Camera, CameraModel, ImageSize, Photogrammetric};
use calibench_model::{Image, PixelPoint, TargetKind, Testfield};
use calibench_random::Key;
use calibench_recognise::{Classifier, ContourTable, NotRecognised, Recogniser, Recognition, SizeGroup};
use calibench_synth::optics::Optics;
use calibench_synth::raster::Renderer;
use calibench_synth::sensor::{Design, Noise, Sensor};
use calibench_synth::stations::{Aim, BoardViews};
use calibench_synth::testfield::Coded;
use calibench_synth::view::{TargetTruth, View};

/// Contrast of paper and ink.
const CONTRAST: f64 = 0.8;

/// How images are taken.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Of the field's layout and of the noise.
    pub seed: u64,
    /// Standard deviation, px.
    pub blur: f64,
    /// Of the contrast.
    pub decibel: f64,
    /// Added to all rolls, degrees.
    pub roll: f64,
    pub field: Coded,
    pub camera: Photogrammetric,
    pub distance: f64,
}

impl Setting {
    /// The paper's recordings, all 64 squares listed.
    pub fn paper(seed: u64, blur: f64, decibel: f64) -> Self {
        let size = ImageSize { width: 240, height: 240 };
        let camera = Photogrammetric { size, pitch_um: 27.0, c: 57.5, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] };
        Self { seed, blur, decibel, roll: 0.0, field: Coded { measured: 8, ..Coded::paper() }, camera, distance: 4440.0 }
    }

    pub fn key(&self) -> Key<'static> {
        Key { seed: self.seed, of: "campaign", trial: 0, view: "", target: "" }
    }

    pub fn testfield(&self) -> Testfield {
        self.field.generate(self.key()).expect("a field")
    }
}

/// An image and what is true of it.
pub struct Shot {
    /// Degrees.
    pub phi: f64,
    pub name: String,
    pub image: Image<'static>,
    pub truth: Vec<TargetTruth>,
    /// For each target of the field whether its square lies wholly in the image.
    pub whole: Vec<bool>,
    /// Where the middles of the grid's lines meet, row by row: (column, row) from the top left corner, counted from 0, and the place in the image.
    pub nodes: Vec<([usize; 2], PixelPoint)>,
}

/// The nine positions with four rolls each: phi 0 once, 30 and 45 degrees towards each side.
pub fn paper_tilts() -> Vec<(f64, [f64; 2])> {
    let sides = |phi: f64| [[0.0, phi], [phi, 0.0], [0.0, -phi], [-phi, 0.0]].map(|tilt| (phi, tilt));
    [(0.0, [0.0, 0.0])].into_iter().chain(sides(30.0)).chain(sides(45.0)).collect()
}

/// An image for each tilt (its phi and the tilts about u and v, degrees) and roll (degrees).
pub fn shots(setting: &Setting, field: &Testfield, tilts: &[(f64, [f64; 2])], rolls: &[f64]) -> Vec<Shot> {
    let aim = Aim::of(&setting.testfield()).expect("an aim");
    let optics = Optics { blur: setting.blur, aperture: 0.8, ..Optics::default() };
    let size = setting.camera.size;
    let renderer = Renderer::new(&optics, size.width as usize, size.height as usize).expect("optics");
    let noise = if setting.decibel.is_finite() { Noise::white_below(CONTRAST, setting.decibel, 0.0) } else { Noise::None };
    let sensor = Sensor::new(Design { noise, converter: Some(8), ..Design::default() }).expect("a sensor");
    let camera: Camera = setting.camera.into();
    let mut shots = Vec::new();
    for &(phi, tilt) in tilts {
        let views = BoardViews {
            tilts: vec![tilt.map(f64::to_radians)],
            distances: vec![setting.distance],
            rolls: rolls.iter().map(|roll| (roll + setting.roll).to_radians()).collect(),
        };
        for station in views.generate(&aim).expect("stations") {
            let view = View { field, camera: &camera, pose: &station.pose, local: None };
            let seen = view.seen(optics.reach()).expect("a view");
            let name = format!("{phi}-{tilt:?}-{}", station.name);
            let picture = seen.picture().expect("a picture");
            let key = Key { view: &name, ..setting.key() };
            let image = sensor.expose(renderer.render(&picture, &[]), key).expect("an exposure").image;
            let (whole, nodes) = (whole(setting, field, &view), nodes(setting, field, &view));
            shots.push(Shot { phi, name: name.clone(), image, truth: seen.truth(), whole, nodes });
        }
    }
    shots
}

/// A square is whole if what is inside its lines by a hundredth of its side is in the image.
fn whole(setting: &Setting, field: &Testfield, view: &View<'_>) -> Vec<bool> {
    let size = setting.camera.size;
    let inside = |p: PixelPoint| {
        let within = |x: f64, side: u32| x >= 0.0 && x <= f64::from(side) - 1.0;
        within(p.x, size.width) && within(p.y, size.height)
    };
    let (spacing, half) = (setting.field.spacing, 0.5 * setting.field.squares as f64);
    let inset = 0.5 * setting.field.line + 0.011 * spacing;
    let of = |target: &calibench_model::ObjectTarget| {
        let low = target.at.map(|v| ((v / spacing + half).floor() - half) * spacing);
        let corners = [[inset, inset], [spacing - inset, inset], [spacing - inset, spacing - inset], [inset, spacing - inset]];
        corners.iter().all(|d| {
            let at = field.plates[0].point([low[0] + d[0], low[1] + d[1]]);
            view.camera.project(view.pose.ray(&at)).is_ok_and(inside)
        })
    };
    field.targets.iter().map(of).collect()
}

/// The grid's nodes that the image shows.
fn nodes(setting: &Setting, field: &Testfield, view: &View<'_>) -> Vec<([usize; 2], PixelPoint)> {
    let (n, size) = (setting.field.squares, setting.camera.size);
    let all = (0..=n).flat_map(|row| (0..=n).map(move |column| [column, row]));
    let of = |[column, row]: [usize; 2]| {
        let (x, y) = (column as f64 - 0.5 * n as f64, 0.5 * n as f64 - row as f64);
        let object = field.plates[0].point([x * setting.field.spacing, y * setting.field.spacing]);
        let at = view.camera.project(view.pose.ray(&object)).ok()?;
        let within = |v: f64, side: u32| v >= 0.0 && v <= f64::from(side) - 1.0;
        (within(at.x, size.width) && within(at.y, size.height)).then_some(([column, row], at))
    };
    all.filter_map(of).collect()
}

/// What is counted over images.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Targets of whole squares.
    pub targets: usize,
    pub right: usize,
    /// Labelled with the name of a target that is more than 2 px away.
    pub wrong: usize,
    /// Labelled though it is not of a whole square.
    pub beyond: usize,
    pub not_recognised: Vec<String>,
    /// Sum of squared distances of right ones from the truth, px^2, and the largest, px.
    pub squares: f64,
    pub farthest: f64,
    /// The largest error of an element of an affine map, as a share of the map's size.
    pub affine: f64,
    /// By phi (0, 30, 45), group of the truth: areas, wrong single, wrong joint decisions.
    pub decisions: [[[usize; 3]; 4]; 3],
    /// Areas that belong to no target, or whose size group is wrong.
    pub stray: usize,
    pub other_group: usize,
    /// Why targets and squares were rejected.
    pub rejected: BTreeMap<&'static str, usize>,
}

fn group(field: &Testfield, target: usize) -> SizeGroup {
    let target = &field.targets[target];
    let large = target.id.contains("-large-");
    match (target.kind, large) {
        (TargetKind::Square | TargetKind::Triangle, false) => SizeGroup::SmallAngular,
        (TargetKind::Square | TargetKind::Triangle, true) => SizeGroup::LargeAngular,
        (_, false) => SizeGroup::SmallRound,
        (_, true) => SizeGroup::LargeRound,
    }
}

/// The target whose true place is nearest, within 2 px.
pub fn nearest(shot: &Shot, at: PixelPoint) -> Option<usize> {
    let off = |index: usize| shot.truth[index].at.map_or(f64::MAX, |p| p.distance(at));
    (0..shot.truth.len()).min_by(|&a, &b| off(a).total_cmp(&off(b))).filter(|&index| off(index) < 2.0)
}

impl Counts {
    pub fn add(&mut self, field: &Testfield, shot: &Shot, found: &Result<Recognition, NotRecognised>) {
        self.targets += shot.whole.iter().filter(|whole| **whole).count();
        let found = match found {
            Ok(found) => found,
            Err(error) => return self.not_recognised.push(format!("{}: {error}", shot.name)),
        };
        for rejected in &found.rejected {
            *self.rejected.entry(rejected.reason.name()).or_default() += 1;
        }
        for recognised in &found.targets {
            let truth = &shot.truth[recognised.target];
            let off = truth.at.map_or(f64::MAX, |at| at.distance(recognised.position));
            if off > 2.0 {
                self.wrong += 1;
                continue;
            }
            if !shot.whole[recognised.target] {
                self.beyond += 1;
                continue;
            }
            self.right += 1;
            self.squares += off * off;
            self.farthest = self.farthest.max(off);
            let (a, b) = (truth.affine.expect("an affine map"), recognised.affine);
            let size = a.axx.hypot(a.axy).max(a.ayx.hypot(a.ayy));
            let worst = [a.axx - b.axx, a.axy - b.axy, a.ayx - b.ayx, a.ayy - b.ayy].into_iter().fold(0.0, |w: f64, d| w.max(d.abs()));
            self.affine = self.affine.max(worst / size);
        }
        let phi = [0.0, 30.0, 45.0].iter().position(|phi| *phi == shot.phi).unwrap_or(0);
        for blob in found.squares.iter().flat_map(|square| &square.blobs) {
            let Some(target) = nearest(shot, blob.position) else {
                self.stray += 1;
                continue;
            };
            let (Some(taken), Some(single), Some(joint)) = (blob.group, blob.single, blob.joint) else { continue };
            let (kind, group) = (field.targets[target].kind, group(field, target));
            self.other_group += usize::from(taken != group);
            let counts = &mut self.decisions[phi][group as usize];
            counts[0] += 1;
            counts[1] += usize::from(single != kind);
            counts[2] += usize::from(joint != kind);
        }
    }

    pub fn rms(&self) -> f64 {
        (self.squares / self.right.max(1) as f64).sqrt()
    }

    pub fn print(&self, title: &str) {
        let [low, high] = interval(self.right, self.targets).map(|share| 100.0 * share);
        println!(
            "{title}: {} of {} right ({low:.2} to {high:.2} %), {} wrong, {} beyond; rms {:.3} px, farthest {:.3} px, affine {:.4}; stray {}, other group {}; not recognised {}",
            self.right,
            self.targets,
            self.wrong,
            self.beyond,
            self.rms(),
            self.farthest,
            self.affine,
            self.stray,
            self.other_group,
            self.not_recognised.len()
        );
        println!("    rejected: {:?}", self.rejected);
        self.not_recognised.iter().take(2).for_each(|error| println!("    {error}"));
        for (phi, groups) in [0, 30, 45].iter().zip(&self.decisions) {
            let of = |[all, single, joint]: &[usize; 3]| {
                let share = |n: usize| 100.0 * n as f64 / (*all).max(1) as f64;
                format!("{all:5} {:5.2} {:5.2}", share(*single), share(*joint))
            };
            println!("    phi {phi:2}: {}", groups.iter().map(of).collect::<Vec<_>>().join("  | "));
        }
    }
}

/// The 95 % interval of a share, of independent ones.
///
/// Source: Wilson 1927.
fn interval(count: usize, of: usize) -> [f64; 2] {
    let (n, z) = (of.max(1) as f64, 1.96_f64);
    let share = count as f64 / n;
    let (middle, half) = (share + z * z / (2.0 * n), z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt());
    [-half, half].map(|half| (middle + half) / (1.0 + z * z / n))
}

/// The seeds that the table of contours is learned on; no test uses them.
pub const LEARNED: [u64; 2] = [501, 502];
/// Blurs, px, and contrasts over noise, dB.
pub const SETTINGS: [(f64, f64); 5] = [(0.6, 46.0), (0.6, 26.0), (0.8, 30.0), (0.8, 26.0), (1.0, 26.0)];

/// Images that a table of contours is learned on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lesson {
    /// All positions of the paper at every setting.
    All,
    /// The frontal position alone, at every setting.
    Frontal,
    /// Three sharp frontal images, as one "examining a few test images" might take.
    Few,
}

impl Lesson {
    fn settings(self) -> &'static [(f64, f64)] {
        if self == Self::Few { &SETTINGS[..1] } else { &SETTINGS }
    }

    fn positions(self) -> (Vec<(f64, [f64; 2])>, Vec<f64>) {
        match self {
            Self::All => (paper_tilts(), vec![0.0, 90.0, 180.0, 270.0]),
            Self::Frontal => (paper_tilts()[..1].to_vec(), vec![0.0, 31.0, 62.0, 90.0]),
            Self::Few => (paper_tilts()[..1].to_vec(), vec![0.0, 31.0, 62.0]),
        }
    }
}

/// The table of contours of these seeds.
pub fn learn(seeds: &[u64], lesson: Lesson) -> ContourTable {
    let mut table = ContourTable::default();
    for (&seed, &(blur, decibel)) in seeds.iter().flat_map(|seed| lesson.settings().iter().map(move |setting| (seed, setting))) {
        let setting = Setting::paper(seed, blur, decibel);
        let field = setting.testfield();
        let recogniser = Recogniser::new(&field, Classifier::Modern).expect("a coded field");
        let (tilts, rolls) = lesson.positions();
        for shot in shots(&setting, &field, &tilts, &rolls) {
            let Ok(found) = recogniser.recognise(&shot.image) else { continue };
            for blob in found.squares.iter().flat_map(|square| &square.blobs) {
                if let (Some(target), Some(features)) = (nearest(&shot, blob.position), blob.features) {
                    table.count(group(&field, target), field.targets[target].kind, features);
                }
            }
        }
    }
    table
}
