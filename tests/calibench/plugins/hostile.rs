//! Programs that do not do as they should: none ends or delays a run, and the rows of other methods stay as they are.

use std::time::{Duration, Instant};

use super::{notes, rows, with_plugins};
use crate::project::{run, stderr};

/// Misbehaves in the way that its parameter says.
const SCRIPT: &str = r#"
import json, os, signal, subprocess, sys, time
stream = sys.stdin.buffer
def say(text, end="\n"):
    sys.stdout.write(text + end)
    sys.stdout.flush()
way = json.loads(stream.readline())["parameters"]["way"]
if way == 1: sys.exit(7)
if way == 2: say("hello"), time.sleep(60)
if way == 3: say('{"error": "no licence"}'), time.sleep(60)
say('{"version": "1"}')
while line := stream.readline():
    asked = json.loads(line)
    n = len(asked["starts"])
    if way == 16: say(json.dumps({"image": asked["image"], "xy": asked["starts"]})); time.sleep(60)
    if way == 25: os.close(0); time.sleep(60)
    stream.read(asked["bytes"])
    if way == 0: time.sleep(60)
    if way == 4: say("\x1b[2Jgarbage \u202e <b>")
    if way == 5: say('{"xy": [[1, ', ""); sys.exit(0)
    if way == 6: say('{"xy": [[1, ', ""); time.sleep(60)
    if way == 7: say("")
    if way == 8: say(json.dumps({"image": asked["image"], "xy": asked["starts"][:-1]}))
    if way == 9: say(json.dumps({"image": asked["image"], "xy": asked["starts"] * 10}))
    if way == 10: say(json.dumps({"image": asked["image"], "xy": [[float("nan")] * 2] * n}))
    if way == 11: say(json.dumps({"image": asked["image"], "xy": [[float("inf"), 1]] * n}))
    if way == 12: say(json.dumps({"image": asked["image"], "xy": [[1]] * n}))
    if way == 13: say(json.dumps({"image": asked["image"], "xy": [["1", "2"]] * n}))
    if way == 14: say(json.dumps({"image": asked["image"], "xy": asked["starts"], "cov": [[1, 5, 1]] * n}))
    if way == 15: say(json.dumps({"image": asked["image"], "xy": asked["starts"]})); say('{"image": 1, "xy": []}')
    if way == 17:
        while True: sys.stdout.write("x" * 65536)
    if way == 18: sys.stderr.write("noise\n" * 200000); say(json.dumps({"image": asked["image"], "xy": asked["starts"]}))
    if way == 19: hold = bytearray(4 * 10**9)
    if way == 20: raise ValueError("boom")
    if way == 21: subprocess.Popen(["sleep", "31536123"]); sys.exit(0)
    if way == 22: say('{"error": "no corner in 3 images"}')
    if way == 23: os.kill(os.getpid(), signal.SIGKILL)
    if way == 24: sys.stdout.buffer.write(b"\xff\xfe\n"); sys.stdout.flush()
    if way == 26: say("[" * 5000)
    if way == 27: os.kill(os.getpid(), signal.SIGSTOP)
"#;

const TOML: &str = r#"
[[plugin]]
name = "hostile"
command = ["python3", "hostile.py"]
parameters = { way = { default = 0, min = 0, max = 99 } }
seconds = 1.0
memory = "1 GB"
"#;

/// A start may lie too far off to count.
const MEASURED: &str = "measured,";

