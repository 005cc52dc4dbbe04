//! Lens and sensor as each station of a run has them.

use std::sync::Arc;

use calibench_model::camera::CameraModel;
use calibench_scenario::{Imaging, ViewsSubject};
use calibench_synth::raster::Renderer;
use calibench_synth::stations::{Own, Station};

use crate::RunError;
use crate::bounds::TargetBounds;

/// Lens and sensor of a station, and what renders and bounds with them.
pub(crate) struct Setup {
    own: Own,
    /// Lens and sensor.
    pub imaging: Imaging,
    /// What renders through the lens.
    pub renderer: Arc<Renderer>,
    /// What bounds methods in its images, if anything does.
    pub bounds: Option<TargetBounds>,
}

/// The setups of a run, those that differ: stations share lens and sensor but for what they have of their own.
pub(crate) struct Setups(Vec<Arc<Setup>>);

impl Setups {
    /// Those of `stations` of `subject`; `bounds` makes what bounds methods under a lens and a sensor.
    ///
    /// # Errors
    /// Lenses and sensors that cannot be.
    pub fn new(
        subject: &ViewsSubject,
        stations: &[Station],
        bounds: impl Fn(&Imaging) -> Result<Option<TargetBounds>, RunError>,
    ) -> Result<Self, RunError> {
        let mut setups = Self(Vec::new());
        for station in stations {
            if setups.0.iter().all(|setup| setup.own != station.own) {
                let setup = setups.made(subject, station.own, &bounds)?;
                setups.0.push(Arc::new(setup));
            }
        }
        Ok(setups)
    }

    /// That of a station that has something of its `own`; without bounds if no station had that before.
    ///
    /// # Errors
    /// A lens or a sensor that cannot be.
    pub fn of(&self, subject: &ViewsSubject, own: Own) -> Result<Arc<Setup>, RunError> {
        match self.0.iter().find(|setup| setup.own == own) {
            Some(setup) => Ok(setup.clone()),
            None => self.made(subject, own, |_| Ok(None)).map(Arc::new),
        }
    }

    fn made(
        &self,
        subject: &ViewsSubject,
        own: Own,
        bounds: impl Fn(&Imaging) -> Result<Option<TargetBounds>, RunError>,
    ) -> Result<Setup, RunError> {
        let imaging = subject.imaging.with(&own)?;
        let alike = self.0.iter().find(|setup| setup.imaging.optics == imaging.optics);
        let size = subject.camera.size();
        let renderer = match alike {
            Some(setup) => setup.renderer.clone(),
            None => Arc::new(imaging.renderer(size.width as usize, size.height as usize)?),
        };
        // The bounds are those of even light.
        let bounds = if own.gradient.is_some() { None } else { bounds(&imaging)? };
        Ok(Setup { own, imaging, renderer, bounds })
    }
}
