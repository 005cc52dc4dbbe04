//! Conventions of tools whose cameras are models that are there already: what their files mean by the same numbers.

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification};
use super::{agisoft, opencv, photogrammetric};

/// COLMAP.
pub const COLMAP: Convention = Convention {
    name: "colmap",
    about: "COLMAP: SIMPLE_PINHOLE to FULL_OPENCV, fisheyes, FOV, thin prism",
    version: "3.x and 4.x",
    pixel_origin: PixelOrigin::PixelCorner,
    principal_point_from: PixelOrigin::PixelCorner,
    normalisation: "divided by f or fx, fy, px",
    source: "COLMAP's documentation, Camera Models and Output Format: the centre of the first pixel is (0.5, 0.5)",
    verification: Verification::Verified(
        "pycolmap 4.2.1 projects alike in every model, to 1e-8 px, and its SIFT finds a blob at (100, 60) at (100.5, 60.5)",
    ),
    ..opencv::CONVENTION
};

/// kapture.
pub const KAPTURE: Convention = Convention {
    name: "kapture",
    about: "kapture: COLMAP's models in sensors.txt",
    version: "1.0, 1.1",
    source: "kapture's format specification: camera models are COLMAP's",
    verification: Verification::Verified(
        "kapture 1.1.12 reads the models and numbers, which pycolmap projects alike, to 1e-8 px; that the origin is COLMAP's is what its converters do",
    ),
    ..COLMAP
};

/// ROS.
pub const ROS: Convention = Convention {
    name: "ros",
    about: "ROS camera_info: plumb_bob, rational_polynomial, equidistant",
    version: "camera_calibration and image_pipeline of ROS 1 and 2",
    source: "sensor_msgs/CameraInfo and distortion_models.h: OpenCV's models",
    verification: Verification::Verified(
        "camera_calibration_parsers 1.12 of ROS reads the files, and OpenCV projects alike what it read, to 1e-8 px",
    ),
    ..opencv::CONVENTION
};

/// Kalibr.
pub const KALIBR: Convention = Convention {
    name: "kalibr",
    about: "Kalibr camchain: pinhole, omni, eucm, ds with radtan, equidistant, fov",
    version: "camchain YAML",
    source: "Kalibr's wiki, Supported models and Yaml formats",
    verification: Verification::Unverified(
        "formulas after its wiki; that (0, 0) is the centre of the first pixel follows from OpenCV's corners, which it measures",
    ),
    ..opencv::CONVENTION
};

/// mrcal.
pub const MRCAL: Convention = Convention {
    name: "mrcal",
    about: "mrcal .cameramodel: PINHOLE, STEREOGRAPHIC, OPENCV4 to OPENCV12; splined models are read and fitted",
    version: "1 and 2",
    source: "mrcal's documentation, Lens models and Conventions",
    verification: Verification::Verified("mrcal 2.2 projects alike by the files, models to 1e-8 px and splines to 1e-6 px"),
    ..opencv::CONVENTION
};

/// OpenSfM and ODM.
pub const OPENSFM: Convention = Convention {
    name: "opensfm",
    about: "OpenSfM, OpenDroneMap: perspective, brown, fisheye, fisheye_opencv, fisheye62, fisheye624, in units of the longer side",
    version: "camera_models.json, cameras.json, reconstruction.json",
    pixel_origin: PixelOrigin::FrameCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    normalisation: "divided by the focal length, which is in units of the longer side of the image",
    source: "OpenSfM's documentation, Geometric models: normalised image coordinates from the centre of the image",
    verification: Verification::Unverified(
        "formulas and origin after its documentation and the points that its own functions project, compiled; its package is in no index",
    ),
    ..opencv::CONVENTION
};

/// nerfstudio.
pub const NERFSTUDIO: Convention = Convention {
    name: "nerfstudio",
    about: "nerfstudio transforms.json: OPENCV, OPENCV_FISHEYE, PINHOLE",
    version: "",
    pixel_origin: PixelOrigin::PixelCorner,
    principal_point_from: PixelOrigin::PixelCorner,
    source: "nerfstudio's documentation, Data conventions",
    verification: Verification::Unverified(
        "formulas after its documentation; that the centre of the first pixel is (0.5, 0.5) after its sampler of rays",
    ),
    ..opencv::CONVENTION
};

/// basalt.
pub const BASALT: Convention = Convention {
    name: "basalt",
    about: "basalt calibration JSON: ds, eucm, ucm, kb4, pinhole, fov, pinhole-radtan8",
    version: "",
    source: "basalt-headers, camera models; Usenko, Demmel and Cremers 2018",
    verification: Verification::Unverified("formulas after the paper; no projected point of it was at hand"),
    ..opencv::CONVENTION
};

