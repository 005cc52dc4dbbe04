use std::fs;

use calibench_exchange::read_points;
use calibench_files::OutputFile;
use calibench_images::write_png;
use calibench_measure::Registry;
use calibench_model::{ControlRow, Image, TargetKind};
use serde_json::{Value, json};

use super::*;
use crate::page::Content;

/// What a server answers to `request`, in which `HOST` and `TOKEN` stand for its own.
fn ask(server: &Server, request: &str) -> (u16, String) {
    let text = request.replace("HOST", &server.address.to_string()).replace("TOKEN", server.guard.token());
    let mut stream = TcpStream::connect(server.address).unwrap();
    stream.write_all(text.as_bytes()).unwrap();
    stream.shutdown(Shutdown::Write).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let answer = String::from_utf8_lossy(&answer).into_owned();
    (answer.split(' ').nth(1).unwrap().parse().unwrap(), answer)
}

fn post(path: &str, body: &str) -> String {
    let length = body.len();
    format!("POST /TOKEN/{path} HTTP/1.1\r\nHost: HOST\r\nContent-Type: application/json\r\nContent-Length: {length}\r\n\r\n{body}")
}

/// A server of one photograph, a chess corner at (40.25, 30), that ends after `idle`.
fn with_server(idle: Duration, work: impl FnOnce(&Server)) {
    with_folder(idle, PATIENCE, &tempfile::tempdir().unwrap(), work);
}

/// The same in a folder that may hold points already, by a server of less patience.
fn with_folder(idle: Duration, patience: Duration, folder: &tempfile::TempDir, work: impl FnOnce(&Server)) {
    let path = folder.path().join("a.png");
    let edge = |d: f64| (0.5 + 0.5 * (d / 1.2).tanh()) as f32;
    let image = Image::from_fn(96, 64, |x, y| {
        let (a, b) = (edge(x as f64 - 40.25), edge(y as f64 - 30.0));
        0.1 + 0.8 * (a * b + (1.0 - a) * (1.0 - b))
    });
    if !path.exists() {
        write_png(&path, &image, true).unwrap();
    }
    let method = Registry::builtin().parse("parametric_corner").unwrap();
    let operator = method.operator.as_ref().unwrap().as_ref();
    let control: Vec<ControlRow> = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]]
        .iter()
        .enumerate()
        .map(|(i, [x, y])| ControlRow::new(format!("t{i}"), [*x, *y, 0.0]))
        .collect();
    let photos = vec![("a.png".to_owned(), path.as_path())];
    let file = OutputFile::open(&folder.path().join("pointed.csv")).unwrap();
    let kept = Kept::open(file, vec!["a.png".to_owned()], Some(TargetKind::ChessCorner)).unwrap();
    let served = Served::new(&Content::default(), photos, (&method, operator), None, &control, &kept).unwrap();
    let server = Server { patience, ..Server::open().unwrap() };
    thread::scope(|scope| {
        let running = scope.spawn(|| server.run(&served, idle));
        work(&server);
        running.join().unwrap().unwrap();
    });
}

#[test]
fn who_has_the_token_is_answered_and_nobody_else() {
    with_server(Duration::from_secs(2), |server| {
        assert!(server.url().starts_with("http://127.0.0.1:") && server.guard.token().len() == 32);
        let (status, page) = ask(server, "GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\n\r\n");
        assert!(status == 200 && page.contains("connect-src 'self'") && page.contains("no-store"));
        assert!(!page.contains(server.guard.token()), "the token stands in the address alone");
        assert_eq!(ask(server, "GET /TOKEN/tile/0/0/0/0 HTTP/1.1\r\nHost: HOST\r\nSec-Fetch-Site: same-origin\r\n\r\n").0, 200);
        for (request, expected) in [
            ("GET / HTTP/1.1\r\nHost: HOST\r\n\r\n", 403),
            ("GET /TOKEN HTTP/1.1\r\nHost: HOST\r\n\r\n", 403),
            ("GET /00000000000000000000000000000000/ HTTP/1.1\r\nHost: HOST\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: evil.example\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: localhost\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\nHost: HOST\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\nOrigin: http://evil.example\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\nOrigin: null\r\n\r\n", 403),
            ("GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\nSec-Fetch-Site: cross-site\r\n\r\n", 403),
            ("GET /TOKEN/../a.png HTTP/1.1\r\nHost: HOST\r\n\r\n", 404),
            ("GET /TOKEN/tile/0/0/9/0 HTTP/1.1\r\nHost: HOST\r\n\r\n", 404),
            ("GET /TOKEN/tile/1/0/0/0 HTTP/1.1\r\nHost: HOST\r\n\r\n", 404),
            ("GET /TOKEN/tile/-1/0/0 HTTP/1.1\r\nHost: HOST\r\n\r\n", 404),
            ("GET /TOKEN/measure HTTP/1.1\r\nHost: HOST\r\n\r\n", 405),
            ("POST /TOKEN/measure HTTP/1.1\r\nHost: HOST\r\nContent-Length: 2\r\n\r\n{}", 400),
            ("POST /TOKEN/measure HTTP/1.1\r\nHost: HOST\r\nContent-Length: 99999999\r\n\r\n", 413),
            ("POST /TOKEN/measure HTTP/1.1\r\nHost: HOST\r\nTransfer-Encoding: chunked\r\n\r\n", 400),
            ("nonsense\r\n\r\n", 400),
        ] {
            assert_eq!(ask(server, request).0, expected, "{request}");
        }
        let long = format!("GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\nX: {}", "x".repeat(20_000));
        assert_eq!(ask(server, &long).0, 431);
    });
}

