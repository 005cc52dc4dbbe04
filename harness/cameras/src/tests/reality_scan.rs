//! RealityScan's two files: what aspect ratio, skew and the division model do, and what a CSV leaves open.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray};

use super::super::{CameraFile, Lens, ReadOptions};
use super::read_with;

const SIZE: ImageSize = ImageSize { width: 4000, height: 3000 };
const MIDDLE: (f64, f64) = (1999.5, 1499.5);

fn xmp(attributes: &str, coefficients: &str) -> CameraFile {
    let text = format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description \
         xmlns:xcr=\"http://www.capturingreality.com/ns/xcr/1.1#\" xcr:FocalLength35mm=\"27\" {attributes}><xcr:DistortionCoeficients>{coefficients}\
         </xcr:DistortionCoeficients></rdf:Description></rdf:RDF></x:xmpmeta>"
    );
    read_with(&text, ReadOptions { size: Some(SIZE), ..ReadOptions::default() }).unwrap()
}

fn csv(rows: &str, lens: Option<Lens>) -> Result<CameraFile, String> {
    let text = format!("#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n{rows}");
    read_with(&text, ReadOptions { size: Some(SIZE), lens, ..ReadOptions::default() })
}

/// The image of the ray (x, y, 1), x right, y down, z forward.
fn image(camera: &Camera, x: f64, y: f64) -> PixelPoint {
    camera.project(Ray { x, y: -y, z: -1.0 }).unwrap()
}

fn assert_near(found: PixelPoint, (x, y): (f64, f64)) {
    assert!(found.distance(PixelPoint::new(x, y)) < 1e-9, "{found:?}, expected {x}, {y}");
}

/// As Epic's own writer has it: f along x, its aspect ratio along y, the skew in units of the longer side.
#[test]
fn aspect_ratio_and_skew_act_as_the_vendor_s_own_writer_has_them() {
    let file = xmp("xcr:AspectRatio=\"1.01\" xcr:Skew=\"0.002\" xcr:PrincipalPointV=\"-0.01\"", "0 0 0 0 0 0");
    let f = 27.0 / 36.0 * 4000.0;
    assert_near(image(&file.cameras[0].camera, 0.3, -0.2), (MIDDLE.0 + f * 0.3 - 0.002 * 4000.0 * 0.2, MIDDLE.1 - 40.0 - 1.01 * f * 0.2));
}

/// t1 multiplies r^2 + 2 x^2.
#[test]
fn the_first_tangential_coefficient_is_brown_s() {
    let file = xmp("xcr:DistortionModel=\"brown3t2\"", "0 0 0 0 0.001 0");
    assert_near(image(&file.cameras[0].camera, 0.3, 0.0), (MIDDLE.0 + 3000.0 * (0.3 + 0.001 * 3.0 * 0.09), MIDDLE.1));
}

#[test]
fn a_division_model_is_undone_by_its_formula_and_said_to_be_assumed() {
    for k in [-0.1, 0.05] {
        let file = xmp("xcr:DistortionModel=\"division\"", &format!("{k} 0 0 0 0 0"));
        let camera = &file.cameras[0].camera;
        for (x, y) in [(0.5, 0.2), (-0.1, 0.6)] {
            let found = image(camera, x, y);
            let (u, v) = ((found.x - MIDDLE.0) / 3000.0, (found.y - MIDDLE.1) / 3000.0);
            let q = 1.0 + k * (u * u + v * v);
            assert!((u / q - x).abs() < 1e-12 && (v / q - y).abs() < 1e-12, "{k}: {found:?}");
        }
        assert!(file.cameras[0].notes.iter().any(|note| note.contains("the tool publishes no formula")), "{:?}", file.cameras[0].notes);
    }
}

#[test]
fn the_two_files_of_one_camera_are_the_same() {
    let of_csv = csv("a.jpg,0,0,0,0,0,0,27,0.01,-0.02,-0.1,0.02,-0.003,0.001,1e-3,-2e-3\n", None).unwrap();
    let of_xmp = xmp(
        "xcr:DistortionModel=\"brown4t2\" xcr:PrincipalPointU=\"0.01\" xcr:PrincipalPointV=\"-0.02\"",
        "-0.1 0.02 -0.003 0.001 1e-3 -2e-3",
    );
    assert_eq!(of_csv.cameras[0].camera, of_xmp.cameras[0].camera);
    assert_eq!(of_csv.cameras[0].name, "a.jpg");
}

#[test]
fn a_csv_with_k1_alone_is_not_guessed() {
    let row = "a.jpg,1,2,3,0,0,0,27,0,0,-0.1,0,0,0,0,0\n";
    let error = csv(row, None).unwrap_err();
    assert!(error.contains("f:2, `k1`: has k1 alone"), "{error}");
    let (brown, division) = (csv(row, Some(Lens::Brown)).unwrap(), csv(row, Some(Lens::Division)).unwrap());
    let of_xmp = |model: &str| xmp(&format!("xcr:DistortionModel=\"{model}\""), "-0.1 0 0 0 0 0").cameras[0].camera;
    assert_eq!((brown.cameras[0].camera, division.cameras[0].camera), (of_xmp("brown3"), of_xmp("division")));
    // Both bend alike at first, and more than 10 px apart in the corner.
    let apart = image(&brown.cameras[0].camera, 0.6, 0.45).distance(image(&division.cameras[0].camera, 0.6, 0.45));
    assert!(apart > 10.0, "{apart}");
    // More coefficients than one are Brown's, and no division model.
    let rich = row.replace("-0.1,0,", "-0.1,0.02,");
    assert!(csv(&rich, None).is_ok());
    assert!(csv(&rich, Some(Lens::Division)).unwrap_err().contains("has more than k1"));
}

#[test]
fn columns_may_be_missing_in_another_order_or_unknown() {
    let text = "name,f,x,y,z,yaw,pitch,roll,gain\n\"a, b.jpg\",27,1,2,3,0,0,0,7\n\n";
    let file = read_with(text, ReadOptions { size: Some(SIZE), ..ReadOptions::default() }).unwrap();
    let camera = &file.cameras[0];
    assert_eq!((file.format.name, camera.name.as_str(), camera.pose.unwrap().position), ("reality-scan-csv", "a, b.jpg", [1.0, 2.0, 3.0]));
    assert_near(image(&camera.camera, 0.1, 0.0), (MIDDLE.0 + 300.0, MIDDLE.1));
    assert!(camera.notes.iter().any(|note| note.contains("column `gain`")), "{:?}", camera.notes);
    // Straight down: the image's right is the world's x, its top the world's y.
    assert_eq!(
        camera.pose.unwrap().camera_from_world,
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]].map(|row| row.map(|v| v + 0.0))
    );
}
