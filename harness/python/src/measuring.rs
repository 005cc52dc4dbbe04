//! `measure`: points of one image.

use calibench_measure::coverage::all_busy;
use calibench_model::{Affine, Covariance, Measurement, Rejection, Start, TargetKind};
use calibench_photographs::points::{is_one_share, shared_out};
use calibench_project::Pictured;
use numpy::{PyArray2, PyArray3, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::arrays::{NOWHERE, matrices, of_covariances, of_positions, positions};
use crate::error::{UnavailableError, doubt, input};
use crate::grey::Grey;
use crate::pickled::{Pickled, Reduced, reduced};
use crate::session::{methods_of, with_project_of};
use crate::stopped::interruptible;

/// What a method made of points: see `calibench.Measured`.
#[pyclass(frozen, get_all, module = "calibench", name = "Measured")]
pub struct Measured {
    /// Positions, px; NaN where there is none.
    xy: Py<PyArray2<f64>>,
    /// Covariances, px^2; NaN where there is none.
    cov: Py<PyArray3<f64>>,
    /// `measured` or `rejected`.
    status: Vec<&'static str>,
    /// Why a point was rejected.
    reason: Vec<Option<&'static str>>,
    /// The method with its parameters, in one word.
    method: String,
    /// Its version.
    version: String,
}

#[pymethods]
impl Measured {
    fn __len__(&self) -> usize {
        self.status.len()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        let measured = self.status.iter().filter(|status| **status == MEASURED).count();
        format!("Measured({measured} of {} points by {} {})", self.status.len(), self.method, self.version)
    }
}

impl Measured {
    /// Why each point was rejected, if so.
    pub fn reasons(&self) -> &[Option<&'static str>] {
        &self.reason
    }

    /// Whether the method gave any point a covariance.
    pub fn has_covariances(&self, py: Python<'_>) -> bool {
        self.cov.bind(py).readonly().as_array().iter().any(|value| value.is_finite())
    }
}

const MEASURED: &str = "measured";

const fn status(is_measured: bool) -> &'static str {
    if is_measured { MEASURED } else { "rejected" }
}

/// Measures points of an image: as `calibench measure` does.
#[pyfunction]
#[pyo3(signature = (image, xy, method = "forstner", *, kind = None, axes = None, cov = None))]
pub fn measure(
    py: Python<'_>,
    image: &Bound<'_, PyAny>,
    xy: &Bound<'_, PyAny>,
    method: &str,
    kind: Option<&Bound<'_, PyAny>>,
    axes: Option<&Bound<'_, PyAny>>,
    cov: Option<&Bound<'_, PyAny>>,
) -> PyResult<Measured> {
    let starts = starts(xy, kind, axes, cov)?;
    with_project_of(method, |here| {
        let methods = methods_of(py, here, &[method.to_owned()], Pictured::Photographs)?;
        let Some(configured) = methods.first() else { return Err(input("method: expected a name")) };
        let operator =
            configured.operator.as_deref().map_err(|why| UnavailableError::new_err(format!("{}: unavailable: {why}", configured.label)))?;
        let needed = configured.kinds.is_some() || operator.needs_kind();
        if let Some(bare) = starts.iter().position(|start| needed && start.kind.is_none()) {
            return Err(input(format!(
                "{}: point {bare} does not say what is pictured, which this method must know; give kind ({}), or the method its `shape`",
                configured.label,
                TargetKind::ALL.map(TargetKind::name).join(", ")
            )));
        }
        all_busy(&methods, starts.iter().filter_map(|start| start.kind)).map_err(|gap| input(format!("method: {gap}")))?;
        if let Some(start) = starts.iter().find(|start| !configured.measures(start.kind)) {
            let kind = start.kind.map_or("", TargetKind::name);
            return Err(input(format!(
                "{}: does not measure the kind `{kind}`; measure these points with another method",
                configured.label
            )));
        }
        let grey = Grey::of(image)?;
        let picture = grey.image()?;
        let measured = || shared_out(operator, &picture, &starts);
        // To wake other threads takes longer than to measure a few points.
        let found = if is_one_share(operator, &starts) { py.detach(measured) } else { interruptible(py, measured)? };
        for note in operator.notes() {
            doubt(py, &format!("{}: {note}", configured.name()))?;
        }
        of_results(py, &found, configured.label.clone(), configured.version.clone())
    })
}

