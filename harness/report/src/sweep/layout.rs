//! What of a sweep goes where: along x, into curves or along y, into panels.

use calibench_diagnostics::nearest;
use calibench_records::description::Sweep;
use thiserror::Error;

use super::metric::{Estimate, Metric};
use super::units;
use crate::load::sweep::LoadedSweep;

/// Something that varies in a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// The methods.
    Method,
    /// A swept key, by its place.
    Axis(usize),
}

/// What the user asks for, by names. `method` stands for the methods.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Along x [default: the first swept key].
    pub x: Option<String>,
    /// One curve for each value [default: the methods], or the y axis of a map.
    pub by: Option<String>,
    /// One panel for each value [default: what is left].
    pub facet: Option<String>,
    /// Held at one value: key and value.
    pub at: Vec<(String, String)>,
    /// Only these methods, if any are named.
    pub methods: Vec<String>,
}

/// A choice that the sweep cannot serve.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum LayoutError {
    /// No such dimension.
    #[error("`{name}` is not swept{}; swept are {known}, and `method` varies", proposal.as_ref().map_or(String::new(), |near| format!(", did you mean `{near}`?")))]
    Unknown {
        /// What was asked for.
        name: String,
        /// What is near.
        proposal: Option<String>,
        /// The names that there are.
        known: String,
    },
    /// One thing in two places.
    #[error("`{0}` is asked for twice; expected one place for it")]
    Twice(String),
    /// A value that is none of the axis.
    #[error("`{name}` has no value `{value}`; it has {known}")]
    NoValue {
        /// Of what.
        name: String,
        /// What was asked for.
        value: String,
        /// The names that there are.
        known: String,
    },
    /// More varies than a picture shows.
    #[error("{0} vary beside what is shown: hold all but one at a value, as in --at {1}")]
    Left(String, String),
    /// Methods along an axis of numbers.
    #[error("the methods cannot lie along x or y; expected a swept key")]
    MethodOnAxis,
}

/// Where each dimension goes.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Along x.
    pub x: usize,
    /// Into curves, or along y.
    pub by: Dimension,
    /// Into panels.
    pub facet: Option<Dimension>,
    /// The place of every axis that is held.
    held: Vec<usize>,
    /// The methods that are shown.
    methods: Vec<usize>,
    /// What is shown.
    pub metric: Metric,
}

/// A place in a sweep.
#[derive(Clone, Debug)]
pub struct At {
    places: Vec<usize>,
    method: usize,
}

impl Layout {
    /// The layout that `choice` asks for; `map` if `by` is the y axis of a map.
    ///
    /// # Errors
    /// What the sweep cannot serve.
    pub fn new(loaded: &LoadedSweep, choice: &Choice, metric: Metric, map: bool) -> Result<Self, LayoutError> {
        let axes = &loaded.sweep.axes;
        let named = |name: &Option<String>| name.as_ref().map(|name| dimension(&loaded.sweep, name)).transpose();
        let by = named(&choice.by)?.unwrap_or(Dimension::Method);
        let first = (0..axes.len()).find(|axis| Dimension::Axis(*axis) != by).unwrap_or(0);
        let Dimension::Axis(x) = named(&choice.x)?.unwrap_or(Dimension::Axis(first)) else { return Err(LayoutError::MethodOnAxis) };
        if map && by == Dimension::Method {
            return Err(LayoutError::MethodOnAxis);
        }
        let mut held = vec![0; axes.len()];
        let mut used = vec![Dimension::Axis(x), by];
        for (name, value) in &choice.at {
            let Dimension::Axis(axis) = dimension(&loaded.sweep, name)? else { return Err(LayoutError::MethodOnAxis) };
            held[axis] = place(&loaded.sweep, axis, value)?;
            used.push(Dimension::Axis(axis));
        }
        let methods = methods(loaded, &choice.methods)?;
        let facet = named(&choice.facet)?;
        used.extend(facet);
        for (index, dimension) in used.iter().enumerate() {
            if used[..index].contains(dimension) {
                return Err(LayoutError::Twice(key(loaded, *dimension)));
            }
        }
        let all = (0..axes.len()).map(Dimension::Axis).chain([Dimension::Method]);
        let size = |dimension: Dimension| if let Dimension::Axis(axis) = dimension { axes[axis].values.len() } else { methods.len() };
        let left: Vec<Dimension> = all.filter(|dimension| !used.contains(dimension) && size(*dimension) > 1).collect();
        let facet = match (&left[..], facet) {
            ([], facet) => facet,
            ([only], None) => Some(*only),
            (several, _) => {
                let names: Vec<String> = several.iter().map(|dimension| format!("`{}`", key(loaded, *dimension))).collect();
                let example = several.iter().find_map(|dimension| match dimension {
                    Dimension::Axis(axis) => Some(format!("{}={}", axes[*axis].name, axes[*axis].values[0].text)),
                    Dimension::Method => None,
                });
                let example = example.unwrap_or_else(|| format!("with -m {}", loaded.methods[methods[0]].name));
                return Err(LayoutError::Left(names.join(" and "), example));
            }
        };
        Ok(Self { x, by, facet, held, methods, metric })
    }

