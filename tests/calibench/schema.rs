//! The schema that editors read is that of the checks, and the scenarios of the project pass both.

use calibench_scenario::catalogue::Catalogue;
use calibench_scenario::schema::schema;

use crate::project::root;

#[test]
fn the_committed_schema_is_current() {
    let committed = std::fs::read_to_string(root().join("scenarios/scenario.schema.json")).unwrap();
    let current = format!("{:#}\n", schema(&calibench_opencv::registry()));
    assert!(committed == current, "scenarios/scenario.schema.json is stale: run `just schema`");
}

#[test]
fn every_scenario_passes_names_the_schema_and_says_why() {
    let catalogue = Catalogue::new(root().join("scenarios"));
    let names = catalogue.names().unwrap();
    assert!(names.len() >= 4, "{names:?}");
    for name in names {
        let scenario = catalogue.load(&name, &calibench_opencv::registry()).unwrap_or_else(|error| panic!("{error}"));
        let first = scenario.text.lines().next().unwrap();
        let schema = first.strip_prefix("#:schema ").unwrap_or_else(|| panic!("{name}: first line is {first}"));
        let folder = root().join("scenarios").join(&name);
        assert!(folder.parent().unwrap().join(schema).is_file(), "{name}: {schema} is not there");
        assert!(scenario.why.split_whitespace().count() > 5, "{name}");
    }
}

#[test]
fn the_schema_knows_every_method_and_parameter() {
    let schema = schema(&calibench_opencv::registry()).to_string();
    for method in calibench_opencv::registry().methods() {
        assert!(schema.contains(&format!("\"const\":\"{}\"", method.name)), "{}", method.name);
        for parameter in method.parameters {
            assert!(schema.contains(parameter.about), "{}: {}", method.name, parameter.name);
        }
    }
    for key in ["why", "source", "seed", "trials", "scene", "photographs", "polygon", "target", "vertices", "pointing", "board"] {
        assert!(schema.contains(&format!("\"{key}\":{{")), "{key}");
    }
}
