//! `measure`, on images of a user's own.

use std::path::Path;

use calibench_images::write_png;
use calibench_model::{Image, PixelPoint, Polygon, Scene};
use calibench_synth::render;

use crate::project::{run, stderr, stdout};

/// A chess corner at (30.25, 28.5) and (70.25, 28.5), of low contrast.
fn corners(contrast: f64) -> Image<'static> {
    let square = |x: f64, y: f64| Polygon {
        id: "s".into(),
        vertices: [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(|(u, v)| PixelPoint::new(x + u, y + v)).to_vec(),
        grey: 0.5 + contrast,
    };
    let polygons = [(10.25, 8.5), (30.25, 28.5), (50.25, 8.5), (70.25, 28.5)].map(|(x, y)| square(x, y)).to_vec();
    render(&Scene { width: 100, height: 60, background: 0.5, polygons, targets: Vec::new() })
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_png(&folder.path().join("a.png"), &corners(0.3), false).unwrap();
    write_png(&folder.path().join("deep.png"), &corners(0.002), true).unwrap();
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

const POINTS: &str =
    "image,target,x,y\ndeep.png,left,31,28\na.png,right,70,29\nb.png,gone,5,5\na.png,flat,90,10\na.png,left,30,29\na.png,edge,2,2\n";

#[test]
fn one_row_for_every_point_in_the_order_given() {
    let folder = folder();
    write(folder.path(), "p.csv", POINTS);
    let arguments =
        ["measure", "a.png", "deep.png", "--points", "p.csv", "-m", "forstner:window=15", "-m", "opencv_subpix", "-o", "out.csv"];
    let output = run(folder.path(), &arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "image,target,x,y,sxx,sxy,syy,kind,axx,axy,ayx,ayy,method,status,reason");
    let head: Vec<String> = lines[1..].iter().map(|line| line.split(',').take(2).collect::<Vec<_>>().join(",")).collect();
    let given = ["deep.png,left", "a.png,right", "b.png,gone", "a.png,flat", "a.png,left", "a.png,edge"];
    assert_eq!(head, [given, given].concat());
    let tails =
        ["measured,", "measured,", "unavailable,photograph b.png was not given", "rejected,no_corner", "measured,", "rejected,border"];
    for (line, (tail, method)) in lines[1..]
        .iter()
        .zip(tails.iter().map(|t| (t, "\"forstner:window=15,significance=4\"")).chain(tails.iter().map(|t| (t, "opencv_subpix:window=11"))))
    {
        assert!(line.ends_with(&format!(",{method},{tail}")), "{line}\nexpected {method},{tail}");
    }
}

/// The file's pixels are upside down, and its EXIF says so: what is measured is as it is seen.
#[test]
fn a_photograph_is_turned_as_its_exif_asks_and_it_is_said() {
    use image::ImageEncoder;
    let folder = folder();
    let mut levels = corners(0.3).to_u8();
    levels.reverse();
    let exif = [77, 77, 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, 3, 0, 0, 0, 0, 0, 0];
    let mut bytes = Vec::new();
    let mut encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder.set_exif_metadata(exif.to_vec()).unwrap();
    encoder.write_image(&levels, 100, 60, image::ExtendedColorType::L8).unwrap();
    std::fs::write(folder.path().join("turned.png"), bytes).unwrap();
    write(folder.path(), "p.csv", "image,target,x,y\na.png,left,30,29\n");
    write(folder.path(), "q.csv", "image,target,x,y\nturned.png,left,30,29\n");
    let measured = |photo: &str, points: &str| run(folder.path(), &["measure", photo, "--points", points, "-q"]);
    let (upright, turned) = (measured("a.png", "p.csv"), measured("turned.png", "q.csv"));
    assert_eq!(stdout(&turned).replace("turned.png", "a.png"), stdout(&upright));
    assert!(
        stderr(&turned).contains("turned.png: EXIF orientation 3, turned by 180 degrees, as OpenCV's imread does"),
        "{}",
        stderr(&turned)
    );
    assert!(!stderr(&upright).contains("EXIF"));
}

#[test]
fn sixteen_bits_are_measured_as_such() {
    let folder = folder();
    write(folder.path(), "p.csv", "image,target,x,y\ndeep.png,left,30,29\n");
    let text = stdout(&run(folder.path(), &["measure", "deep.png", "--points", "p.csv", "-m", "forstner", "-q"]));
    let cells: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    let (x, y): (f64, f64) = (cells[2].parse().unwrap(), cells[3].parse().unwrap());
    // 0.2 % of contrast is half a level of 8 bits and 131 levels of 16.
    assert!((x - 30.25).hypot(y - 28.5) < 0.1, "{x} {y}");
}

#[test]
fn the_output_can_be_the_next_input() {
    let folder = folder();
    write(folder.path(), "p.csv", POINTS);
    assert!(run(folder.path(), &["measure", "a.png", "deep.png", "--points", "p.csv", "-o", "q.csv", "-q"]).status.success());
    let again = run(folder.path(), &["measure", "a.png", "deep.png", "--points", "q.csv", "-m", "pixel", "-q"]);
    assert!(again.status.success(), "{}", stderr(&again));
    assert_eq!(stdout(&again).matches(",pixel,measured,").count(), 3);
    assert!(stderr(&again).contains("3 rows without a position"), "{}", stderr(&again));
    // `pixel` hands on what it was given, the covariance too.
    let covariances = |text: &str| {
        text.lines()
            .filter(|l| l.contains(",measured,"))
            .map(|l| l.split(',').skip(4).take(3).collect::<Vec<_>>().join(","))
            .collect::<Vec<_>>()
    };
    let first = std::fs::read_to_string(folder.path().join("q.csv")).unwrap();
    assert_eq!(covariances(&stdout(&again)), covariances(&first));
    assert!(!covariances(&first)[0].starts_with(','));
}

#[test]
fn bad_input_is_named_and_leaves_the_old_output() {
    let folder = folder();
    write(folder.path(), "p.csv", "image,target,x,y\na.png,left,30,oops\n");
    write(folder.path(), "out.csv", "old");
    write(folder.path(), "text.png", "no image");
    write(folder.path(), "good.csv", POINTS);
    write(folder.path(), "kinds.csv", "image,target,x,y,kind\na.png,left,30,29,chess_corner\na.png,right,70,29,disc\n");
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::copy(folder.path().join("a.png"), folder.path().join("c.png")).unwrap();
    write_png(&folder.path().join("sub/a.png"), &corners(0.1), false).unwrap();
    for (arguments, expected) in [
        (&["measure", "a.png", "--points", "p.csv"][..], "p.csv:2, column `y`: expected a finite number"),
        (&["measure", "a.png", "text.png", "--points", "good.csv"], "text.png: not an image"),
        (&["measure", "a.png", "sub/a.png", "--points", "good.csv"], "two photographs are called a.png"),
        (&["measure", "a.png", "sub", "--points", "good.csv"], "two photographs are called a.png: a.png and sub/a.png"),
        (
            &["measure", "c.png", "--points", "good.csv"],
            "no point is of a photograph that was given: points name `deep.png`, the photographs are called `c.png`",
        ),
        (&["measure", "a.png", "--points", "good.csv", "-m", "forstner:window=10"], "odd number from 3 to 31"),
        (
            &["measure", "a.png", "--points", "good.csv", "-m", "lsm"],
            "does not say what is pictured, which this method must know; give the column `kind`",
        ),
        (
            &["measure", "a.png", "--points", "good.csv", "-m", "corner=forstner"],
            "-m forstner:window=11,significance=4,kinds=corner: point left of deep.png does not say what is pictured, which this method must know; give the column `kind` \
             (corner, chess_corner, junction, cross, disc, square, triangle), or leave out the kinds",
        ),
        (&["measure", "a.png", "--points", "kinds.csv", "-m", "korner=forstner"], "no kind of target is called `korner`"),
        (&["measure", "a.png", "--points", "kinds.csv", "-m", "korner=forstner"], "did you mean `corner`"),
        (&["measure", "a.png", "--points", "kinds.csv", "-m", "disc+disc=forstner"], "the kind `disc` is given twice"),
        (
            &["measure", "a.png", "--points", "kinds.csv", "-m", "cross=forstner"],
            "`forstner:window=11,significance=4,kinds=cross` has nothing to measure: there are only targets of the kind `chess_corner`, `disc`",
        ),
        (
            &["measure", "a.png", "--points", "kinds.csv", "-m", "forstner", "-m", "disc=forstner"],
            "`forstner:window=11,significance=4,kinds=disc` is to measure `disc` twice, here and as `forstner:window=11,significance=4`",
        ),
    ] {
        let output = run(folder.path(), &[arguments, &["-o", "out.csv"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
        assert_eq!(std::fs::read_to_string(folder.path().join("out.csv")).unwrap(), "old", "{arguments:?}");
    }
    let output = run(folder.path(), &["measure", "a.png", "--points", "good.csv", "-m", "lsm:shape=corner"]);
    assert!(output.status.success(), "told by the method's parameter: {}", stderr(&output));
    let output = run(folder.path(), &["measure", "a.png", "--points", "good.csv", "-o", "no/such/out.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no/such/out.csv"), "{}", stderr(&output));
}

const MIXED: &str = "image,target,x,y,kind\na.png,left,30,29,chess_corner\na.png,flat,90,10,disc\nb.png,gone,5,5,disc\na.png,right,70,29,square\n\
                     a.png,edge,2,2,chess_corner\nb.png,there,5,5,chess_corner\n";

/// What each row says: image, target, method, status, reason.
fn told(text: &str) -> Vec<String> {
    let of = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let label = cells[12..cells.len() - 2].join(",").replace('"', "");
        [cells[0], cells[1], &label, cells[cells.len() - 2], cells[cells.len() - 1]].join(" ")
    };
    text.lines().skip(1).map(of).collect()
}

#[test]
fn methods_by_kind_of_target_measure_their_own_and_what_nobody_measures_is_said() {
    let folder = folder();
    write(folder.path(), "p.csv", MIXED);
    let by_kind = ["measure", "a.png", "--points", "p.csv", "-m", "disc=ellipse_edges", "-m", "chess_corner=forstner:window=15"];
    let output = run(folder.path(), &by_kind);
    assert!(output.status.success(), "{}", stderr(&output));
    let expected = [
        "a.png flat ellipse_edges:kinds=disc rejected no_corner",
        "b.png gone ellipse_edges:kinds=disc unavailable photograph b.png was not given",
        "a.png left forstner:window=15,significance=4,kinds=chess_corner measured ",
        "a.png edge forstner:window=15,significance=4,kinds=chess_corner rejected border",
        "b.png there forstner:window=15,significance=4,kinds=chess_corner unavailable photograph b.png was not given",
        "a.png right  unavailable no method measures the kind square",
    ];
    assert_eq!(told(&stdout(&output)), expected);
    let said = stderr(&output);
    assert!(
        said.contains("1 of 6 points are of the kind `square`, which no method measures; give one for it, as in -m square=METHOD"),
        "{said}"
    );
    assert!(said.contains("1 measured, 2 rejected, 2 of 6 points are of photographs that were not given"), "{said}");
    // Every point stands there once: the file can be the next input.
    write(folder.path(), "q.csv", &stdout(&output));
    let again = run(folder.path(), &["measure", "a.png", "--points", "q.csv", "-m", "pixel", "-q"]);
    assert!(again.status.success() && stdout(&again).lines().count() == 2, "{}", stderr(&again));
    // The position is that of the method on all kinds, to the digit.
    let all = stdout(&run(folder.path(), &["measure", "a.png", "--points", "p.csv", "-m", "forstner:window=15", "-q"]));
    let left = |text: &str| {
        text.lines().find(|line| line.starts_with("a.png,left")).unwrap().split(',').take(7).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(left(&all), left(&stdout(&output)));
}
