//! Real photographs: OpenCV's samples, where they are.

use crate::project::{copy, data, run, stderr, stdout, table};

#[test]
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
fn the_report_compares_all_operators_on_all_photographs() {
    let project = copy();
    assert!(run(project.path(), &["run", "photographs/opencv-left", "-q"]).status.success());
    let output = run(project.path(), &["report", "photographs", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let folder = project.path().join("reports/photographs");
    let page = std::fs::read_to_string(folder.join("README.md")).unwrap();
    assert!(page.contains("The board was found in 13 of 13 photographs, 702 corners in all."), "{page}");
    assert!(page.contains("| `forstner:window=11` and `opencv_subpix:window=11` "), "{page}");
    assert!(page.contains("**Of these images trust `"), "{page}");
    assert!(page.contains("**The published calibration** differs by "), "{page}");
    for picture in ["furthest.png", "usual.png", "holdout.png", "halves.png", "views.png", "principal-point.png"] {
        assert!(page.contains(&format!("({picture})")));
        assert!(image::open(folder.join(picture)).is_ok(), "{picture}");
    }
}

#[test]
#[cfg_attr(
    not(photographs),
    ignore = "the photographs left01.jpg to left14.jpg are absent: docs/scenarios.md says where they are looked for"
)]
fn detect_feeds_measure() {
    let folder = tempfile::tempdir().unwrap();
    let photo = data().join("opencv-left/left01.jpg");
    let photo = photo.to_str().unwrap();
    let output = run(folder.path(), &["detect", photo, "--chessboard", "9x6", "-o", "approx.csv"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let output = run(folder.path(), &["measure", photo, "--points", "approx.csv", "-m", "forstner:window=9", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(stdout(&output).matches(",\"forstner:window=9,significance=4\",measured,").count(), 54);
    assert!(stdout(&output).contains("left01.jpg,r6c9,"));
}

#[test]
#[cfg_attr(not(webcam), ignore = "the photographs webcam/img0.png to img13.png are absent")]
fn a_board_among_many_quadrangles_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let photos: Vec<String> = (0..14).map(|i| data().join(format!("webcam/img{i}.png")).to_str().unwrap().to_owned()).collect();
    let arguments =
        [&["detect", "--chessboard", "10x10", "-q", "-o", "corners.csv"][..], &photos.iter().map(String::as_str).collect::<Vec<_>>()];
    let output = run(folder.path(), &arguments.concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let found = std::fs::read_to_string(folder.path().join("corners.csv")).unwrap();
    assert_eq!(found.lines().count(), 1 + 14 * 100, "{}", stderr(&output));
}

#[test]
fn without_photographs_the_scenario_is_unavailable_visibly() {
    let project = copy();
    let empty = tempfile::tempdir().unwrap();
    let ends = |arguments: &[&str], code: i32| {
        let output = crate::project::program(project.path()).args(arguments).env("CALIBENCH_DATA", empty.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", stderr(&output));
        stderr(&output) + &stdout(&output)
    };
    let why = "unavailable: 13 of 13 photographs are not in `opencv-left`";
    let said = ends(&["run", "photographs/opencv-left"], 2);
    assert!(said.contains(why) && said.contains("error: photographs/opencv-left: nothing was measured"), "{said}");
    ends(&["report", "photographs"], 0);
    let page = std::fs::read_to_string(project.path().join("reports/photographs/README.md")).unwrap();
    assert!(page.contains("**unavailable**: 13 of 13 photographs are not in `opencv-left`"), "{page}");
    let records = table(&project.path().join("records/photographs/opencv-left/records.csv.gz"));
    assert_eq!(records.matches(",unavailable,").count(), 9, "a row for each method");
    let judgement = table(&project.path().join("records/photographs/opencv-left/judgement.csv.gz"));
    assert_eq!(judgement.matches(",unavailable,").count(), 1, "{judgement}");
    assert!(ends(&["show", "photographs/opencv-left"], 0).contains("no preview, unavailable"));
}

#[test]
fn a_photograph_without_a_board_is_said_to_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let noise = calibench_model::Image::from_fn(320, 240, |x, y| ((x * 7919 + y * 104_729) % 251) as f32 / 250.0);
    calibench_images::write_png(&folder.path().join("noise.png"), &noise, false).unwrap();
    let output = run(folder.path(), &["detect", "noise.png", "--chessboard", "9x6"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("noise.png: no board of 9 x 6 inner corners found"), "{}", stderr(&output));
}

/// Paper, walls and clothes of photographs in which no edges cross: columns and rows of first and last pixels, as a person saw them.
const NO_CORNERS: [(&str, &[[u32; 4]]); 3] = [
    (
        "reports/01-gopro-wide/GOPR0034.jpg",
        &[
            [15, 250, 80, 700],
            [15, 15, 100, 60],
            [605, 30, 705, 100],
            [605, 140, 705, 225],
            [600, 260, 710, 370],
            [600, 400, 710, 515],
            [600, 550, 715, 660],
            [610, 690, 710, 780],
            [610, 815, 705, 880],
            [465, 285, 570, 370],
            [470, 550, 570, 650],
            [745, 265, 850, 365],
            [745, 400, 860, 510],
        ],
    ),
    (
        "reports/01-gopro-wide/GOPR0052.jpg",
        &[
            [10, 200, 45, 600],
            [10, 10, 130, 80],
            [530, 40, 680, 160],
            [705, 190, 875, 350],
            [540, 380, 675, 510],
            [905, 400, 1035, 530],
            [1090, 240, 1260, 370],
            [710, 380, 865, 525],
            [540, 560, 670, 660],
            [1060, 605, 1230, 690],
        ],
    ),
    ("opencv-left/left01.jpg", &[[20, 80, 140, 130], [165, 60, 200, 190]]),
];

#[test]
#[cfg_attr(not(wide_photographs), ignore = "the photographs reports/01-gopro-wide are absent")]
fn where_a_person_saw_no_corner_next_to_none_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let (mut tried, mut accepted) = (0, 0);
    for (photo, places) in NO_CORNERS {
        let photo = data().join(photo);
        let name = photo.file_name().unwrap().to_str().unwrap();
        let mut starts = String::from("image,target,x,y\n");
        // The search and the window, whichever way the corner is followed, stay within.
        let within = |from: u32, to: u32| (from + 14..=to - 14).step_by(3);
        let all = places
            .iter()
            .flat_map(|&[left, top, right, bottom]| within(top, bottom).flat_map(move |y| within(left, right).map(move |x| (x, y))));
        for (index, (x, y)) in all.enumerate() {
            starts.push_str(&format!("{name},t{index},{x},{y}\n"));
            tried += 1;
        }
        std::fs::write(folder.path().join("starts.csv"), starts).unwrap();
        let output = run(folder.path(), &["measure", photo.to_str().unwrap(), "--points", "starts.csv", "-m", "parametric_corner", "-q"]);
        let measured: Vec<String> = stdout(&output).lines().filter(|line| line.contains(",measured,")).map(str::to_owned).collect();
        accepted += measured.len();
        println!("{name}: {} measured: {measured:#?}", measured.len());
    }
    println!("{accepted} of {tried} places");
    assert!(tried > 10_000 && accepted * 1000 <= tried, "{accepted} of {tried}");
}
