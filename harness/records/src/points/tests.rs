use super::*;

fn example() -> (Vec<MethodInfo>, Vec<Trial>) {
    let info =
        |label: &str, why: Option<&str>| MethodInfo { label: label.into(), version: "1".into(), unavailable: why.map(str::to_owned) };
    let point = |method, target: &str, outcome| PointResult::new("v", target, method, outcome);
    let measured = |x: f64, error| Outcome::Measured { position: PixelPoint::new(x, 0.333_333_333), error };
    let trials = vec![
        Trial {
            number: 0,
            points: vec![
                PointResult {
                    bound: Some(0.012_345),
                    predicted: Some(0.142_857),
                    ..point(1, "a", measured(0.3, Some((-0.000_000_001, -3.5))))
                },
                point(1, "b", Outcome::Rejected(Rejection::NoCorner)),
                point(2, "a", measured(7.0, None)),
                point(2, "b", measured(8.0, Some((0.125, 0.25)))),
            ],
            missed_views: vec![("w".into(), "no board, sorry".into())],
            ..Trial::default()
        },
        Trial { number: 3, points: vec![point(2, "a", measured(-1.0, Some((0.5, 0.25))))], ..Trial::default() },
    ];
    (vec![info("absent", Some("not built")), info("m:w=1,k=2", None), info("n", None)], trials)
}

#[test]
fn what_is_written_is_read_again() {
    let (methods, trials) = example();
    let detector = Some(("board".into(), "2".into()));
    let run = RunInfo { scenario: "f/s".into(), seed: 9, revision: "abc".into(), detector };
    let mut bytes = Vec::new();
    let mut writer = RecordWriter::new(&mut bytes, run.clone(), methods.clone()).unwrap();
    trials.iter().for_each(|trial| writer.trial(trial).unwrap());
    writer.finish().unwrap();
    let mut again = Vec::new();
    let head = read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
    assert_eq!(head, RecordHead { run, methods });
    assert_eq!(again, trials);
    assert!(String::from_utf8(bytes).unwrap().contains(",lost,"), "3.5 px off is lost");
}

#[test]
fn methods_without_points_are_named() {
    let (methods, _) = example();
    let run = RunInfo { scenario: "f/s".into(), seed: 9, revision: "abc".into(), detector: None };
    let mut bytes = Vec::new();
    let mut writer = RecordWriter::new(&mut bytes, run.clone(), methods.clone()).unwrap();
    writer.adjusted_alone().unwrap();
    writer.trial(&Trial::default()).unwrap();
    writer.finish().unwrap();
    let head = read_records(&bytes[..], |_, _| panic!("there is no point")).unwrap();
    assert_eq!(head, RecordHead { run, methods });
}

