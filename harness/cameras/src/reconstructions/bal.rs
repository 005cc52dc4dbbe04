//! Problems of Bundle Adjustment in the Large: observations, a camera an image, points; y up, the camera looks along -z, the principal point at (0, 0).

use calibench_model::Reconstruction;
use calibench_model::camera::ImageSize;
use calibench_model::reconstruction::{OrientedImage, TiePoint, TieSight};
use nalgebra::Point3;

use super::lens::{frame_around, from_the_middle, one_focal};
use super::{oriented, within};
use crate::CameraFileError;
use crate::brown::{middle, positive};
use crate::pose::{of_rotation_vector, of_rt};
use crate::words::Words;

/// Three counts on the first line, two indices and two coordinates on the second.
pub(super) fn recognise(text: &str) -> bool {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty()).map(|line| line.split_whitespace().collect::<Vec<_>>());
    let (first, second) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let whole = |word: &&str| word.bytes().all(|byte| byte.is_ascii_digit());
    first.len() == 3 && first.iter().all(whole) && second.len() == 4 && second[..2].iter().all(whole)
}

struct Row {
    image: usize,
    point: usize,
    at: [f64; 2],
}

pub(super) fn read(text: &str, size: Option<ImageSize>) -> Result<Reconstruction, CameraFileError> {
    let mut words = Words::new(text);
    let (images, points, count) =
        (words.whole("the number of cameras")?, words.whole("the number of points")?, words.whole("the number of observations")?);
    let mut rows = Vec::new();
    for _ in 0..count {
        let what = "an observation: camera, point, x, y";
        let mut index =
            |name, most| words.whole(what).and_then(|index| within(name, index, most).map_err(|error| words.wrong(error, what)));
        let (image, point) = (index("camera", images)?, index("point", points)?);
        rows.push(Row { image, point, at: words.numbers(what)? });
    }
    let size = size.unwrap_or_else(|| frame_around(largest(rows.iter().map(|row| row.at))));
    let centre = middle(size);
    let mut out = Reconstruction::default();
    for index in 0..images {
        let what = format!("the nine numbers of camera {index}");
        let [a, b, c, x, y, z, f, k1, k2] = words.numbers(&what)?;
        let at = |error| words.wrong(error, &what);
        positive("f", f).map_err(at)?;
        let pose = of_rotation_vector([a, b, c]);
        let pose = of_rt(pose, [x, y, z]).map_err(at)?.with_y_and_z_reversed();
        let name = index.to_string();
        let mut camera = one_focal(&name, size, f, [centre.x, centre.y], [k1, k2, 0.0, 0.0], 2);
        // There is no frame in which a principal point could lie elsewhere.
        camera.principal_point.clear();
        out.cameras.push(camera);
        out.images.push(OrientedImage { name, camera: index, pose: oriented(&pose) });
    }
    for index in 0..points {
        let [x, y, z] = words.numbers(&format!("the three numbers of point {index}"))?;
        out.points.push(TiePoint { name: index.to_string(), position: Point3::new(x, y, z) });
    }
    words.ends()?;
    let sight = |row: Row| TieSight { image: row.image, point: row.point, position: from_the_middle(size, row.at) };
    out.sights = rows.into_iter().map(sight).collect();
    Ok(out)
}

/// The largest absolute x and y.
pub(super) fn largest(all: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    all.fold([0.0; 2], |most, at| [most[0].max(at[0].abs()), most[1].max(at[1].abs())])
}
