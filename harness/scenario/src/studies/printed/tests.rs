//! Every kind of mistake in `[printed]` is one diagnostic with its place; what is read is what was written.

use calibench_measure::Registry;

use super::Printed;
use crate::{StudyPlan, Subject, parse};

const GOOD: &str = r#"why = "Print."
source = "a test"
seed = 1
[printed]
width = 4000
height = 3000
pitch = 5.0
distance = 10
unit = "m"
[[printed.pixel]]
name = "of the width"
mm = 10.0
times = 2.0
pixels = 4000
[[printed.camera]]
name = "none"
c = 20.0
[[printed.camera]]
name = "own"
tool = "photoscan"
c = 20.0
x0 = 0.1
k = [-4e-4, 1e-6, 0]
[[printed.grid]]
name = "bent"
camera = "own"
k = [4e-4, 0, 0]
[[printed.point]]
name = "A"
at = [0, 1, 2]
errors = { none = [0.1, 0.2, 0.3], own = [0.01, 0.02, 0.03] }
[[printed.point]]
name = "B"
at = [0, 2, 2]
errors = { none = [0.1, 0.2, 0.3], own = [0, 0, 0] }
[[printed.point]]
name = "C"
at = [0, 2, 1]
errors = { none = [0.1, 0.2, 0.3], own = [0, 0, 0.0] }
[printed.network]
truth = "own"
stations = 4
from = [2, 0, 0]
up = [1, 0, 1]
fitted = ["none"]
distances = [10]
bases = [3]
within = 0.1
[[printed.variant]]
name = "other"
camera = "own"
powers = [2, 4, 4]
k = [1e-4, 1e-6, 1e-8]
"#;

