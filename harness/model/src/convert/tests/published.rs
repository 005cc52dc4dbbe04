//! The Canon paper's Table 3.

use super::super::{ConvertOptions, DifferenceOptions, Region, Tangential, Target, difference, from_naive};
use crate::camera::{Camera, ImageSize, Photogrammetric};

/// Name, c, x0, y0 (mm), k1 (mm^-2), k2 (mm^-4), k3 (mm^-6), p1, p2 (mm^-1): published/canon-t3-table3.csv.
type Row = (&'static str, [f64; 3], [f64; 3], [f64; 2]);
const TABLE_3: [Row; 4] = [
    ("photoscan", [19.213, 0.042, -0.134], [-4.61e-4, 1.20e-6, -0.04e-8], [0.86e-4, 0.89e-4]),
    ("pix4d", [19.214, -0.054, -0.078], [-4.61e-4, 1.12e-6, -0.01e-8], [0.81e-4, 0.86e-4]),
    ("opencv", [18.525, 0.041, -0.698], [-6.57e-4, 4.17e-6, -1.73e-8], [2.26e-4, 0.39e-4]),
    ("lens", [19.005, -0.048, -0.267], [-6.75e-4, 4.77e-6, -1.90e-8], [2.74e-4, 0.71e-4]),
];
const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };

fn printed((_, [c, x0, y0], k, p): Row, pitch_um: f64) -> Photogrammetric {
    Photogrammetric { size: SIZE, pitch_um, c, x0, y0, k, p, b: [0.0; 2] }
}

fn tool(row: Row, pitch_um: f64) -> Camera {
    from_naive(&printed(row, pitch_um), Target::metashape(), Tangential::Converted).unwrap()
}

#[test]
fn explore() {
    for pitch in [5.38085, 5.15] {
        for row in TABLE_3 {
            let (truth, naive) = (tool(row, pitch), Camera::from(printed(row, pitch)));
            println!(
                "{} {pitch} fold tool {:?} naive {:?}",
                row.0,
                crate::camera::fold(&truth).map(|f| (f.radius_px * pitch / 1e3, f.share)),
                crate::camera::fold(&naive).map(|f| (f.radius_px * pitch / 1e3, f.share))
            );
            for (a, b) in [(&truth, &naive), (&naive, &truth)] {
                for rotation in [false, true] {
                    let d = difference(a, b, &DifferenceOptions { rotation, compensation: true, ..Default::default() });
                    match d {
                        Ok(d) => println!(
                            "  rot {rotation} {:?} lost {:.4} comp {:?} {:e} wall rms {} max {}",
                            d.spread,
                            d.not_comparable,
                            d.compensated.as_ref().map(|c| c.spread),
                            d.compensated.clone().unwrap().scale,
                            d.on_object(d.spread.rms_px, 13.0),
                            d.on_object(d.spread.max_px, 13.0)
                        ),
                        Err(e) => println!("  {e}"),
                    }
                }
            }
            let options = ConvertOptions { accept: true, ..Default::default() };
            match super::super::convert(&truth, Target::photogrammetric(pitch), &options) {
                Ok(c) => println!("  convert {:?} {:?}", c.residual, c.camera),
                Err(e) => println!("  convert {e}"),
            }
            let options = ConvertOptions { accept: true, region: Region::Radius { px: 2400.0 }, ..Default::default() };
            match super::super::convert(&truth, Target::photogrammetric(pitch), &options) {
                Ok(c) => println!("  convert to 2400 {:?} {:?}", c.residual, c.camera),
                Err(e) => println!("  convert {e}"),
            }
        }
    }
}
