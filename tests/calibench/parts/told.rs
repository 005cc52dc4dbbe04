//! What methods from outside tell of the parts of a run: together it is what they tell of the whole, and nothing of it keeps parts from being put together.

use std::path::Path;

use super::{good, part, same};
use crate::plugins::with_plugins;
use crate::project::{root, stderr};

/// Declines some points with words that depend on the image: more in all than are kept.
const TALKER: &str = r#"import json, sys
stream = sys.stdin.buffer
stream.readline()
print(json.dumps({"version": "1"}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    some = sum(stream.read(asked["bytes"])) % 37
    reasons = [f"image {some:02} says {place}" if place < 3 else None for place in range(len(asked["starts"]))]
    xy = [None if why else start for why, start in zip(reasons, asked["starts"])]
    print(json.dumps({"image": asked["image"], "xy": xy, "reasons": reasons}), flush=True)
"#;

const PLUGINS: &str = r#"[[plugin]]
name = "talker"
command = ["python3", "talker.py"]

[[plugin]]
name = "start_folder"
command = ["sh", "start_folder.sh"]
mode = "folder"
version = "1"
"#;

const METHODS: [&str; 6] = ["-m", "talker", "-m", "recorded", "-m", "start_folder"];

/// A project with methods that tell something, among them a file without an image of trial 1 and without a point of trial 3.
fn project() -> tempfile::TempDir {
    let folder = with_plugins(&[("talker.py", TALKER), ("plugins.toml", PLUGINS)]);
    let methods = folder.path().join("methods");
    for name in ["recorded.toml", "start_folder.sh"] {
        std::fs::copy(root().join("examples/plugins").join(name), methods.join(name)).unwrap();
    }
    good(folder.path(), &["render", "corners/noise", "--trials", "4", "-o", "pictures", "-q"]);
    let photos: Vec<String> = (0..4).map(|trial| format!("pictures/image-trial-{trial:04}.png")).collect();
    let measure = ["measure", "--points", "pictures/starts.csv", "-m", "pixel", "-o", "methods/mine.csv", "-q"];
    good(folder.path(), &[&measure[..], &photos.iter().map(String::as_str).collect::<Vec<_>>()].concat());
    let text = std::fs::read_to_string(methods.join("mine.csv")).unwrap();
    let last = text.lines().rfind(|line| line.starts_with("image-trial-0003")).unwrap();
    let kept = text.lines().filter(|line| !line.starts_with("image-trial-0001") && *line != last);
    std::fs::write(methods.join("mine.csv"), kept.map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    folder
}

fn description(project: &Path, records: &str) -> String {
    std::fs::read_to_string(project.join(records).join("corners/noise/scenario.json")).unwrap()
}

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn parts_tell_together_what_the_whole_run_tells() {
    let folder = project();
    let project = folder.path();
    let run = |trials: &str| good(project, &[&["run", "corners/noise", "-q", "--trials", trials][..], &METHODS].concat());
    for (trials, parts) in [("6", 3), ("4", 6)] {
        run(trials);
        let whole = description(project, "records");
        let talks = whole.matches("**`talker`:** image").count();
        assert!(talks > 0 && whole.matches("**`talker`:**").count() <= 8, "{whole}");
        let missing = if trials == "6" { "no row of 3 of 6 images" } else { "no row of 1 of 4 images" };
        for told in [missing, "in trial 1 for one", "no row of 1 targets in images that it has"] {
            assert!(whole.contains(told), "{told}\n{whole}");
        }
        for number in (1..=parts).rev() {
            let said = part(project, &["corners/noise"], &format!("{number}/{parts}"), &[&METHODS[..], &["--trials", trials]].concat());
            assert!(number > 2 || said.contains("talker: image"), "a part says what its own trials tell: {said}");
        }
        let merged = good(project, &["merge", "parts", "-o", "merged"]);
        assert!(stderr(&merged).contains(&format!("{trials} trials from {parts} parts")), "{}", stderr(&merged));
        same(&project.join("records"), &project.join("merged"));
        for made in ["parts", "records", "merged"] {
            std::fs::remove_dir_all(project.join(made)).unwrap();
        }
    }
}
