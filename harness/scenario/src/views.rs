//! The tables of a scenario that pictures a testfield: `[camera]`, `[testfield]`, `[stations]`, `[[station]]`, `[optics]`, `[sensor]`, `[pointing]`.

use std::ops::Range;
use std::path::Path;

use calibench_diagnostics::Problem;
use calibench_model::Testfield;
use calibench_model::camera::{Camera, CameraModel};
use calibench_random::Key;
use calibench_synth::optics::Optics;
use calibench_synth::pointing::{Hand, MapError};

use super::camera::CameraPlan;
use super::pointing::BoardPointing;
use super::section::Section;
use super::sensor::{Surroundings, read_sensor};
use super::subject::Study;
use super::{Detector, Imaging, Pointing, ViewsSubject, camera, optics, stations, testfield};

/// Where a detector points.
const NO_HAND: Hand = Hand { sigma: 0.0, whole_pixels: true, map: MapError { turn: 0.0, stretch: 0.0 } };

/// Lens and sensor as they stand in the file, not read yet: a sensor's contrast depends on what it sees.
pub struct ImagingTables<'i> {
    optics: Option<Section<'i>>,
    sensor: Option<Section<'i>>,
}

impl<'i> ImagingTables<'i> {
    /// Takes `[optics]` and `[sensor]` out of the file.
    pub fn take(root: &mut Section<'i>, problems: &mut Vec<Problem>) -> Self {
        let optics = root.take_table("optics", "[optics]", problems);
        Self { optics, sensor: root.take_table("sensor", "[sensor]", problems) }
    }

    /// Where either stands, if one does.
    pub fn span(&self) -> Option<Range<usize>> {
        self.optics.as_ref().or(self.sensor.as_ref()).map(|section| section.span.clone())
    }

    /// Where `[sensor]` stands, if it does.
    pub fn sensor_span(&self) -> Option<Range<usize>> {
        self.sensor.as_ref().map(|section| section.span.clone())
    }

    /// Reads both.
    pub fn read(self, surroundings: &Surroundings, problems: &mut Vec<Problem>) -> Option<Imaging> {
        let optics = match self.optics {
            Some(section) => optics::read(section, problems),
            None => Some(Optics::default()),
        };
        let sensor = match self.sensor {
            Some(section) => read_sensor(section, surroundings, problems).map(Some),
            None => Some(None),
        };
        Some(Imaging { optics: optics?, sensor: sensor? })
    }
}

/// The tables of a view but for lens and sensor.
pub struct ViewTables<'i> {
    camera: Option<Section<'i>>,
    testfield: Option<Section<'i>>,
    stations: Option<Section<'i>>,
    explicit: Vec<Section<'i>>,
    pointing: Option<Section<'i>>,
}

impl<'i> ViewTables<'i> {
    /// Takes them out of the file.
    pub fn take(root: &mut Section<'i>, problems: &mut Vec<Problem>) -> Self {
        Self {
            camera: root.take_table("camera", "[camera]", problems),
            testfield: root.take_table("testfield", "[testfield]", problems),
            stations: root.take_table("stations", "[stations]", problems),
            explicit: root.take_tables("station", "[[station]]", problems).unwrap_or_default(),
            pointing: root.take_table("pointing", "[pointing]", problems),
        }
    }

    /// Where the first of them stands, if one does.
    pub fn span(&self) -> Option<Range<usize>> {
        let tables = [&self.testfield, &self.camera, &self.stations, &self.pointing];
        tables.into_iter().flatten().chain(self.explicit.first()).map(|section| section.span.clone()).next()
    }

