//! Pointing at targets: the page, what it saves, and the server behind it.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use calibench_images::write_png;
use calibench_model::Image;
use image::ImageEncoder;
use image::codecs::png::PngEncoder;

use crate::project::{program, run, stderr, stdout};

/// A photograph's and a target's name that would do something on a page that does not escape them.
const PHOTO: &str = "<img src=x onerror=alert(1)>.png";
const TARGET: &str = "</script><script>alert(2)</script>";
const SIZE: [usize; 2] = [900, 700];

/// Names, object coordinates, and where a known map pictures them, px.
fn targets() -> Vec<(String, [f64; 2], [f64; 2])> {
    let named = ["A", "B", "C", "D", TARGET, "=F", "G"].into_iter();
    let places = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [1.0, 1.0], [2.0, 1.0], [2.0, 2.0]];
    let image = |[x, y]: [f64; 2]| {
        let w = 1.0 + 0.02 * x + 0.03 * y;
        [(180.0 * x + 20.0 * y + 150.3) / w, (10.0 * x + 200.0 * y + 110.7) / w]
    };
    named.zip(places).map(|(name, place)| (name.to_owned(), place, image(place))).collect()
}

/// Where a corner is that no control names: between four pixels.
const FREE: [f64; 2] = [250.5, 240.5];

/// Chess corners on grey, in grey values from `low` to `high`.
fn scene([low, high]: [f64; 2]) -> Image<'static> {
    let corners: Vec<[f64; 2]> = targets().into_iter().map(|(_, _, place)| place).chain([FREE]).collect();
    Image::from_fn(SIZE[0], SIZE[1], |x, y| {
        let of = |[cx, cy]: &[f64; 2]| {
            let (dx, dy) = (x as f64 - cx, y as f64 - cy);
            (dx.hypot(dy) < 30.0).then(|| (dx / 1.2).tanh() * (dy / 1.2).tanh())
        };
        let value = corners.iter().find_map(of).unwrap_or(0.0);
        (low + (high - low) * (0.5 + 0.5 * value)) as f32
    })
}

/// The scene lies on its side in the file, which says how to turn it.
fn write_turned(path: &Path) {
    let upright = scene([0.1, 0.9]);
    let side = Image::from_fn(SIZE[1], SIZE[0], |column, row| upright.at(SIZE[0] - 1 - row, column));
    let exif = [77, 77, 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0];
    let mut bytes = Vec::new();
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_exif_metadata(exif.to_vec()).unwrap();
    encoder.write_image(&side.to_u8(), SIZE[1] as u32, SIZE[0] as u32, image::ExtendedColorType::L8).unwrap();
    std::fs::write(path, bytes).unwrap();
}

/// Photographs, control, and measured points of which one was rejected.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write_png(&here.join(PHOTO), &scene([0.1, 0.9]), false).unwrap();
    write_turned(&here.join("turned.png"));
    let deep: Vec<u16> = scene([0.02, 0.05]).grey().iter().map(|grey| (grey * 65535.0).round() as u16).collect();
    let deep = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(SIZE[0] as u32, SIZE[1] as u32, deep).unwrap();
    deep.save(here.join("deep.tif")).unwrap();
    let (mut control, mut starts) = ("target,X,Y,Z\n".to_owned(), "image,target,x,y\n".to_owned());
    for (name, [x, y], [column, row]) in targets() {
        let name = if name.starts_with('=') { format!("'{name}") } else { name };
        control.push_str(&format!("{name},{x},{y},0\n"));
        starts.push_str(&format!("{PHOTO},{name},{},{}\n", column.round(), row.round()));
    }
    starts.push_str(&format!("{PHOTO},flat,600,600\n"));
    std::fs::write(here.join("control.csv"), control).unwrap();
    std::fs::write(here.join("starts.csv"), starts).unwrap();
    let made = run(here, &["measure", PHOTO, "--points", "starts.csv", "-m", "parametric_corner", "-o", "measured.csv", "-q"]);
    assert!(made.status.success(), "{}", stderr(&made));
    folder
}

const PHOTOS: [&str; 3] = [PHOTO, "turned.png", "deep.tif"];

#[test]
fn a_page_is_one_file_without_a_request() {
    let folder = folder();
    let here = folder.path();
    let made =
        run(here, &[&["point"], &PHOTOS[..], &["--control", "control.csv", "--measured", "measured.csv", "-o", "points.html"]].concat());
    assert!(made.status.success(), "{}", stderr(&made));
    assert!(stderr(&made).contains("turned by 90 degrees"), "{}", stderr(&made));
    let page = std::fs::read_to_string(here.join("points.html")).unwrap();
    assert!(page.contains("default-src 'none'") && !page.contains("connect-src"));
    assert!(!page.contains("<img") && page.matches("</script>").count() == page.matches("<script").count());
    assert!(page.contains("\"width\":900") && !page.contains("\"width\":700"), "upright, as `measure` reads them");
    assert!(page.contains("16 bits: black is 0.0"));
    assert!(page.len() < 1_000_000, "{}", page.len());
    // The same bytes, and over the older page.
    let again = run(
        here,
        &[&["point", "-q"], &PHOTOS[..], &["--control", "control.csv", "--measured", "measured.csv", "-o", "points.html"]].concat(),
    );
    assert!(again.status.success() && std::fs::read_to_string(here.join("points.html")).unwrap() == page);
}

