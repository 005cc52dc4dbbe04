//! Programs that are asked by files, and those of them that do not do as they should.

use std::time::{Duration, Instant};

use super::hostile::is_running;
use super::{notes, rows, versions, with_examples, with_plugins};
use crate::project::{run, stderr, table};

/// Misbehaves in the way that its parameter says.
const SCRIPT: &str = r#"
import os, resource, signal, subprocess, sys, time
way = int(os.environ["CALIBENCH_WAY"])
if way == 0: time.sleep(60)
if way == 1: sys.exit("no licence")
if way == 2: sys.exit()
if way == 13: hold = bytearray(4 * 10**9)
if way == 18: os.close(1); os.close(2); time.sleep(60)
if way == 21: os.kill(os.getpid(), signal.SIGSTOP)
if way == 22: os.kill(os.getpid(), signal.SIGKILL)
if way == 14: os.symlink("points.csv", "measured.csv"); sys.exit()
if way == 15: os.mkfifo("measured.csv"); sys.exit()
if way == 17: os.mkdir("measured.csv"); sys.exit()
assert sorted(os.listdir(".")) == ["images", "points.csv"] and os.listdir("images") == ["0001.png"]
rows = [line.split(",") for line in open("points.csv").read().splitlines()[1:]]
out = open("measured.csv", "w")
if way == 3: out.write("\x1b[2Jgarbage \u202e <b>"); sys.exit()
out.write("image,target,x,y,sxx,sxy,syy,status,reason\n")
for place, (image, target, x, y) in enumerate(row[:4] for row in rows):
    assert target == str(place + 1)
    cov, end = ",,", "measured,"
    if way == 4 and place == 2: out.write("0001.png,3,1.2"); break
    if way == 7 and place == 2: x = "inf"
    if way == 8: cov = "1,5,1"
    if way == 9: image = "left.png"
    if way == 10: break
    if way == 16: target = "0" * 10**6 + target
    if way == 20: x, y, end = "", "", "rejected,no corner here"
    if way == 23 and place == 2: continue
    if way == 24: x, y = y, x
    out.write(",".join([image, target, x, y, cov, end]) + "\n")
if way == 5: out.write("0001.png,%d,1,1,,,,measured,\n" % (len(rows) + 1))
if way == 6: out.write(",".join(["0001.png", "1", "1", "1", ",,", "measured,"]) + "\n")
out.close()
if way == 11: sys.exit(1)
if way == 12: subprocess.Popen(["sleep", "31536124"])
if way == 19: sys.stdout.write("noise\n" * 200000)
if way == 25:
    done = []
    def trying(name, act):
        try: act(); done.append(name)
        except OSError: pass
    trying("scenario", lambda: open("@project@/scenarios/corners/noise.toml").read())
    trying("write", lambda: open("@project@/methods/left", "w").write("x"))
    trying("link", lambda: os.link("@project@/scenarios/corners/noise.toml", "linked"))
    sys.exit("did " + (" ".join(done) or "nothing"))
"#;

const TOML: &str = r#"
[[plugin]]
name = "hostile"
command = ["python3", "hostile.py"]
mode = "folder"
version = "3"
parameters = { way = { default = 0, min = 0, max = 99 } }
seconds = 4.0
memory = "1 GB"
"#;

/// Its starts are returned; one may lie too far off to count.
const MEASURED: &str = "measured,";

