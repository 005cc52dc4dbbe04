//! What `[tasks]` reads.

use calibench_measure::Registry;

use super::{BoardErrors, Tasks};
use crate::studies::StudyPlan;
use crate::{Study, Subject, parse};

const HEAD: &str = r#"why = "A board."
source = "ours"
seed = 3
[camera]
size = [1280, 960]
pitch = 5.0
c = 5.0
[testfield]
kind = "chessboard"
rows = 6
columns = 9
square = 25
[stations]
kind = "random"
count = 4
distance = [300, 500]
tilt = 35
each_trial = true
[pointing]
sigma = 0
whole_pixels = false
[[method]]
name = "pixel"
[tasks]
model = "opencv5"
noise_px = 0.1
print_noise = 0.03
board_scale = 2e-4
flatness = 0.08
length = 60
centre_sigma = 0.05
angle_sigma = 0.002
plane_sigma = 0.05
tilt_sigma = 0.01
"#;

fn read(text: &str) -> Result<Tasks, String> {
    let scenario = parse("s", "s.toml", text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
    match scenario.subject {
        Subject::Views(views) => match views.study {
            Study::Tasks(found) => Ok(*found),
            other => panic!("{other:?}"),
        },
        _ => panic!("it has stations"),
    }
}

#[test]
fn tasks_are_read_with_the_errors_of_their_board() {
    let found = read(HEAD).unwrap();
    assert_eq!((found.model.as_str(), found.noise_px, found.count, found.length), ("opencv5", 0.1, 20, 60.0));
    assert_eq!(found.board, BoardErrors { print: 0.03, scale: 2e-4, flatness: 0.08 });
    assert!((found.angle_sigma - 3.490_658_5e-5).abs() < 1e-12 && (found.tilt_sigma - 1.745_329_25e-4).abs() < 1e-12);
    assert_eq!((found.drawn(), found.is_random()), (Some(&[("pixel".to_owned(), Some(0.1))][..]), true));
    assert_eq!(read(&HEAD.replace("length = 60", "length = 60\ncount = 3")).unwrap().count, 3);
}

#[test]
fn what_is_wrong_with_the_table_is_said() {
    let wall = "kind = \"wall\"\nunit = \"mm\"\n[[testfield.plate]]\nid = \"a\"\nmiddle = [0, 0, 20]\nright = [1, 0, 0]\nup = [0, 1, 0]\nwidth = 400\nheight = 300\n[testfield.fill]\nkinds = [\"corner\"]\nsize = 20\nrows = 3\ncolumns = 4\n";
    for (old, new, message) in [
        ("opencv5", "opencv6", "`opencv6` is no camera model"),
        ("each_trial = true\n", "", "[tasks] with stations that are the same in all trials"),
        ("length = 60", "length = 170", "`length` 170: expected at most 165.09"),
        ("board_scale = 2e-4", "board_scale = 1", "expected a number from 0 to 0.05, found 1"),
        ("flatness = 0.08\n", "", "[tasks] has no `flatness`"),
        (
            "kind = \"chessboard\"\nrows = 6\ncolumns = 9\nsquare = 25\n",
            wall,
            "[tasks] needs a testfield whose targets lie in the plane Z = 0",
        ),
    ] {
        assert!(HEAD.contains(old), "{old}");
        let found = read(&HEAD.replacen(old, new, 1)).unwrap_err();
        assert!(found.contains(message), "{message}: {found}");
    }
}
