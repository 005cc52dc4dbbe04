//! The page of a calibration beside its tables: what is drawn is where the tables say.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use calibench_calibrate::Calibration;
use calibench_images::Reading;
use serde_json::Value;

use super::tests::{Row, number, rotation, rows, written};
use super::{Pictured, figures, html, uncertainty};

/// The page with some figures.
fn page(calibration: &Calibration<'_>, photos: &[Pictured<'_>]) -> String {
    let text = ["residuals", "distribution", "correlations", "uncertainty-far"].map(|name| format!("![{name}]({name}.png)\n\n")).concat();
    let corners = figures::corners(calibration);
    let drawn = figures::figures(calibration, &[uncertainty::maps(calibration, 0)], &corners);
    let in_place = drawn.all().map(|figure| (figure.file(), figure.html())).collect();
    html::page(calibration, (&text, in_place), &corners, (photos, &[]))
}

/// What stands between two texts.
fn between<'t>(text: &'t str, from: &str, to: &str) -> &'t str {
    text.split_once(from).unwrap().1.split_once(to).unwrap().0
}

fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || "-.e".contains(c))).filter_map(|word| word.parse().ok()).collect()
}

fn by_name(folder: &Path) -> HashMap<String, Row> {
    rows(&folder.join("residuals.csv")).into_iter().map(|row| (format!("{}|{}", row["image"], row["target"]), row)).collect()
}

/// The frame of 1000 x 800 px is 760 px of the drawing wide, and begins at (76, 30).
#[test]
fn arrows_begin_at_their_points_and_go_along_their_residuals() {
    written(|calibration, folder| {
        let (html, residuals) = (page(calibration, &[]), by_name(folder));
        let arrows = html.split("<path class=\"arrow\" d=\"M").skip(1).map(|rest| rest.split("/>").next().unwrap());
        let arrows: Vec<&str> = arrows.filter(|arrow| arrow.contains("data-k")).collect();
        assert_eq!(arrows.len(), 150, "all of them are among the 200 longest");
        let times = numbers(between(&html, "Arrows ", " times"))[0];
        let (mut keys, mut last) = (Vec::new(), f64::INFINITY);
        for arrow in arrows {
            let said: Vec<&str> = between(arrow, "data-t=\"", "\"").split('|').collect();
            let row = &residuals[&format!("{}|{}", said[0], said[1])];
            let at = numbers(arrow.split(['M', '"']).next().unwrap());
            let [x, y, vx, vy] = ["x", "y", "vx", "vy"].map(|column| number(row, column));
            let expected = [76.0 + 0.76 * (x + 0.5), 30.0 + 0.76 * (y + 0.5), 0.76 * times * vx, 0.76 * times * vy];
            let found = [at[0], at[1], at[2] - at[0], at[3] - at[1]];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 0.011, "{arrow}: {found:?} is not {expected}");
            }
            assert_eq!(said[2..5], [vx.hypot(vy), vx, vy].map(crate::plain), "{row:?}");
            let w = number(row, "w_x").abs().max(number(row, "w_y").abs());
            assert_eq!((said[5], between(arrow, "data-g=\"", "\"")), (crate::plain(w).as_str(), &row["image"][1..]));
            let length = vx.hypot(vy);
            assert!(length <= last, "the longest first");
            last = length;
            keys.push(between(arrow, "data-k=\"", "\"").parse::<usize>().unwrap());
        }
        assert_eq!(keys, (0..150).collect::<Vec<_>>());
    });
}

