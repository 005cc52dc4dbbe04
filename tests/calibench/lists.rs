//! Long lists of cameras, as a user converts them: in pieces, with the memory of a few.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

use crate::project::{files, program, run, stderr, stdout};

/// COLMAP's cameras.txt, as it is written here.
fn text(count: usize) -> String {
    let line = |i: usize| format!("{} OPENCV 640 480 {}.5 501.25 320.5 240.0 -0.125 0.0625 0.001 -0.002\n", i + 1, 500 + i % 100);
    let head = "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras:";
    format!("{head} {count}\n{}", (0..count).map(line).collect::<String>())
}

fn folder(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cameras.txt"), text(count)).unwrap();
    folder
}

fn convert(folder: &Path, from: &str, to: &str, output: &str) -> Output {
    run(folder, &["convert", from, "--all", "--to", to, "-o", output])
}

fn good(output: &Output) {
    assert!(output.status.success(), "{}", stderr(output));
}

#[test]
fn a_long_list_comes_back_as_it_was() {
    let folder = folder(30_000);
    let at = |name: &str| folder.path().join(name);
    let said = convert(folder.path(), "cameras.txt", "colmap-bin", "cameras.bin");
    good(&said);
    assert_eq!(stderr(&said), "1: OPENCV: exact: the same camera in other units (so are 29999 more)\n");
    good(&convert(folder.path(), "cameras.bin", "colmap", "back.txt"));
    assert!(fs::read(at("back.txt")).unwrap() == fs::read(at("cameras.txt")).unwrap());
    // The same to standard output, which is written when all is known.
    let output = run(folder.path(), &["convert", "cameras.bin", "--all", "--to", "colmap", "-q"]);
    assert!(output.status.success() && output.stdout == fs::read(at("cameras.txt")).unwrap());
    let card = stdout(&run(folder.path(), &["camera", "cameras.bin"]));
    assert!(card.contains("30000 cameras") && card.contains("...   and 29800 more") && card.contains("  200   200: "), "{card}");
    for (camera, f) in [("17", "516.5"), ("29999", "598.5")] {
        let output = run(folder.path(), &["convert", "cameras.bin", "--camera", camera, "--to", "colmap", "-q"]);
        assert!(stdout(&output).contains(&format!("{camera} OPENCV 640 480 {f} ")), "{}", stdout(&output));
    }
    let output = run(folder.path(), &["convert", "cameras.bin", "--camera", "30001", "--to", "colmap"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("cameras.bin: no camera is called 30001"));
}

/// What comes through a pipe is read whole.
#[cfg(unix)]
#[test]
fn in_pieces_and_as_a_whole_are_the_same_bytes_and_words() {
    let folder = folder(9000);
    fs::write(folder.path().join("few.txt"), text(9)).unwrap();
    good(&convert(folder.path(), "cameras.txt", "colmap-bin", "cameras.bin"));
    for (from, to) in [
        ("cameras.txt", "colmap-bin"),
        ("cameras.txt", "kapture"),
        ("cameras.bin", "colmap"),
        ("cameras.bin", "kapture"),
        ("few.txt", "colmap-bin"),
        ("few.txt", "colmap"),
    ] {
        let pieces = run(folder.path(), &["convert", from, "--all", "--to", to]);
        good(&pieces);
        let file = fs::File::open(folder.path().join(from)).unwrap();
        let mut cat = std::process::Command::new("cat").stdin(file).stdout(Stdio::piped()).spawn().unwrap();
        let mut whole = program(folder.path());
        let whole = whole.args(["convert", "/dev/stdin", "--all", "--to", to]).stdin(cat.stdout.take().unwrap()).output().unwrap();
        cat.wait().unwrap();
        assert!(pieces.stdout == whole.stdout && !pieces.stdout.is_empty(), "{from} to {to}");
        assert_eq!(stderr(&pieces), stderr(&whole), "{from} to {to}");
    }
}

#[test]
fn what_is_wrong_late_is_named_and_nothing_is_written() {
    let folder = folder(30_000);
    let at = |name: &str| folder.path().join(name);
    good(&convert(folder.path(), "cameras.txt", "colmap-bin", "cameras.bin"));
    let good_text = text(30_000);
    let line = |id: usize| good_text.lines().nth(id + 2).unwrap();
    let changed = |id: usize, with: &str| good_text.replacen(line(id), with, 1).into_bytes();
    let bytes = fs::read(at("cameras.bin")).unwrap();
    fs::write(at("old.txt"), "old").unwrap();
    fs::create_dir(at("folder.txt")).unwrap();
    for (list, to, output, expected) in [
        (changed(29_990, &line(29_990).replace("240.0", "24o")), "colmap", "old.txt", "list:29993, `PARAMS[]`: expected a finite number"),
        (
            changed(29_990, &line(29_990).replace("29990 ", "17 ")),
            "colmap",
            "old.txt",
            "list:29993, `17`: the id of two cameras, first on line 20",
        ),
        (
            changed(29_990, &line(29_990).replace("OPENCV", "OPENGL")),
            "colmap",
            "new.txt",
            "list:29993, `OPENGL`: model `OPENGL` is not known",
        ),
        (bytes[..bytes.len() - 1].to_vec(), "colmap", "new.txt", "list, `camera 30000 of 30000, PARAMS[]`: the file of "),
        (
            changed(
                29_990,
                "29990 RAD_TAN_THIN_PRISM_FISHEYE 640 480 300 310 320 240 0.01 -0.02 0.03 -0.01 0.005 0.001 0.02 -0.03 0.04 -0.05 0.06 -0.07",
            ),
            "kapture",
            "old.txt",
            "29990: kapture cannot hold the camera",
        ),
        (bytes.clone(), "colmap", "folder.txt", "-o folder.txt: is a folder; expected the name of a file"),
        (bytes, "colmap", "none/new.txt", "-o none/new.txt: there is no folder none"),
    ] {
        fs::write(at("list"), list).unwrap();
        let before = files(folder.path());
        let found = convert(folder.path(), "list", to, output);
        assert_eq!(found.status.code(), Some(2), "{expected}");
        assert!(stderr(&found).contains(expected), "{}\nexpected {expected}", stderr(&found));
        assert!(files(folder.path()) == before, "{expected}");
        if !output.starts_with("folder") && !output.starts_with("none") {
            let found = run(folder.path(), &["convert", "list", "--all", "--to", to]);
            assert!(found.status.code() == Some(2) && found.stdout.is_empty(), "{expected}");
        }
    }
}

/// A disk that is full after some kilobytes, as the system's limit on files plays it.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_list() {
    let folder = folder(30_000);
    fs::write(folder.path().join("old.bin"), "old").unwrap();
    let before = files(folder.path());
    let binary = program(folder.path()).get_program().to_owned();
    let full = |arguments: &[&str]| {
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(folder.path()).args(["-c", "trap '' XFSZ; ulimit -f 64; exec \"$0\" \"$@\""]).arg(&binary);
        shell.args(["convert", "cameras.txt", "--all", "--to", "colmap-bin"]).args(arguments).output().unwrap()
    };
    for (arguments, place) in [(&["-o", "old.bin"][..], "old.bin: File too large"), (&[], "a temporary file: File too large")] {
        let found = full(arguments);
        assert_eq!(found.status.code(), Some(2));
        assert!(stderr(&found).contains(place) && found.stdout.is_empty(), "{}", stderr(&found));
        assert!(files(folder.path()) == before, "{arguments:?}");
    }
}

