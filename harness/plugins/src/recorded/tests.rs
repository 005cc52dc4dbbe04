//! Files of positions, read and asked by name.

use std::path::Path;

use calibench_exchange::{Fingerprint, RENDERED, RenderedImage, write_rendered};
use calibench_measure::{Configured, ImageId, Known, Registry, RunId};
use calibench_model::{Image, Rejection};

use super::Positions;
use crate::file::{Declared, parse};

const TOML: &str = "[[method]]\nname = \"mine\"\nfile = \"mine.csv\"\nimages = \"pictures\"\n";
const CSV: &str = "image,target,x,y,sxx,sxy,syy,method,status,reason\n\
    a-0.png,one,1.5,2.25,0.01,0,0.02,m,measured,\n\
    a-0.png,two,3,4,,,,m,measured,\n\
    a-0.png,three,,,,,,m,rejected,misfit\n\
    a-0.png,four,,,,,,m,unavailable,the licence ran out\n\
    a-1.png,one,5,6,,,,m,measured,\n";

/// The image of a trial; no two are alike.
fn image(trial: u64) -> Image<'static> {
    Image::from_fn(30, 20, |x, y| ((x * y + 7 * trial as usize) % 11) as f32 / 10.0)
}

/// A folder with renders of four trials and a file of positions.
fn folder(csv: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("pictures")).unwrap();
    let listed = |trial| RenderedImage {
        image: format!("a-{trial}.png"),
        scenario: "s/t".into(),
        seed: 5,
        trial,
        view: "left".into(),
        fingerprint: Fingerprint::of(&image(trial), false),
    };
    let list = std::fs::File::create(folder.path().join("pictures").join(RENDERED)).unwrap();
    write_rendered(list, &[0, 1, 2, 3].map(listed)).unwrap();
    std::fs::write(folder.path().join("mine.csv"), csv).unwrap();
    folder
}

fn configured(folder: &Path, toml: &str) -> Result<Configured, String> {
    let Declared::Recording(recording) = parse("a.toml", toml).unwrap().remove(0) else { panic!("a file of positions") };
    Registry::default().with(recording.method(folder)).parse("mine").map_err(|error| error.to_string())
}

const RUN: RunId<'_> = RunId { scenario: "s/t", seed: 5, photographs: false };
const TARGETS: [&str; 5] = ["two", "one", "three", "four", "five"];

fn said(method: &Configured, trial: u64, view: &str, shown: u64) -> Vec<Result<[f64; 2], Rejection>> {
    let found = method.recorded().unwrap().recall(ImageId { trial, view }, &image(shown), &TARGETS);
    found.into_iter().map(|one| one.map(|found| [found.position.x, found.position.y])).collect()
}

#[test]
fn each_target_of_each_trial_gets_its_own_row() {
    let folder = folder(CSV);
    let method = configured(folder.path(), TOML).unwrap();
    assert!(method.version.starts_with("0 (") && method.version.len() == 12, "{}", method.version);
    assert_eq!(method.recorded().unwrap().unfit(&RUN), None);
    let (given, other) = (Err(Rejection::NotGiven), Err(Rejection::OtherImage));
    let first = [Ok([3.0, 4.0]), Ok([1.5, 2.25]), Err(Rejection::Misfit), Err(Rejection::Declined), given];
    assert_eq!(said(&method, 0, "left", 0), first);
    assert_eq!(said(&method, 1, "left", 1), [given, Ok([5.0, 6.0]), given, given, given]);
    assert_eq!(said(&method, 2, "left", 2), [given; 5], "an image without a row");
    assert_eq!(said(&method, 9, "left", 9), [given; 5], "an image that was not rendered");
    assert_eq!(said(&method, 0, "right", 0), [given; 5]);
    assert_eq!(said(&method, 1, "left", 0), [other; 5], "an image that is not what was rendered");
    let covariance = method.recorded().unwrap().recall(ImageId { trial: 0, view: "left" }, &image(0), &["one", "two"]);
    assert_eq!(covariance.iter().map(|one| one.unwrap().covariance.map(|c| c.syy)).collect::<Vec<_>>(), [Some(0.02), None]);
    let told = method.operator.unwrap().notes();
    assert_eq!(told[0], "`mine.csv` has no row of 3 of 7 images, that of view `right` in trial 0 for one");
    assert!(
        told[1].starts_with("1 of 7 images are not those that were rendered for `mine.csv`, that of view `left` in trial 1"),
        "{told:?}"
    );
    assert!(told[2].contains("no row of 5 targets in images that it has, `five` of view `left` in trial 0"), "{told:?}");
    assert!(told[3].contains("rounded"), "{told:?}");
}