#[test]
fn the_network_stands_where_its_tables_say() {
    written(|calibration, folder| {
        let html = page(calibration, &[]);
        let scene: Value = serde_json::from_str(between(&html, "<script type=\"application/json\">", "</script>")).unwrap();
        let (stations, points) = (rows(&folder.join("stations.csv")), rows(&folder.join("points.csv")));
        for (place, row) in stations.iter().enumerate() {
            let of = |column: &str| &scene["stations"][column][place];
            assert_eq!((of("name"), of("g").as_u64()), (&Value::from(row["image"].as_str()), Some(place as u64)));
            for (key, column) in [("X", "X0"), ("Y", "Y0"), ("Z", "Z0")] {
                assert_eq!(of(key).as_f64(), Some(number(row, column)));
            }
            let m = rotation(["omega_deg", "phi_deg", "kappa_deg"].map(|column| number(row, column)));
            for (found, expected) in of("R").as_array().unwrap().iter().zip(m.concat()) {
                assert!((found.as_f64().unwrap() - expected).abs() < 1e-6, "row by row: {} {expected}", of("R"));
            }
            // 1000 x 800 px of 5 um before a lens of 8 mm, hardly distorted; from the first pixel's middle to the last's.
            for (found, side) in of("half").as_array().unwrap().iter().zip([999.0, 799.0]) {
                assert!((found.as_f64().unwrap() / (side * 0.005 / 16.0) - 1.0).abs() < 0.03, "{}", of("half"));
            }
        }
        for (place, row) in points.iter().enumerate() {
            let of = |column: &str| &scene["points"][column][place];
            assert_eq!((of("name"), of("X").as_f64()), (&Value::from(row["target"].as_str()), Some(number(row, "X"))));
            let variances = ["sX", "sY", "sZ"].map(|column| number(row, column).powi(2));
            for (found, expected) in [0, 3, 5].iter().map(|i| of("C")[*i].as_f64().unwrap()).zip(variances) {
                assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
            }
            assert_eq!(of("control").as_u64(), Some(1));
        }
        let mut rays: Vec<String> = by_name(folder).into_keys().collect();
        let name = |kind: &str, index: &Value| scene[kind]["name"][index.as_u64().unwrap() as usize].as_str().unwrap().to_owned();
        let [of, to] = ["station", "point"].map(|column| scene["rays"][column].as_array().unwrap());
        let mut found: Vec<String> = of.iter().zip(to).map(|(s, p)| format!("{}|{}", name("stations", s), name("points", p))).collect();
        rays.sort();
        found.sort();
        assert_eq!(found, rays);
    });
}

/// Photographs that are black but for the pixel at each point.
#[test]
fn what_is_enlarged_is_what_was_measured() {
    written(|calibration, folder| {
        let residuals = by_name(folder);
        let paths: HashMap<String, PathBuf> = (0..6).map(|i| (format!("i{i}"), folder.join(format!("{i}.png")))).collect();
        for (name, path) in &paths {
            let mut photo = image::GrayImage::new(1000, 800);
            for row in residuals.values().filter(|row| row["image"] == *name) {
                photo.put_pixel(number(row, "x").round() as u32, number(row, "y").round() as u32, image::Luma([200]));
            }
            photo.save(path).unwrap();
        }
        let photos: Vec<Pictured<'_>> = paths.iter().map(|(name, path)| (name.as_str(), path.as_path(), Reading::default())).collect();
        let html = page(calibration, &photos);
        let patches: Vec<&str> = html.split("<figure class=\"patch\" data-k=\"").skip(1).collect();
        assert_eq!(patches.len(), 150);
        for (key, patch) in patches.iter().enumerate() {
            assert!(patch.starts_with(&format!("{key}\"")), "in the order of their keys");
            let png = STANDARD.decode(between(patch, "base64,", "\"")).unwrap();
            let shown = image::load_from_memory(&png).unwrap().into_luma8();
            assert_eq!((shown.dimensions(), shown.get_pixel(15, 15).0, shown.get_pixel(0, 0).0), ((31, 31), [255], [0]), "{key}");
            let caption = between(patch, "<figcaption>", ", ").replace(": ", "|");
            let row = &residuals[&caption];
            let [x, y, vx, vy] = ["x", "y", "vx", "vy"].map(|column| number(row, column));
            let places: Vec<Vec<f64>> =
                patch.split("translate(").skip(1).take(2).map(|rest| numbers(rest.split(')').next().unwrap())).collect();
            // The adjusted point below, the measured one above: the middle of the pixel in the middle is at (15.5, 15.5).
            let measured = [15.5 + x - x.round(), 15.5 + y - y.round()];
            for i in 0..2 {
                assert!(
                    (places[1][i] - measured[i]).abs() < 1e-3 && (places[0][i] - measured[i] - [vx, vy][i]).abs() < 2e-3,
                    "{row:?} {places:?}"
                );
            }
        }
    });
}

/// Left, top, width and height of each cell of a figure, and what it says.
fn cells<'t>(html: &'t str, id: &str) -> Vec<([f64; 4], Vec<&'t str>)> {
    let figure = between(html, &format!("<figure class=\"plot\" id=\"{id}\">"), "</figure>");
    let cell = |rest: &'t str| {
        let of = |name: &str| between(rest, &format!("{name}=\""), "\"").parse::<f64>().unwrap();
        ([of(" x"), of(" y"), of("width"), of("height")], between(rest, "data-t=\"", "\"").split('|').collect())
    };
    figure.split("<rect class=\"cell").skip(1).map(cell).collect()
}

