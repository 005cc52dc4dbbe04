//! Every kind of mistake in the tables of blocks and of recognition is one diagnostic: place, what was expected, nearest name.

use calibench_measure::Registry;

use crate::parse;

const GOOD: &str = r#"why = "Blocks."
source = "a test"
seed = 1
[camera]
size = [240, 240]
pitch = 27.0
c = 57.5
[testfield]
kind = "coded"
unit = "mm"
[stations]
kind = "stand"
phis = [30, 45]
turns = [0, 90]
rolls = [0, 90]
distance = 4700
[pointing]
sigma = 0.1
whole_pixels = false
[recognition]
classifiers = ["modern"]
[[recognition.images]]
name = "tilted"
images = ["11??"]
[blocks]
c = 57.5
sigma_px = 0.04
[[block]]
name = "sets"
methods = ["pixel"]
targets = ["*-large-disc-*"]
images = ["11??"]
parameters = ["e1", "e2"]
groups = [["11?1"], ["11?2"]]
[[block]]
name = "discs"
corrected_by = "sets"
[blocks.residuals]
blocks = ["sets"]
pairs = [["1111", "1211"]]
[[method]]
name = "pixel"
"#;

/// The diagnostics of [`GOOD`] with `old` replaced by `new`, one a line; empty where it is accepted.
fn diagnostics(old: &str, new: &str) -> String {
    assert_eq!(GOOD.matches(old).count(), 1, "`{old}` stands once");
    let text = GOOD.replace(old, new);
    parse("family/test", "test.toml", &text, &Registry::builtin()).err().map_or_else(String::new, |problems| problems.to_string())
}

#[test]
fn the_good_scenario_is_good() {
    assert_eq!(diagnostics("seed = 1", "seed = 2"), "");
}

#[test]
fn each_mistake_is_one_diagnostic_with_its_place() {
    let cases: &[(&str, &str, &str, &[&str])] = &[
        ("\"e1\", \"e2\"", "\"e1\", \"e22\"", "33:21", &["no parameter is called `e22`", "did you mean `e2`"]),
        ("\"e1\", \"e2\"", "\"e1\", \"e1\"", "33:21", &["`e1` stands twice"]),
        ("methods = [\"pixel\"]", "methods = [\"pixl\"]", "30:12", &["no method is called `pixl`", "did you mean `pixel`"]),
        ("*-large-disc-*", "*-lagre-disc-*", "31:12", &["no target is called `*-lagre-disc-*`"]),
        ("*-large-disc-*", "[", "31:12", &["`[` is no pattern"]),
        ("\nimages = [\"11??\"]\nparameters", "\nimages = [\"19??\"]\nparameters", "32:11", &["no station is called `19??`"]),
        ("\nimages = [\"11??\"]\nparameters", "\nimages = [\"1111\"]\nparameters", "32:10", &["at least 2 images"]),
        ("\ngroups", "\neach = [[\"11?1\"]]\ngroups", "34:8", &["`each` beside `images`", "expected one of them"]),
        ("[\"11?2\"]]", "[\"11?2\", \"1111\"]]", "34:21", &["is in two groups"]),
        ("[[\"11?1\"], [\"11?2\"]]", "[[\"11?1\"]]", "34:10", &["image `1112` is in no group"]),
        ("name = \"discs\"", "name = \"sets\"", "36:8", &["the name `sets` is taken"]),
        ("name = \"discs\"", "name = \"residuals\"", "36:8", &["the name `residuals` is taken"]),
        ("corrected_by = \"sets\"", "corrected_by = \"stes\"", "37:16", &["no earlier block is called `stes`", "did you mean `sets`"]),
        ("corrected_by = \"sets\"", "corrected_by = \"discs\"", "37:16", &["no earlier block is called `discs`"]),
        ("corrected_by = \"sets\"", "corrected_by = \"sets\"\nparameters = [\"e1\"]", "37:16", &["`corrected_by` beside `parameters`"]),
        ("\"1111\", \"1211\"", "\"1111\", \"1911\"", "40:19", &["no station is called `1911`", "did you mean"]),
        ("pairs = [[\"1111\", \"1211\"]]", "pairs = []", "40:9", &["`pairs` is empty", "at least one"]),
        ("blocks = [\"sets\"]", "blocks = [\"sest\"]", "39:11", &["no block is called `sest`", "did you mean `sets`"]),
        ("blocks = [\"sets\"]", "blocks = []", "39:10", &["`blocks` is empty"]),
        ("methods = [\"pixel\"]", "methods = []", "30:11", &["`methods` is empty"]),
        ("targets = [\"*-large-disc-*\"]", "targets = []", "31:11", &["`targets` is empty"]),
        ("corrected_by = \"sets\"", "each = []", "37:8", &["`each` is empty"]),
        ("name = \"tilted\"\nimages = [\"11??\"]", "name = \"tilted\"\nimages = []", "24:10", &["`images` is empty"]),
        ("sigma_px = 0.04", "sigma_pxx = 0.04", "27:1", &["unknown key `sigma_pxx`", "did you mean `sigma_px`"]),
        ("[\"modern\"]", "[\"modren\"]", "21:16", &["no classifier is called `modren`", "did you mean `modern`"]),
        ("[\"modern\"]", "[]", "21:15", &["`classifiers` is empty", "`modern`, `contours` or others"]),
        ("[\"modern\"]", "[\"modern\", \"modern\"]", "21:26", &["`modern` stands twice"]),
        ("name = \"tilted\"\nimages = [\"11??\"]", "name = \"tilted\"\nimages = [\"19??\"]", "24:11", &["no station is called `19??`"]),
    ];
    let wrong: Vec<String> = cases.iter().filter_map(|(old, new, place, parts)| wrong(&diagnostics(old, new), new, place, parts)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_field_without_codes_is_not_recognised() {
    let text = GOOD.replace("kind = \"coded\"\nunit = \"mm\"", "kind = \"chessboard\"\nunit = \"mm\"\nrows = 6\ncolumns = 9\nsquare = 100");
    let text = text.replace("targets = [\"*-large-disc-*\"]\n", "");
    let found = parse("family/test", "test.toml", &text, &Registry::builtin()).err().unwrap().to_string();
    let expected =
        "test.toml:23:2: [recognition] needs a coded field: the testfield's sheet has no square grid of lines: expected a coded field";
    assert_eq!(found, expected);
}

/// What is wrong with the diagnostics `found`, if anything.
fn wrong(found: &str, new: &str, place: &str, parts: &[&str]) -> Option<String> {
    let one = found.lines().count() == 1 || place.is_empty();
    let good =
        one && found.lines().any(|line| line.starts_with(&format!("test.toml:{place}")) && parts.iter().all(|part| line.contains(part)));
    (!good).then(|| format!("{new:?}: expected {place} {parts:?}, found:\n{found}"))
}