    /// The values of a dimension that are shown: their places.
    pub fn shown(&self, loaded: &LoadedSweep, dimension: Dimension) -> Vec<usize> {
        match dimension {
            Dimension::Method => self.methods.clone(),
            Dimension::Axis(axis) => (0..loaded.sweep.axes[axis].values.len()).collect(),
        }
    }

    /// The place from which panels, curves and points go on.
    pub fn start(&self) -> At {
        At { places: self.held.clone(), method: self.methods.first().copied().unwrap_or(0) }
    }

    /// The panels: their titles and places.
    pub fn panels(&self, loaded: &LoadedSweep) -> Vec<(String, At)> {
        let Some(facet) = self.facet else {
            let only = if self.by == Dimension::Method { String::new() } else { loaded.methods[self.start().method].name.clone() };
            return vec![(only, self.start())];
        };
        let panel = |place: usize| {
            let value = value(loaded, facet, place);
            let title = if facet == Dimension::Method { value } else { format!("{} = {value}", title(loaded, facet)) };
            (title, self.start().with(facet, place))
        };
        self.shown(loaded, facet).into_iter().map(panel).collect()
    }

    /// The figure at a place.
    pub fn estimate(&self, loaded: &LoadedSweep, at: &At) -> Option<Estimate> {
        self.metric.of(loaded.score(at.cell(loaded), at.method)?)
    }

    /// In words, what is held.
    pub fn held(&self, loaded: &LoadedSweep) -> String {
        let shown = |axis: usize| axis == self.x || self.by == Dimension::Axis(axis) || self.facet == Some(Dimension::Axis(axis));
        let axes = loaded.sweep.axes.iter().enumerate().filter(|(index, axis)| !shown(*index) && axis.values.len() > 1);
        axes.map(|(index, axis)| format!("; {} = {}", units::titled(axis), units::label(axis, &axis.values[self.held[index]]))).collect()
    }
}

impl At {
    /// The same place but for one dimension.
    #[must_use]
    pub fn with(&self, dimension: Dimension, place: usize) -> Self {
        let mut at = self.clone();
        match dimension {
            Dimension::Method => at.method = place,
            Dimension::Axis(axis) => at.places[axis] = place,
        }
        at
    }

    /// The index of its cell.
    pub fn cell(&self, loaded: &LoadedSweep) -> usize {
        self.places.iter().zip(&loaded.sweep.axes).fold(0, |index, (place, axis)| index * axis.values.len() + place)
    }

    /// Its place along a dimension.
    pub fn place(&self, dimension: Dimension) -> usize {
        match dimension {
            Dimension::Method => self.method,
            Dimension::Axis(axis) => self.places[axis],
        }
    }