/// Whether a place of the frame of 1000 x 800 px is in a cell.
fn is_in([left, top, width, height]: [f64; 4], x: f64, y: f64) -> bool {
    let (x, y) = (76.0 + 0.76 * (x + 0.5), 30.0 + 0.76 * (y + 0.5));
    (left - 0.01..left + width).contains(&x) && (top - 0.01..top + height).contains(&y)
}

#[test]
fn maps_say_what_their_tables_say_where_it_is() {
    written(|calibration, folder| {
        let html = page(calibration, &[]);
        let far: Vec<Row> = rows(&folder.join("uncertainty.csv")).into_iter().filter(|row| row["distance"] == "far").collect();
        let shown = cells(&html, "uncertainty-far");
        assert_eq!(shown.len(), far.len());
        for (row, (place, said)) in far.iter().zip(&shown) {
            let [x, y, sigma] = ["x", "y", "sigma"].map(|column| number(row, column));
            assert!(is_in(*place, x, y), "{row:?} {place:?}");
            assert_eq!(said[..], [format!("{x:.0}"), format!("{y:.0}"), crate::plain(sigma)]);
        }
        let points = by_name(folder);
        let counts = cells(&html, "distribution");
        assert_eq!(counts.len(), 120, "12 x 10 squares");
        assert!(counts.iter().all(|([_, _, width, height], _)| (width / height - 1.0).abs() < 0.1), "{:?}", counts[0]);
        for (place, said) in &counts {
            let inside = points.values().filter(|row| is_in(*place, number(row, "x"), number(row, "y"))).count();
            assert_eq!(said[0], inside.to_string(), "{place:?}");
        }
        let rho: HashMap<String, f64> = rows(&folder.join("correlations.csv"))
            .iter()
            .map(|row| (format!("{}, {}", row["first"], row["second"]), number(row, "rho")))
            .collect();
        let matrix = cells(&html, "correlations");
        assert_eq!(matrix.len(), 25);
        for (names, expected) in &rho {
            let (_, said) = matrix.iter().find(|(_, said)| said[0] == *names).unwrap();
            assert_eq!(said[1], format!("{expected:.4}"));
        }
        assert_eq!(rho.len(), 10);
    });
}

/// Where a line of equal standard deviation ends, the table has its level: linear between its places, as lines are drawn.
#[test]
fn lines_of_equal_standard_deviation_lie_where_the_table_has_their_level() {
    written(|calibration, folder| {
        let html = page(calibration, &[]);
        let far: Vec<[f64; 3]> = rows(&folder.join("uncertainty.csv"))
            .iter()
            .filter(|row| row["distance"] == "far")
            .map(|row| ["x", "y", "sigma"].map(|column| number(row, column)))
            .collect();
        let axis = |of: usize| {
            let mut ticks: Vec<f64> = far.iter().map(|place| place[of]).collect();
            ticks.sort_by(f64::total_cmp);
            ticks.dedup();
            ticks
        };
        let (xs, ys) = (axis(0), axis(1));
        let sigma = |x: f64, y: f64| {
            let cell = |ticks: &[f64], value: f64| (ticks.partition_point(|tick| *tick <= value).max(1) - 1).min(ticks.len() - 2);
            let (column, row) = (cell(&xs, x), cell(&ys, y));
            let [u, v] = [(x - xs[column]) / (xs[column + 1] - xs[column]), (y - ys[row]) / (ys[row + 1] - ys[row])];
            let at = |column: usize, row: usize| far[row * xs.len() + column][2];
            let along = |row: usize| at(column, row) + (at(column + 1, row) - at(column, row)) * u;
            along(row) + (along(row + 1) - along(row)) * v
        };
        let figure = between(&html, "id=\"uncertainty-far\"", "</figure>");
        let levels: Vec<f64> = figure.split("class=\"note tag\"").skip(1).map(|rest| between(rest, "\">", "<").parse().unwrap()).collect();
        assert!(!levels.is_empty());
        let mut ends = 0;
        for line in figure.split("<path class=\"contour\" d=\"").skip(1) {
            let places: Vec<f64> = numbers(&line.split('"').next().unwrap().replace(['M', 'L'], " "));
            let values: Vec<f64> =
                places.chunks_exact(2).map(|at| sigma((at[0] - 76.0) / 0.76 - 0.5, (at[1] - 30.0) / 0.76 - 0.5)).collect();
            // Hundredths of a pixel of the drawing are all that is written.
            let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
            assert!(high / low < 1.002, "one line has from {low} to {high}");
            ends += values.len();
        }
        assert!(ends > 50, "{ends}");
    });
}
