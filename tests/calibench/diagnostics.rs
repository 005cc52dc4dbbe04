//! Every kind of mistake in a scenario is one clear diagnostic: place, what was expected, what to do.

use calibench_diagnostics::Problems;
use calibench_measure::Registry;
use calibench_scenario::parse;

const GOOD: &str = r#"why = "To see what is wrong."
source = "a test"
seed = 1

[scene]
width = 100
height = 80
background = 0.8

[[scene.polygon]]
id = "a"
grey = 0.2
vertices = [[20, 20], [60, 20], [60, 50], [20, 50]]

[[scene.target]]
id = "1"
kind = "corner"
at = [20, 20]
start = [21, 20]

[[method]]
name = "forstner"
window = 11
"#;

fn problems(text: &str) -> Problems {
    match parse("family/test", "test.toml", text, &Registry::builtin()) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(problems) => problems,
    }
}

/// The diagnostics of [`GOOD`] with `old` replaced by `new`, one a line.
fn diagnostics(old: &str, new: &str) -> String {
    assert_eq!(GOOD.matches(old).count(), 1, "`{old}` stands once");
    problems(&GOOD.replace(old, new)).to_string()
}

#[test]
fn the_good_scenario_is_good() {
    assert!(parse("family/test", "test.toml", GOOD, &Registry::builtin()).is_ok());
}