#[test]
fn what_is_pointed_at_is_measured_and_the_rest_predicted() {
    with_server(Duration::from_secs(3), |server| {
        let (status, answer) = ask(server, &post("measure", r#"{"photo":0,"x":41,"y":31}"#));
        let value: Value = serde_json::from_str(answer.split("\r\n\r\n").nth(1).unwrap()).unwrap();
        let off = |key: &str, truth: f64| (value[key].as_f64().unwrap() - truth).abs();
        assert!(status == 200 && off("x", 40.25) < 0.02 && off("y", 30.0) < 0.02, "{value}");
        assert!(value["covariance"].is_array() && value["method"].as_str().unwrap().starts_with("parametric_corner"), "{value}");
        let (_, answer) = ask(server, &post("measure", r#"{"photo":0,"x":80,"y":10}"#));
        assert!(answer.contains("\"rejected\"") && answer.contains("\"meaning\""), "{answer}");
        assert_eq!(ask(server, &post("measure", r#"{"photo":1,"x":80,"y":10}"#)).0, 404);
        assert_eq!(ask(server, &post("measure", r#"{"photo":0}"#)).0, 400);
        let (_, answer) = ask(server, &post("predict", r#"{"photo":0,"points":[["t0",10,10],["t1",50,10],["t2",50,50],["t3",10,50]]}"#));
        let value: Value = serde_json::from_str(answer.split("\r\n\r\n").nth(1).unwrap()).unwrap();
        assert_eq!(value["targets"][0][0], "t4");
        assert!((value["targets"][0][1].as_f64().unwrap() - 30.0).abs() < 1e-6, "{value}");
        let (_, answer) = ask(server, &post("predict", r#"{"photo":0,"points":[["t0",10,10]]}"#));
        assert!(answer.contains("1 of 4 points"), "{answer}");
    });
}

#[test]
fn a_server_that_nobody_asks_ends() {
    let begun = Instant::now();
    with_server(Duration::from_millis(300), |server| assert_eq!(ask(server, "GET / HTTP/1.1\r\nHost: HOST\r\n\r\n").0, 403));
    assert!(begun.elapsed() < Duration::from_secs(20));
}

fn sent(server: &Server, since: Option<&str>, changes: &Value) -> (u16, Value) {
    let (status, answer) = ask(server, &post("points", &json!({ "since": since, "changes": changes }).to_string()));
    (status, serde_json::from_str(answer.split("\r\n\r\n").nth(1).unwrap()).unwrap_or_default())
}

#[test]
fn points_of_two_pages_are_merged_on_the_disk_and_outlive_the_server() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pointed.csv");
    fs::write(&path, "image,target,x,y\nother.png,t9,7,8\na.png,t0,1,2\n").unwrap();
    let idle = Duration::from_secs(3);
    with_folder(idle, PATIENCE, &folder, |server| {
        let (_, first) = sent(server, None, &json!([]));
        assert_eq!(first["points"], json!([[["t0", 1.0, 2.0]]]));
        // Two pages that do not know of each other.
        sent(server, first["revision"].as_str(), &json!([[0, "t1", [3.5, 4.25]], [0, "=t2", [5, 6]]]));
        let (_, second) = sent(server, first["revision"].as_str(), &json!([[0, "t0", null], [0, "t3", [9, 9]]]));
        assert_eq!(second["points"], json!([[["t1", 3.5, 4.25], ["=t2", 5.0, 6.0], ["t3", 9.0, 9.0]]]));
        // What is known is not said again; what another program writes is.
        assert!(sent(server, second["revision"].as_str(), &json!([])).1.get("points").is_none());
        fs::write(&path, "image,target,x,y\nother.png,t9,7,8\na.png,t1,3.5,4\n").unwrap();
        assert_eq!(sent(server, second["revision"].as_str(), &json!([])).1["points"], json!([[["t1", 3.5, 4.0]]]));
        for wrong in [json!([[1, "t1", [1, 1]]]), json!([[0, " ", [1, 1]]]), json!([[0, "a\nb", [1, 1]], [0, "t5", [1, 1]]])] {
            assert_eq!(sent(server, None, &wrong).0, 500, "{wrong}");
        }
        assert_eq!(ask(server, &post("points", r#"{"changes":[[0,"t1"]]}"#)).0, 400);
    });
    with_folder(idle, PATIENCE, &folder, |server| {
        assert_eq!(sent(server, None, &json!([[0, "t4", [2, 2]]])).1["points"], json!([[["t1", 3.5, 4.0], ["t4", 2.0, 2.0]]]));
    });
    let points = read_points(&path).unwrap().points;
    let rows: Vec<_> = points.rows().map(|row| (row.image, row.target, row.start.kind)).collect();
    assert_eq!(rows, [("other.png", "t9", None), ("a.png", "t1", None), ("a.png", "t4", Some(TargetKind::ChessCorner))]);
}

#[test]
fn a_table_of_something_else_is_not_written_to() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pointed.csv");
    for (text, expected) in [
        ("a,b\n1,2\n", "unknown"),
        ("image,target,x,y,sxx,sxy,syy\na.png,t0,1,2,1,0,1\n", "measured points"),
        ("image,target,x,y,method,status,reason\na.png,t0,,,forstner,rejected,border\n", "measured points"),
    ] {
        fs::write(&path, text).unwrap();
        let error = Kept::open(OutputFile::open(&path).unwrap(), vec!["a.png".to_owned()], None).err().unwrap();
        assert!(error.contains("pointed.csv") && error.contains(expected), "{error}");
    }
}

/// Connections that send next to nothing.
fn slow(server: &Server, count: usize) -> Vec<TcpStream> {
    let one = |_| {
        let mut stream = TcpStream::connect(server.address).unwrap();
        stream.write_all(b"GET /").unwrap();
        stream
    };
    (0..count).map(one).collect()
}

#[test]
fn slow_clients_block_nobody_and_do_not_keep_the_server() {
    let begun = Instant::now();
    with_server(Duration::from_secs(3), |server| {
        let held = slow(server, 3 * MOST);
        assert_eq!(ask(server, "GET /TOKEN/ HTTP/1.1\r\nHost: HOST\r\n\r\n").0, 200);
        // They stay open until the server has ended: nobody uses the page any more.
        std::mem::forget(held);
    });
    assert!(begun.elapsed() < PATIENCE, "{:?}", begun.elapsed());
}

#[test]
fn a_deadline_holds_within_a_line() {
    with_folder(Duration::from_secs(3), Duration::from_millis(300), &tempfile::tempdir().unwrap(), |server| {
        let (begun, [mut stream]) = (Instant::now(), <[TcpStream; 1]>::try_from(slow(server, 1)).unwrap());
        // A byte now and then: each comes in time, the line never.
        let dripped = (0..40).take_while(|_| {
            thread::sleep(Duration::from_millis(50));
            stream.write_all(b"x").is_ok()
        });
        assert!(dripped.count() < 40 && begun.elapsed() < Duration::from_secs(2));
    });
}

#[test]
fn pages_that_only_ask_what_others_changed_do_not_keep_the_server() {
    with_server(Duration::from_millis(600), |server| {
        let request = post("points", r#"{"since":null,"changes":[]}"#).replace("HOST", &server.address.to_string());
        let is_answered = |within: Duration| {
            let mut stream = TcpStream::connect(server.address).unwrap();
            stream.set_read_timeout(Some(within)).unwrap();
            stream.write_all(request.replace("TOKEN", server.guard.token()).as_bytes()).ok();
            stream.read(&mut [0; 16]).is_ok_and(|read| read > 0)
        };
        assert!(is_answered(PATIENCE));
        let (begun, short) = (Instant::now(), Duration::from_millis(300));
        while begun.elapsed() < Duration::from_secs(2) {
            is_answered(short);
            thread::sleep(Duration::from_millis(50));
        }
        assert!(!is_answered(short), "it has ended");
    });
}
