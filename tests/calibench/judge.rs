//! `judge`: photographs of a board whose camera is known, and what a user may get wrong.

use std::path::Path;

use crate::project::{root, run, stderr, stdout};

/// The rendered chessboard, and the names of its images.
pub fn board(folder: &Path) -> Vec<String> {
    let root = root();
    let output = run(folder, &["--root", root.to_str().unwrap(), "render", "testfields/chessboard", "-o", "board", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut images: Vec<String> = std::fs::read_dir(folder.join("board"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "png"))
        .map(|name| format!("board/{name}"))
        .collect();
    images.sort();
    images
}

pub fn judge(folder: &Path, images: &[String], more: &[&str]) -> std::process::Output {
    let mut arguments = vec!["judge", "-q", "--chessboard", "9x6:25"];
    arguments.extend(images.iter().map(String::as_str));
    arguments.extend(more);
    run(folder, &arguments)
}

#[test]
fn the_page_names_operator_and_model_and_is_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    assert!(images.len() >= 6, "{images:?}");
    let more = ["-m", "pixel", "-m", "parametric_corner", "--model", "opencv4:fx,fy,cx,cy", "--model", "opencv4+bent", "--splits", "3"];
    let page = |name: &str, threads: &str| {
        let with: Vec<&str> = more.into_iter().chain(["--report", name, "--threads", threads]).collect();
        let output = judge(folder.path(), &images, &with);
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(stdout(&output).contains("trust `parametric_corner:window=15` with the model `opencv4+bent`"), "{}", stdout(&output));
        let files = crate::project::files(&folder.path().join(name));
        files.into_iter().map(|(path, bytes)| (path.file_name().unwrap().to_owned(), bytes)).collect::<Vec<_>>()
    };
    let one = page("one", "1");
    let text = std::fs::read_to_string(folder.path().join("one/README.md")).unwrap();
    for picture in ["holdout.png", "halves.png", "views.png", "principal-point.png"] {
        assert!(text.contains(&format!("({picture})")), "{text}");
        assert!(image::open(folder.path().join("one").join(picture)).is_ok(), "{picture}");
    }
    assert!(one == page("two", "2"), "the same bytes");
    // A folder of the user's own is never replaced.
    std::fs::create_dir(folder.path().join("mine")).unwrap();
    std::fs::write(folder.path().join("mine/letter.txt"), "dear").unwrap();
    let output = judge(folder.path(), &images, &["--report", "mine"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--report mine: holds files that calibench did not write"), "{}", stderr(&output));
}

#[test]
fn a_calibration_in_use_holds_has_moved_or_cannot_be_told() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    let mut arguments = vec!["calibrate", "-q", "--chessboard", "9x6:25", "--model", "opencv4", "-o", "camera.yaml"];
    arguments.extend(images.iter().map(String::as_str));
    let output = run(folder.path(), &arguments);
    assert!(folder.path().join("camera.yaml").is_file(), "{}", stderr(&output));
    let text = std::fs::read_to_string(folder.path().join("camera.yaml")).unwrap();
    let output = run(folder.path(), &["camera", "camera.yaml"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let models = ["--model", "opencv4+bent", "--splits", "3"];
    let ended = |camera: &str, margin: &str| {
        let output = judge(folder.path(), &images, &[&models[..], &["--camera", camera, "--margin", margin, "--report", "page"]].concat());
        let page = std::fs::read_to_string(folder.path().join("page/README.md")).unwrap();
        let first = stdout(&output).lines().next().unwrap_or_default().to_owned();
        assert!(page.contains(first.trim_start_matches("- ")), "{first}\n{page}");
        (output.status.code(), first)
    };
    let (code, says) = ended("camera.yaml", "2");
    assert!(code == Some(0) && says.starts_with("- **holds**: the camera in use differs from the one of these photographs by "), "{says}");
    // It is what these photographs give, whatever the margin; one that is a tenth of a pixel off is not.
    let (code, says) = ended("camera.yaml", "0.0001");
    assert!(code == Some(0) && says.starts_with("- **holds**: "), "{says}");
    std::fs::write(folder.path().join("near.yaml"), moved(&text, 1.0002)).unwrap();
    let (code, says) = ended("near.yaml", "0.0001");
    assert!(code == Some(3) && says.starts_with("- **cannot tell**: "), "{says}");
    // The longer side two per cent off: over the frame several pixels.
    let moved = moved(&text, 1.02);
    std::fs::write(folder.path().join("moved.yaml"), moved).unwrap();
    let (code, says) = ended("moved.yaml", "0.5");
    assert!(code == Some(1) && says.starts_with("- **has moved**: ") && says.ends_with("it holds up to 0.5 px."), "{says}");
    let output = judge(folder.path(), &images, &["--margin", "2"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("--camera"), "{}", stderr(&output));
}

/// An OpenCV file with its first focal length 2 % longer.
fn moved(text: &str, factor: f64) -> String {
    let data = text.find("data:").unwrap() + "data:".len();
    let first = data + text[data..].find('[').unwrap() + 1;
    let end = first + text[first..].find(',').unwrap();
    let focal: f64 = text[first..end].trim().parse().unwrap();
    format!("{}{}{}", &text[..first], factor * focal, &text[end..])
}

#[test]
fn mistakes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    let refused = |images: &[String], more: &[&str], why: &str| {
        let output = judge(folder.path(), images, more);
        assert_eq!(output.status.code(), Some(2), "{why}");
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
    };
    refused(&images[..1], &[], "judging takes at least 6 photographs that show the board");
    refused(&images[..5], &[], "found 5");
    refused(&images, &["--model", "opncv5"], "did you mean `opencv5`?");
    refused(&images, &["--model", "opencv4:fx,k9"], "opencv4 has no parameter k9");
    refused(&images, &["-m", "forstnr"], "did you mean `forstner`?");
    refused(&[images.clone(), images[..1].to_vec()].concat(), &[], "given twice");
    let noise = calibench_model::Image::from_fn(640, 480, |x, y| ((x * 7919 + y * 104_729) % 251) as f32 / 250.0);
    let blank: Vec<String> = (0..6).map(|i| format!("blank{i}.png")).collect();
    blank.iter().for_each(|name| calibench_images::write_png(&folder.path().join(name), &noise, false).unwrap());
    refused(&blank, &["-m", "pixel"], "found 0");
}

#[test]
fn a_scenario_says_what_is_wrong_with_its_judgement() {
    let folder = tempfile::tempdir().unwrap();
    let root = root();
    let text = std::fs::read_to_string(root.join("scenarios/photographs/opencv-left.toml")).unwrap();
    let refused = |wrong: String, why: &str| {
        std::fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
        let output = run(folder.path(), &["--root", root.to_str().unwrap(), "show", "wrong.toml"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
    };
    refused(text.replace("\"opencv8\"", "\"opencv9\""), "no camera model is called opencv9");
    refused(text.replace("side = 25\n", ""), "[judgement] has no `side`");
    refused(text.replace("left_intrinsics.yml", "../left_intrinsics.yml"), "is no plain file name");
}
