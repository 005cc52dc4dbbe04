//! `detect --testfield`: the coded field in a user's images, from the scenario of the field alone.

use std::collections::BTreeMap;
use std::path::Path;

use image::{DynamicImage, GrayImage, ImageBuffer, Luma, Rgb, RgbImage};

use crate::project::{data, files, root, run, stderr, stdout};

const FIELD: &str = "testfields/coded";

/// A folder with the three images of the scenario, and `--root` of the project.
fn rendered() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let project = root().display().to_string();
    let output = run(folder.path(), &["--root", &project, "render", FIELD, "-o", "c", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    (folder, project)
}

/// Cells of a CSV by image and target; columns by name.
fn table(path: &Path, columns: &[&str]) -> BTreeMap<(String, String), Vec<String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let headers = reader.headers().unwrap().clone();
    let place = |name: &str| headers.iter().position(|header| header == name).unwrap_or_else(|| panic!("no column {name}"));
    let places: Vec<usize> = ["image", "target"].iter().chain(columns).map(|name| place(name)).collect();
    let row = |record: csv::StringRecord| {
        let mut cells = places.iter().map(|place| record[*place].to_owned());
        ((cells.next().unwrap(), cells.next().unwrap()), cells.collect())
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

fn grey(path: &Path) -> GrayImage {
    image::open(path).unwrap().into_luma8()
}

#[test]
fn what_is_detected_is_measured() {
    let (folder, project) = rendered();
    let at = |name: &str| folder.path().join(name);
    let photos = ["c/s01.png", "c/s02.png", "c/s03.png"];
    let detect = |more: &[&str]| {
        let arguments = [&["--root", &project, "detect"][..], &photos, &["--testfield", FIELD, "-q"], more].concat();
        run(folder.path(), &arguments)
    };
    let output = detect(&["-o", "approx.csv"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(stderr(&output), "", "every target of every whole square was recognised");
    let measure = [&["measure"][..], &photos, &["--points", "approx.csv", "-m", "lsm:window=13", "-o", "lsm.csv", "-q"]].concat();
    let output = run(folder.path(), &measure);
    assert!(output.status.success(), "{}", stderr(&output));

    let (found, measured) =
        (table(&at("approx.csv"), &["x", "y", "kind", "axx", "axy", "ayx", "ayy"]), table(&at("lsm.csv"), &["x", "y", "status"]));
    assert_eq!((found.len(), measured.len()), (768, 768), "sixteen targets of sixteen listed squares in three images");
    let (mut squares, mut farthest) = (0.0, 0.0_f64);
    for image in photos {
        let truth = table(&at(&image.replace(".png", ".csv")), &["x", "y", "kind", "axx", "axy", "ayx", "ayy"]);
        for (key, truth) in &truth {
            let (found, measured) = (&found[key], &measured[key]);
            let off = |point: &[String]| (number(&point[0]) - number(&truth[0])).hypot(number(&point[1]) - number(&truth[1]));
            assert!(off(found) < 0.5, "{key:?}: {} px off", off(found));
            assert_eq!(found[2], truth[2], "{key:?}");
            for column in 3..7 {
                assert!((number(&found[column]) - number(&truth[column])).abs() < 0.05, "{key:?}: {found:?} {truth:?}");
            }
            assert_eq!(measured[2], "measured", "{key:?}");
            squares += off(measured).powi(2);
            farthest = farthest.max(off(measured));
        }
    }
    let rms = (squares / 768.0_f64).sqrt();
    println!("lsm from what was detected: rms 2D {rms:.4} px, farthest {farthest:.4} px");
    assert!(rms < 0.02 && farthest < 0.1, "{rms} {farthest}");

    // To standard output, by contours: fewer, and none elsewhere.
    let output = detect(&["--classifier", "contours"]);
    assert!(output.status.success(), "{}", stderr(&output));
    std::fs::write(at("contours.csv"), stdout(&output)).unwrap();
    let contours = table(&at("contours.csv"), &["x", "y"]);
    assert!(contours.len() > 650, "{}", contours.len());
    let off = |key, point: &[String]| {
        let modern: &[String] = &found[key];
        (number(&modern[0]) - number(&point[0])).hypot(number(&modern[1]) - number(&point[1]))
    };
    assert!(contours.iter().all(|(key, point)| off(key, point) < 0.3));
}

/// 16 bits, colour, an alpha channel, JPEG: the same targets in the same places.
#[test]
fn depth_and_colour_change_nothing() {
    let (folder, project) = rendered();
    let at = |name: &str| folder.path().join(name);
    let image = grey(&at("c/s02.png"));
    let (width, height) = image.dimensions();
    ImageBuffer::<Luma<u16>, _>::from_fn(width, height, |x, y| Luma([257 * u16::from(image.get_pixel(x, y)[0])]))
        .save(at("deep.png"))
        .unwrap();
    let coloured = |value: u8| Rgb([value, (f64::from(value) * 0.9) as u8, (f64::from(value) * 0.7) as u8]);
    RgbImage::from_fn(width, height, |x, y| coloured(image.get_pixel(x, y)[0])).save(at("colour.png")).unwrap();
    DynamicImage::from(image.clone()).into_rgba16().save(at("alpha.tif")).unwrap();
    DynamicImage::from(image).save(at("photo.jpg")).unwrap();
    let names = ["c/s02.png", "deep.png", "colour.png", "alpha.tif", "photo.jpg"];
    let arguments = [&["--root", &project, "detect"][..], &names, &["--testfield", FIELD, "-q", "-o", "approx.csv"]].concat();
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let found = table(&at("approx.csv"), &["x", "y"]);
    assert_eq!(found.len(), 5 * 256, "{}", stderr(&output));
    for ((image, target), point) in &found {
        let first = &found[&("s02.png".to_owned(), target.clone())];
        let off = (number(&point[0]) - number(&first[0])).hypot(number(&point[1]) - number(&first[1]));
        assert!(off < 0.3, "{image} {target}: {off} px");
    }
}

/// Each is named with its reason; with one that shows the field the others are no failure.
#[test]
fn images_without_the_field_are_named_with_their_reason() {
    let (folder, project) = rendered();
    let at = |name: &str| folder.path().join(name);
    let field = grey(&at("c/s01.png"));
    image::imageops::flip_horizontal(&field).save(at("mirrored.png")).unwrap();
    image::imageops::crop_imm(&field, 300, 200, 20, 20).to_image().save(at("tiny.png")).unwrap();
    GrayImage::from_pixel(300, 200, Luma([128])).save(at("blank.png")).unwrap();
    GrayImage::from_fn(300, 200, |x, y| Luma([if (x / 30 + y / 30) % 2 == 0 { 20 } else { 220 }])).save(at("board.png")).unwrap();
    let scenario = std::fs::read_to_string(root().join("scenarios/testfields/coded.toml")).unwrap();
    std::fs::write(at("other.toml"), scenario.replace("seed = 88", "seed = 89")).unwrap();
    let output = run(folder.path(), &["--root", &project, "render", "other.toml", "-o", "other", "-q", "--station", "s01"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let bad = ["mirrored.png", "tiny.png", "blank.png", "board.png", "other/s01.png"];
    let options = ["--testfield", FIELD, "-q", "-o", "approx.csv"];
    let output = run(folder.path(), &[&["--root", &project, "detect"][..], &bad, &options].concat());
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(!at("approx.csv").exists());
    let expected = [
        "mirrored.png: not recognised (mirrored): ",
        "tiny.png: not recognised (too_small): the image has 20 x 20 px: expected at least 32 px a side",
        "blank.png: not recognised (blank): ",
        "board.png: not recognised (",
        "other/s01.png: not recognised (other_field): ",
        "error: no target was recognised; expected photographs of the field of `testfields/coded`",
    ];
    for part in expected {
        assert!(stderr(&output).contains(part), "{part}\n{}", stderr(&output));
    }
    let output = run(folder.path(), &[&["--root", &project, "detect", "c/s01.png"][..], &bad, &options].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(expected[..5].iter().all(|part| stderr(&output).contains(part)), "{}", stderr(&output));
    assert_eq!(table(&at("approx.csv"), &["x"]).len(), 256);
}

/// A hand over a part of the field: what is lost is told.
#[test]
fn what_is_lost_is_told() {
    let (folder, project) = rendered();
    let mut image = grey(&folder.path().join("c/s01.png"));
    for (x, y) in (330..420).flat_map(|x| (200..300).map(move |y| (x, y))) {
        image.put_pixel(x, y, Luma([150]));
    }
    image.save(folder.path().join("hand.png")).unwrap();
    let output = run(folder.path(), &["--root", &project, "detect", "hand.png", "--testfield", FIELD, "-q", "-o", "approx.csv"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let said = stderr(&output);
    assert!(said.contains("hand.png: ") && said.contains(" whole squares recognised, ") && said.contains("rejected ("), "{said}");
    let rows = table(&folder.path().join("approx.csv"), &["x"]).len();
    assert!((100..256).contains(&rows) && said.contains(&format!("{rows} targets of ")), "{rows} {said}");
}

#[test]
fn other_testfields_and_options_are_refused() {
    let (folder, project) = rendered();
    for (options, expected) in [
        (&["--testfield", "testfields/chessboard"][..], "--testfield testfields/chessboard: the testfield"),
        (&["--testfield", "testfields/wall"], "its [testfield] must have kind = \"coded\""),
        (&["--testfield", "corners/noise"], "`corners/noise` has no testfield; expected a scenario with [testfield] kind = \"coded\""),
        (&["--testfield", "photographs/opencv-left"], "has no testfield"),
        (&["--testfield", "testfields/coed"], "did you mean `testfields/coded`?"),
        (&["--testfield", FIELD, "--chessboard", "9x6"], "cannot be used with"),
        (&["--classifier", "contours", "--chessboard", "9x6"], "cannot be used with"),
        (&["--testfield", FIELD, "--classifier", "other"], "modern, contours"),
        (&[], "required"),
    ] {
        let output = run(folder.path(), &[&["--root", &project, "detect", "c/s01.png"][..], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{options:?}: expected {expected}\n{}", stderr(&output));
    }
}

#[test]
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
fn photographs_of_a_chessboard_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let project = root().display().to_string();
    let data = data().join("opencv-left");
    let photos: Vec<_> = files(&data).into_iter().map(|(name, _)| data.join(name)).collect();
    let photos = photos.iter().filter(|path| path.extension().is_some_and(|extension| extension == "jpg"));
    let photos: Vec<&str> = photos.map(|path| path.to_str().unwrap()).collect();
    assert!(!photos.is_empty());
    for classifier in ["modern", "contours"] {
        let options = ["--testfield", FIELD, "--classifier", classifier, "-q"];
        let output = run(folder.path(), &[&["--root", &project, "detect"][..], &photos, &options].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert_eq!(stderr(&output).matches(": not recognised (").count(), photos.len(), "{}", stderr(&output));
    }
}
