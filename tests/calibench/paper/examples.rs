//! The examples without Rust, as CONTRIBUTING says to use them.

use std::fs;

use crate::project::{copy, root, run, stderr};

#[test]
fn a_testfield_and_a_published_table_of_ones_own_are_reported() {
    let project = copy();
    for (from, folder, to) in
        [("testfield.toml", "scenarios/example", "testfield.toml"), ("published-table.toml", "reference/published/example", "table-1.toml")]
    {
        fs::create_dir_all(project.path().join(folder)).unwrap();
        fs::copy(root().join("examples").join(from), project.path().join(folder).join(to)).unwrap();
    }
    for arguments in [
        &["run", "example/testfield", "-q"][..],
        &["report", "example", "-q"],
        &["list", "tables"],
        &["print", "example/testfield", "-o", "sheets"],
    ] {
        let output = run(project.path(), arguments);
        assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    }
    let page = fs::read_to_string(project.path().join("reports/example/README.md")).unwrap();
    // The mean error of the operator is well below a hundredth; half a pixel is far above what it leaves.
    assert!(
        page.starts_with("# example\n\nOf 2 printed figures 2 are predictions, of which 1 come out; 0 are not comparable.\n\n"),
        "{page}"
    );
    let row = |name: &str| page.lines().find(|line| line.starts_with(&format!("| {name} "))).unwrap_or_else(|| panic!("{name}: {page}"));
    assert!(row("mean error in x").contains("| reproduces "), "{page}");
    assert!(row("root mean square error").contains("| differs: 0."), "{page}");
    assert!(row("time, s").contains("not comparable (a)") && page.contains("- (a) times are in no record"), "{page}");
    // Twenty trials: the paper's single run is held against where single runs lie.
    assert!(page.contains("single runs, 95 %") && page.contains("the mean of 20 trials"), "{page}");
    // Without sets, all methods are shown on all targets.
    assert!(
        page.lines().any(|line| line.starts_with("| `forstner:window=11` ") && line.contains(" of 6 ") && line.contains("| all ")),
        "{page}"
    );
    let index = fs::read_to_string(project.path().join("reports/README.md")).unwrap();
    assert!(index.contains("- **[example](example/README.md)**: Of 2 printed figures 2 are predictions"), "{index}");
}