/// Of each way: what its rows say, and what is told.
const WAYS: [(u32, &str, &str); 24] = [
    (0, "rejected,too_slow", "did not end within 4 s"),
    (1, "rejected,ended", "exit status: 1: no licence"),
    (2, "rejected,malformed", "wrote no measured.csv"),
    (3, "rejected,malformed", "measured.csv"),
    (4, "rejected,malformed", "measured.csv:4: expected 9 cells"),
    (5, "rejected,malformed", "column `target`: expected one of 1 to 8"),
    (6, "rejected,malformed", "is already on line 2"),
    (7, "rejected,malformed", "measured.csv:4, column `x`: expected a finite number"),
    (8, "rejected,malformed", "no covariance"),
    (9, "rejected,malformed", "expected `0001.png`, found `left.png`"),
    (10, "rejected,declined", ""),
    (11, "rejected,ended", "exit status: 1"),
    (12, MEASURED, ""),
    (13, "rejected,ended", "MemoryError"),
    (14, "rejected,malformed", "expected a file"),
    (15, "rejected,malformed", "is no file"),
    (16, "rejected,malformed", "longer than"),
    (17, "rejected,malformed", "is no file"),
    (18, "rejected,too_slow", "did not end"),
    (19, MEASURED, ""),
    (20, "rejected,declined", "no corner here"),
    (21, "rejected,too_slow", "did not end"),
    (22, "rejected,ended", "signal: 9"),
    (25, "rejected,ended", "did nothing"),
];

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn none_hangs_ends_the_run_or_changes_another_methods_rows() {
    let project = with_plugins(&[("hostile.toml", TOML)]);
    let script = SCRIPT.replace("@project@", &project.path().display().to_string());
    std::fs::write(project.path().join("methods/hostile.py"), script).unwrap();
    let measure = |methods: &[&str]| {
        let output = run(project.path(), &[&["run", "corners/noise", "--trials", "2", "-q", "-m", "pixel"][..], methods].concat());
        assert!(output.status.success(), "{methods:?}: {}", stderr(&output));
        (rows(project.path(), "pixel"), stderr(&output))
    };
    let (alone, _) = measure(&[]);
    for (way, expected, told) in WAYS {
        let started = Instant::now();
        let (beside, said) = measure(&["--threads", "2", "-m", &format!("hostile:way={way}")]);
        assert!(started.elapsed() < Duration::from_secs(40), "way {way}: {:?}", started.elapsed());
        assert!(beside == alone, "way {way} changes another method's rows");
        let own = rows(project.path(), "hostile");
        let right = |row: &String| row.contains(expected) || (expected == MEASURED && row.contains(",lost,"));
        assert!(own.len() == 16 && own.iter().all(right), "way {way}: expected {expected}, found {own:?}\n{said}");
        if expected == MEASURED {
            assert!(own == alone, "way {way}: its starts");
        }
        let everything = format!("{}{said}{}", notes(project.path()), table(&project.path().join("records/corners/noise/records.csv.gz")));
        let unkept = way == 25 && everything.contains("not kept from");
        assert!(unkept || everything.contains(told), "way {way}: {told}\n{said}");
        assert!(!everything.contains('\u{1b}') && !everything.contains('\u{202e}'), "way {way} commands the terminal");
    }
    assert!(!is_running("31536124"), "what a program started is ended with it");
    // What it leaves out it declines; what it swaps shows.
    measure(&["-m", "hostile:way=23"]);
    let own = rows(project.path(), "hostile");
    let left_out = own.iter().zip(&alone).filter(|(a, b)| a != b).map(|(a, _)| a).collect::<Vec<_>>();
    assert!(left_out.len() == 2 && left_out.iter().all(|row| row.contains("rejected,declined")), "{left_out:?}");
    measure(&["-m", "hostile:way=24"]);
    // A corner on the diagonal is none the worse.
    assert!(rows(project.path(), "hostile").iter().zip(&alone).filter(|(a, b)| a != b).count() > 12);
    assert!(versions(project.path(), "hostile")[0].starts_with("3 ("));
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn its_images_are_of_the_depth_that_it_asks_for_and_whole_images_have_no_points() {
    let script = "import os, sys\n\
        name = os.listdir('images')[0]\n\
        head = open('images/' + name, 'rb').read(32)\n\
        said = 'tiff' if head[:3] == b'II*' else 'png%d' % head[24]\n\
        open('measured.csv', 'w').write('image,target,x,y\\n%s,a,31.5,30.25\\n%s,b,5000,3\\n' % (name, name))\n\
        if os.path.exists('points.csv'): sys.exit('points')\n\
        if said != sys.argv[1]: sys.exit(said)\n";
    for (image, expected) in [("gray8", "png8"), ("gray16", "png16"), ("gray32f", "tiff")] {
        let toml = format!(
            "[[plugin]]\nname = \"whole\"\ncommand = [\"python3\", \"whole.py\", \"{expected}\"]\nmode = \"folder\"\nstarts = \"none\"\nimage = \"{image}\"\n\
            [[plugin]]\nname = \"absent\"\ncommand = [\"no-such-program\"]\nmode = \"folder\"\n"
        );
        let project = with_plugins(&[("whole.toml", &toml), ("whole.py", script)]);
        let output = run(project.path(), &["run", "corners/noise", "--trials", "1", "-q", "-m", "whole", "-m", "absent"]);
        assert!(output.status.success(), "{image}: {}", stderr(&output));
        let own = rows(project.path(), "whole");
        assert!(own[0].contains(",31.5,30.25,") && own[1..].iter().all(|row| row.contains("not_detected")), "{own:?}");
        assert!(rows(project.path(), "absent")[0].contains("unavailable"), "{:?}", rows(project.path(), "absent"));
    }
}

/// On one thread and on two.
#[test]
fn the_example_returns_its_starts_in_their_order() {
    let project = with_examples();
    let once = |threads: &str| {
        let arguments = ["run", "corners/noise", "--trials", "3", "-q", "--threads", threads, "-m", "pixel", "-m", "start_folder"];
        assert!(run(project.path(), &arguments).status.success());
        (rows(project.path(), "pixel"), rows(project.path(), "start_folder"))
    };
    let (one, two) = (once("1"), once("2"));
    assert!(one == two && one.0 == one.1 && one.0.len() == 24);
}
