//! The Python package: its own tests, beside this program.

#[test]
#[cfg_attr(not(python_package), ignore = "the Python package is not in target/python: `./bootstrap python` puts it there")]
fn the_package_passes_its_own_tests() {
    let Some(folder) = option_env!("CALIBENCH_PYTHON") else { return };
    let tests = concat!(env!("CARGO_MANIFEST_DIR"), "/../harness/python/tests");
    let done = std::process::Command::new(std::path::Path::new(folder).join("bin/python"))
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "-W", "ignore::calibench.DoubtWarning", tests])
        .env("CALIBENCH_PROGRAM", env!("CARGO_BIN_EXE_calibench-under-test"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    assert!(done.status.success(), "{}{}", String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
}
