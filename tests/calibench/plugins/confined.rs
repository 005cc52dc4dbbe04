//! What a plug-in is kept from, as far as the kernel goes.

use std::net::TcpListener;

use super::{notes, versions, with_plugins};
use crate::project::{run, stderr};

/// Its version names what it could do.
const SPY: &str = r#"
import json, os, socket, sys
PROJECT, PORT = "@project@", @port@
done = []
def trying(name, act):
    try:
        act()
        done.append(name)
    except OSError:
        pass
def connected():
    socket.create_connection(("127.0.0.1", PORT), 2).close()
def listening():
    socket.socket().bind(("127.0.0.1", 0))
trying("scenario", lambda: open(PROJECT + "/scenarios/corners/noise.toml").read())
trying("folder", lambda: os.listdir(PROJECT + "/scenarios"))
trying("records", lambda: os.listdir(PROJECT))
trying("parent", lambda: os.listdir("/proc/%d/cwd/" % os.getppid()))
trying("command line", lambda: open("/proc/%d/cmdline" % os.getppid()).read())
trying("surroundings", lambda: open("/proc/%d/environ" % os.getppid()).read())
trying("processes", lambda: os.listdir("/proc"))
trying("signal", lambda: os.kill(os.getppid(), 0))
def abstract():
    other = socket.socket(socket.AF_UNIX)
    other.connect("\0@abstract@")
trying("abstract socket", abstract)
trying("write", lambda: open(PROJECT + "/methods/left", "w").write("x"))
trying("outside", lambda: open("@outside@/left", "w").write("x"))
trying("connect", connected)
trying("listen", listening)
if os.listdir("."): done.append("scratch not empty")
if PROJECT in " ".join(list(os.environ.values()) + [os.getcwd()]): done.append("environment")
allowed = []
def own(name, act):
    try: act()
    except OSError as error: done.append("%s: %s" % (name, error))
own("scratch", lambda: open("mine", "w").write("x"))
own("itself", lambda: open(PROJECT + "/methods/spy.py").read())
own("null", lambda: open("/dev/null", "w").write("x"))
own("self", lambda: open("/proc/self/status").read())
own("machine", lambda: open("/proc/meminfo").read())
stream = sys.stdin.buffer
stream.readline()
print(json.dumps({"version": "did " + (" ".join(done) or "nothing")}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    stream.read(asked["bytes"])
    print(json.dumps({"image": asked["image"], "xy": asked["starts"]}), flush=True)
"#;

#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn a_spy_reads_writes_and_calls_nothing_or_it_is_said() {
    let (listener, outside) = (TcpListener::bind("127.0.0.1:0").unwrap(), tempfile::tempdir().unwrap());
    let toml = "[[plugin]]\nname = \"spy\"\ncommand = [\"python3\", \"spy.py\"]\n";
    let project = with_plugins(&[("spy.toml", toml)]);
    let text = SPY.replace("@project@", &project.path().display().to_string());
    let text = text.replace("@port@", &listener.local_addr().unwrap().port().to_string());
    let name = format!("calibench-test-{}", std::process::id());
    let _abstract = {
        use std::os::linux::net::SocketAddrExt;
        use std::os::unix::net::{SocketAddr, UnixListener};
        UnixListener::bind_addr(&SocketAddr::from_abstract_name(&name).unwrap()).unwrap()
    };
    let text = text.replace("@abstract@", &name);
    let text = text.replace("@outside@", &outside.path().display().to_string());
    std::fs::write(project.path().join("methods/spy.py"), text).unwrap();
    let output = run(project.path(), &["run", "corners/noise", "--trials", "1", "-q", "-m", "spy"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let did = versions(project.path(), "spy").remove(0);
    if did.starts_with("did nothing (") {
        assert!(!notes(project.path()).contains("kept from"), "what was kept is not called into doubt");
    } else {
        // A kernel that knows less is told in the records.
        assert!(notes(project.path()).contains("not kept from"), "{did}");
    }
    assert!(!did.contains("environment") && !did.contains("scratch"), "{did}");
}

/// Starts something in a session of its own, whose parent ends at once, and then keeps its image waiting.
const LEAVER: &str = r#"
import json, os, subprocess, sys, time
stream = sys.stdin.buffer
stream.readline()
print(json.dumps({"version": "1"}), flush=True)
stream.readline()
if os.fork() == 0:
    os.setsid()
    subprocess.Popen(["sleep", "31536125"])
    os._exit(0)
time.sleep(60)
"#;

#[cfg_attr(not(all(python, target_os = "linux")), ignore = "no python3, or no /proc")]
#[test]
fn who_leaves_the_group_is_ended_with_it() {
    let toml = "[[plugin]]\nname = \"leaver\"\ncommand = [\"python3\", \"leaver.py\"]\nseconds = 2.0\n";
    let project = with_plugins(&[("leaver.toml", toml), ("leaver.py", LEAVER)]);
    let output = run(project.path(), &["run", "corners/noise", "--trials", "1", "-q", "-m", "forstner", "-m", "leaver"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(!super::hostile::is_running("31536125"));
}

/// A file in memory that is larger than the program may have.
const SHARED: &str = r#"
import json, os, sys
stream = sys.stdin.buffer
stream.readline()
print(json.dumps({"version": "1"}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    stream.read(asked["bytes"])
    os.ftruncate(os.memfd_create("x"), 101 * 10**6)
    print(json.dumps({"image": asked["image"], "xy": asked["starts"]}), flush=True)
"#;

#[cfg_attr(not(all(python, target_os = "linux")), ignore = "no python3, or no memfd")]
#[test]
fn a_file_in_memory_counts_as_memory() {
    for (memory, rejected) in [("100 MB", true), ("1 GB", false)] {
        let toml = format!("[[plugin]]\nname = \"shared\"\ncommand = [\"python3\", \"shared.py\"]\nmemory = \"{memory}\"\n");
        let project = with_plugins(&[("shared.toml", &toml), ("shared.py", SHARED)]);
        let output = run(project.path(), &["run", "corners/noise", "--trials", "1", "-q", "-m", "forstner", "-m", "shared"]);
        assert!(output.status.success(), "{}", stderr(&output));
        assert_eq!(notes(project.path()).contains("File too large"), rejected, "{memory}");
    }
}