fn of_results(py: Python<'_>, found: &[Result<Measurement, Rejection>], method: String, version: String) -> PyResult<Measured> {
    Ok(Measured {
        xy: of_positions(py, found.iter().map(|result| result.as_ref().map_or(NOWHERE, |found| found.position)))?,
        cov: of_covariances(py, found.iter().map(|result| result.as_ref().ok().and_then(|found| found.covariance)))?,
        status: found.iter().map(|result| status(result.is_ok())).collect(),
        reason: found.iter().map(|result| result.as_ref().err().map(|why| why.name())).collect(),
        method,
        version,
    })
}

/// Positions, covariances, reasons, method, version.
type State<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>, Vec<Option<String>>, String, String);

impl Pickled for Measured {
    const CLASS: &'static str = "Measured";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        (self.xy.bind(py), self.cov.bind(py), &self.reason, &self.method, &self.version).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (xy, cov, reasons, method, version): State<'_> = state.extract()?;
        let known = |name: String| {
            let reason = Rejection::ALL.into_iter().map(Rejection::name).find(|known| *known == name);
            reason.ok_or_else(|| input(format!("`{name}` is no reason for which points are rejected")))
        };
        let reason = reasons.into_iter().map(|name| name.map(known).transpose()).collect::<PyResult<Vec<_>>>()?;
        let status = reason.iter().map(|reason| status(reason.is_none())).collect();
        Ok(Self { xy: xy.unbind(), cov: cov.unbind(), status, reason, method, version })
    }
}

/// Where measuring starts.
fn starts(
    xy: &Bound<'_, PyAny>,
    kind: Option<&Bound<'_, PyAny>>,
    axes: Option<&Bound<'_, PyAny>>,
    cov: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Start>> {
    let positions = positions(xy, "xy")?;
    let n = positions.len();
    let kinds = kinds(kind, n)?;
    let axes = axes.map(|axes| matrices(axes, n, "axes")).transpose()?;
    let cov = cov.map(|cov| matrices(cov, n, "cov")).transpose()?;
    let start = |(i, position)| Start {
        kind: kinds.as_ref().map(|kinds| kinds[i]),
        affine: axes.as_ref().map(|axes| affine(axes[i])),
        covariance: cov.as_ref().map(|cov| covariance(cov[i])),
        ..Start::at(position)
    };
    Ok(positions.into_iter().enumerate().map(start).collect())
}

/// The affine start of a matrix whose columns are the target's own axes.
pub fn affine([[axx, axy], [ayx, ayy]]: [[f64; 2]; 2]) -> Affine {
    Affine { axx, axy, ayx, ayy }
}

/// The covariance of a symmetric matrix, px^2.
pub fn covariance([[sxx, sxy], [_, syy]]: [[f64; 2]; 2]) -> Covariance {
    Covariance { sxx, sxy, syy }
}

/// One kind for all points, or one for each.
fn kinds(kind: Option<&Bound<'_, PyAny>>, n: usize) -> PyResult<Option<Vec<TargetKind>>> {
    let Some(kind) = kind else { return Ok(None) };
    let named = |name: &str| {
        let known = || TargetKind::ALL.map(TargetKind::name).join(", ");
        TargetKind::ALL
            .into_iter()
            .find(|kind| kind.name() == name)
            .ok_or_else(|| input(format!("kind: `{name}` is no kind of target; expected one of {}", known())))
    };
    if let Ok(name) = kind.extract::<String>() {
        return Ok(Some(vec![named(&name)?; n]));
    }
    let names: Vec<String> = kind.extract().map_err(|_| input("kind: expected a name, or a list of names, one for each point"))?;
    if names.len() != n {
        return Err(input(format!("kind: found {} names for {n} points; expected one, or one for each", names.len())));
    }
    Ok(Some(names.iter().map(|name| named(name)).collect::<PyResult<_>>()?))
}
