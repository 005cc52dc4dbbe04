//! Files of tasks.

use std::ops::Range;

use calibench_diagnostics::{Problem, Problems};
use calibench_model::Pose;
use nalgebra::{Point3, Vector3};
use serde::Deserialize;
use toml::Spanned;

use crate::{ControlErrors, KnownPlane, Quantity, Station, Task, Temperature};

type Triple = Spanned<[f64; 3]>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    unit: Option<String>,
    sigma: Spanned<f64>,
    scale_sigma: Option<Spanned<f64>>,
    measure: Spanned<Measure>,
    known_plane: Option<Spanned<PlaneTable>>,
    #[serde(default)]
    control: ControlTable,
    temperature: Option<TemperatureTable>,
    #[serde(default)]
    image: Vec<Image>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Measure {
    length: Option<Spanned<Vec<Triple>>>,
    point: Option<Triple>,
    angle: Option<Spanned<Vec<Triple>>>,
    plane: Option<Spanned<Vec<Triple>>>,
    rotation: Option<Spanned<Vec<Triple>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlaneTable {
    point: Triple,
    normal: Triple,
    sigma: Option<Spanned<f64>>,
    sigma_tilt: Option<Spanned<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ControlTable {
    sigma: Option<Spanned<f64>>,
    print_sigma: Option<Spanned<f64>>,
    flatness_sigma: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TemperatureTable {
    difference: Spanned<f64>,
    sigma: Spanned<f64>,
    expansion: Spanned<f64>,
    expansion_sigma: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Image {
    centre: Triple,
    angles: Option<Triple>,
    target: Option<Triple>,
    up: Option<Triple>,
    roll: Option<Spanned<f64>>,
    sigma_centre: Option<Spanned<f64>>,
    sigma_angles: Option<Spanned<f64>>,
}

/// The task in `text`, which is that of `file`: lengths in object units, angles in degrees, image coordinates in px.
///
/// # Errors
/// Every mistake with line and column.
pub fn parse(file: &str, text: &str) -> Result<Task, Problems> {
    let all = |problems| Problems { file: file.to_owned(), text: text.to_owned(), problems };
    let wire: File =
        toml::from_str(text).map_err(|error| all(vec![Problem::new(error.span().unwrap_or(0..0), error.message().to_owned())]))?;
    let mut check = Check { problems: Vec::new() };
    let quantity = check.quantity(&wire.measure);
    let plane = wire.known_plane.as_ref().map(|plane| check.plane(plane.get_ref()));
    let images: Vec<Station> = wire.image.iter().map(|image| check.station(image)).collect();
    match (images.len(), &wire.known_plane) {
        (0, _) => check.wrong(0..0, "has no [[image]]; expected two or more, or one with [known_plane]"),
        (1, None) => {
            check.wrong(0..0, "has one [[image]] and no [known_plane]; expected a second image, or the plane that all of it lies in");
        }
        (2.., Some(plane)) => check.wrong(plane.span(), "several images need no [known_plane]; leave it out, or the other images"),
        _ => {}
    }
    let sigma_px = check.above_0(&wire.sigma);
    let control = ControlErrors {
        sigma_px: wire.control.sigma.as_ref().map_or(sigma_px, |sigma| check.above_0(sigma)),
        print_sigma: check.deviation(wire.control.print_sigma.as_ref()),
        flatness_sigma: check.deviation(wire.control.flatness_sigma.as_ref()),
    };
    let scale_sigma = check.deviation(wire.scale_sigma.as_ref());
    let temperature = wire.temperature.as_ref().map(|table| Temperature {
        difference: check.number(&table.difference),
        sigma: check.deviation(Some(&table.sigma)),
        expansion: check.number(&table.expansion),
        expansion_sigma: check.deviation(table.expansion_sigma.as_ref()),
    });
    match quantity {
        Some(quantity) if check.problems.is_empty() => {
            Ok(Task { unit: wire.unit, quantity, images, plane, sigma_px, control, scale_sigma, temperature })
        }
        _ => Err(all(check.problems)),
    }
}

/// Collects what is wrong.
struct Check {
    problems: Vec<Problem>,
}

impl Check {
    fn wrong(&mut self, span: Range<usize>, message: &str) {
        self.problems.push(Problem::new(span, message));
    }

    fn number(&mut self, number: &Spanned<f64>) -> f64 {
        if !number.get_ref().is_finite() {
            self.wrong(number.span(), "expected a finite number");
        }
        *number.get_ref()
    }

    fn finite(&mut self, numbers: &Triple) -> [f64; 3] {
        if !numbers.get_ref().iter().all(|number| number.is_finite()) {
            self.wrong(numbers.span(), "expected three finite numbers");
        }
        *numbers.get_ref()
    }

    fn point(&mut self, numbers: &Triple) -> Point3<f64> {
        Point3::from(self.finite(numbers))
    }

    /// A standard deviation; 0 where none is stated.
    fn deviation(&mut self, number: Option<&Spanned<f64>>) -> f64 {
        let Some(number) = number else { return 0.0 };
        let value = *number.get_ref();
        if !(value >= 0.0 && value.is_finite()) {
            self.wrong(number.span(), "expected a standard deviation of at least 0");
        }
        value
    }

    fn above_0(&mut self, number: &Spanned<f64>) -> f64 {
        let value = *number.get_ref();
        if !(value > 0.0 && value.is_finite()) {
            self.wrong(number.span(), "expected a standard deviation above 0, px");
        }
        value
    }

    fn points(&mut self, points: &Spanned<Vec<Triple>>) -> Vec<Point3<f64>> {
        points.get_ref().iter().map(|point| self.point(point)).collect()
    }

    /// Exactly `N` points, no two of them one.
    fn exactly<const N: usize>(&mut self, points: &Spanned<Vec<Triple>>, expected: &str) -> Option<[Point3<f64>; N]> {
        let found: Option<[Point3<f64>; N]> = self.points(points).try_into().ok();
        let found = found.filter(|found| (1..N).all(|place| found[place] != found[place - 1]));
        if found.is_none() {
            self.wrong(points.span(), expected);
        }
        found
    }

    fn three_or_more(&mut self, points: &Spanned<Vec<Triple>>) -> Vec<Point3<f64>> {
        if points.get_ref().len() < 3 {
            self.wrong(points.span(), "expected three points at least");
        }
        self.points(points)
    }

    fn quantity(&mut self, measure: &Spanned<Measure>) -> Option<Quantity> {
        match measure.get_ref() {
            Measure { length: Some(ends), point: None, angle: None, plane: None, rotation: None } => {
                self.exactly(ends, "expected two points that are not one").map(Quantity::Length)
            }
            Measure { length: None, point: Some(point), angle: None, plane: None, rotation: None } => {
                Some(Quantity::Point(self.point(point)))
            }
            Measure { length: None, point: None, angle: Some(points), plane: None, rotation: None } => {
                self.exactly(points, "expected three points, the second at the apex, none of which is its neighbour").map(Quantity::Angle)
            }
            Measure { length: None, point: None, angle: None, plane: Some(points), rotation: None } => {
                Some(Quantity::Plane(self.three_or_more(points)))
            }
            Measure { length: None, point: None, angle: None, plane: None, rotation: Some(points) } => {
                Some(Quantity::Rotation(self.three_or_more(points)))
            }
            _ => {
                self.wrong(measure.span(), "expected one of length, point, angle, plane and rotation");
                None
            }
        }
    }

    /// A direction, of length one.
    fn direction(&mut self, numbers: &Triple, what: &str) -> Vector3<f64> {
        let unit = Vector3::from(self.finite(numbers)).try_normalize(0.0);
        if unit.is_none() {
            self.wrong(numbers.span(), what);
        }
        unit.unwrap_or_else(Vector3::z)
    }

    fn plane(&mut self, plane: &PlaneTable) -> KnownPlane {
        KnownPlane {
            point: self.point(&plane.point),
            normal: self.direction(&plane.normal, "expected a normal with a length"),
            sigma: self.deviation(plane.sigma.as_ref()),
            sigma_tilt: self.deviation(plane.sigma_tilt.as_ref()).to_radians(),
        }
    }

    fn station(&mut self, image: &Image) -> Station {
        Station {
            pose: self.pose(image),
            sigma_centre: self.deviation(image.sigma_centre.as_ref()),
            sigma_angles: self.deviation(image.sigma_angles.as_ref()).to_radians(),
        }
    }

    fn pose(&mut self, image: &Image) -> Pose {
        let centre = self.point(&image.centre);
        let fallen = Pose::from_angles(centre, [0.0; 3]);
        match (&image.angles, &image.target) {
            (Some(angles), None) => {
                let unused = image.up.as_ref().map(Spanned::span).or(image.roll.as_ref().map(Spanned::span));
                if let Some(span) = unused {
                    self.wrong(span, "goes with `target`; with `angles` leave it out");
                }
                Pose::from_angles(centre, self.finite(angles).map(f64::to_radians))
            }
            (None, Some(target)) => {
                let up = image.up.as_ref().map_or_else(Vector3::y, |up| self.direction(up, "expected a direction with a length"));
                let roll = image.roll.as_ref().map_or(0.0, |roll| self.number(roll).to_radians());
                let at = self.point(target);
                Pose::looking_at(centre, at, up, roll).unwrap_or_else(|| {
                    self.wrong(
                        target.span(),
                        "is not to be looked at: it is the centre, or lies along `up` from it [default of up: 0, 1, 0]",
                    );
                    fallen
                })
            }
            _ => {
                self.wrong(
                    image.centre.span(),
                    "expected `angles` (omega, phi, kappa, degrees) or `target` (what the camera looks at) beside it",
                );
                fallen
            }
        }
    }
}