#[test]
fn a_file_of_other_images_is_of_no_use() {
    let folder = folder(CSV);
    let method = configured(folder.path(), TOML).unwrap();
    let unfit = |run: RunId<'_>| method.recorded().unwrap().unfit(&run).unwrap();
    assert!(unfit(RunId { scenario: "s/u", ..RUN }).contains("of images of the scenario `s/t`"));
    assert!(unfit(RunId { seed: 6, ..RUN }).contains("of the seed 5, and this run has the seed 6"));
    assert!(unfit(RunId { photographs: true, ..RUN }).contains("of rendered images"));
    let photographs = TOML.replace("images = \"pictures\"", "photographs = \"s/t\"");
    let method = configured(folder.path(), &photographs).unwrap();
    assert!(method.recorded().unwrap().unfit(&RUN).unwrap().contains("give `images`"));
    assert_eq!(method.recorded().unwrap().unfit(&RunId { photographs: true, ..RUN }), None);
    assert_eq!(said(&method, 0, "a-1.png", 7)[1], Ok([5.0, 6.0]), "photographs are known by their names");
    let corner = configured(folder.path(), &format!("{photographs}origin = \"corner\"\n")).unwrap();
    assert_eq!(said(&corner, 0, "a-1.png", 7)[1], Ok([4.5, 5.5]), "the centre of the first pixel is (0.5, 0.5) there");
}

#[test]
fn mistakes_are_refused_with_their_line() {
    let bad = |old: &str, new: &str| configured(folder(&CSV.replacen(old, new, 1)).path(), TOML).err().unwrap_or_else(|| panic!("{new}"));
    for (old, new, expected) in [
        ("a-1.png", "a-l.png", "mine.csv:6, column `image`: no image of "),
        ("a-1.png", "a-l.png", "is called `a-l.png`; did you mean `a-"),
        ("a-0.png,two,3", "a-0.png,one,3", "mine.csv:3: target `one` of image `a-0.png` is already on line 2"),
        ("0.01,0,0.02", "0.01,0.1,0.02", "mine.csv:2, column `sxx`: no covariance"),
        ("1.5,2.25", "nan,2.25", "mine.csv:2, column `x`: expected a finite number"),
        ("a-0.png,three", "a-0.png,two", "`two` of image `a-0.png` has a row with a position and one without"),
        ("a-0.png,three", "a-0.png,four", "`four` of image `a-0.png` has two rows without a position"),
        ("x,y,", "x,z,", "column `z`: unknown"),
    ] {
        let message = bad(old, new);
        assert!(message.starts_with("`mine`: ") && message.contains(expected), "{new}: {message}");
    }
    let empty = tempfile::tempdir().unwrap();
    assert!(configured(empty.path(), TOML).err().unwrap().contains(RENDERED));
}

#[test]
fn names_that_a_run_does_not_have_are_refused_with_their_line() {
    let folder = folder(CSV);
    let check = |toml: &str, known: Known<'_>| {
        let Declared::Recording(recording) = parse("a.toml", toml).unwrap().remove(0) else { panic!("a file of positions") };
        Positions::read(&recording, folder.path()).unwrap().check(&known)
    };
    let known =
        |targets: &[&'static str], photographs: &[&'static str]| Known { targets: targets.to_vec(), photographs: photographs.to_vec() };
    assert_eq!(check(TOML, known(&["one", "two", "unmeasured"], &[])), Ok(()));
    let wrong = check(TOML, known(&["one", "twox"], &[])).unwrap_err();
    assert!(
        wrong.contains("mine.csv:3, column `target`: no target of the scenario `s/t` is called `two`; did you mean `twox`?"),
        "{wrong}"
    );
    let photographs = TOML.replace("images = \"pictures\"", "photographs = \"s/t\"");
    assert_eq!(check(&photographs, known(&["one", "two"], &["a-0.png", "a-1.png"])), Ok(()));
    let wrong = check(&photographs, known(&["one", "two"], &["a-0.png", "b-1.png"])).unwrap_err();
    assert!(wrong.contains("mine.csv:6, column `image`: no photograph of"), "{wrong}");
}

#[test]
fn every_mistake_in_a_declaration_has_its_place() {
    for (old, new, place, expected) in [
        ("\"mine\"", "\"Mine\"", "2:8", "no name of a method"),
        ("\"mine.csv\"", "\"\"", "3:8", "expected the file of positions"),
        ("images = \"pictures\"\n", "", "2:8", "does not say which images were measured"),
        ("images", "photographs = \"s/t\"\nimages", "4:15", "`photographs` stands beside `images`"),
        ("images", "image", "4:1", "unknown field `image`"),
        ("images", "origin = \"left\"\nimages", "4:10", "unknown variant `left`"),
        ("file = \"mine.csv\"\n", "", "1:1", "missing field `file`"),
    ] {
        let message = parse("a.toml", &TOML.replacen(old, new, 1)).expect_err(new).to_string();
        assert!(message.starts_with(&format!("a.toml:{place}")) && message.contains(expected), "{new}: {message}");
    }
}
