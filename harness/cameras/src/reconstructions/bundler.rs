//! Bundler's bundle.out: a camera an image, then points with the images that show them; y up, from the middle of the frame.

use calibench_model::Reconstruction;
use calibench_model::camera::ImageSize;
use calibench_model::named_camera::Pose;
use calibench_model::reconstruction::{OrientedImage, TiePoint, TieSight};
use nalgebra::Point3;

use super::bal::largest;
use super::lens::{frame_around, from_the_middle, one_focal};
use super::{oriented, within};
use crate::CameraFileError;
use crate::brown::{middle, positive};
use crate::pose::of_rt;
use crate::words::Words;

const HEADER: &str = "# Bundle file";

pub(super) fn recognise(text: &str) -> bool {
    text.trim_start().starts_with(HEADER)
}

/// f, k1, k2 and the pose of an image; `None` if Bundler did not orient it.
type Oriented = Option<([f64; 3], Pose)>;

fn image(words: &mut Words<'_>, index: usize) -> Result<Oriented, CameraFileError> {
    let what = format!("the fifteen numbers of camera {index}");
    let inner: [f64; 3] = words.numbers(&what)?;
    let rows = [words.numbers(&what)?, words.numbers(&what)?, words.numbers(&what)?];
    let t = words.numbers(&what)?;
    if inner[0] == 0.0 {
        return Ok(None);
    }
    let at = |error| words.wrong(error, &what);
    positive("f", inner[0]).map_err(at)?;
    Ok(Some((inner, of_rt(rows, t).map_err(at)?.with_y_and_z_reversed())))
}

pub(super) fn read(text: &str, size: Option<ImageSize>) -> Result<Reconstruction, CameraFileError> {
    // The comment is the first line alone.
    let body = text.trim_start().split_once('\n').map_or("", |(_, body)| body);
    let mut words = Words::new(body);
    let (count, points) = (words.whole("the number of cameras")?, words.whole("the number of points")?);
    let mut all = Vec::new();
    for index in 0..count {
        all.push(image(&mut words, index)?);
    }
    let (mut out, mut rows) = (Reconstruction::default(), Vec::new());
    for index in 0..points {
        let what = format!("point {index}");
        let [x, y, z] = words.numbers(&what)?;
        let _colour: [f64; 3] = words.numbers(&what)?;
        for _ in 0..words.whole(&what)? {
            let image = words.whole(&what).and_then(|image| within("camera", image, count).map_err(|error| words.wrong(error, &what)))?;
            let _key = words.whole(&what)?;
            rows.push((image, index, words.numbers(&what)?));
        }
        out.points.push(TiePoint { name: index.to_string(), position: Point3::new(x, y, z) });
    }
    words.ends()?;
    let size = size.unwrap_or_else(|| frame_around(largest(rows.iter().map(|row| row.2))));
    let centre = middle(size);
    let mut place = vec![None; count];
    for (index, oriented_image) in all.iter().enumerate() {
        let Some(([f, k1, k2], pose)) = oriented_image else { continue };
        place[index] = Some(out.images.len());
        let (name, camera) = (index.to_string(), out.cameras.len());
        let mut interior = one_focal(&name, size, *f, [centre.x, centre.y], [*k1, *k2, 0.0, 0.0], 2);
        interior.principal_point.clear();
        out.cameras.push(interior);
        out.images.push(OrientedImage { name, camera, pose: oriented(pose) });
    }
    let unused = count - out.images.len();
    if unused > 0 {
        out.notes.push(format!("{unused} images that are not oriented were left out"));
    }
    let sight =
        |(image, point, at): (usize, usize, [f64; 2])| Some(TieSight { image: place[image]?, point, position: from_the_middle(size, at) });
    out.sights = rows.into_iter().filter_map(sight).collect();
    Ok(out)
}
