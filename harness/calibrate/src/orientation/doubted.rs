//! What is in doubt of exterior orientations.

use calibench_adjust::approximate::Resection;

use super::misfit::Misfit;
use super::{ImageOrientation, Orientations};
use crate::Survey;
use crate::doubt::ALPHA;
use crate::doubt::gross::LEFT_OUT;
use crate::doubt::impossible::half_of;
use crate::error::few;

/// How many times as large as in the middle of all images residuals are that are said.
const LARGER: f64 = 3.0;

impl Orientations {
    /// What is in doubt of each image that has an orientation, in words: points outside the image, another
    /// pose, points that do not fit or were left out, residuals that no operator leaves, or that are larger
    /// than the standard deviation that was stated, or else than those of the other images.
    pub fn doubts(&self, survey: &Survey) -> Vec<Vec<String>> {
        let middle = self.middle();
        let of = |one: &ImageOrientation| {
            let misfit = one.misfit.as_ref().map(|misfit| words(misfit, one, survey));
            let size = self.sigma_px.map_or_else(|| beside(one, middle), |sigma| stated(one, sigma));
            [outside(one), rival(one), misfit.or_else(|| far(one)), left_out(one), size].into_iter().flatten().collect()
        };
        self.found.iter().map(of).collect()
    }
}

fn outside(one: &ImageOrientation) -> Option<String> {
    let count = one.outside;
    (count > 0).then(|| format!("{count} points lie outside the image: is the camera's size that of the image, and are x and y right?"))
}

fn far(one: &ImageOrientation) -> Option<String> {
    let half = half_of(one.found.residuals.iter().copied().flatten())?;
    Some(format!(
        "residuals of {half:.1} px and more at half of the points are no operator's: are names, object coordinates and the camera right?"
    ))
}

fn rival(one: &ImageOrientation) -> Option<String> {
    one.has_rival().then(|| "another pose fits nearly as well".into())
}

fn words(misfit: &Misfit, one: &ImageOrientation, survey: &Survey) -> String {
    let names: Vec<String> = misfit.targets.iter().map(|&target| survey.target(target).to_owned()).collect();
    let off = misfit.worst.map_or_else(|| "the camera does not picture the first".into(), |off| format!("the first is {off:.3} px off"));
    let kept = one.points - one.rejected.len();
    format!(
        "{} of {kept} points do not fit: {} ({off}); are names and positions right? --tolerance leaves out what is wrong",
        names.len(),
        few(&names)
    )
}

fn left_out(one: &ImageOrientation) -> Option<String> {
    let count = one.rejected.len();
    let are_many = count as f64 > LEFT_OUT * one.points as f64;
    are_many.then(|| format!("{count} of {} points were left out, and what is left need not be the right part", one.points))
}

fn stated(one: &ImageOrientation, sigma_px: f64) -> Option<String> {
    let Resection { sigma0, .. } = one.found;
    one.residuals().exceed(sigma_px, ALPHA).then(|| format!("residuals say {sigma0:.4} px of an image coordinate, --sigma {sigma_px}"))
}

fn beside(one: &ImageOrientation, middle: Option<f64>) -> Option<String> {
    let (Resection { sigma0, .. }, middle) = (&one.found, middle?);
    let are_larger = *sigma0 > LARGER * middle && one.residuals().exceed(middle, ALPHA);
    are_larger.then(|| format!("residuals say {sigma0:.4} px of an image coordinate, {middle:.4} px in the middle of all images"))
}
