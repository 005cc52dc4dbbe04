//! `calibrate` of points without coordinates: the network comes from the images, its scale from distances.

use std::path::Path;

use serde_json::Value;

use crate::project::{self, data, number, run, stderr, stdout};

/// Points keep to the middle of the frame: k3 is not determined.
const NETWORK: [&str; 11] =
    ["calibrate", "--points", "points.csv", "--size", "4032x3024", "--model", "opencv4", "--sigma", "0.25", "--distances", "distances.csv"];
const ASKED: [&str; 5] = ["--length", "T01,T20", "--length", "T05,T33", "--json"];

fn example() -> tempfile::TempDir {
    project::example("free_network", &["points.csv", "distances.csv"])
}

fn answer(folder: &Path, arguments: &[&str]) -> (Option<i32>, Value) {
    let output = run(folder, arguments);
    let found = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), found)
}

fn parameter(found: &Value, name: &str) -> f64 {
    let parameters = found["cameras"][0]["camera"]["parameters"].as_array().unwrap();
    number(&parameters.iter().find(|parameter| parameter["name"] == name).unwrap()["value"])
}

fn edit(folder: &Path, name: &str, change: impl Fn(&str) -> String) {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    std::fs::write(folder.join(name), change(&text)).unwrap();
}

#[test]
fn lengths_come_from_images_and_bars_alone() {
    let folder = example();
    let (code, found) = answer(folder.path(), &[&NETWORK[..], &ASKED, &["--report", "page"]].concat());
    assert_eq!(code, Some(0), "{}", found["doubts"]);
    assert_eq!((&found["counts"]["constraints"], &found["counts"]["observations"]), (&Value::from(6), &Value::from(1302)));
    let lengths = found["lengths"].as_array().unwrap();
    for (length, truth) in lengths.iter().zip([1200.0, 800.0, 716.5190, 764.2993]) {
        let off = number(&length["length"]) - truth;
        assert!(off.abs() < 4.0 * number(&length["sigma"]) && number(&length["sigma"]) < 0.15, "{length}");
    }
    // The bars are known better than the images tell: of what they would be without one the deviation is that of the lengths between targets.
    let checked = [0, 1].map(|i| number(&lengths[i]["redundancy"]));
    assert!(checked.iter().all(|r| (0.005..0.05).contains(r)) && lengths[2]["measured"].is_null(), "{lengths:?}");
    let parameter = |name: &str| parameter(&found, name);
    assert!((parameter("fx") - 3150.0).abs() < 2.5 && (parameter("cx") - 2012.4).abs() < 5.0);
    let table = std::fs::read_to_string(folder.path().join("page/distances.csv")).unwrap();
    assert!(table.starts_with("target_a,target_b,length,sigma,measured,sigma_measured,redundancy,w\nB1,B2,") && table.lines().count() == 5);
    let page = std::fs::read_to_string(folder.path().join("page/README.md")).unwrap();
    assert!(page.contains("## Lengths") && page.contains("the others to"), "{page}");
}

#[test]
fn the_same_network_has_the_same_lengths_in_every_frame() {
    let folder = example();
    let (_, alone) = answer(folder.path(), &[&NETWORK[..], &ASKED, &["--report", "page"]].concat());
    std::fs::rename(folder.path().join("page/points.csv"), folder.path().join("near.csv")).unwrap();
    // Coarse coordinates, of some targets.
    edit(folder.path(), "near.csv", |text| {
        let cut = |line: &str| line.split(',').take(4).map(|cell| cell.split('.').next().unwrap_or(cell)).collect::<Vec<_>>().join(",");
        text.lines().take(31).map(cut).collect::<Vec<_>>().join("\n") + "\n"
    });
    for datum in ["free", "free:T01,T03,T04,T05"] {
        let (code, near) = answer(folder.path(), &[&NETWORK[..], &ASKED, &["--approx", "near.csv", "--datum", datum]].concat());
        assert_eq!(code, Some(0), "{}", near["doubts"]);
        assert!((number(&near["sigma0"]) / number(&alone["sigma0"]) - 1.0).abs() < 1e-9);
        for (a, b) in near["lengths"].as_array().unwrap().iter().zip(alone["lengths"].as_array().unwrap()) {
            assert!(["length", "sigma"].iter().all(|key| (number(&a[key]) / number(&b[key]) - 1.0).abs() < 1e-6), "{a} {b}");
        }
    }
}

#[test]
fn a_bar_that_is_wrong_is_doubted() {
    let folder = example();
    edit(folder.path(), "distances.csv", |text| text.replace("799.979", "801.479"));
    let (code, found) = answer(folder.path(), &[&NETWORK[..], &ASKED].concat());
    let doubted = found["doubted"].as_array().unwrap();
    assert_eq!(code, Some(3));
    assert!(doubted.iter().any(|doubt| doubt["subject"] == "distances"), "{doubted:?}");
    assert!(found["doubts"].to_string().contains("the distance from B"), "{}", found["doubts"]);
}

