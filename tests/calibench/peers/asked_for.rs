//! Files that people ask for, by the tools whose they are: ours projected by them, theirs by us.

#![cfg_attr(
    not(all(peer_opencv, peer_anipose, peer_caliscope, peer_lensfun, peer_usd, peer_hugin, peer_mrcal)),
    allow(dead_code, unused_imports)
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use calibench_cameras::{ReadOptions, format_named, read_camera_with, write_camera};
use calibench_model::camera::{Camera, CameraModel, ImageSize, LensProjection, Omni, OpenCv, OpenCvFisheye, PtLens, Ray};
use calibench_model::{NamedCamera, PixelPoint};

use super::{SIZE, SYSTEM, agrees, answered, asked, compare, fisheye, opencv, own, radial};

/// The camera that a tool wrote pictures the points where the tool does, within `tolerance`, px.
fn reads(tool: &str, ending: &str, tolerance: f64) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("camera.{ending}"));
    let points: Vec<[f64; 3]> = (-4..=4).flat_map(|x| (-3..=3).map(move |y| [0.09 * f64::from(x), 0.09 * f64::from(y), 1.0])).collect();
    let expected = answered(&own(), "write.py", tool, &file, &points, &[]);
    let camera =
        read_camera_with(&file, &ReadOptions::default()).unwrap_or_else(|error| panic!("{tool}: {error}")).cameras.remove(0).camera;
    pictures(tool, &camera, &points, &expected, tolerance);
}

fn pictures(tool: &str, camera: &Camera, points: &[[f64; 3]], expected: &[[f64; 2]], tolerance: f64) {
    assert_eq!(points.len(), expected.len());
    for (&[x, y, z], expected) in points.iter().zip(expected) {
        let found = camera.project(Ray { x, y: -y, z: -z }).unwrap();
        let off = found.distance(PixelPoint::new(expected[0], expected[1]));
        assert!(off < tolerance, "{tool}: {off} px at {expected:?}, {camera:?}");
    }
}

#[test]
#[cfg_attr(not(peer_opencv), ignore = "no opencv-contrib-python")]
fn numpy_loads_its_archive_and_opencv_projects_alike() {
    let omni = Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx: 605.0, cy: 445.0, xi: 1.3, k: [-0.1, 0.02], p: [2e-4, 1e-4] };
    let round = fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]);
    let cameras = [opencv(4), opencv(5), opencv(8), opencv(12), opencv(14), round, omni.into()];
    agrees(&own(), "numpy_archive", ("numpy", "npz"), &cameras, 1e-8);
}

#[test]
#[cfg_attr(not(peer_opencv), ignore = "no opencv-contrib-python")]
fn what_numpy_and_opencv_save_is_read() {
    for tool in ["mtx", "halves", "fisheye"] {
        reads(tool, "npz", 1e-8);
    }
    for ending in ["yml", "xml", "json"] {
        reads("storage", ending, 1e-8);
    }
}

#[test]
#[cfg_attr(not(peer_anipose), ignore = "no aniposelib")]
fn aniposelib_loads_its_tables_and_dumps_what_is_read() {
    agrees(&own(), "anipose", ("anipose", "toml"), &[opencv(4), opencv(5), opencv(8), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4])], 1e-8);
    reads("anipose", "toml", 1e-8);
}

#[test]
#[cfg_attr(not(peer_caliscope), ignore = "no caliscope")]
fn caliscope_loads_the_same_tables_and_writes_what_is_read() {
    agrees(&own(), "caliscope", ("anipose", "toml"), &[opencv(5), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4])], 1e-8);
    reads("caliscope", "toml", 1e-8);
}

#[test]
#[cfg_attr(not(peer_usd), ignore = "no usd-core")]
fn usd_core_opens_its_stage() {
    // Its attributes are floats of 32 bits.
    agrees(&own(), "usd", ("usd", "usda"), &[opencv(4), opencv(5), opencv(12), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4])], 1e-3);
}

/// Lenses of every projection with a, b, c, and those that are everybody's.
fn lenses() -> Vec<Camera> {
    let of = |projection, [a, b, c]: [f64; 3]| PtLens { size: SIZE, projection, f: 1400.0, cx: 603.5, cy: 447.25, a, b, c }.into();
    let every =
        LensProjection::ALL.into_iter().flat_map(|projection| [[0.05, -0.09, 0.03], [0.0, -0.06, 0.0]].map(|terms| of(projection, terms)));
    every.chain([radial(0), radial(1)]).collect()
}