/// camodocal.
pub const CAMODOCAL: Convention = Convention {
    name: "camodocal",
    about: "camodocal YAML: MEI, KANNALA_BRANDT, PINHOLE",
    version: "",
    source: "camodocal's camera models; Mei and Rives 2007; Kannala and Brandt 2006",
    verification: Verification::Unverified("formulas after the papers; no file of the tool was at hand"),
    ..opencv::CONVENTION
};

/// OpenMVG.
pub const OPENMVG: Convention = Convention {
    name: "openmvg",
    about: "OpenMVG sfm_data.json: pinhole, radial k1, k3, brown t2, fisheye",
    version: "0.3, 1 and 2",
    source: "OpenMVG's documentation, Cameras",
    verification: Verification::Unverified(
        "formulas after its documentation; what (0, 0) is it does not say: the centre of the first pixel is assumed",
    ),
    ..opencv::CONVENTION
};

/// Theia.
pub const THEIA: Convention = Convention {
    name: "theia",
    about: "Theia calibration JSON: PINHOLE, PINHOLE_RADIAL_TANGENTIAL, FISHEYE, FOV",
    version: "0.8 and later",
    source: "Theia's documentation, Camera",
    verification: Verification::Unverified(
        "formulas by its own package, pytheia 1.2.1, to 1e-8 px; what (0, 0) is it does not say: the centre of the first pixel is assumed",
    ),
    ..opencv::CONVENTION
};

/// Bundler and BAL.
pub const BUNDLER: Convention = Convention {
    name: "bundler",
    about: "Bundler, BAL: f, k1, k2, y up, principal point in the centre of the frame",
    version: "bundle.out v0.3; Bundle Adjustment in the Large",
    pixel_origin: PixelOrigin::FrameCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    y: super::Vertical::Up,
    order: TangentialOrder::Without,
    normalisation: "divided by f, px",
    source: "Bundler v0.4 User's Manual; Agarwal et al. 2010",
    verification: Verification::Unverified(
        "formulas after the manual; Theia's package reads the cameras of Bundler's files, no projected point of Bundler was at hand",
    ),
    ..opencv::CONVENTION
};

/// RealityCapture.
pub const REALITY_CAPTURE: Convention = Convention {
    name: "reality-capture",
    about: "RealityCapture, RealityScan: XMP and CSV; focal length of 36 mm film, principal point, skew, aspect ratio, brown3 to brown4t2, division",
    version: "XMP version 2 to 4, Internal/External camera parameters",
    pixel_origin: PixelOrigin::FrameCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    normalisation: "divided by the focal length; that and the principal point are in units of the longer side, the former times 36",
    source: "RealityCapture's support pages, XMP camera math; Epic's own writer of its XMP in the calibration library of MetaHuman; the export templates of RealityScan 2; the readers of AliceVision and camorph",
    verification: Verification::Unverified(
        "aspect ratio, skew and the order of t1 and t2 by Epic's writer and templates, angles of the CSV by nerfstudio's reader, the division model's formula by none; no numbers of the tool were at hand",
    ),
    ..agisoft::METASHAPE
};

/// Bentley's BlocksExchange.
pub const BENTLEY: Convention = Convention {
    name: "bentley",
    about: "Bentley ContextCapture, iTwin BlocksExchange: FocalLength or FocalLengthPixels, PrincipalPoint, K1 to K3, P1, P2",
    version: "BlocksExchange 2.1 and later",
    source: "ContextCapture User Guide, BlocksExchange XML format: the centre of the first pixel is (0, 0)",
    verification: Verification::Unverified(
        "direction and the order of P1 and P2 are not stated (Brown's model by name): ideal to distorted and OpenCV's order are assumed",
    ),
    ..opencv::CONVENTION
};

/// PhotoModeler.
pub const PHOTOMODELER: Convention = Convention {
    name: "photomodeler",
    about: "PhotoModeler: focal length, principal point, format in mm, K1 to K3, P1, P2 added to measured coordinates",
    version: "",
    pixel_origin: PixelOrigin::PixelCorner,
    principal_point_from: PixelOrigin::PixelCorner,
    order: TangentialOrder::Brown,
    normalisation: "none: mm from the principal point",
    source: "PhotoModeler's online help, Lens Distortion Formulation",
    verification: Verification::Unverified(
        "formulas after its help; whether y points up there is not stated (up is assumed), and no file of it was at hand: names of keys are after the help's dialog",
    ),
    ..photogrammetric::CONVENTION
};

/// Gyroflow.
pub const GYROFLOW: Convention = Convention {
    name: "gyroflow",
    about: "Gyroflow lens profiles: opencv_fisheye, opencv_standard, poly3, poly5, ptlens",
    version: "1",
    source: "Gyroflow's source, lens profiles and distortion models",
    verification: Verification::Unverified(
        "formulas after its source; what (0, 0) is it does not say: the centre of the first pixel is assumed, as OpenCV's corners have it",
    ),
    ..opencv::CONVENTION
};

