//! What a scenario sweeps.

use serde::{Deserialize, Serialize};

use crate::names::cell_run;

/// The swept keys of a scenario and its cells, each the scenario with one value of each key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// In the order of the file; the last changes fastest.
    pub axes: Vec<Axis>,
    /// In the order of their folders.
    pub cells: Vec<Cell>,
}

/// A swept key with its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// The key with its tables, as in `optics.blur`.
    pub path: String,
    /// The key as reports call it, as in `blur`.
    pub name: String,
    /// Its values, in their order.
    pub values: Vec<Value>,
    /// The values are steps of a factor, not of a difference.
    pub log: bool,
}

/// One value of a swept key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Value {
    /// As labels show it.
    pub text: String,
    /// The value, if it is a number, in the unit of its key.
    pub number: Option<f64>,
}

/// A cell of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Its values in a line, as in `blur=0.3, grey_noise=0.01`.
    pub label: String,
    /// The place of its value on each axis.
    pub places: Vec<usize>,
}

impl Axis {
    /// Whether the user calls it `name`: its key, or its whole path.
    pub fn is_called(&self, name: &str) -> bool {
        self.path == name || self.name == name || self.path.rsplit('.').next() == Some(name)
    }

    /// Whether it is the parameter `key` of operator `operator`.
    fn sets(&self, operator: &str, key: &str) -> bool {
        let parts: Vec<&str> = self.path.split('.').collect();
        parts.first() == Some(&"method") && parts.last() == Some(&key) && (parts.len() == 2 || parts[1] == operator)
    }
}

impl Sweep {
    /// The value on each axis of cell `index`.
    ///
    /// # Panics
    /// Never for an index below the number of cells.
    pub fn values(&self, index: usize) -> Vec<&Value> {
        self.axes.iter().zip(&self.cells[index].places).map(|(axis, place)| &axis.values[*place]).collect()
    }

    /// The name of the run of cell `index` of the scenario `name`, as its records have it.
    ///
    /// # Panics
    /// Never for an index below the number of cells.
    pub fn run(&self, name: &str, index: usize) -> String {
        cell_run(name, &self.cells[index].label)
    }

    /// The label of method `label` without its swept parameters: what is the same method in all cells.
    pub fn method(&self, label: &str) -> String {
        let Some((name, settings)) = label.split_once(':') else { return label.to_owned() };
        let swept = |setting: &&str| {
            let key = setting.split('=').next().unwrap_or_default();
            self.axes.iter().any(|axis| axis.sets(name, key))
        };
        let kept: Vec<&str> = settings.split(',').filter(|setting| !swept(setting)).collect();
        if kept.is_empty() { name.to_owned() } else { format!("{name}:{}", kept.join(",")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(path: &str) -> Axis {
        let values = vec![Value { text: "1".into(), number: Some(1.0) }, Value { text: "2".into(), number: Some(2.0) }];
        Axis { path: path.into(), name: path.rsplit('.').next().unwrap().into(), values, log: false }
    }

    #[test]
    fn methods_are_named_without_what_is_swept() {
        let sweep = Sweep { axes: vec![axis("optics.blur"), axis("method.window"), axis("method.lsm.sigma")], cells: Vec::new() };
        assert_eq!(sweep.method("forstner:window=11"), "forstner");
        assert_eq!(sweep.method("opencv_subpix:window=7,epsilon=0.1"), "opencv_subpix:epsilon=0.1");
        assert_eq!((sweep.method("lsm:sigma=2"), sweep.method("other:sigma=2")), ("lsm".into(), "other:sigma=2".into()));
        assert_eq!(sweep.method("pixel"), "pixel");
    }

    #[test]
    fn a_cell_has_the_values_of_its_places() {
        let cell = Cell { label: "blur=2, window=1".into(), places: vec![1, 0] };
        let sweep = Sweep { axes: vec![axis("optics.blur"), axis("method.window")], cells: vec![cell] };
        assert_eq!(sweep.values(0).iter().map(|value| value.text.as_str()).collect::<Vec<_>>(), ["2", "1"]);
        assert!(sweep.axes[0].is_called("blur") && sweep.axes[0].is_called("optics.blur") && !sweep.axes[0].is_called("optics"));
    }

    #[test]
    fn a_key_is_called_by_its_path_its_last_part_or_its_name_in_reports() {
        let axis = Axis { name: "width".into(), ..axis("method.lsm.window") };
        let called = ["method.lsm.window", "window", "width", "method", "lsm.window", ""].map(|name| axis.is_called(name));
        assert_eq!(called, [true, true, true, false, false, false]);
    }

    #[test]
    fn a_key_of_the_scene_or_of_another_operator_is_no_setting_of_a_method() {
        let sets = |path: &str, operator: &str, key: &str| axis(path).sets(operator, key);
        assert!(sets("method.window", "lsm", "window") && sets("method.lsm.window", "lsm", "window"));
        assert!(!sets("optics.window", "lsm", "window") && !sets("optics.lsm.window", "lsm", "window"));
        assert!(!sets("method.window", "lsm", "sigma") && !sets("method.forstner.window", "lsm", "window"));
        assert!(!sets("method.lsm.deep.sigma", "lsm", "window"));
    }
}