#[test]
fn what_is_wrong_is_said() {
    let folder = folder();
    let here = folder.path();
    std::fs::write(here.join("twice.csv"), "target,X,Y,Z\nA,0,0,0\nA,1,0,0\n").unwrap();
    std::fs::write(here.join("nameless.csv"), "target,X,Y,Z\n,0,0,0\n").unwrap();
    std::fs::write(here.join("no-photo.png"), "no photograph").unwrap();
    for (arguments, said) in [
        (&["-o", "points.html"][..], "<PHOTO>"),
        (&[PHOTO], "--output"),
        (&[PHOTO, "-o", "points.html", "--serve"], "cannot be used with"),
        (&[PHOTO, "-o", "points.html", "-m", "lsm"], "-m: is of the server"),
        (&[PHOTO, "-o", "points.html", "--idle", "3"], "--idle: is of the server"),
        (&[PHOTO, PHOTO, "-o", "points.html"], "given twice"),
        (&["absent.png", "-o", "points.html"], "absent.png: "),
        (&["no-photo.png", "-o", "points.html"], "no-photo.png: "),
        (&[PHOTO, "-o", "points.txt"], "-o points.txt: a page ends in .html"),
        (&[PHOTO, "-o", "turned.png"], "-o turned.png"),
        (&[PHOTO, "--control", "control.csv", "-o", "control.csv"], "name another place"),
        (&[PHOTO, "--control", "twice.csv", "-o", "points.html"], "twice.csv:3"),
        (&[PHOTO, "--control", "nameless.csv", "-o", "points.html"], "nameless.csv:2"),
        (&[PHOTO, "--measured", "control.csv", "-o", "points.html"], "control.csv:1"),
        (&[PHOTO, "--serve", "-m", "nothing"], "nothing"),
        (&[PHOTO, "--serve", "-m", "disc=centroid"], "give --kind"),
        (&[PHOTO, "--serve", "--idle", "-1"], "expected minutes"),
        (&[PHOTO, "--serve", "--camera", "absent.yaml"], "absent.yaml"),
    ] {
        let output = run(here, &[&["point"], arguments].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
        assert!(!here.join("points.html").exists(), "{arguments:?}");
    }
    let output = run(here, &["point", "turned.png", "--measured", "measured.csv", "-o", "points.html"]);
    assert!(output.status.success() && stderr(&output).contains("shows nothing: it is of other photographs"), "{}", stderr(&output));
}

#[test]
fn a_server_prints_its_address_and_ends() {
    let folder = folder();
    let output = run(folder.path(), &["point", PHOTO, "--serve", "--idle", "0.01"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let url = stdout(&output);
    assert!(url.starts_with("http://127.0.0.1:") && url.trim_end().ends_with('/') && url.lines().count() == 1, "{url}");
    let token = url.trim_end().rsplit('/').nth(1).unwrap();
    assert!(token.len() == 32 && !stderr(&output).contains(token), "{}", stderr(&output));
    assert!(stderr(&output).contains("ended: nobody used the page"), "{}", stderr(&output));
}

#[test]
#[cfg_attr(not(browser), ignore = "no Chromium to open pages in: `./bootstrap browser` installs it")]
fn what_is_pointed_at_is_measured() {
    let Some(environment) = option_env!("CALIBENCH_BROWSER") else { return };
    let folder = folder();
    let here = folder.path();
    let shared = [&["point", "-q"], &PHOTOS[..], &["--control", "control.csv", "--measured", "measured.csv"]].concat();
    let made = run(here, &[&shared[..], &["-o", "points.html"]].concat());
    assert!(made.status.success(), "{}", stderr(&made));
    let made = run(here, &["point", "turned.png", "-q", "-o", "free.html"]);
    assert!(made.status.success(), "{}", stderr(&made));
    let served = [&["point", "-q"], &PHOTOS[..], &["--control", "control.csv", "--serve", "-m", "parametric_corner"]].concat();
    let mut server = program(here).args(served).stdout(Stdio::piped()).spawn().unwrap();
    let mut url = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut url).unwrap();
    let truth: Vec<_> = targets().into_iter().map(|(name, _, place)| (name, place)).collect();
    let about = serde_json::json!({
        "url": url.trim(),
        "program": env!("CARGO_BIN_EXE_calibench-under-test"),
        "photos": PHOTOS,
        "size": SIZE,
        "free": FREE,
        "targets": truth,
    });
    std::fs::write(here.join("about.json"), about.to_string()).unwrap();
    let done = Command::new(Path::new(environment).join("bin/python"))
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", concat!(env!("CARGO_MANIFEST_DIR"), "/browser_point")])
        .env("CALIBENCH_PAGES", here)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output();
    server.kill().unwrap();
    server.wait().unwrap();
    let done = done.unwrap();
    assert!(done.status.success(), "{}{}", stdout(&done), stderr(&done));
}