/// MATLAB.
pub const MATLAB: Convention = Convention {
    name: "matlab",
    about: "MATLAB cameraIntrinsics, cameraParameters: FocalLength, PrincipalPoint, RadialDistortion, TangentialDistortion, Skew; the first pixel's centre is (1, 1)",
    version: "",
    normalisation: "divided by the focal lengths, px, which count from 1",
    source: "MathWorks' documentation, cameraIntrinsics and What Is Camera Calibration",
    verification: Verification::Unverified("formulas and origin after its documentation; no projected point of it was at hand"),
    ..opencv::CONVENTION
};

/// OpenUSD with Omniverse's schemas.
pub const USD: Convention = Convention {
    name: "usd",
    about: "OpenUSD omni:lensdistortion: opencvPinhole, opencvFisheye",
    version: "OmniLensDistortion schemas",
    source: "Omniverse's lens distortion schemas and Isaac Sim's documentation: OpenCV's models by name",
    verification: Verification::Unverified(
        "OpenCV's models by name; usd-core reads what is written, no rendered point was at hand; what (0, 0) is it does not say: the centre of the first pixel is assumed",
    ),
    ..opencv::CONVENTION
};

/// Bouguet's toolbox.
pub const CALTECH: Convention = Convention {
    name: "caltech",
    about: "Camera Calibration Toolbox for Matlab: fc, cc, alpha_c, kc",
    version: "Calib_Results.m",
    normalisation: "divided by fc, px",
    source: "Bouguet, Camera Calibration Toolbox for Matlab, Description of the calibration parameters: the first pixel's centre is (0, 0)",
    verification: Verification::Unverified(
        "formulas after the toolbox's page, from which OpenCV's are taken; no numbers of it were at hand",
    ),
    ..opencv::CONVENTION
};

/// VisualSFM.
pub const NVM: Convention = Convention {
    name: "nvm",
    about: "VisualSFM NVM: f, one radial coefficient that corrects measured coordinates in units of f, principal point in the centre of the frame",
    version: "NVM_V3",
    direction: Direction::MeasuredToIdeal,
    pixel_origin: PixelOrigin::FrameCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    order: TangentialOrder::Without,
    normalisation: "divided by f, px",
    source: "VisualSFM's documentation, NVM format; its author's bundle adjustment, Multicore Bundle Adjustment (Wu et al. 2011), which reads the files",
    verification: Verification::Unverified(
        "formulas after Multicore Bundle Adjustment; that the centre of the frame is meant and not the centre of its middle pixel is assumed; no numbers of the tool were at hand",
    ),
    ..opencv::CONVENTION
};

/// DJI.
pub const DJI: Convention = Convention {
    name: "dji",
    about: "DJI DewarpData: fx, fy, principal point from the optical centre, k1, k2, p1, p2, k3",
    version: "XMP of Phantom 4 RTK and Multispectral, Mavic 3 Enterprise and Multispectral",
    normalisation: "divided by the focal lengths, px; the principal point counts from CalibratedOpticalCenter, or half of the size",
    source: "DJI, P4 Multispectral Image Processing Guide and Mavic 3M Image Processing Guide: OpenCV's model by name",
    verification: Verification::Unverified(
        "OpenCV's model by name; what (0, 0) is it does not say: the centre of the first pixel is assumed, as OpenCV has it; no numbers of the tool were at hand",
    ),
    ..opencv::CONVENTION
};

/// JPL's CAHVOR.
pub const CAHVOR: Convention = Convention {
    name: "cahvor",
    about: "CAHV, CAHVOR: centre, axis, columns, rows, axis of the lens, r0 to r2, as vectors in the world",
    version: ".cahvor, labels of PDS3 and VICAR",
    order: TangentialOrder::Without,
    normalisation: "divided by the distance along the axis of the lens, O",
    source: "Yakimovsky and Cunningham 1978; Gennery 2006, \"Generalized Camera Calibration Including Fish-Eye Lenses\"",
    verification: Verification::Verified("mrcal 2.2 projects alike by the files, to 1e-6 px; labels by none"),
    ..opencv::CONVENTION
};

/// Qualisys.
pub const QUALISYS: Convention = Convention {
    name: "qualisys",
    about: "Qualisys Track Manager: focal lengths and centre in 64ths of a pixel, radialDistortion1 to 3, tangentalDistortion1, 2",
    version: "calibration XML, real-time protocol 1.20 and later",
    normalisation: "divided by the focal lengths, 64ths of px",
    source: "Qualisys, QTM RT Server Protocol Documentation, Calibration; the readers of Pose2Sim and of its own SDK, by the names",
    verification: Verification::Unverified(
        "OpenCV's order of coefficients as Pose2Sim takes it; what (0, 0) is it does not say: the centre of the first pixel is assumed; no numbers of the tool were at hand",
    ),
    ..opencv::CONVENTION
};
