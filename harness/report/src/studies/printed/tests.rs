//! Tables and pictures of printed figures, against numbers by hand.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{ConvertError, DifferenceOptions, Region, difference};
use calibench_records::adjustments::Numbers;
use calibench_records::description::{CheckPoint, PlacedNetwork, Printed, PrintedCamera};
use calibench_records::figures::{FigureName, Group};

use super::grids::{self, Grid};
use super::maps::{conversions, distortions};
use super::pictures::{self, Drawn};
use super::tables::{again, by_figure, by_set, failures, numbers, stations};
use crate::field::Field;
use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::plain;
use crate::sides::{Sides, around};
use crate::studies::network::pictures::plan::{plan, wall_ends};

/// Cameras `a` (c 1, RMSE 2) and `b` (c 3), a network of two stations.
fn summaries() -> Summaries {
    let mut found = Summaries { methods: vec!["print".into()], trials: 1, ..Summaries::default() };
    let mut add = |set: &str, group: Group, name: &str, value: f64| {
        let first = Some(Numbers { value, sigma: None, error: None });
        let figure = FigureName::parse(group, name).unwrap();
        found.figures.insert(("print".into(), set.into(), figure), Summary { first, ..Summary::default() });
    };
    add("a", Group::Network, "c, um", 1.0);
    add("b", Group::Network, "c, um", 3.0);
    add("a", Group::Check, "RMSE X, m", 2.0);
    add("a", Group::Object, "V1/X", 7.0);
    add("net", Group::Eop, "height, m", 5.0);
    for (station, height) in [("1", 10.0), ("2", 20.0)] {
        add("net", Group::Eop, &format!("{station}/X"), height);
        add("net", Group::Eop, &format!("{station}/Y"), 0.0);
        add("net", Group::Eop, &format!("{station}/Z"), height);
        // Turned by 90 degrees about Y: the camera's z axis is X.
        for (angle, degrees) in [("omega", 0.0), ("phi", 90.0), ("kappa", 0.0)] {
            add("net", Group::Eop, &format!("{station}/{angle}"), degrees);
        }
    }
    found
}

