//! Programs that fail, at every image or at some: what is recorded of an image depends on the image alone, and not on which others the same process, thread or
//! part was asked for.

use super::{good, part, same};
use crate::plugins::with_plugins;
use crate::project::{stderr, table};

/// Fails in the way that its parameter says; about half of the images have an odd sum.
const SCRIPT: &str = r#"import json, sys, time
stream = sys.stdin.buffer
way = json.loads(stream.readline())["parameters"]["way"]
print(json.dumps({"version": "1"}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    odd = sum(stream.read(asked["bytes"])) % 2
    if way == 0: raise ValueError("boom")
    if way == 1 and odd: sys.exit(3)
    if way == 2 and odd: print("garbage", flush=True)
    if way == 3 and odd: print(json.dumps({"image": 0, "xy": asked["starts"]}), flush=True)
    if way == 4: time.sleep(60)
    if way == 5 and odd: time.sleep(60)
    print(json.dumps({"image": asked["image"], "xy": asked["starts"]}), flush=True)
"#;

const TOML: &str = r#"[[plugin]]
name = "failing"
command = ["python3", "failing.py"]
parameters = { way = { default = 9, min = 0, max = 9 } }
seconds = 1.0
"#;

/// Of each way: how many trials, in how many parts, the reason that its rows have, whether all have it, and what is told.
const WAYS: [(u32, &str, u32, &str, bool, &str); 6] = [
    (0, "9", 4, "ended", true, "ValueError: boom"),
    (1, "9", 4, "ended", false, "exit status: 3"),
    (2, "9", 4, "malformed", false, "expected a line of JSON"),
    (3, "9", 4, "malformed", false, "found another"),
    // No part is long enough to give it up.
    (4, "8", 2, "too_slow", true, "asked no more"),
    // More are too slow than it takes to give up who never is in time.
    (5, "16", 3, "too_slow", false, "no answer within 1 s"),
];

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn one_thread_two_and_parts_give_the_same_bytes() {
    let folder = with_plugins(&[("failing.toml", TOML), ("failing.py", SCRIPT)]);
    let project = folder.path();
    for (way, trials, parts, reason, all, told) in WAYS {
        let method = format!("failing:way={way}");
        let options = ["-q", "--trials", trials, "-m", "pixel", "-m", &method];
        let whole = |threads: &str| good(project, &[&["run", "corners/noise", "--threads", threads][..], &options].concat());
        whole("1");
        std::fs::rename(project.join("records"), project.join("one")).unwrap();
        let said = stderr(&whole("2"));
        same(&project.join("one"), &project.join("records"));
        let records = table(&project.join("one/corners/noise/records.csv.gz"));
        let of_method = records.lines().filter(|line| line.contains(&method)).collect::<Vec<_>>();
        let failed = of_method.iter().filter(|line| line.contains(&format!("rejected,{reason}"))).count();
        assert!(failed > 0 && (failed == of_method.len()) == all, "way {way}: {failed} of {}", of_method.len());
        // Eight points an image.
        assert!(way != 5 || failed > 8 * 5, "{failed}");
        for number in (1..=parts).rev() {
            part(project, &["corners/noise"], &format!("{number}/{parts}"), &options);
        }
        let merged = stderr(&good(project, &["merge", "-q", "parts", "-o", "merged"]));
        same(&project.join("records"), &project.join("merged"));
        let description = std::fs::read_to_string(project.join("merged/corners/noise/scenario.json")).unwrap();
        assert!(description.contains(told), "way {way}: {description}");
        let doubts = |said: &str| said.lines().filter(|line| line.starts_with("failing: ")).map(str::to_owned).collect::<Vec<_>>();
        assert!(!doubts(&said).is_empty() && doubts(&said) == doubts(&merged), "way {way}: {said}\n{merged}");
        assert_eq!(merged.contains("time decides what is too slow"), reason == "too_slow", "{merged}");
        for made in ["one", "records", "parts", "merged"] {
            std::fs::remove_dir_all(project.join(made)).unwrap();
        }
    }
}
