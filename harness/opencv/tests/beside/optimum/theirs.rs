// Also a part of the benchmark `boards`.
//! OpenCV's own calibration of a board.

use opencv::calib3d::calibrate_camera_extended;
use opencv::core::{Mat, MatTraitConst, Point2f, Point3f, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS, Vector};

/// What OpenCV found.
pub struct Theirs {
    /// Root mean square of the residuals, px: `sqrt(mean(vx^2 + vy^2))`.
    pub rms: f64,
    /// fx, fy, cx, cy, k1, k2, p1, p2, k3.
    pub parameters: [f64; 9],
    /// Their standard deviations, as OpenCV reports them.
    pub sigmas: [f64; 9],
    /// Of each view: rotation vector and translation, x right, y down, z forward.
    pub poses: Vec<[f64; 6]>,
}

/// A board seen in several views.
pub struct Board {
    /// Columns and rows of the images.
    pub size: (i32, i32),
    /// X, Y of the corners in the plane, one list for each view.
    pub objects: Vec<Vec<[f64; 2]>>,
    /// Their images, px, in the same order.
    pub images: Vec<Vec<[f64; 2]>>,
}

/// Five coefficients from the corners alone; at most `steps` iterations, until the relative change of the parameters is below `change`.
pub fn calibrate(board: &Board, steps: i32, change: f64) -> opencv::Result<Theirs> {
    let object = |[x, y]: &[f64; 2]| Point3f::new(*x as f32, *y as f32, 0.0);
    let objects: Vector<Vector<Point3f>> = board.objects.iter().map(|view| view.iter().map(object).collect::<Vector<_>>()).collect();
    let image = |[x, y]: &[f64; 2]| Point2f::new(*x as f32, *y as f32);
    let images: Vector<Vector<Point2f>> = board.images.iter().map(|view| view.iter().map(image).collect::<Vector<_>>()).collect();
    let (mut k, mut d, mut each) = (Mat::default(), Mat::default(), Mat::default());
    let (mut r, mut t) = (Vector::<Mat>::new(), Vector::<Mat>::new());
    let (mut interior, mut exterior) = (Mat::default(), Mat::default());
    let criteria = TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, steps, change)?;
    let size = Size::new(board.size.0, board.size.1);
    let rms = calibrate_camera_extended(
        &objects,
        &images,
        size,
        &mut k,
        &mut d,
        &mut r,
        &mut t,
        &mut interior,
        &mut exterior,
        &mut each,
        0,
        criteria,
    )?;
    let mut parameters = [*k.at_2d::<f64>(0, 0)?, *k.at_2d(1, 1)?, *k.at_2d(0, 2)?, *k.at_2d(1, 2)?, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut sigmas = [0.0; 9];
    for i in 0..5 {
        parameters[4 + i] = *d.at::<f64>(i as i32)?;
    }
    for (i, sigma) in sigmas.iter_mut().enumerate() {
        *sigma = *interior.at::<f64>(i as i32)?;
    }
    let mut poses = Vec::with_capacity(r.len());
    for (r, t) in r.iter().zip(t.iter()) {
        let mut pose = [0.0; 6];
        for i in 0..3 {
            (pose[i], pose[3 + i]) = (*r.at::<f64>(i as i32)?, *t.at::<f64>(i as i32)?);
        }
        poses.push(pose);
    }
    Ok(Theirs { rms, parameters, sigmas, poses })
}
