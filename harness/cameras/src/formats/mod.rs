//! The camera files that are known: one file a format. A new one is its file and its two lines here.

mod anipose;
mod bal;
mod basalt;
mod bentley;
mod bundler;
mod cahvor;
mod caltech;
mod camodocal;
pub(super) mod colmap;
pub(super) mod colmap_bin;
mod dji;
mod gyroflow;
mod kalibr;
mod kapture;
mod lensfun;
mod matlab;
mod metashape_calibration;
mod metashape_cameras;
mod micmac;
pub(super) mod mrcal;
mod nerfstudio;
mod numpy;
mod nvm;
mod ocam;
mod opencv_json;
mod opencv_xml;
mod opencv_yaml;
pub(super) mod openmvg;
mod opensfm;
mod panotools;
mod photogrammetric;
mod photoscan_cameras;
mod pix4d_cam;
mod pix4d_inpho;
mod pix4d_parameters;
pub mod pix4d_pmatrix;
mod qualisys;
mod reality_capture;
mod reality_scan_csv;
mod ros;
mod ros_message;
mod theia;
mod usd;

/// The worked example of CONTRIBUTING, linked from `examples/`.
#[cfg(test)]
mod example;

pub(super) use opencv_yaml::{matrix as yaml_matrix, tree as yaml};

use super::format::{CameraFormat, PLAIN};

/// Every format; all are asked, and of those that read the same cameras the first is taken.
pub static FORMATS: &[&CameraFormat] = &[
    &photogrammetric::FORMAT,
    &camodocal::FORMAT,
    &ros::FORMAT,
    &ros_message::FORMAT,
    &kalibr::FORMAT,
    &opencv_yaml::FORMAT,
    &opencv_xml::FORMAT,
    &opencv_json::FORMAT,
    &numpy::FORMAT,
    &anipose::FORMAT,
    &metashape_calibration::FORMAT,
    &metashape_cameras::FORMAT,
    &photoscan_cameras::FORMAT,
    &pix4d_inpho::FORMAT,
    &pix4d_cam::FORMAT,
    &pix4d_parameters::FORMAT,
    &pix4d_pmatrix::FORMAT,
    &micmac::FORMAT,
    &bentley::FORMAT,
    &reality_capture::FORMAT,
    &reality_scan_csv::FORMAT,
    &mrcal::FORMAT,
    &basalt::FORMAT,
    &nerfstudio::FORMAT,
    &openmvg::FORMAT,
    &theia::FORMAT,
    &opensfm::FORMAT,
    &colmap::FORMAT,
    &colmap_bin::FORMAT,
    &kapture::FORMAT,
    &bundler::FORMAT,
    &bal::FORMAT,
    &caltech::FORMAT,
    &lensfun::FORMAT,
    &panotools::FORMAT,
    &gyroflow::FORMAT,
    &matlab::FORMAT,
    &usd::FORMAT,
    &ocam::FORMAT,
    &nvm::FORMAT,
    &dji::FORMAT,
    &cahvor::FORMAT,
    &qualisys::FORMAT,
];

/// The format called `name`.
pub fn format_named(name: &str) -> Option<&'static CameraFormat> {
    FORMATS.iter().copied().find(|format| format.name == name)
}