#[test]
fn each_mistake_is_one_diagnostic_with_its_place() {
    let second_polygon = "\n[[scene.polygon]]\nid = \"b\"\ngrey = 0.1\nvertices = [[50, 40], [90, 40], [90, 70]]\n\n[[scene.target]]";
    let cases: &[(&str, &str, &str, &[&str])] = &[
        // (what is replaced, by what, place, parts of the message)
        ("width = 100", "widht = 100", "6:1", &["unknown key `widht` in [scene]", "did you mean `width`"]),
        ("seed = 1", "sede = 1", "3:1", &["unknown key `sede`", "did you mean `seed`"]),
        ("[scene]\n", "[scen]\na = 1\n[scene]\n", "5:2", &["unknown key `scen`", "did you mean `scene`"]),
        ("seed = 1", "", "1:1", &["has no `seed`", "Seed of all random numbers"]),
        ("seed = 1", "seed = \"one\"", "3:8", &["string \"one\"", "a whole number"]),
        ("seed = 1", "seed = -1", "3:8", &["whole number from 0", "found -1"]),
        ("seed = 1", "seed = 1\ntrials = 0", "4:10", &["whole number from 1", "found 0"]),
        ("seed = 1", "seed = 1\ntrials = 5", "4:10", &["nothing is random", "grey_noise"]),
        ("width = 100", "width = -100", "6:9", &["whole number from 1", "found -100"]),
        ("width = 100", "width = 100.5", "6:9", &["floating point `100.5`"]),
        ("width = 100\nheight = 80", "width = 1000000\nheight = 1000000", "6:9", &["1000000 x 1000000 px", "20000 GB", "400 megapixels"]),
        ("background = 0.8", "background = nan", "8:14", &["number from 0 to 1", "NaN"]),
        ("background = 0.8", "background = 1.2", "8:14", &["number from 0 to 1", "1.2"]),
        ("background = 0.8", "background = 0.8\nbits = 10", "9:8", &["8, 12 or 16", "10"]),
        ("background = 0.8", "background = 0.8\nphase = \"unifrom\"", "9:9", &["unknown variant `unifrom`", "`uniform`"]),
        ("background = 0.8", "background = 0.8\nphase = \"uniform\"", "5:2", &["starts must move", "[scene.pointing]"]),
        ("background = 0.8", "background = 0.8\n[scene.pointing]\nsigma = inf\nwhole_pixels = true", "10:9", &["from 0 to 100", "inf"]),
        (
            "background = 0.8",
            "background = 0.8\n[scene.pointing]\nsigmaa = 1\nwhole_pixels = true",
            "10:1",
            &["unknown key `sigmaa` in [scene.pointing]", "did you mean `sigma`"],
        ),
        (
            "background = 0.8",
            "background = 0.8\n[scene.pointing]\nsigma = 1\nwhole_pixels = true\nmap_turn = 3",
            "12:1",
            &["`map_turn` of [scene.pointing]", "a flat scene hands on no map"],
        ),
        (
            "background = 0.8",
            "background = 0.8\n[scene.pointing]\nsigma = 1",
            "9:8",
            &["[scene.pointing] has no `whole_pixels`", "Whether the pointer stops"],
        ),
        ("id = \"1\"", "id = \" \"", "16:6", &["the id of a target is a name"]),
        ("window = 11", "colour = \"red\"", "23:1", &["`forstner` has no parameter `colour`"]),
        ("grey = 0.2", "grey = \"dark\"", "12:8", &["string \"dark\"", "a number"]),
        ("[60, 50], [20, 50]]", "[60, nan], [20, 50]]", "13:33", &["number from -1000000 to 1000000", "NaN"]),
        ("[[20, 20], [60, 20], [60, 50], [20, 50]]", "[]", "13:12", &["at least 3 vertices, found 0"]),
        ("[60, 50], [20, 50]]", "[20, 50], [80, 45]]", "13:12", &["crosses or touches itself"]),
        ("\n[[scene.target]]", second_polygon, "18:12", &["polygon `b` overlaps polygon `a`"]),
        ("at = [20, 20]", "at = [20.1, 20]", "18:6", &["no vertex of a polygon", "the nearest vertex is (20, 20)"]),
        ("at = [20, 20]", "at = [120, 20]", "18:6", &["outside the image of 100 x 80"]),
        ("at = [20, 20]", "at = [20, 20, 20]", "18:6", &["expected two numbers [x, y], found 3"]),
        ("kind = \"corner\"", "kind = \"chess\"", "17:8", &["no kind of target is called `chess`", "did you mean `chess_corner`"]),
        ("start = [21, 20]", "", "16:6", &["target `1` has no `start`", "[scene.pointing]"]),
        ("name = \"forstner\"", "name = \"forster\"", "22:8", &["no method is called `forster`", "did you mean `forstner`"]),
        ("name = \"forstner\"", "", "21:1", &["[[method]] has no `name`", "pixel"]),
        ("window = 11", "window = 10", "23:10", &["odd number from 3 to 31", "found 10"]),
        ("window = 11", "window = nan", "23:10", &["odd number from 3 to 31", "found NaN"]),
        ("window = 11", "windw = 11", "23:1", &["no parameter `windw`", "did you mean `window`"]),
        ("window = 11", "window = \"big\"", "23:10", &["must be an odd number from", "found big"]),
        ("window = 11", "window = 11\n\n[[method]]\nname = \"forstner\"", "25:1", &["listed twice"]),
        ("window = 11", "window = 11\nwindow = 13", "24:1", &["duplicate key"]),
        (
            "window = 11",
            "kinds = [\"korner\"]",
            "23:9",
            &["no kind of target is called `korner`", "known are corner,", "did you mean `corner`"],
        ),
        ("window = 11", "kinds = [\"corner\", \"corner\"]", "23:9", &["`kinds`: the kind `corner` is given twice"]),
        ("window = 11", "kinds = []", "23:9", &["`kinds`: no kind of target is given", "at least one of corner,"]),
        ("window = 11", "kinds = \"corner\"", "23:9", &["`kinds` is a list of kinds of targets", "known are corner,"]),
        ("window = 11", "kinds = [\"disc\"]", "21:1", &["`forstner:window=11,kinds=disc` has nothing to measure", "the kind `corner`"]),
        (
            "window = 11",
            "window = 11\n\n[[method]]\nname = \"forstner\"\nkinds = [\"corner\"]",
            "25:1",
            &["`forstner:window=11,kinds=corner` is to measure `corner` twice, here and as `forstner:window=11`"],
        ),
        (
            "\n[[method]]\n",
            "\n[[scene.target]]\nid = \"2\"\nkind = \"disc\"\nat = [60, 20]\nstart = [60, 20]\n\n[[method]]\nkinds = [\"corner\"]\n",
            "27:1",
            &["no method measures targets of the kind `disc`", "add a method for them"],
        ),
        ("source = \"a test\"", "source = \"\"", "2:10", &["`source` is empty"]),
        ("why = \"To see what is wrong.\"", "why = ", "1:7", &["string values must be quoted"]),
    ];
    for (old, new, place, parts) in cases {
        let found = diagnostics(old, new);
        assert!(found.starts_with(&format!("test.toml:{place}: ")), "{new:?}: expected {place}\n{found}");
        assert_eq!(found.lines().count(), 1, "{new:?}: more than one diagnostic\n{found}");
        assert!(parts.iter().all(|part| found.contains(part)), "{new:?}: expected {parts:?}\n{found}");
    }
}

#[test]
fn lists_may_not_be_empty_nor_missing() {
    let without = |from: &str, to: &str| {
        let (start, end) = (GOOD.find(from).unwrap(), GOOD.find(to).unwrap_or(GOOD.len()));
        problems(&format!("{}{}", &GOOD[..start], &GOOD[end..])).to_string()
    };
    assert!(without("[[method]]", "nothing").contains("lists no method"));
    assert!(without("[[scene.target]]", "[[method]]").contains("[scene] has no target"));
    assert!(without("[[scene.polygon]]", "[[scene.target]]").contains("[scene] has no polygon"));
    assert!(without("[scene]", "[[method]]").contains("nothing to measure"));
    assert!(diagnostics("seed = 1", "seed = 1\nmethod = []").contains("duplicate key"));
}

#[test]
fn ids_are_unique() {
    let target = "\n[[scene.target]]\nid = \"1\"\nkind = \"corner\"\nat = [60, 20]\nstart = [60, 20]\n\n[[method]]";
    let found = diagnostics("\n[[method]]", target);
    assert!(found.starts_with("test.toml:22:6: target `1` stands here a second time"), "{found}");
}