/// Cells between bars, without blanks.
fn cells(table: &str) -> Vec<Vec<String>> {
    let rows = table.lines().filter(|line| !line.contains("--"));
    rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

#[test]
fn figures_stand_by_set_and_what_a_set_lacks_is_empty() {
    let sets = ["a".to_owned(), "b".to_owned()];
    let found = cells(&by_figure(&summaries(), &sets, &[Group::Network, Group::Check]));
    assert_eq!(found, [["figure", "a", "b"], ["c, um", "1.00", "3.00"], ["RMSE X, m, of printed errors", "2.00", ""]]);
    assert_eq!(cells(&by_set(&summaries(), &sets)), [["camera", "c, um"], ["a", "1.00"], ["b", "3.00"]]);
}

/// The network's own row has its columns' figures; a set with which it is fitted again has them by name.
#[test]
fn readings_stand_below_each_other() {
    let camera = |name: &str, tool: Option<&str>| PrintedCamera {
        name: name.into(),
        tool: tool.map(str::to_owned),
        c: 19.0,
        principal_point: [0.0; 2],
        k: [0.0; 3],
        p: [0.0; 2],
    };
    let sets = Printed {
        sensor: "sensor".into(),
        size: [4272, 2848],
        pitch_um: 5.38,
        unit: "m".into(),
        cameras: vec![camera("plain", None), camera("a", Some("opencv"))],
        grids: Vec::new(),
        points: Vec::new(),
        network: Some(PlacedNetwork { set: "net".into(), from: [1.0, 0.0, 0.0] }),
        variants: Vec::new(),
        again: vec!["turned".into()],
    };
    let mut found = summaries();
    let mut add = |set: &str, name: &str, value: f64| {
        let first = Some(Numbers { value, sigma: None, error: None });
        let figure = FigureName::parse(Group::Network, name).unwrap();
        found.figures.insert(("print".into(), set.into(), figure), Summary { first, ..Summary::default() });
    };
    for (set, name, value) in [
        ("net", "misfit of what is fitted, m", 0.004),
        ("net", "starts that end here", 7.0),
        ("net", "errors predicted nearly", 72.0),
        ("a", "misfit, m", 0.02),
        ("a", "predicted RMSE Z, m", 0.42),
        ("turned", "misfit of what is fitted, m", 0.005),
        ("turned", "a: misfit, m", 0.03),
        ("turned", "a: predicted planimetric RMSE, m", 0.25),
    ] {
        add(set, name, value);
    }
    let header = ["reading", "misfit", "starts that end here", "near", "a: misfit", "a: planimetric", "a: Z"];
    let first = ["as above", "0.00400", "7", "72", "0.0200", "", "0.420"];
    let second = ["turned", "0.00500", "", "", "0.0300", "0.250", ""];
    assert_eq!(cells(&again(&found, &sets)), [header, first, second]);
}

#[test]
fn a_network_is_its_numbers_and_its_stations() {
    assert_eq!(cells(&numbers(&summaries(), "net")), [["number", "value"], ["height, m", "5.00"]]);
    let stations = cells(&stations(&summaries(), "net"));
    assert_eq!(stations, [["station", "X", "Y", "Z"], ["1", "10.00", "0.00", "10.00"], ["2", "20.00", "0.00", "20.00"]]);
}

#[test]
fn what_has_no_predictions_is_said_with_its_reason() {
    let mut found = summaries();
    assert_eq!(failures(&found), "");
    found.failed.insert(("print".into(), "a".into(), Group::Check), (1, "rays are parallel".into()));
    assert_eq!(failures(&found), "- `a` has no predictions: rays are parallel.\n\n");
}

const K1: f64 = 4e-4;
const P: [f64; 2] = [8e-5, 5e-5];

fn camera(name: &str, tool: Option<&str>, k1: f64, p: [f64; 2]) -> PrintedCamera {
    PrintedCamera { name: name.into(), tool: tool.map(str::to_owned), c: 20.0, principal_point: [0.0; 2], k: [k1, 0.0, 0.0], p }
}

/// Frames of 24 x 16 mm, 4801 x 3201 px of 5 um: the middle is a pixel. Columns without distortion, of two tools and of none.
fn printed() -> Printed {
    Printed {
        sensor: "sensor".into(),
        size: [4801, 3201],
        pitch_um: 5.0,
        unit: "m".into(),
        cameras: vec![
            camera("none", None, 0.0, [0.0; 2]),
            camera("one", Some("photoscan"), -K1, P),
            camera("two", Some("opencv"), -0.5 * K1, P),
            camera("other", None, -K1, [0.0; 2]),
        ],
        grids: vec![camera("pincushion", None, K1, [0.0; 2]), camera("barrel", None, -K1, [0.0; 2]), camera("tangential", None, 0.0, P)],
        points: [[100.0, 2000.0, 3.0], [102.0, 2010.0, 5.0]].map(|at| CheckPoint { name: "V".into(), at }).into(),
        network: Some(PlacedNetwork { set: "net".into(), from: [1.0, 0.0, 0.0] }),
        variants: Vec::new(),
        again: Vec::new(),
    }
}

/// Places of a grid at which it stands without distortion, by columns and rows of 400 px from the middle, and where the camera has them; from the middle.
fn seen(grid: &Grid, column: f64, row: f64) -> [f64; 2] {
    let wanted = PixelPoint::new(2400.0 + 400.0 * column, 1600.0 + 400.0 * row);
    let (_, seen) = grid.lines.iter().flatten().find(|(ideal, _)| ideal.distance(wanted) < 1e-6).unwrap();
    [seen.x - 2400.0, seen.y - 1600.0]
}

#[test]
fn a_pincushion_pulls_corners_outwards_and_a_barrel_pushes_them_inwards() {
    let [pincushion, barrel, _] = &Grid::all(&printed())[..] else { panic!("three grids") };
    let corner = 400.0 * 6_f64.hypot(4.0);
    for (grid, sign) in [(pincushion, 1.0), (barrel, -1.0)] {
        for (column, row) in [(6.0, 4.0), (-6.0, 4.0), (-6.0, -4.0), (6.0, -4.0)] {
            let [x, y] = seen(grid, column, row);
            assert!(sign * (x.hypot(y) - corner) > 100.0, "{} at ({column}, {row}): {x}, {y}", grid.name);
            // By hand: ideal = measured (1 - k1 r^2), in mm of 200 px.
            let measured = x.hypot(y) / 200.0;
            assert!((measured * (1.0 - sign * K1 * measured * measured) - corner / 200.0).abs() < 1e-9, "{}", grid.name);
        }
        // Middles of sides move less than corners: lines bend.
        assert!((seen(grid, 6.0, 0.0)[0].abs() - 2400.0).abs() < (seen(grid, 6.0, 4.0)[0].abs() - 2400.0).abs());
        assert_eq!(grid.times(), 1.0, "a displacement of 200 px is seen");
    }
}

/// Brown: a positive p1 moves both ends of the x axis to the right by 3 p1 x^2, a positive p2 both ends of the y axis upwards; all of it is too small to be seen.
#[test]
fn tangential_distortion_moves_opposite_ends_the_same_way() {
    let grid = &Grid::all(&printed())[2];
    for side in [-1.0, 1.0] {
        let (along, up) = (seen(grid, 6.0 * side, 0.0)[0] - 2400.0 * side, seen(grid, 0.0, 4.0 * side)[1] - 1600.0 * side);
        let expected = [3.0 * P[0] * 12.0 * 12.0, 3.0 * P[1] * 8.0 * 8.0].map(|mm| 200.0 * mm);
        assert!(
            (along - expected[0]).abs() < 0.02 * expected[0] && (up + expected[1]).abs() < 0.02 * expected[1],
            "{along} {up} {expected:?}"
        );
    }
    assert!(grid.times() > 1.0 && grid.times() * grid.longest() < 0.1 * 4801.0);
    assert!(grids::picture(&[]).is_none() && grids::picture(&Grid::all(&printed())).is_some());
}

/// A panel for each camera that has a distortion, and for each that is a tool's.
#[test]
fn every_camera_has_its_panels() {
    let names = |maps: Vec<(String, Result<Field, ConvertError>)>| {
        maps.into_iter().map(|(name, map)| map.map(|_| name).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(names(distortions(&printed())), ["one", "two", "other"]);
    assert_eq!(names(conversions(&printed())), ["one", "two"]);
    let mut drawn = Drawn::new("stem");
    let text = drawn.cameras(&printed());
    let files: Vec<&str> = drawn.pictures.iter().map(|(file, _)| file.as_str()).collect();
    assert_eq!(files, ["stem-grids.png", "stem-distortion.png", "stem-conversion.png"]);
    assert!(files.iter().all(|file| text.contains(&format!("]({file})"))), "{text}");
    let factor = Grid::all(&printed())[2].times();
    assert!(text.contains(&format!("drawn {factor} times too large.\n")) && text.contains("*barrel*, at most "), "{text}");
    let bare = Printed { cameras: vec![camera("none", None, 0.0, [0.0; 2])], grids: Vec::new(), ..printed() };
    let mut drawn = Drawn::new("stem");
    assert_eq!((drawn.cameras(&bare), drawn.pictures.len()), (String::new(), 0));
}

/// The correction by hand of a measured place is the ideal one.
#[test]
fn the_map_of_a_distortion_leads_from_ideal_to_measured() {
    let field = distortions(&printed()).remove(0).1.unwrap();
    for (at, vector) in field.vectors.iter().filter(|(at, _)| at.x < 1000.0 || at.y > 2900.0) {
        let (dx, dy) = vector.unwrap();
        // mm, y up.
        let (x, y) = ((at.x + dx - 2400.0) / 200.0, (1600.0 - at.y - dy) / 200.0);
        let r2 = x * x + y * y;
        let ideal = [
            x - (-K1 * r2 * x + P[0] * (r2 + 2.0 * x * x) + 2.0 * P[1] * x * y),
            y - (-K1 * r2 * y + 2.0 * P[0] * x * y + P[1] * (r2 + 2.0 * y * y)),
        ];
        let apart = (200.0 * ideal[0] - (at.x - 2400.0)).hypot(200.0 * ideal[1] - (1600.0 - at.y));
        assert!(apart < 1e-6, "{at:?}: {apart}");
    }
}

/// What the map shows is what the model says of the two cameras, and leads from the tool's own to the printed one.
#[test]
fn the_map_of_a_conversion_is_the_difference_of_the_models() {
    let printed = printed();
    let own = printed.own(&printed.cameras[1]).unwrap().unwrap();
    let direct: Camera = printed.camera(&printed.cameras[1]).into();
    let found =
        difference(&own, &direct, &DifferenceOptions { region: Region::inside_fold(&own), ..DifferenceOptions::default() }).unwrap();
    let field = conversions(&printed).remove(0).1.unwrap();
    assert!(field.title.contains(&plain(found.spread.rms_px)) && field.title.contains(&plain(found.spread.max_px)), "{}", field.title);
    for place in [0, 20, 700] {
        let (at, vector) = field.vectors[place];
        let turned = direct.project(found.rotation.apply(own.unproject(at).unwrap())).unwrap();
        let (dx, dy) = vector.unwrap();
        assert!((turned.x - at.x - dx).hypot(turned.y - at.y - dy) < 1e-9, "{at:?}");
    }
    assert!(found.spread.max_px > 1.0);
}

#[test]
fn the_plan_of_a_network_has_its_stations_and_check_points() {
    let printed = printed();
    let views = pictures::views(&printed, printed.network.as_ref().unwrap(), &summaries());
    let stations: Vec<_> = views.stations.iter().map(|station| (station.name.as_str(), station.centre)).collect();
    assert_eq!(stations, [("1", [10.0, 0.0, 10.0]), ("2", [20.0, 0.0, 20.0])]);
    assert!(views.stations.iter().all(|station| (station.sight[0] + 1.0).abs() < 1e-12), "the axis leads against X: {:?}", views.stations);
    assert_eq!(views.targets.len(), 2);
    assert!(plan(&views).is_some());
}

/// A wall whose points go back to the right is drawn so.
#[test]
fn a_wall_from_above_lies_along_its_points() {
    let printed = printed();
    let mut views = pictures::views(&printed, printed.network.as_ref().unwrap(), &summaries());
    views.extent = around(&views);
    let draw = |views: &calibench_records::description::Views| {
        let sides = Sides::of([1.0, 0.0, 0.0], &views.extent.unwrap());
        wall_ends(views, (sides.across, sides.towards.reversed()))
    };
    let [left, right] = draw(&views);
    assert!(left.1 > right.1, "towards the viewer to the right: {left:?} {right:?}");
    views.targets[0].surveyed[0] = 102.0;
    views.targets[1].surveyed[0] = 100.0;
    let [left, right] = draw(&views);
    assert!(left.1 < right.1, "away from the viewer to the right: {left:?} {right:?}");
}