#[test]
fn other_files_are_refused() {
    assert!(read_records(&b"a,b\n1,2\n"[..], |_, _| ()).is_err());
    for (rows, expected) in [
        ("s,0,v,t,,1,1,2,,,,,px,measured,,0,r\n", "line 2: a row without a method"),
        ("s,,,,,,,,,,,,,unavailable,why,0,r\n", "line 2: a row without a method"),
        ("s,0,v,t,m,1,1,2,,,,,px,found,,0,r\n", "line 2: column `status` holds `found`"),
        ("s,0,v,t,m,1,,,,,,,px,rejected,luck,0,r\n", "line 2: unknown reason"),
        ("s,0,v,t,m,1,1e999,2,,,,,px,measured,,0,r\n", "line 2: column `x` holds `1e999`"),
        ("s,0,v,t,m,1,1,NaN,,,,,px,measured,,0,r\n", "line 2: column `y` holds `NaN`"),
        ("s,0,v,t,m,1,1,,,,,,px,measured,,0,r\n", "line 2: column `y` holds ``"),
        ("s,0,v,t,m,1,1,2,,0.5,,,px,measured,,0,r\n", "line 2: one of `x_true` and `y_true` without the other"),
        ("s,0,v,t,m,1,1,2,0.5,,,,px,measured,,0,r\n", "line 2: one of `x_true` and `y_true` without the other"),
        ("s,0,v,t,m,1,1,2,,,inf,,px,measured,,0,r\n", "line 2: column `bound` holds `inf`"),
        ("s,-1,v,t,m,1,1,2,,,,,px,measured,,0,r\n", "line 2: column `trial` holds `-1`"),
        ("s,0,v,t,m,1,1,2,,,,,mm,measured,,0,r\n", "line 2: column `unit` holds `mm`, expected `px`"),
        ("s,0,v,t,m,1,1,2,,,,,px,rejected,no-corner,0,r\n", "line 2: column `x` holds `1`"),
        ("s,0,v,t,m,1,1,2,4,6,,,px,measured,,0,r\n", "line 2: column `status` holds `measured` 5.000000 px from the truth"),
        ("s,0,v,t,m,1,1,2,1,2.5,,,px,lost,,0,r\n", "line 2: column `status` holds `lost` 0.500000 px from the truth"),
    ] {
        let text = format!("{}\n{rows}", COLUMNS.join(","));
        let error = read_records(text.as_bytes(), |_, _| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{rows}: {error}");
    }
}

/// Rows that are each well formed, and contradict each other.
#[test]
fn rows_that_do_not_belong_together_are_refused() {
    let first = "s,1,v,t,m,1,1,2,,,,,px,measured,,0,r\n";
    let unavailable = "s,,,,b,2,,,,,,,,unavailable,why,0,r\n";
    for (row, expected) in [
        ("s,1,v,t,m,1,1.5,2,,,,,px,measured,,0,r\n", "line 4: `m` says twice what it made of `v/t` in trial 1"),
        ("s,1,v,t,m,1,,,,,,,px,rejected,no_corner,0,r\n", "line 4: `m` says twice"),
        ("s,0,v,t,m,1,1,2,,,,,px,measured,,0,r\n", "line 4: column `trial` holds `0`, expected `1 or more`"),
        ("z,1,v,u,m,1,1,2,,,,,px,measured,,0,r\n", "line 4: column `scenario` holds `z`, expected `s`"),
        ("s,1,v,u,m,1,1,2,,,,,px,measured,,7,r\n", "line 4: column `seed` holds `7`, expected `0`"),
        ("s,1,v,u,m,1,1,2,,,,,px,measured,,0,q\n", "line 4: column `revision` holds `q`, expected `r`"),
        ("s,1,v,u,m,2,1,2,,,,,px,measured,,0,r\n", "line 4: column `version` holds `2`, expected `1`"),
        ("s,2,v,t,b,2,1,2,,,,,px,measured,,0,r\n", "line 4: `b` is unavailable and says what it made of `v/t`"),
    ] {
        let text = format!("{}\n{unavailable}{first}{row}", COLUMNS.join(","));
        let error = read_records(text.as_bytes(), |_, _| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{row}: {error}");
    }
    for row in
        ["s,1,w,t,m,1,1,2,,,,,px,measured,,0,r\n", "s,1,v,t,n,1,1,2,,,,,px,measured,,0,r\n", "s,2,v,t,m,1,1,2,,,,,px,measured,,0,r\n"]
    {
        let text = format!("{}\n{unavailable}{first}{row}", COLUMNS.join(","));
        assert!(read_records(text.as_bytes(), |_, _| ()).is_ok(), "{row}");
    }
}

#[test]
fn names_are_no_formulas_and_are_read_again() {
    let (methods, mut trials) = example();
    trials[0].points[0].target = "=HYPERLINK(\"x\")".into();
    trials[0].points[2].target = "-12".into();
    let mut bytes = Vec::new();
    let mut writer = RecordWriter::new(&mut bytes, RunInfo::default(), methods).unwrap();
    trials.iter().for_each(|trial| writer.trial(trial).unwrap());
    writer.finish().unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    assert!(text.contains(",\"'=HYPERLINK(") && text.contains(",v,-12,") && !text.contains(",=") && !text.contains(",\"="), "{text}");
    let mut again = Vec::new();
    read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
    assert_eq!(again, trials);
}

#[test]
fn points_keep_their_own_view() {
    let measured = |view: &str, target: &str, x: f64| {
        PointResult::new(view, target, 0, Outcome::Measured { position: PixelPoint::new(x, -x), error: Some((x, 0.25)) })
    };
    let points = vec![measured("v", "t", 0.5), measured("w", "t", 0.75), measured("w", "u", 1.0), measured("v", "u", 0.125)];
    let trials = [Trial { points: points.clone(), ..Trial::default() }, Trial { number: 1, points, ..Trial::default() }];
    let methods = vec![MethodInfo { label: "m".into(), version: "1".into(), unavailable: None }];
    let mut bytes = Vec::new();
    let mut writer = RecordWriter::new(&mut bytes, RunInfo { scenario: "s".into(), ..RunInfo::default() }, methods).unwrap();
    trials.iter().for_each(|trial| writer.trial(trial).unwrap());
    writer.finish().unwrap();
    let mut again = Vec::new();
    read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
    assert_eq!(again, trials);
}
