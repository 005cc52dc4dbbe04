//! `judge --points`: files of corners in the place of photographs.

use std::path::Path;
use std::process::Output;

use crate::project::{data, files, root, run, stderr, stdout};

const METHODS: [&str; 2] = ["forstner:window=11,significance=4", "chess_corners"];
const MODELS: [&str; 6] = ["--model", "opencv4:fx,fy,cx,cy,k1", "--model", "opencv4", "--splits", "2"];

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// The photographs of a rendered chessboard, 640 x 480 px.
fn rendered(folder: &Path) -> Vec<String> {
    done(folder, &["--root", root().to_str().unwrap(), "render", "testfields/chessboard", "-o", "board", "-q"]);
    let names = files(&folder.join("board")).into_iter().map(|(name, _)| name);
    names.filter(|name| name.extension().is_some_and(|ending| ending == "png")).map(|name| format!("board/{}", name.display())).collect()
}

/// Corners of the photographs by [`METHODS`], from whole pixels as `judge` starts them: `0.csv` and `1.csv`.
fn measured(folder: &Path, photos: &[String]) {
    let photos: Vec<&str> = photos.iter().map(String::as_str).collect();
    let found = done(folder, &[&["detect", "--chessboard", "9x6", "-q"][..], &photos].concat());
    let whole = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [x, y] = [cells[2], cells[3]].map(|text| text.parse::<f64>().unwrap().round());
        format!("{},{},{x},{y},chess_corner\n", cells[0], cells[1])
    };
    let starts: String = found.lines().skip(1).map(whole).collect();
    std::fs::write(folder.join("starts.csv"), format!("image,target,x,y,kind\n{starts}")).unwrap();
    for (index, method) in METHODS.iter().enumerate() {
        let file = format!("{index}.csv");
        done(folder, &[&["measure", "--points", "starts.csv", "-q", "-m", method, "-o", &file][..], &photos].concat());
    }
}

fn judged(folder: &Path, points: &[&str], more: &[&str]) -> Output {
    let mut arguments = vec!["judge", "-q", "--chessboard", "9x6:25", "--size", "640x480"];
    points.iter().for_each(|file| arguments.extend(["--points", file]));
    arguments.extend(more);
    run(folder, &arguments)
}

/// Photographs and the files measured in them give the same figures, verdict and pictures, byte by byte.
fn agree(folder: &Path, photos: &[String]) -> String {
    measured(folder, photos);
    let photos: Vec<&str> = photos.iter().map(String::as_str).collect();
    let by_photographs = ["judge", "-q", "--chessboard", "9x6:25", "-m", METHODS[0], "-m", METHODS[1], "--report", "photographs"];
    let says = run(folder, &[&by_photographs[..], &MODELS, &photos].concat());
    let named: Vec<String> = METHODS.iter().enumerate().map(|(index, method)| format!("{method}={index}.csv")).collect();
    let output = judged(folder, &[&named[0], &named[1]], &[&MODELS[..], &["--report", "files"]].concat());
    assert_eq!((stdout(&output), output.status.code()), (stdout(&says), says.status.code()), "{}", stderr(&output));
    let compared = ["judgement.csv", "holdout.png", "halves.png", "halves-predicted.png", "views.png", "principal-point.png"];
    for name in compared {
        let [a, b] = ["photographs", "files"].map(|from| std::fs::read(folder.join(from).join(name)).unwrap());
        assert!(a == b, "{name} differs");
    }
    stdout(&output)
}

#[test]
fn files_are_judged_exactly_as_the_photographs_they_were_measured_in() {
    let folder = tempfile::tempdir().unwrap();
    agree(folder.path(), &rendered(folder.path()));
    let page = std::fs::read_to_string(folder.path().join("files/README.md")).unwrap();
    assert!(
        page.starts_with(
            "# Which file of corners and which model to trust\n\nMade by `calibench judge` from corners that were measured beforehand"
        ),
        "{page}"
    );
    assert!(page.contains("- `forstner:window=11,significance=4`: `0.csv`, ") && !page.contains("photographs of a chessboard"), "{page}");
    // One file alone is called as the file, and nothing stands beside it.
    let output = judged(folder.path(), &["0.csv"], &MODELS);
    assert!(
        stdout(&output).contains("trust `0` with the model") && stdout(&output).contains("`0` has no other beside it."),
        "{}",
        stdout(&output)
    );
}

#[test]
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
fn files_measured_in_real_photographs_are_judged_as_these() {
    let folder = tempfile::tempdir().unwrap();
    let data = data().join("opencv-left");
    let photos: Vec<String> = files(&data)
        .into_iter()
        .map(|(name, _)| data.join(name).display().to_string())
        .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "jpg"))
        .collect();
    let says = agree(folder.path(), &photos);
    assert!(says.contains("trust `chess_corners` with"), "{says}");
    let page = std::fs::read_to_string(folder.path().join("files/README.md")).unwrap();
    assert!(page.contains("`chess_corners` rejected 14 of 702 corners (2.0 %: 14 no_corner)"), "{page}");
}