/// Of each way: what its rows say, and what is told.
const WAYS: [(u32, &str, &str); 28] = [
    (0, "rejected,too_slow", "no answer within 1 s"),
    (1, "unavailable,", "exit status: 7"),
    (2, "unavailable,", "expected a line of JSON"),
    (3, "unavailable,", "no licence"),
    (4, "rejected,malformed", "garbage"),
    (5, "rejected,ended", "exit status: 0"),
    (6, "rejected,too_slow", "no answer"),
    (7, "rejected,malformed", "an empty line"),
    (8, "rejected,malformed", "asked for were"),
    (9, "rejected,malformed", "asked for were"),
    (10, "rejected,declined", ""),
    (11, "rejected,malformed", "infinite"),
    (12, "rejected,malformed", "not [x, y]"),
    (13, "rejected,malformed", "expected a line of JSON"),
    (14, "rejected,malformed", "covariance"),
    (15, "rejected,malformed", ""),
    // A small image fits into the pipe: whether it was read shows at the next.
    (16, "rejected,too_slow", "no answer"),
    (17, "rejected,malformed", "longer than"),
    (18, MEASURED, ""),
    (19, "rejected,ended", "MemoryError"),
    (20, "rejected,ended", "ValueError: boom"),
    (21, "rejected,", ""),
    (22, "rejected,raised", "no corner in 3 images"),
    (23, "rejected,ended", "signal: 9"),
    (24, "rejected,malformed", "no UTF-8"),
    (25, "rejected,too_slow", "no answer"),
    (26, "rejected,malformed", "invalid type"),
    (27, "rejected,too_slow", "no answer"),
];

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn none_hangs_ends_the_run_or_changes_another_methods_rows() {
    let project = with_plugins(&[("hostile.toml", TOML), ("hostile.py", SCRIPT)]);
    let measure = |methods: &[&str]| {
        let output = run(project.path(), &[&["run", "corners/noise", "--trials", "2", "-q", "-m", "forstner"][..], methods].concat());
        assert!(output.status.success(), "{methods:?}: {}", stderr(&output));
        (rows(project.path(), "forstner"), stderr(&output))
    };
    let (alone, _) = measure(&[]);
    for (way, expected, told) in WAYS {
        let started = Instant::now();
        // The first image is answered; on one thread the second finds the same process.
        let late = [15, 16].contains(&way);
        let threads = if late { "1" } else { "2" };
        let (beside, said) = measure(&["--threads", threads, "-m", &format!("hostile:way={way}")]);
        assert!(started.elapsed() < Duration::from_secs(20), "way {way}: {:?}", started.elapsed());
        assert!(beside == alone, "way {way} changes another method's rows");
        let own = rows(project.path(), "hostile");
        assert!(!own.is_empty(), "way {way}");
        let right = own.iter().filter(|row| row.contains(expected) || (expected == MEASURED && row.contains(",lost,"))).count();
        assert!(right == if late { own.len() / 2 } else { own.len() }, "way {way}: expected {expected}, found {own:?}");
        let notes = notes(project.path());
        let everything = format!("{notes}{said}{}", crate::project::table(&project.path().join("records/corners/noise/records.csv.gz")));
        assert!(everything.contains(told), "way {way}: {told}\n{notes}");
        assert!(!everything.contains('\u{1b}') && !everything.contains('\u{202e}'), "way {way} commands the terminal");
    }
    assert!(!is_running("31536123"), "what a program started is ended with it");
}

/// Whether a process with this argument runs.
pub fn is_running(argument: &str) -> bool {
    let lines = std::fs::read_dir("/proc").into_iter().flatten().filter_map(|entry| std::fs::read(entry.ok()?.path().join("cmdline")).ok());
    lines.into_iter().any(|line| line.split(|byte| *byte == 0).any(|word| word == argument.as_bytes()))
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn who_is_never_in_time_is_asked_no_more() {
    let project = with_plugins(&[("hostile.toml", TOML), ("hostile.py", SCRIPT)]);
    let started = Instant::now();
    // Another one of the same program does not wait in its place.
    let methods = ["-m", "hostile:way=0", "-m", "hostile:way=18"];
    let output = run(project.path(), &[&["run", "corners/noise", "--trials", "30", "-q", "--threads", "1"][..], &methods].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(started.elapsed() < Duration::from_secs(20), "30 s where it is asked for every image: {:?}", started.elapsed());
    let all = rows(project.path(), "hostile");
    let slow = all.iter().filter(|row| row.contains("rejected,too_slow")).count();
    assert_eq!((2 * slow, all.iter().any(|row| row.contains(MEASURED))), (all.len(), true));
    assert!(notes(project.path()).contains("asked no more"));
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn plugin_test_says_what_fails() {
    let project = with_plugins(&[("hostile.py", SCRIPT)]);
    for (way, expected) in
        [(1, "FAILED  it starts and says its version: it ended: exit status: 7"), (8, "asked for were"), (20, "ValueError: boom")]
    {
        let path = project.path().join("methods/hostile.toml");
        std::fs::write(&path, TOML.replace("default = 0", &format!("default = {way}"))).unwrap();
        let output = run(project.path(), &["plugin", "test", "methods/hostile.toml"]);
        let text = crate::project::stdout(&output);
        assert_eq!(output.status.code(), Some(1), "way {way}: {text}");
        assert!(text.contains(expected), "way {way}: {text}");
    }
}