fn read(text: &str) -> Result<Printed, String> {
    let scenario = parse("family/test", "test.toml", text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
    assert!(scenario.is_deterministic() && scenario.methods.is_empty());
    match scenario.subject {
        Subject::Printed(printed) => Ok(*printed),
        _ => panic!("printed figures"),
    }
}

/// The diagnostics of [`GOOD`] with `old` replaced by `new`.
fn diagnostics(old: &str, new: &str) -> String {
    assert_eq!(GOOD.matches(old).count(), 1, "`{old}` stands once");
    read(&GOOD.replace(old, new)).err().unwrap_or_default()
}

#[test]
fn what_is_written_is_read() {
    let printed = read(GOOD).unwrap();
    assert_eq!(printed.sets(), ["sensor", "none", "own", "network", "other"]);
    assert_eq!(printed.pitches, [("of the width".to_owned(), 5.0)], "20 mm / 4000");
    assert_eq!(printed.points[0].errors, [[0.1, 0.2, 0.3], [0.01, 0.02, 0.03]]);
    let grid = &printed.grids[0];
    assert_eq!((grid.name.as_str(), grid.camera.k, grid.camera.x0), ("bent", [4e-4, 0.0, 0.0], 0.1), "the rest is that of the camera");
    let network = printed.network.unwrap();
    assert_eq!((network.truth, network.stations, network.fitted, network.heights), (1, 4, vec![0], vec![0.0]));
    assert!((network.from.x - 1.0).abs() < 1e-15 && (network.up.z - 1.0).abs() < 1e-15 && network.up.x.abs() < 1e-15, "unit and across");
    // kc / c^4 in place of kc / c^6 is c^2 = 400 times as large.
    assert_eq!((printed.variants[0].turned_truth, network.turned_truth), (None, super::Turned::default()));
    let k = printed.variants[0].camera.k;
    assert!((k[0] - 1e-4).abs() < 1e-18 && (k[1] - 1e-6).abs() < 1e-20 && (k[2] - 4e-6).abs() < 1e-18, "{k:?}");
}

#[test]
fn a_mistake_is_told_by_line_and_name() {
    for (old, new, place, said) in [
        (
            "{ none = [0.1, 0.2, 0.3], own = [0.01",
            "{ none = [0.1, 0.2, 0.3], nome = [0, 0, 0], own = [0.01",
            "31:36",
            "no camera is called `nome` (did you mean `none`?)",
        ),
        (", own = [0, 0, 0] }", " }", "35:10", "point `B` has no errors of own: expected X, Y, Z of every camera"),
        ("stations = 4", "stations = 1", "42:12", "from 2 to 1000, found 1"),
        ("truth = \"own\"", "truth = \"onw\"", "41:9", "no camera is called `onw`"),
        ("truth = \"own\"", "truth = \"none\"", "41:9", "`none` has no tool"),
        ("k = [-4e-4, 1e-6, 0]", "k = [-2e-3, 0, 0]", "41:9", "`own` folds over inside the frame"),
        ("fitted = [\"none\"]", "fitted = []", "45:10", "`fitted` is empty"),
        ("fitted = [\"none\"]", "fitted = [\"one\"]", "45:11", "no camera is called `one`"),
        ("up = [1, 0, 1]", "up = [-3, 0, 0]", "44:6", "`up` lies along `from`"),
        ("from = [2, 0, 0]", "from = [0, 0, 0]", "43:8", "`from` is no direction"),
        ("bases = [3]", "bases = []", "47:9", "`bases` is empty"),
        ("bases = [3]", "bases = [3]\nheights = []", "48:11", "`heights` is empty"),
        ("stations = 4", "turned_truth = [\"p3\"]\nstations = 4", "42:17", "`p3` has no sign to turn"),
        ("powers = [2, 4, 4]", "turned_columns = [\"y0\"]", "50:8", "expected `refit = true`"),
        ("tool = \"photoscan\"", "tool = \"photscan\"", "20:8", "did you mean `photoscan`?"),
        ("camera = \"own\"\nk = [4e-4, 0, 0]", "camera = \"won\"\nk = [4e-4, 0, 0]", "26:10", "no camera is called `won`"),
        ("k = [4e-4, 0, 0]", "k = [4e-3, 0, 0]", "25:8", "`bent` folds over inside the frame"),
        ("k = [4e-4, 0, 0]", "k = [0, 0, 0]", "25:8", "`bent` has no distortion to show"),
        ("unit = \"m\"", "unit = \"inch\"", "9:8", "no unit is called `inch`"),
        ("name = \"other\"", "name = \"network\"", "50:8", "stands twice"),
        ("name = \"C\"", "name = \"A\"", "37:8", "`A` stands twice"),
        ("[0.01, 0.02, 0.03]", "[-0.01, 0.02, 0.03]", "31:42", "expected a number from 0"),
        ("seed = 1", "seed = 1\ntrials = 2", "4:10", "2 trials of a scenario in which nothing is random"),
    ] {
        let found = diagnostics(old, new);
        let at = format!("test.toml:{place}: ");
        assert!(found.contains(said) && found.starts_with(&at), "{new}: {found}");
        assert_eq!(found.lines().count(), 1, "{found}");
    }
}

#[test]
fn too_few_points_determine_no_network_and_without_one_nothing_is_fitted_again() {
    let third = GOOD.find("[[printed.point]]\nname = \"C\"").unwrap();
    let network = GOOD.find("[printed.network]").unwrap();
    let variant = GOOD.find("[[printed.variant]]").unwrap();
    let two = format!("{}{}", &GOOD[..third], &GOOD[network..]);
    assert!(read(&two).unwrap_err().contains("a network takes 3 check points at least, found 2"));
    let none = format!("{}{}refit = true\n", &GOOD[..network], &GOOD[variant..]);
    assert!(read(&none).unwrap_err().contains("`other` is to be fitted again, and there is no network"));
    let method = format!("{GOOD}[[method]]\nname = \"pixel\"\n");
    assert!(read(&method).unwrap_err().contains("beside [printed]: nothing is measured there"));
}