#[test]
fn the_better_of_two_files_is_named_and_a_camera_in_use_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    measured(folder.path(), &rendered(folder.path()));
    let text = std::fs::read_to_string(folder.path().join("0.csv")).unwrap();
    // Every other corner half a pixel off.
    let (header, rows) = text.split_once('\n').unwrap();
    let worse = |(index, line): (usize, &str)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let x: f64 = cells[2].parse().unwrap();
        cells[2] = (x + 0.5 * (index % 2) as f64).to_string();
        cells.join(",") + "\n"
    };
    let rows: String = rows.lines().enumerate().map(worse).collect();
    std::fs::write(folder.path().join("worse.csv"), format!("{header}\n{rows}")).unwrap();
    for files in [["worse.csv", "good=0.csv"], ["good=0.csv", "worse.csv"]] {
        let says = stdout(&judged(folder.path(), &files, &MODELS));
        assert!(says.contains("trust `good` with") && says.contains("Worse: `worse` ("), "{says}");
    }
    done(folder.path(), &["control", "9x6:25", "-o", "control.csv"]);
    let calibrate =
        ["calibrate", "--points", "0.csv", "--control", "control.csv", "--size", "640x480", "--model", "opencv4", "-o", "camera.yaml"];
    run(folder.path(), &calibrate);
    for (margin, code, says) in [("100", 0, "**holds**"), ("0.00001", 0, "**holds**")] {
        let output =
            judged(folder.path(), &["0.csv"], &["--model", "opencv4+bent", "--splits", "3", "--camera", "camera.yaml", "--margin", margin]);
        assert!(output.status.code() == Some(code) && stdout(&output).contains(says), "{}{}", stdout(&output), stderr(&output));
    }
}

/// Six images with the corners of a 9 x 6 board on a grid.
fn grid(row: impl Fn(usize, usize) -> Option<String>) -> String {
    let rows = (0..6).flat_map(|image| (0..54).map(move |corner| (image, corner))).filter_map(|(image, corner)| row(image, corner));
    format!("image,target,x,y\n{}", rows.collect::<String>())
}

#[test]
fn mistakes_in_files_are_named_with_their_lines() {
    let folder = tempfile::tempdir().unwrap();
    let line = |image: usize, corner: usize| {
        format!("i{image},r{}c{},{},{}\n", corner / 9 + 1, corner % 9 + 1, 50 * (corner % 9), 50 * (corner / 9))
    };
    let good = grid(|image, corner| Some(line(image, corner)));
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    std::fs::create_dir(folder.path().join("x")).unwrap();
    write("good.csv", &good);
    write("x/good.csv", &good);
    write("other.csv", &good.replace("\ni", "\nj"));
    write("strange.csv", &good.replace("i0,r1c3,", "i0,P3,"));
    write("wide.csv", &good.replace("i0,r1c2,50,0", "i0,r1c2,640,0"));
    write("twice.csv", &good.replace("i0,r1c3,100", "i0,r1c2,100"));
    write("few.csv", &grid(|image, corner| (image < 5 || corner < 11).then(|| line(image, corner))));
    write("empty.csv", "image,target,x,y\n");
    let refused = |files: &[&str], why: &str| {
        let output = judged(folder.path(), files, &[]);
        assert_eq!(output.status.code(), Some(2), "{why}");
        assert!(stderr(&output).contains(why), "{why}\n{}", stderr(&output));
    };
    refused(
        &["strange.csv"],
        "strange.csv:4, column `target`: `P3` is no inner corner of a board of 9 x 6: expected `r1c1` (row 1, column 1) to `r6c9`",
    );
    refused(&["wide.csv"], "wide.csv:3, column `x`: 640 px is outside the image: expected -0.5 to 639.5 with --size 640x480");
    refused(&["twice.csv"], "twice.csv:4: target `r1c2` of image `i0` is already on line 3");
    refused(&["empty.csv"], "empty.csv: holds no point");
    refused(&["absent.csv"], "absent.csv: No such file");
    refused(
        &["few.csv"],
        "few.csv: judging takes at least 6 images with 12 corners or more (each half of them is calibrated by itself), found 5",
    );
    refused(
        &["good.csv", "x/good.csv"],
        "two files are called `good`: good.csv and x/good.csv; give them names, as in --points first=good.csv",
    );
    refused(&["good.csv", "a=good.csv"], "good.csv: given twice");
    refused(&["good.csv", "a=x/../good.csv"], "x/../good.csv: given twice");
    write("half.csv", &grid(|image, corner| (corner % 9 < 5).then(|| line(image, corner))));
    refused(
        &["good.csv", "half.csv"],
        "half.csv: has 180 of the 324 corners that the files have together; operators are compared where each has 80 %",
    );
    write(
        "rejected.csv",
        &format!(
            "{}i0,P7,,,rejected,no_corner\n",
            good.replace("x,y\n", "x,y,status,reason\n").replace(['\n'], ",,\n").replace("reason,,", "reason")
        ),
    );
    refused(&["rejected.csv"], "rejected.csv: `P7` is no inner corner of a board of 9 x 6");
    refused(&["good.csv", "other.csv"], "other.csv: has no image in common with good.csv: it names `j0`, the other `i0`");
    refused(&["=good.csv"], "is no name of an operator: expected NAME=FILE");
    for (arguments, why) in [
        (&["judge", "--points", "good.csv", "--chessboard", "9x6:25"][..], "--size <WxH>"),
        (&["judge", "photo.jpg", "--points", "good.csv", "--chessboard", "9x6:25", "--size", "640x480"], "cannot be used with"),
        (&["judge", "--points", "good.csv", "--chessboard", "9x6:25", "--size", "640x480", "-m", "pixel"], "cannot be used with"),
        (&["judge", "photo.jpg", "--chessboard", "9x6:25", "--size", "640x480"], "cannot be used with"),
        (&["judge", "--chessboard", "9x6:25"], "PHOTO"),
        (
            &["calibrate", "--points", "good.csv", "--control", "good.csv", "--size", "640x480", "--model", "opencv5+bent"],
            "expected --model opencv5 and --board-shape bent",
        ),
    ] {
        let output = run(folder.path(), arguments);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(why), "{why}\n{}", stderr(&output));
    }
}