#[test]
fn gross_points_are_left_out_of_a_free_network_too() {
    let folder = example();
    let (_, sound) = answer(folder.path(), &[&NETWORK[..], &ASKED].concat());
    edit(folder.path(), "points.csv", |text| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for line in [40, 131, 222, 313, 404, 495, 586] {
            let mut cells: Vec<String> = lines[line].split(',').map(str::to_owned).collect();
            cells[2] = format!("{:.3}", cells[2].parse::<f64>().unwrap() + 35.0);
            lines[line] = cells.join(",");
        }
        lines.join("\n") + "\n"
    });
    let (code, found) = answer(folder.path(), &[&NETWORK[..], &ASKED].concat());
    assert_eq!(code, Some(0), "{}", found["doubts"]);
    assert_eq!(number(&found["counts"]["not_in_full"]) as i32, 7, "{}", found["rejected"]);
    for (a, b) in found["lengths"].as_array().unwrap().iter().zip(sound["lengths"].as_array().unwrap()) {
        assert!((number(&a["length"]) - number(&b["length"])).abs() < number(&b["sigma"]), "{a} {b}");
    }
}

#[test]
fn what_does_not_go_is_said() {
    let folder = example();
    let refused = |arguments: &[&str]| {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        stderr(&output)
    };
    let bare = &NETWORK[..9];
    std::fs::write(folder.path().join("d.csv"), "target_a,target_b,distance,sigma\nB1,B22,1,0.1\n").unwrap();
    let error = refused(&[bare, &["--distances", "d.csv"]].concat());
    assert!(error.contains("a distance names B22, which takes no part: no image shows it; is it `B2`?"), "{error}");
    let error = refused(&[&NETWORK[..], &["--length", "T01,T99"]].concat());
    assert!(error.contains("a length names T99"), "{error}");
    let error = refused(&[&NETWORK[..], &["--length", "T01"]].concat());
    assert!(error.contains("expected two names with a comma"), "{error}");
    let error = refused(&[&NETWORK[..], &["--datum", "free:T01,T02"]].concat());
    assert!(error.contains("is no datum"), "{error}");
    // Two halves that nothing joins.
    edit(folder.path(), "points.csv", |text| {
        let of = |line: &str| line.split(',').next().and_then(|image| image.strip_prefix("photo")).is_some_and(|n| n > "10");
        text.lines().map(|line| if of(line) { line.replacen(',', ",other", 1) } else { line.to_owned() }).collect::<Vec<_>>().join("\n")
            + "\n"
    });
    let error = refused(&[&NETWORK[..7], &["--plain"]].concat());
    assert!(error.contains("do not hang together with the others: photo") && error.lines().count() < 4, "{error}");
}

/// AICON's network of 115 images, as an independent program adjusted it.
#[test]
#[cfg_attr(not(rigs), ignore = "the networks in `rigs` are absent: docs/scenarios.md says where they are looked for")]
fn a_network_of_others_is_as_another_program_adjusts_it() {
    let folder = data().join("rigs/freenet-aicon");
    let arguments =
        ["calibrate", "--points", "points.csv", "--size", "8688x5792", "--model", "opencv5", "--sigma", "0.1", "--plain", "--json"];
    let more = ["--distances", "distances.csv", "--length", "6,8", "--length", "14,12", "--length", "133,117"];
    let (_, found) = answer(&folder, &[&arguments[..], &more].concat());
    let reference: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("reference.json")).unwrap()).unwrap();
    assert_eq!(found["counts"]["redundancy"], reference["redundancy"]);
    let cost = number(&found["sigma0"]).powi(2) * number(&reference["redundancy"]);
    // Ours is lower by 2e-6, of 18041.277: the other program stopped a little above the minimum.
    assert!(cost <= number(&reference["cost"]) && cost / number(&reference["cost"]) > 1.0 - 3e-6, "{cost}");
    for solved in found["cameras"][0]["solved"].as_array().unwrap() {
        let name = solved["parameter"].as_str().unwrap();
        let [value, sigma] = [0, 1].map(|i| number(&reference["camera"][name][i]));
        let own = parameter(&found, name);
        assert!((own - value).abs() < 1e-3 * sigma && (number(&solved["sigma"]) / sigma - 1.0).abs() < 1e-2, "{name}: {own} {solved}");
    }
    for length in found["lengths"].as_array().unwrap() {
        let name = format!("{}-{}", length["targets"][0].as_str().unwrap(), length["targets"][1].as_str().unwrap());
        let [value, sigma] = [0, 1].map(|i| number(&reference["lengths_mm"][&name][i]));
        assert!((number(&length["length"]) - value).abs() < 6e-6 && (number(&length["sigma"]) / sigma - 1.0).abs() < 6e-3, "{length}");
    }
}