#[test]
#[cfg_attr(not(peer_hugin), ignore = "no hugin-tools")]
fn pano_trafo_reads_its_project() {
    agrees(&own(), "hugin", ("panotools", "pto"), &lenses(), 1e-6);
}

#[test]
#[cfg_attr(not(peer_lensfun), ignore = "no lensfunpy")]
fn lensfun_loads_its_data_base() {
    let round = OpenCvFisheye { size: SIZE, fx: 1400.0, fy: 1400.0, cx: 603.5, cy: 447.25, skew: 0.0, k: [-0.02, 0.003, 0.0, 0.0] };
    // It holds floats of 32 bits.
    agrees(&own(), "lensfun", ("lensfun", "xml"), &[lenses(), vec![radial(2), round.into()]].concat(), 1e-3);
}

/// Lenses with the image plane's axis, and tilted against it about one axis and about both.
#[test]
#[cfg_attr(not(peer_mrcal), ignore = "no mrcal")]
fn mrcal_reads_cahvor_and_projects_alike() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("camera.cahvor");
    for [k1, k2, tx, ty] in
        [[0.0; 4], [-0.08, 0.02, 0.0, 0.0], [-0.08, 0.02, 0.01, 0.0], [-0.08, 0.02, 0.0, -0.03], [-0.08, 0.02, 0.2, -0.1]]
    {
        let mut distortion = [0.0; 14];
        [distortion[0], distortion[1], distortion[12], distortion[13]] = [k1, k2, tx, ty];
        let camera = OpenCv { size: SIZE, fx: 1400.0, fy: 1403.0, cx: 610.0, cy: 440.0, distortion, coefficients: 14 }.into();
        write_camera(&file, format_named("cahvor").unwrap(), &[NamedCamera::new("", camera)]).unwrap();
        compare(SYSTEM, "cahvor", &file, &camera, 1e-6);
    }
}

/// Lenses of the data base that lensfunpy brings, by lensfun and by ours.
#[test]
#[cfg_attr(not(peer_lensfun), ignore = "no lensfunpy")]
fn lenses_of_lensfun_s_own_data_base_are_read() {
    let size = ImageSize { width: 1500, height: 1000 };
    let points: Vec<[f64; 3]> = [(0.0, 0.0), (0.1, 0.05), (-0.12, 0.06), (0.05, -0.11)].map(|(x, y)| [x, y, 1.0]).into();
    let mut compared = 0;
    for name in ["mil-sony.xml", "slr-sigma.xml", "slr-samyang.xml", "compact-canon.xml"] {
        let file = database().join(name);
        let found =
            read_camera_with(&file, &ReadOptions { size: Some(size), ..ReadOptions::default() }).unwrap_or_else(|error| panic!("{error}"));
        for named in found.cameras.iter().step_by(37) {
            // Of two measurements of one lens at one focal length lensfun keeps one; which, nobody says.
            if found.cameras.iter().filter(|other| other.name == named.name).count() > 1 {
                continue;
            }
            let (lens, focal) =
                named.name.rsplit_once(" at ").map_or((named.name.as_str(), "0"), |(lens, rest)| (lens, rest.trim_end_matches(" mm")));
            let variables = [("SIZE", "1500x1000"), ("LENS", lens), ("FOCAL", focal)];
            let expected = asked(&own(), "lensfun", &file, &points, &variables);
            if points.iter().all(|&[x, y, z]| named.camera.project(Ray { x, y: -y, z: -z }).is_ok()) {
                pictures(&named.name, &named.camera, &points, &expected, 1e-3);
                compared += 1;
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

/// The folder of the data base.
fn database() -> PathBuf {
    let where_ = "import lensfunpy, os; print(os.path.join(os.path.dirname(lensfunpy.__file__), 'db_files'))";
    let output = Command::new(own()).args(["-c", where_]).stderr(Stdio::null()).output().unwrap();
    Path::new(String::from_utf8(output.stdout).unwrap().trim()).to_owned()
}