    /// Its method.
    pub fn method(&self) -> usize {
        self.method
    }
}

/// The key of a dimension, as the user names it.
fn key(loaded: &LoadedSweep, dimension: Dimension) -> String {
    match dimension {
        Dimension::Method => "method".into(),
        Dimension::Axis(axis) => loaded.sweep.axes[axis].name.clone(),
    }
}

/// What a dimension is called in a picture.
pub fn title(loaded: &LoadedSweep, dimension: Dimension) -> String {
    match dimension {
        Dimension::Method => "method".into(),
        Dimension::Axis(axis) => units::titled(&loaded.sweep.axes[axis]),
    }
}

/// What a place of a dimension is called.
pub fn value(loaded: &LoadedSweep, dimension: Dimension, place: usize) -> String {
    match dimension {
        Dimension::Method => loaded.methods[place].name.clone(),
        Dimension::Axis(axis) => units::label(&loaded.sweep.axes[axis], &loaded.sweep.axes[axis].values[place]),
    }
}

/// The cells of a sweep in which every key of `at` has its value, in their order.
///
/// # Errors
/// [`LayoutError::Unknown`] for a key that is not swept, [`LayoutError::NoValue`] for a value that it does not have.
pub fn cells(sweep: &Sweep, at: &[(String, String)]) -> Result<Vec<usize>, LayoutError> {
    let held = at.iter().map(|(name, value)| match dimension(sweep, name)? {
        Dimension::Axis(axis) => Ok((axis, place(sweep, axis, value)?)),
        Dimension::Method => Err(LayoutError::MethodOnAxis),
    });
    let held = held.collect::<Result<Vec<_>, _>>()?;
    let fits = |cell: &usize| held.iter().all(|(axis, place)| sweep.cells[*cell].places[*axis] == *place);
    Ok((0..sweep.cells.len()).filter(fits).collect())
}

fn dimension(sweep: &Sweep, name: &str) -> Result<Dimension, LayoutError> {
    if name == "method" {
        return Ok(Dimension::Method);
    }
    let axes = &sweep.axes;
    axes.iter()
        .position(|axis| axis.path == name || axis.name == name)
        .or_else(|| axes.iter().position(|axis| axis.is_called(name)))
        .map_or_else(
            || {
                let known: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
                let proposal = nearest(name, known.iter().copied().chain(["method"])).map(str::to_owned);
                Err(LayoutError::Unknown { name: name.to_owned(), proposal, known: known.join(", ") })
            },
            |axis| Ok(Dimension::Axis(axis)),
        )
}

fn place(sweep: &Sweep, axis: usize, text: &str) -> Result<usize, LayoutError> {
    let (axis, number) = (&sweep.axes[axis], text.parse::<f64>().ok());
    let found = axis.values.iter().position(|value| value.text == text || (number.is_some() && value.number == number));
    found.ok_or_else(|| {
        let known: Vec<&str> = axis.values.iter().map(|value| value.text.as_str()).collect();
        LayoutError::NoValue { name: axis.name.clone(), value: text.to_owned(), known: known.join(", ") }
    })
}

/// The methods of these names, or all, that measured.
fn methods(loaded: &LoadedSweep, names: &[String]) -> Result<Vec<usize>, LayoutError> {
    let available = || loaded.methods.iter().enumerate().filter(|(_, method)| method.unavailable.is_none());
    if names.is_empty() {
        return Ok(available().map(|(index, _)| index).collect());
    }
    let mut found = Vec::new();
    for name in names {
        let fits = |label: &str| label == name || label.split(':').next() == Some(name);
        let before = found.len();
        found.extend(available().filter(|(_, method)| fits(&method.name)).map(|(index, _)| index));
        if found.len() == before {
            let known: Vec<&str> = available().map(|(_, method)| method.name.as_str()).collect();
            return Err(LayoutError::NoValue { name: "method".into(), value: name.clone(), known: known.join(", ") });
        }
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}
