use calibench_diagnostics::Problems;
use calibench_synth::testfield::Levels;
use toml::de::DeTable;

use super::*;

const KEY: Key<'_> = Key { seed: 1, of: "test", trial: 0, view: "", target: "" };

/// The plan of a text, or its problems as `line:column: message (help)`.
pub fn plan(text: &str) -> Result<FieldPlan, String> {
    let (root, errors) = DeTable::parse_recoverable(text);
    assert!(errors.is_empty(), "{errors:?}");
    let mut root = Section { name: "the scenario", span: 0..1, table: root.into_inner() };
    let mut problems = Vec::new();
    let section = root.take_table("testfield", "[testfield]", &mut problems).unwrap();
    let plan = read(section, Path::new(env!("CARGO_MANIFEST_DIR")), KEY, &mut problems);
    assert_eq!(plan.is_some(), problems.is_empty(), "no plan without a problem, no problem with a plan");
    plan.ok_or_else(|| Problems { file: "f".into(), text: text.into(), problems }.to_string())
}

fn refused(text: &str, message: &str) {
    let found = plan(text).unwrap_err();
    assert!(found.contains(message), "{text}\n{found}\nexpected {message}");
}

#[test]
fn a_chessboard_is_read_with_its_defaults() {
    let plan = plan("[testfield]\nkind = \"chessboard\"\nrows = 6\ncolumns = 9\nsquare = 30\nbend = 1.5\nbend_across = 90").unwrap();
    assert_eq!(plan.unit, Unit::Millimetre);
    let Generator::Chessboard(board) = &plan.generator else { panic!() };
    assert_eq!((board.rows, board.columns, board.margin, board.levels), (6, 9, 30.0, Levels::default()));
    assert!((board.bend.unwrap().across - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(plan.generate(KEY).unwrap().targets.len(), 54);
}

#[test]
fn the_coded_field_and_the_house_have_the_papers_defaults() {
    let coded = plan("[testfield]\nkind = \"coded\"").unwrap();
    assert_eq!(coded.generator, Generator::Coded(Coded::paper()));
    let metres = plan("[testfield]\nkind = \"coded\"\nunit = \"m\"").unwrap();
    let extent = metres.generate(KEY).unwrap().plates[0].corners;
    assert!((extent[1][0] - 0.6).abs() < 1e-12 && metres.unit == Unit::Metre);
    let house = plan("[testfield]\nkind = \"house\"\nwidth = 16").unwrap();
    assert_eq!(house.generator, Generator::House(House::default()));
}

const WALL: &str = r#"[testfield]
kind = "wall"
unit = "m"
survey_sigma = 0.003
[[testfield.plate]]
id = "front"
middle = [0, 5, 2]
right = [0, -1, 0]
up = [0, 0, 1]
width = 4
height = 2
shift = [0.002, 0, 0]
[[testfield.target]]
id = "gcp1"
plate = "front"
kind = "corner"
at = [-1, 0.5]
size = 0.1
angle = 60
turn = 15
[testfield.panels]
rows = 1
columns = 2
width = 1
height = 1
gap = 0.2
relief = 0.1
tilt = 20
[testfield.fill]
kinds = ["cross", "disc", "corner"]
angles = [30, 150]
size = 0.05
count = 20
distance = 0.13
"#;

#[test]
fn a_wall_is_its_plates_its_panels_and_its_targets() {
    let field = plan(WALL).unwrap().generate(KEY).unwrap();
    let ids: Vec<&str> = field.plates.iter().map(|plate| plate.id.as_str()).collect();
    assert_eq!(ids, ["front", "p1-1", "p1-2"]);
    assert_eq!(field.targets.len(), 61);
    assert_eq!(field.targets[0].axes[1], [15_f64.to_radians().cos(), 15_f64.to_radians().sin()], "along its first edge");
    let corners = field.targets.iter().filter(|target| target.kind == calibench_model::TargetKind::Corner).count();
    assert_eq!(corners, 31, "two of four shapes, and the given one");
}

#[test]
fn mistakes_are_told_with_their_places() {
    let board = "[testfield]\nkind = \"chessboard\"\nrows = 6\ncolumns = 9\n";
    refused(
        "[testfield]\nrows = 3",
        "1:2: [testfield] has no `kind` (`kind`: one of chessboard, wall, coded, house, board, charuco, aprilgrid, gridboard, circles, rings, puzzle, dotted, tags)",
    );
    refused("[testfield]\nkind = \"chesboard\"", "2:8: `kind` of [testfield] is one of");
    refused("[testfield]\nkind = \"chesboard\"", "did you mean `chessboard`?");
    refused(
        "[testfield]\nkind = 3",
        "2:8: `kind` of [testfield] is one of chessboard, wall, coded, house, board, charuco, aprilgrid, gridboard, circles, rings, puzzle, dotted, tags; found a value of type integer",
    );
    refused("[testfield]\nkind = \"house\"\nunit = \"cm\"\nwidth = 3", "3:8: `unit` is \"mm\" or \"m\"; found `cm`");
    refused(board, "[testfield] has no `square`");
    refused(&format!("{board}sqare = 30"), "5:1: unknown key `sqare` in [testfield]");
    refused(&format!("{board}square = -30"), "5:10: expected a number from 0.000001 to 1000000, found -30");
    refused(&format!("{board}square = nan"), "5:10: expected a number");
    refused(&format!("{board}square = 30\nprint_noise = 2"), "6:15: `print_noise` is 2: expected a number from 0 to 0.6");
    refused(&format!("{board}square = 30\nmargin = 1\nprint_noise = 0.5"), "6:10: `margin` is 1: expected at least 8 times");
    refused("[testfield]\nkind = \"coded\"\nsquares = 9", "3:11: `squares` is 9");
    refused("[testfield]\nkind = \"coded\"\nsmall = [1, 2, 3]", "3:9: expected 4 numbers in brackets, found 3");
    refused("[testfield]\nkind = \"house\"\nwidth = 1\nspeck = 0.5", "4:9: `speck` is 0.5");
    refused("[testfield]\nkind = \"wall\"", "1:2: the testfield has no plates");
}

#[test]
fn mistakes_in_a_wall_are_told_with_their_places() {
    let changed = |from: &str, to: &str| {
        assert!(WALL.contains(from), "{from}");
        WALL.replace(from, to)
    };
    refused(&changed("right = [0, -1, 0]", "right = [0, 0, 3]"), "6:6: the axes of plate `front`");
    refused(&changed("right = [0, -1, 0]", "right = [0, 3]"), "8:9: expected 3 numbers in brackets, found 2");
    refused(&changed("plate = \"front\"", "plate = \"back\""), "14:6: target `gcp1` is on plate `back`");
    refused(&changed("at = [-1, 0.5]", "at = [-2.1, 0.5]"), "14:6: target `gcp1` does not lie wholly on plate `front`");
    refused(&changed("kind = \"corner\"", "kind = \"junction\""), "16:8: no target of a wall is a `junction`");
    refused(&changed("kind = \"corner\"", "kind = \"conrer\""), "did you mean `corner`?");
    refused(&changed("angle = 60", "angle = 20"), "19:9: `angle` is 20");
    refused(&changed("gap = 0.2", "gap = 0.0"), "26:7: `gap` is 0: expected at least 0.11");
    refused(&changed("tilt = 20", "tilt = 70"), "28:8: `tilt` is 70");
    refused(&changed("count = 20", "rows = 20"), "29:12: [testfield.fill] does not say where the targets are");
    refused(&changed("count = 20", "count = 20000"), "of 20000 targets found a place on plate `front`");
    refused(&changed("kinds = [\"cross\", \"disc\", \"corner\"]", "kinds = []"), "30:9: `kinds` is empty");
    refused(&changed("angles = [30, 150]", "angles = [30, 170]"), "`angle` is 170");
    refused(&changed("survey_sigma", "survey_sgma"), "4:1: unknown key `survey_sgma`");
}

#[test]
fn boards_are_read_with_their_defaults() {
    use calibench_model::boards::Board;

    let board = |text: &str| match plan(&format!("[testfield]\n{text}")).unwrap().generator {
        Generator::Board(sheet) => (sheet.board, sheet.margin),
        other => panic!("{other:?}"),
    };
    let same = |text: &str, option: &str, margin: f64| assert_eq!(board(text), (option.parse::<Board>().unwrap(), margin), "{text}");
    same(
        "kind = \"charuco\"\ncolumns = 8\nrows = 5\nsquare = 30\nmarker = 21\ndictionary = \"DICT_4X4_50\"",
        "charuco:8x5:30:21:DICT_4X4_50",
        30.0,
    );
    same("kind = \"aprilgrid\"\nunit = \"m\"\ncolumns = 6\nrows = 6\ntag = 0.088", "aprilgrid:6x6:0.088:0.3", 0.088);
    same(
        "kind = \"aprilgrid\"\ncolumns = 6\nrows = 5\ntag = 88\nborder = 1\nsquares = false\nfirst = 4",
        "aprilgrid:6x5:88:0.3:4:border1:plain",
        88.0,
    );
    same(
        "kind = \"gridboard\"\ncolumns = 5\nrows = 7\nmarker = 40\nseparation = 10\ndictionary = \"DICT_6X6_250\"",
        "gridboard:5x7:40:10:DICT_6X6_250",
        40.0,
    );
    same(
        "kind = \"gridboard\"\ncolumns = 3\nrows = 2\nmarker = 40\nseparation = 10\ndictionary = \"DICT_4X4_50\"\nfirst = 9\nborder = 2\nmargin = 5",
        "gridboard:3x2:40:10:DICT_4X4_50:9:border2",
        5.0,
    );
    same("kind = \"circles\"\ncolumns = 4\nrows = 11\nspacing = 20\nasymmetric = true\nmargin = 3", "acircles:4x11:20", 3.0);
    same("kind = \"rings\"\ncolumns = 6\nrows = 5\nspacing = 50\ndiameter = 8", "rings:12:6x5:50:8", 50.0);
    same("kind = \"puzzle\"\ncolumns = 23\nrows = 16\nsquare = 30\nplace = [50, 100]", "puzzle:23x16:30:50,100", 30.0);
    same("kind = \"dotted\"\ncolumns = 9\nrows = 6\nsquare = 25", "dotted:9x6:25", 25.0);
    same("kind = \"dotted\"\ncolumns = 9\nrows = 6\nsquare = 25\nplace = [2, 1]\nmargin = 0", "dotted:9x6:25:2,1", 0.0);
    same("kind = \"puzzle\"\ncolumns = 11\nrows = 8\nsquare = 60\nmargin = 0", "puzzle:11x8:60", 0.0);
}

const TAGS: &str = "[testfield]
kind = \"tags\"
unit = \"m\"
dictionary = \"DICT_APRILTAG_36h11\"
[[testfield.tag]]
id = 4
middle = [0, 0, 0]
right = [1, 0, 0]
up = [0, 1, 0]
side = 0.2
";

#[test]
fn markers_stand_by_themselves() {
    let field = plan(TAGS).unwrap().generate(KEY).unwrap();
    assert_eq!((field.plates.len(), field.targets.len(), field.targets[3].id.as_str()), (1, 4, "t4c3"));
    let changed = |from: &str, to: &str, message: &str| refused(&TAGS.replace(from, to), message);
    changed("36h11", "36h12", "4:14: `DICT_APRILTAG_36h12` is no dictionary of markers");
    changed("id = 4", "id = 587", "6:6: `id` is 587: expected 0 to 586");
    changed("up = [0, 1, 0]", "up = [1, 1, 0]", "the axes of plate `tag 4`");
    changed("side = 0.2", "size = 0.2", "10:1: unknown key `size` in [[testfield.tag]]");
    let grid = "[testfield]\nkind = \"gridboard\"\ncolumns = 5\nrows = 7\nmarker = 40\ndictionary = \"DICT_4X4_50\"\n";
    refused(grid, "[testfield] has no `separation`");
    refused(&format!("{grid}separation = 900"), "7:14: `separation` is 900: expected 0.8 to 400");
    refused(&format!("{grid}separation = 9\nfirst = 16"), "8:9: `first` is 16: expected at most 50");
    let charuco = "[testfield]\nkind = \"charuco\"\ncolumns = 8\nrows = 5\nsquare = 30\n";
    refused(&format!("{charuco}marker = 40\ndictionary = \"DICT_4X4_50\""), "6:10: `marker` is 40");
    refused(&format!("{charuco}marker = 20\ndictionary = \"DICT_4X4\""), "did you mean `DICT_4X4_50`?");
    refused(&format!("{charuco}marker = 20\ndictionary = \"DICT_4X4_50\"\nfirst = 40"), "8:9: `first` is 40: expected at most 50");
    refused(&format!("{charuco}marker = 20\ndictionary = \"DICT_4X4_50\"\nmargn = 4"), "8:1: unknown key `margn` in [testfield]");
}

#[test]
fn any_board_is_read_in_a_word() {
    let word = |word: &str| format!("[testfield]\nkind = \"board\"\nboard = \"{word}\"");
    for (_, example) in calibench_model::boards::examples() {
        let read = plan(&word(example)).unwrap();
        assert_eq!(read.board(), Some(example.parse().unwrap()));
        assert!(BOARDS.contains(&"board") && !read.generate(KEY).unwrap().targets.is_empty());
    }
    let Generator::Board(sheet) = plan(&(word("circles:7x5:20") + "\nmargin = 3\nbend = 1")).unwrap().generator else { panic!() };
    assert_eq!((sheet.margin, sheet.bend.unwrap().peak), (3.0, 1.0));
    let chessboard = plan("[testfield]\nkind = \"chessboard\"\nrows = 6\ncolumns = 9\nsquare = 30").unwrap();
    assert_eq!(chessboard.board(), Some("chessboard:9x6:30".parse().unwrap()));
    assert_eq!(plan("[testfield]\nkind = \"coded\"").unwrap().board(), None);
    refused(&word("charuco:8x5:30:40:DICT_4X4_50"), "`marker` is 40");
    refused(&word("dots:8x5:30"), "3:9: `dots` is no kind of board");
    refused("[testfield]\nkind = \"board\"", "board");
}

#[test]
fn a_board_is_printed_as_its_file_and_its_keys_say() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("board.csv");
    let row = |row: i32, column: i32| {
        let (x, y) = (20.0 * f64::from(column - 1) + 0.03 * f64::from(row), -20.0 * f64::from(row - 1));
        format!("r{row}c{column},{x},{y},0,0.01,0.01,0.01\n")
    };
    let rows: String = (1..=5).flat_map(|r| (1..=7).map(move |c| row(r, c))).collect();
    std::fs::write(&file, format!("target,X,Y,Z,sX,sY,sZ\n{rows}")).unwrap();
    let board = |more: &str| format!("[testfield]\nkind = \"board\"\nboard = \"chessboard:7x5:20\"\n{more}");
    let corners = format!("corners = {:?}\n", file.display().to_string());
    let read = plan(&board(&corners)).unwrap();
    let field = read.generate(KEY).unwrap();
    let place = field.targets.iter().find(|target| target.id == "r4c2").unwrap();
    assert!((field.position(place).x - 20.12).abs() < 1e-9 && place.surveyed.x == 20.0);
    assert_eq!(read.corner_file.as_deref(), Some(file.as_path()));
    let spread = plan(&board("ink_spread = 0.2\nragged = 0.05")).unwrap();
    assert_eq!((spread.print.ink_spread, spread.print.ragged, spread.print.ragged_length), (0.2, 0.05, 2.0));
    assert!(spread.drawn().contains(&"how ragged printed edges are"));
    refused(&board(&format!("{corners}bend = 1")), "`corners` beside `bend`");
    refused(&board("corners = \"nowhere.csv\""), "nowhere.csv");
    refused(&board("ragged_length = 2"), "says nothing without `ragged`");
    refused(&board("ink_spread = 5"), "ink_spread");
    refused(&board("inkspread = 5"), "did you mean `ink_spread`");
    refused(&format!("[testfield]\nkind = \"chessboard\"\nrows = 5\ncolumns = 6\nsquare = 20\n{corners}"), "corners");
    refused("[testfield]\nkind = \"house\"\nwidth = 16\nink_spread = 1", "unknown key `ink_spread`");
}
