//! Examples below the help of every command. Each of them is parsed by a test.

use clap::Command;

/// Lines as a user types them, and what each is for, by command.
pub const EXAMPLES: &[(&str, &[(&str, &str)])] = &[
    ("demo", &[("calibench demo", "a folder calibench-demo, whose report.html tells the story")]),
    (
        "list",
        &[
            ("calibench list methods", "every method with its parameters, their defaults and ranges"),
            ("calibench list methods --json", "the same for a program"),
            ("calibench list peers", "what other tools' numbers mean, by version"),
        ],
    ),
    ("show", &[("calibench show corners/noise", "the scenario as it is resolved, and a preview PNG")]),
    (
        "run",
        &[
            ("calibench run --all", "every scenario of the project"),
            ("calibench run corners", "every scenario of a family"),
            ("calibench run corners/noise -m forstner -m lsm:window=13 --trials 100", "two methods on the same 100 images"),
            ("calibench run corners/noise --trials 1000 --part 3/8 -o parts", "the third of eight parts, on a machine of its own"),
        ],
    ),
    ("merge", &[("calibench merge parts", "the parts in that folder, into the project's records")]),
    (
        "records",
        &[
            ("calibench records corners/noise", "columns side by side"),
            ("calibench records atlas/corners --at blur=0.5 --csv", "some cells of a sweep as CSV"),
        ],
    ),
    (
        "twin",
        &[
            ("calibench twin photos --board 9x6:25 -o twin", "a scenario that looks like the photographs, and what operators do to them"),
            ("calibench twin photos --board 9x6:25 --what-if light=2 --what-if optics.blur=0.5 -o twin", "and what would change"),
        ],
    ),
    ("render", &[("calibench render corners/noise --trials 20 -o pictures", "twenty images, with the truth beside them")]),
    (
        "print",
        &[
            ("calibench print --board 9x6:25 --paper A4", "a chessboard on one sheet, in the folder board"),
            ("calibench print targets/aprilgrid -o board", "SVG and PDF at true scale, and target.yaml for Kalibr"),
        ],
    ),
    (
        "report",
        &[("calibench report", "all pages, from the records that are there"), ("calibench report --html", "all of them in one file")],
    ),
    ("plot", &[("calibench plot atlas/corners --x blur --y rmse --by method", "a curve for each method, with the numbers as CSV")]),
    (
        "check",
        &[
            ("calibench check", "fails on what is worse"),
            ("calibench check --strict --locked --junit gate.xml", "in CI: also on what changed or is not blessed"),
        ],
    ),
    (
        "init",
        &[
            ("calibench init gate", "a folder with one scenario, its baseline and the schema for editors"),
            ("calibench init mine --calibrator", "the same for a calibration system, with a program to put it in"),
        ],
    ),
    ("bless", &[("calibench bless corners/noise", "lists what gets worse, asks, and writes the baseline")]),
    ("gate-power", &[("calibench gate-power --divisions 200", "the page of docs/gate-power.md, in short")]),
    (
        "league",
        &[
            ("calibench league --plugins examples/calibrators --minutes 60", "every calibrator that can run here, for an hour"),
            ("calibench league league/good --system ours --fresh", "one cell again"),
        ],
    ),
    ("speed", &[("calibench speed -m forstner:window=15 -m lsm -o speeds.csv", "points a second of two methods")]),
    (
        "measure",
        &[
            ("calibench measure photos --board 9x6:25 -o measured.csv", "a board's points in a folder of photographs"),
            ("calibench measure a.jpg b.jpg --points approx.csv -m lsm:window=13 -o measured.csv", "by one method"),
            (
                "calibench measure a.jpg --points approx.csv -m disc=parametric_circle -m square=lsm --json",
                "each kind of target by its own, for a program",
            ),
        ],
    ),
    (
        "detect",
        &[
            ("calibench detect a.jpg b.jpg --board 9x6:25 -o approx.csv", "a chessboard's corners"),
            ("calibench detect photos --board 9x6:25 --draw drawn -o approx.csv", "a folder, with what was found drawn on each"),
            ("calibench detect a.jpg b.jpg --board unknown", "what board is this, and by which words is it found"),
            ("calibench detect room.jpg --board gridboard:5x7:40:10:DICT_6X6_250 --all -o approx.csv", "each of several boards"),
            ("calibench detect a.jpg --testfield testfields/coded -o approx.csv", "a coded field"),
        ],
    ),
    (
        "point",
        &[
            ("calibench point a.jpg b.jpg --control control.csv -o points.html", "a page to point at targets, as one file"),
            ("calibench point a.jpg --measured measured.csv -o points.html", "shows what was measured, and what was not"),
            ("calibench point a.jpg b.jpg --control control.csv --serve -m parametric_corner", "measures at each click"),
        ],
    ),
    ("control", &[("calibench control 9x6:25 -o control.csv", "corners r1c1, r1c2, ... with squares of 25")]),
    (
        "calibrate",
        &[
            ("calibench calibrate photos --board 9x6:25 -o camera.yaml --report page", "from photographs"),
            ("calibench calibrate clip.mp4 --board 9x6:25 -o camera.yaml", "from the frames of a video that are sharp and tell most"),
            ("calibench calibrate --points points.csv --control control.csv --size 4272x2848 -o camera.yaml", "from points"),
            (
                "calibench calibrate --points points.csv --distances bars.csv --size 8688x5792 --length 6,8",
                "from points without coordinates, and scale bars",
            ),
            ("calibench calibrate photos --board 9x6:25 -o camera.yaml --certificate camera.pdf", "with a certificate"),
            ("calibench calibrate a.jpg b.jpg --board aprilgrid:6x6:0.088:0.3 --json", "the answer for a program"),
            (
                "calibench calibrate *.png --board 9x6:25 --rig left,right --sync left*.png=right*.png -o rig",
                "two cameras on a bar, with files for Kalibr, OpenCV and COLMAP",
            ),
        ],
    ),
    (
        "judge",
        &[
            ("calibench judge photos --board 9x6:25 --report page", "which operator and which model"),
            ("calibench judge new --camera camera.yaml --board 9x6:25 --limit 0.5", "whether a camera still holds"),
            ("calibench judge --points a.csv --points mine=b.csv --board 9x6:25 --size 640x480", "whose corners are better"),
        ],
    ),
    ("resect", &[("calibench resect --camera cam.yaml --points points.csv --control control.csv -o stations.csv", "poses")]),
    ("intersect", &[("calibench intersect --camera cam.yaml --points points.csv --stations stations.csv -o xyz.csv", "object points")]),
    ("orient", &[("calibench orient --points points.csv --left A --right B --camera camera.toml -o model.csv", "a pair and its model")]),
    (
        "accept",
        &[
            ("calibench accept --lengths lengths.csv --limit 0.02,1e-5 --unit mm --plot errors.png", "after VDI/VDE 2634-1"),
            ("calibench accept --lengths bars.csv --measured xyz.csv --limit 0.05 --scale scale.csv", "from measured points"),
            ("calibench accept --check-points survey.csv --measured xyz.csv --vertical 0.1 --json", "after ASPRS 2023"),
        ],
    ),
    (
        "certificate",
        &[
            ("calibench certificate calibrated -o certificate.pdf --by me --place here", "of a folder that `calibrate --report` wrote"),
            ("calibench certificate --verify certificate.pdf", "whether files and pages are as they were"),
        ],
    ),
    (
        "task",
        &[
            (
                "calibench task task.toml --calibration calibrated --map map.png",
                "its 95 % interval, from stated poses, and over the volume",
            ),
            ("calibench task task.toml --camera camera.toml --board 9x6:25 --json", "from a board in the same images"),
        ],
    ),
    (
        "convert",
        &[
            ("calibench convert camera.xml --to opencv -o camera.yaml", "the format of what is read is found by content"),
            ("calibench convert camchain.yaml --all --to colmap -o cameras.txt", "every camera of a rig"),
            ("calibench convert camera.cam --to photogrammetric --json", "what it costs, for a program"),
            ("calibench convert camera.yaml --size 800x600 -o half.yaml", "the same camera in images of half the size"),
            ("calibench convert camera.yaml --crop 0,150,1600,900 --size 1280x720 -o video.yaml", "in a video mode"),
            ("calibench convert camera.yaml --turn 90 -o portrait.yaml", "turned clockwise, from landscape to portrait"),
        ],
    ),
    (
        "camera",
        &[("calibench camera camera.yaml", "view, distortion, fold-over"), ("calibench camera camera.yaml --json", "for a program")],
    ),
    (
        "diff",
        &[
            ("calibench diff a.xml b.yaml --plot diff.png", "px over the frame, after the best rotation"),
            ("calibench diff a.xml b.yaml --limit 0.5", "exit code 1 where they differ by more, px RMS"),
            ("calibench diff a.xml b.yaml --points points.csv --distance 5", "where points were measured, and on an object"),
            ("calibench diff before.yaml after.yaml --rig --distance 2", "two rigs, at 2 units before them"),
            ("calibench diff half.yaml whole.yaml --same-camera", "of images of two sizes"),
        ],
    ),
    ("stmap", &[("calibench stmap camera.xml --redistort --overscan auto -o map.exr", "for Nuke or Blender")]),
    (
        "undistort",
        &[
            ("calibench undistort a.jpg b.jpg --camera camera.yaml --frame crop -o flat", "straight lines are straight"),
            ("calibench undistort a.tif --camera fisheye.json --to equirectangular --frame all -o sphere", "all of a fisheye"),
            ("calibench undistort points.csv --camera camera.yaml -o ideal.csv", "points; --redistort leads back"),
        ],
    ),
    ("plugin", &[("calibench plugin test methods/mine.toml", "does it do what every plug-in must")]),
    ("schema", &[("calibench schema scenarios", "for editors"), ("calibench schema calibrate", "what `calibrate --json` answers")]),
    ("completions", &[("calibench completions bash", "write it to ~/.local/share/bash-completion/completions/calibench")]),
    ("man", &[("calibench man -o man1", "calibench.1 and a page for each command")]),
];

/// `command` with the examples of each of its commands.
pub fn with_examples(command: Command) -> Command {
    EXAMPLES.iter().fold(command, |command, (name, examples)| command.mut_subcommand(name, |one| one.after_help(text(examples))))
}

fn text(examples: &[(&str, &str)]) -> String {
    let lines = examples.iter().map(|(line, what)| format!("  {line}\n      {what}"));
    format!("Examples:\n{}", lines.collect::<Vec<_>>().join("\n"))
}
