//! A network in space: stations, points, their error ellipsoids, rays. Seen from above and from the side as it stands, turned by the script.

use serde_json::{Value, json};

use crate::markup::{escaped, json as in_script};
use crate::plot::{Axis, Plot, Said, Shape};

/// Where an image was taken.
pub(crate) struct Station {
    pub(crate) name: String,
    pub(crate) group: usize,
    pub(crate) centre: [f64; 3],
    /// From the axes of the object to those of the camera, row by row: x right, y up, z backwards.
    pub(crate) rotation: [f64; 9],
    /// Tangents of half the angle of view across and up.
    pub(crate) half: [f64; 2],
}

/// A point of the object.
pub(crate) struct ScenePoint {
    pub(crate) name: String,
    pub(crate) place: [f64; 3],
    /// Covariance XX, XY, XZ, YY, YZ, ZZ; `None` for one that is fixed.
    pub(crate) covariance: Option<[f64; 6]>,
    pub(crate) is_control: bool,
}

/// What is shown.
pub(crate) struct Scene {
    pub(crate) stations: Vec<Station>,
    pub(crate) points: Vec<ScenePoint>,
    /// Index of a station and of a point.
    pub(crate) rays: Vec<[usize; 2]>,
    /// How many times enlarged ellipsoids are.
    pub(crate) factor: f64,
}

impl Scene {
    /// The figure, with a caption.
    pub(crate) fn figure(&self, caption: &str) -> String {
        let still = [(0, 1, ["X", "Y"]), (0, 2, ["X", "Z"])].map(|(a, b, names)| self.view(a, b, names));
        format!(
            "<figure class=\"scene\" id=\"scene\">{}<script type=\"application/json\">{}</script><figcaption>{}</figcaption></figure>\n",
            still.concat(),
            in_script(&self.data()),
            escaped(caption)
        )
    }

    /// The script's data, in columns.
    fn data(&self) -> Value {
        let short = |value: f64| value as f32;
        let column = |of: &dyn Fn(usize) -> Value, count: usize| Value::from((0..count).map(of).collect::<Vec<_>>());
        let (stations, points) = (&self.stations, &self.points);
        let of_stations = |of: &dyn Fn(&Station) -> Value| column(&|i| of(&stations[i]), stations.len());
        let of_points = |of: &dyn Fn(&ScenePoint) -> Value| column(&|i| of(&points[i]), points.len());
        json!({
            "unit": "object units",
            "factor": self.factor,
            "stations": {
                "name": of_stations(&|s| json!(s.name)),
                "g": of_stations(&|s| json!(s.group)),
                "X": of_stations(&|s| json!(s.centre[0])),
                "Y": of_stations(&|s| json!(s.centre[1])),
                "Z": of_stations(&|s| json!(s.centre[2])),
                "R": of_stations(&|s| json!(s.rotation.map(short))),
                "half": of_stations(&|s| json!(s.half.map(short))),
            },
            "points": {
                "name": of_points(&|p| json!(p.name)),
                "X": of_points(&|p| json!(p.place[0])),
                "Y": of_points(&|p| json!(p.place[1])),
                "Z": of_points(&|p| json!(p.place[2])),
                "C": of_points(&|p| json!(p.covariance.map(|c| c.map(short)))),
                "control": of_points(&|p| json!(u8::from(p.is_control))),
            },
            "rays": {
                "station": self.rays.iter().map(|ray| ray[0]).collect::<Vec<_>>(),
                "point": self.rays.iter().map(|ray| ray[1]).collect::<Vec<_>>(),
            },
        })
    }

    /// A still view along an axis of the object, for those without the script.
    fn view(&self, a: usize, b: usize, names: [&str; 2]) -> String {
        let all = || self.stations.iter().map(|s| s.centre).chain(self.points.iter().map(|p| p.place));
        let ends = |axis: usize| {
            let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
            if low < high { (low, high) } else { (low - 1.0, high + 1.0) }
        };
        let ((left, right), (low, high)) = (ends(a), ends(b));
        // One scale for both, with some room around.
        let unit = ((right - left) / 680.0).max((high - low) / 380.0);
        let [mx, my] = [(left + right) / 2.0, (low + high) / 2.0];
        let x = Axis::linear(&format!("{}, object units", names[0]), [mx - 380.0 * unit, mx + 380.0 * unit]);
        let y = Axis::linear(&format!("{}, object units", names[1]), [my - 210.0 * unit, my + 210.0 * unit]);
        let mut plot = Plot::new(&format!("scene-{}{}", names[0], names[1]), "The network from one side", x, y, 420.0);
        plot.series(1, None, &["point"]);
        for point in &self.points {
            plot.symbol(Shape::Circle, (point.place[a], point.place[b]), &Said::of([point.name.clone()]));
        }
        plot.series(0, None, &["image"]);
        for station in &self.stations {
            let said = Said { group: Some(station.group), ..Said::of([station.name.clone()]) };
            plot.symbol(Shape::Triangle, (station.centre[a], station.centre[b]), &said);
        }
        plot.drawing()
    }
}