#[test]
fn lists_beyond_the_limit_of_other_files_are_converted() {
    let folder = folder(3);
    // Three images with a million points each, and three cameras with long lines.
    let points = "1.25 2.5 -1 ".repeat(2_000_000);
    let image = |i: usize| format!("{i} 1 0 0 0 0 0 {i} {i} {i}.jpg\n{points}\n");
    fs::write(folder.path().join("images.txt"), (1..=3).map(image).collect::<String>()).unwrap();
    assert!(fs::metadata(folder.path().join("images.txt")).unwrap().len() > calibench_cameras::LARGEST_FILE);
    let output = convert(folder.path(), "images.txt", "colmap", "images-cameras.txt");
    good(&output);
    assert!(stderr(&output).contains("warning: lost: the pose: colmap has no place for it (3 cameras)"), "{}", stderr(&output));
    assert!(fs::read_to_string(folder.path().join("images-cameras.txt")).unwrap() == text(3));
    // A list whose target is none is read whole, and may not be as long.
    let output = convert(folder.path(), "images.txt", "opensfm", "c.json");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("images.txt: is larger than 64 MB; expected a camera file. Longer ones are lists of COLMAP's alone"),
        "{}",
        stderr(&output)
    );
}

/// The most memory that was resident while the program ran, bytes.
#[cfg(target_os = "linux")]
fn peak(folder: &Path, arguments: &[&str]) -> u64 {
    let mut child = program(folder).args(arguments).env("RAYON_NUM_THREADS", "2").stderr(Stdio::null()).spawn().unwrap();
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let of = |line: &str| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB")?.trim().parse::<u64>().ok();
        peak = peak.max(1024 * status.lines().find_map(of).unwrap_or(0));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success() && peak > 0);
    peak
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_cameras() {
    const FEW: usize = 20_000;
    const MANY: usize = 200_000;
    let (few, many) = (folder(FEW), folder(MANY));
    for (from, to, output) in [("cameras.txt", "colmap-bin", "cameras.bin"), ("cameras.bin", "colmap", "back.txt")] {
        let [less, more] = [&few, &many].map(|folder| peak(folder.path(), &["convert", from, "--all", "--to", to, "-o", output]));
        let grown = more.saturating_sub(less) as f64 / (MANY - FEW) as f64;
        // 8 bytes for an id and its place, twice that while their list grows; whole lists took 1000.
        assert!(grown < 40.0, "{from}: {grown} bytes a camera, {less} and {more} in all");
    }
}

/// The list of cameras beside a list of images is read, too, and is not written over, under whatever name the images stand.
#[test]
fn the_list_beside_a_list_of_images_is_an_input() {
    let folder = folder(2);
    let image = |i: usize| format!("{i} 1 0 0 0 0.5 0.25 1 {i} {i}.jpg\n\n");
    for name in ["images.txt", "mine.txt"] {
        fs::write(folder.path().join(name), (1..=2).map(image).collect::<String>()).unwrap();
        let before = fs::read(folder.path().join("cameras.txt")).unwrap();
        let output = convert(folder.path(), name, "colmap", "cameras.txt");
        assert!(output.status.code() == Some(2) && stderr(&output).contains("cameras.txt"), "{name}: {}", stderr(&output));
        assert!(fs::read(folder.path().join("cameras.txt")).unwrap() == before);
        good(&convert(folder.path(), name, "colmap", "others.txt"));
    }
}