#[test]
fn mistakes_are_reported_together_in_the_order_of_the_text() {
    let text = GOOD.replace("seed = 1", "seed = 1.5").replace("grey = 0.2", "grey = 2").replace("window = 11", "window = 12");
    let found = problems(&text).to_string();
    let places: Vec<&str> = found.lines().map(|line| line.split(": ").next().unwrap()).collect();
    assert_eq!(places, ["test.toml:3:8", "test.toml:12:8", "test.toml:23:10"], "{found}");
}

#[test]
fn the_picture_shows_the_line_and_the_place() {
    let picture = problems(&GOOD.replace("window = 11", "windw = 11")).picture(false);
    for part in ["test.toml:23:1", "windw = 11", "help: did you mean `window`?"] {
        assert!(picture.contains(part), "{part}\n{picture}");
    }
}

#[test]
fn photographs_are_checked_too() {
    let base = "why = \"w\"\nsource = \"s\"\nseed = 0\n[photographs]\nfolder = \"f\"\nfiles = [\"a.jpg\"]\nboard = \"9x6\"\n[[method]]\nname = \"pixel\"\n";
    assert!(parse("p/t", "test.toml", base, &Registry::builtin()).is_ok());
    for (old, new, expected) in [
        ("\"9x6\"", "\"9\"", "test.toml:7:9: `9` is no chessboard"),
        ("[\"a.jpg\"]", "[]", "test.toml:6:9: `files` is empty"),
        ("[\"a.jpg\"]", "[\"a.jpg\", \"a.jpg\"]", "test.toml:6:9: photograph `a.jpg` is listed twice"),
        ("[\"a.jpg\"]", "[\"/etc/a.jpg\"]", "test.toml:6:9: `/etc/a.jpg` is no plain file name"),
        ("[\"a.jpg\"]", "[\"sub/a.jpg\"]", "test.toml:6:9: `sub/a.jpg` is no plain file name"),
        ("[\"a.jpg\"]", "[\"..\"]", "test.toml:6:9: `..` is no plain file name"),
        ("folder =", "foldr =", "test.toml:5:1: unknown key `foldr` in [photographs]"),
        ("folder = \"f\"\n", "", "test.toml:4:2: [photographs] has no `folder`"),
    ] {
        let found = problems(&base.replace(old, new)).to_string();
        assert!(found.starts_with(expected), "expected {expected}\n{found}");
    }
}

mod any_text {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn is_read_or_refused_without_panic(cut in 0..GOOD.len(), insert in "\\PC{0,12}") {
            let cut = GOOD.floor_char_boundary(cut);
            let text = format!("{}{insert}{}", &GOOD[..cut], &GOOD[cut..]);
            if let Err(problems) = parse("f/t", "test.toml", &text, &Registry::builtin()) {
                prop_assert!(!problems.to_string().is_empty() && !problems.picture(false).is_empty());
            }
        }
    }
}

/// What a sweep over boards and a detector of boards ask of a scenario.
#[test]
fn detectors_of_boards_want_a_board_and_methods_a_cell_with_their_targets() {
    let text = std::fs::read_to_string(crate::project::root().join("scenarios/targets/by-noise.toml")).unwrap();
    let said = |changes: &[(&str, &str)]| {
        let mut text = text.clone();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        match parse("targets/test", "test.toml", &text, &Registry::builtin()) {
            Ok(_) => String::new(),
            Err(problems) => problems.to_string(),
        }
    };
    assert_eq!(said(&[]), "");
    let wall = said(&[
        (
            "\"testfield.board\" = [\n    \"chessboard:9x6:38\",\n    \"charuco:10x7:38:26.6:DICT_4X4_50\",\n    \"aprilgrid:6x4:48:0.3\",\n    \"circles:10x7:38:20\",\n    \"rings:12:10x7:38:10\",\n]\n",
            "",
        ),
        ("kind = \"board\"\nunit = \"mm\"\nboard = \"chessboard:9x6:38\"\nmargin = 8", "kind = \"coded\""),
    ]);
    assert!(wall.contains("`detector = \"board\"` finds boards, and the [testfield] is none") && wall.contains("aprilgrid"), "{wall}");
    let unknown = said(&[("detector = \"board\"", "detector = \"board\"\nsigma = 1")]);
    assert!(unknown.contains("unknown key `sigma`"), "{unknown}");
    let idle = said(&[("    \"circles:10x7:38:20\",\n    \"rings:12:10x7:38:10\",\n", "")]);
    assert!(idle.contains("`ellipse_edges:kinds=disc` has nothing to measure"), "{idle}");
    let unmeasured = said(&[("[[method]]\nname = \"ellipse_edges\"\nkinds = [\"disc\"]\n", "")]);
    assert!(unmeasured.contains("disc"), "{unmeasured}");
    let drawn = diagnostics("background = 0.8", "background = 0.8\n[scene.pointing]\ndetector = \"board\"");
    assert!(drawn.contains("`detector = \"board\"` in a drawing"), "{drawn}");
}
