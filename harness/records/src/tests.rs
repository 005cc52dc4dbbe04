//! Files of records to the letter: others read their columns by name and their rows by word.

use std::io::{self, Write};

use calibench_model::{PixelPoint, Rejection};

use crate::adjustments::{self, CalibrationWriter};
use crate::figures::Quantity;
use crate::judgement::{Row, read_rows, write_rows};
use crate::points::{RecordWriter, RunInfo, read_records};
use crate::results::{Calibrated, Figure, MethodInfo, Outcome, PointResult, Trial};
use crate::theory;

fn run() -> RunInfo {
    RunInfo { scenario: "f/s".into(), seed: 9, revision: "abc".into(), detector: Some(("board".into(), "2".into())) }
}

fn methods() -> Vec<MethodInfo> {
    let info =
        |label: &str, why: Option<&str>| MethodInfo { label: label.into(), version: "1".into(), unavailable: why.map(str::to_owned) };
    vec![info("absent", Some("not built")), info("m:w=1,k=2", None), info("n", None)]
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

#[test]
fn records_of_points() {
    let measured = |x: f64, y: f64, error| Outcome::Measured { position: PixelPoint::new(x, y), error };
    let point = |method, target: &str, outcome| PointResult::new("v", target, method, outcome);
    let trial = Trial {
        number: 3,
        points: vec![
            PointResult { bound: Some(0.0125), predicted: Some(0.03), ..point(1, "a", measured(10.25, 20.5, Some((0.25, -0.5)))) },
            point(1, "b, c", Outcome::Rejected(Rejection::NoCorner)),
            point(2, "a", measured(13.0, 24.5, Some((3.0, 4.0)))),
            point(2, "b, c", measured(1.0, 2.0, None)),
        ],
        missed_views: vec![("w".into(), "no \"board\"".into())],
        ..Trial::default()
    };
    let mut bytes = Vec::new();
    let mut writer = RecordWriter::new(&mut bytes, run(), methods()).unwrap();
    writer.trial(&trial).unwrap();
    writer.finish().unwrap();
    insta::assert_snapshot!(text(bytes));
}

#[test]
fn records_of_adjustments() {
    let iop = Figure { name: Quantity::Parameter.of(&["c"]), value: 16.55, sigma: Some(0.0125), error: Some(-1.0 / 3.0), unit: "mm" };
    let figures = vec![iop, Figure::plain(Quantity::ResidualX.of(&["6", "left/3"]), -0.5, "px")];
    let all = [
        Calibrated { method: 1, set: 0, outcome: Ok(figures), check_failed: Some("image 6: no points".into()) },
        Calibrated { method: 2, set: 1, outcome: Err("no convergence, sorry".into()), check_failed: None },
    ];
    let mut bytes = Vec::new();
    let mut writer = CalibrationWriter::new(&mut bytes, run(), methods(), vec!["c,x0".into(), "c".into()]).unwrap();
    writer.trial(7, &all).unwrap();
    writer.finish().unwrap();
    let mut rows = Vec::new();
    adjustments::read(&bytes[..], |row| rows.push(row)).unwrap();
    assert_eq!((rows.len(), rows[0].trial, &*rows[0].set, rows[3].figure.clone()), (4, 7, "c,x0", Err("no convergence, sorry".into())));
    let (name, c) = rows[0].figure.clone().unwrap();
    assert_eq!((name.quantity(), name.text(), name.group()), (Quantity::Parameter, "c", rows[0].group));
    assert_eq!((c.value, c.sigma), (16.55, Some(0.0125)));
    assert!((c.error.unwrap() + 1.0 / 3.0).abs() < 1e-6);
    insta::assert_snapshot!(text(bytes));
}

#[test]
fn records_of_a_judgement() {
    let rows = [
        Row::px("holdout", "a, b.jpg", 0.125).beside(0.25).of(54).by(&"m".into(), &"opencv5".into()),
        Row::plain("parameters", "", 9.0),
        Row::without("split", "1", "failed", "no, \"not\" determined"),
    ];
    let mut bytes = Vec::new();
    write_rows(&mut bytes, &run(), &rows).unwrap();
    insta::assert_snapshot!(text(bytes));
}

/// What a user reads of a file that was cut, edited or written by another version.
#[test]
fn messages_name_line_and_column() {
    let points = "scenario,trial,view,target,method,version,x,y,x_true,y_true,bound,predicted,unit,status,reason,seed,revision\n";
    let adjusted = "scenario,trial,method,set,group,name,value,sigma,error,unit,status,reason,seed\n";
    let judged = "scenario,method,model,measure,place,value,sigma,count,unit,status,reason,seed,revision\n";
    let of_points = |row: &str| read_records(format!("{points}{row}\n").as_bytes(), |_, _| ()).unwrap_err().to_string();
    let of_adjusted = |row: &str| adjustments::read(format!("{adjusted}{row}\n").as_bytes(), |_| ()).unwrap_err().to_string();
    let of_judged = |row: &str| read_rows(format!("{judged}{row}\n").as_bytes()).unwrap_err().to_string();
    let messages = [
        of_points("s,zero,v,t,m,1,1,2,,,,,px,measured,,0,r"),
        of_points("s,0,v,t,m,1,one,2,,,,,px,measured,,0,r"),
        of_points("s,0,v,t,m,1,1,2,,,,,px,measured,,-1,r"),
        of_points("s,0,v,t,m,1,,,,,,,px,rejected,boredom,0,r"),
        of_points("s,0,v,t,m,1,1,2,0.5,,,,px,measured,,0,r"),
        of_points("s,0,v,t"),
        of_adjusted("s,0,m,c,iop,c,1,2,x,mm,adjusted,,1"),
        of_adjusted("s,0,m,c,eye,c,1,2,3,mm,adjusted,,1"),
        of_adjusted("s,0,m,c,iop,c,1,2,3,mm,done,,1"),
        of_judged("s,m,c,holdout,v,1,x,3,px,found,,1,r"),
    ];
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn adjustments_that_do_not_belong_together_are_refused() {
    let first = "s,1,m,c,iop,c,1,2,3,mm,adjusted,,1\ns,1,m,c,check,,,,,,failed,no point,1\n";
    for (row, expected) in [
        ("s,1,m,c,iop,c,1.5,2,3,mm,adjusted,,1", "line 4: `m` says twice what iop `c` of set `c` is in trial 1"),
        ("s,1,m,c,check,,,,,,failed,no view,1", "line 4: `m` says twice what check `` of set `c` is in trial 1"),
        ("s,0,m,c,iop,c,1,2,3,mm,adjusted,,1", "line 4: column `trial` holds `0`, expected `1 or more`"),
        ("s,2,m,c,iop,c,1,2,3,px,adjusted,,1", "line 4: column `unit` holds `px`, expected `mm`"),
        ("z,1,m,c,iop,x0,1,2,3,mm,adjusted,,1", "line 4: column `scenario` holds `z`, expected `s`"),
        ("s,1,m,c,iop,x0,1,2,3,mm,adjusted,,2", "line 4: column `seed` holds `2`, expected `1`"),
        ("s,1,m,c,network,sigma,1,,,px,adjusted,,1", "line 4: no figure of `network` is called `sigma`: is `sigma0` meant?"),
        ("s,1,m,c,check,rmse_xy,1,,,px,adjusted,,1", "line 4: column `unit` holds `px`, expected `object unit`"),
    ] {
        let text = format!("{}\n{first}{row}\n", adjustments::COLUMNS.join(","));
        let error = adjustments::read(text.as_bytes(), |_| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{row}: {error}");
    }
    for row in ["s,1,n,c,iop,c,1,2,3,mm,adjusted,,1", "s,1,m,d,iop,c,1,2,3,mm,adjusted,,1", "s,1,m,c,eop,6/X0,1,2,3,m,adjusted,,1"] {
        let text = format!("{}\n{first}{row}\n", adjustments::COLUMNS.join(","));
        assert_eq!(adjustments::read(text.as_bytes(), |_| ()).unwrap().scenario, "s", "{row}");
    }
}

/// Takes nothing: what a writer says to it at the end must not be lost.
struct Full;

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::Error::other("no space left"))
    }

    fn flush(&mut self) -> io::Result<()> {
        Err(io::Error::other("no space left"))
    }
}

#[test]
fn a_full_disk_is_reported() {
    // Rows are buffered: only the end of a file reaches the disk.
    let points = RecordWriter::new(Full, run(), methods()).unwrap();
    assert!(points.finish().is_err());
    let adjusted = CalibrationWriter::new(Full, run(), methods(), Vec::new()).unwrap();
    assert!(adjusted.finish().is_err());
    assert!(write_rows(Full, &run(), &[]).is_err());
    assert!(theory::write(Full, &run(), &[]).is_err());
}
