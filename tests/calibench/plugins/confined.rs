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