    /// Reads all of them; `span` is where the file begins, `folder` where it is, keys those of the field and of all that is pictured.
    pub fn read(
        self,
        imaging: ImagingTables<'_>,
        span: &Range<usize>,
        folder: &Path,
        [of_field, key]: [Key<'_>; 2],
        problems: &mut Vec<Problem>,
    ) -> Option<ViewsSubject> {
        let mut missing = |name: &str, help: &str| {
            problems.push(Problem::new(span.clone(), format!("the scenario pictures a testfield and has no {name}")).help(help.to_owned()));
        };
        if self.camera.is_none() {
            missing("[camera]", "add one with `size`, `pitch` and `c`, or with `file`");
        }
        if self.testfield.is_none() {
            missing("[testfield]", "add one with a `kind`");
        }
        if self.stations.is_none() && self.explicit.is_empty() {
            missing("station", "add [stations] with a `kind`, or [[station]] tables");
        }
        if self.pointing.is_none() {
            missing("[pointing]", "measuring starts where somebody points: add `sigma` (px) and `whole_pixels`");
        }
        let camera = self.camera.and_then(|section| camera::read(section, folder, problems));
        let pointing = self.pointing.and_then(|section| Pointing::read(section, problems));
        let plan = self.testfield.and_then(|section| testfield::read(section, folder, of_field, problems));
        let (camera, pointing, plan) = (camera?, pointing?, plan?);
        let CameraPlan { camera, file: camera_file, local } = camera;
        let field = plan.generate(of_field).map_err(|error| problems.push(plan.problem(&error))).ok()?;
        let imaging = imaging.read(&surroundings(&camera, &field), problems);
        let plan_of_stations = stations::read(self.stations, self.explicit, problems)?;
        if let Some(imaging) = &imaging {
            plan_of_stations.check_imaging(imaging, problems);
        }
        let drawn = plan_of_stations.generate(&field, &camera, key);
        let stations = drawn.map_err(|error| problems.push(plan_of_stations.problem(&error))).ok()?;
        let moved = plan_of_stations.each_trial;
        let once = [
            ("the stations", plan_of_stations.is_random() && !moved),
            ("the local distortion of the camera", local.is_some_and(|local| !local.each_trial)),
        ];
        let once = once.into_iter().filter_map(|(what, is_drawn)| is_drawn.then_some(what)).chain(plan.drawn()).collect();
        let redraw = Some(plan_of_stations).filter(|_| moved);
        let (hand, clipped, detector) = match pointing {
            Pointing::Hand { hand, clipped } => (hand, clipped, None),
            Pointing::Harris(harris) => (NO_HAND, false, Some(Detector::Harris(harris))),
            Pointing::Board { span, within } => {
                let Some(board) = plan.board() else {
                    let problem = Problem::new(span, "`detector = \"board\"` finds boards, and the [testfield] is none");
                    problems.push(problem.help(format!("expected one of kind {}", testfield::BOARDS.join(", "))));
                    return None;
                };
                (NO_HAND, false, Some(Detector::Board(BoardPointing { board, within })))
            }
        };
        let (unit, survey_sigma) = (plan.unit, plan.survey_sigma());
        let imaging = imaging?;
        Some(ViewsSubject {
            field,
            sheet: plan.board(),
            survey_sigma,
            unit,
            camera,
            camera_file,
            corner_file: plan.corner_file.clone(),
            local,
            stations,
            redraw,
            drawn_once: once,
            imaging,
            hand,
            clipped,
            detector,
            recognition: None,
            study: Study::Points,
        })
    }
}

/// What a sensor's signal-to-noise ratios refer to: the lightest and the darkest level of the field, and the mean of the two.
fn surroundings(camera: &Camera, field: &Testfield) -> Surroundings {
    let levels = field.plates.iter().flat_map(|plate| plate.areas.iter().map(|area| area.level).chain([plate.level]));
    let (low, high) = levels.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), level| (low.min(level), high.max(level)));
    let axis = calibench_model::camera::Ray::from_tangent(0.0, 0.0);
    let on_axis = camera.derivatives(axis).ok();
    Surroundings {
        principal_distance: on_axis.as_ref().map(|derivatives| derivatives.by_ray[0][0].abs()),
        principal_point: on_axis.map(|derivatives| derivatives.point),
        contrast: Some(high - low).filter(|contrast| contrast.is_finite()),
        mean: Some(0.5 * (high + low)).filter(|mean| mean.is_finite()),
    }
}
