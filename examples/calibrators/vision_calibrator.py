"""vision-calibration (calibration-rs): run_planar_intrinsics, least squares or Huber's loss."""
import argparse
import importlib.metadata

import asked
import vision_calibration as vc
from vision_calibration import models

options = argparse.ArgumentParser()
options.add_argument("--huber", type=float, metavar="PX")
options = options.parse_args()

# k3 is fixed in its own default.
DISTORTION = {
    "opencv4": ("brown_conrady5", {}, "k1 k2 p1 p2"),
    "opencv5": ("brown_conrady5", {"k3": False}, "k1 k2 p1 p2 k3"),
    "opencv8": ("rational8", {"k3": False}, "k1 k2 p1 p2 k3 k4 k5 k6"),
}


def calibrate(task):
    names, _, objects, images = asked.views(task)
    views = [models.PlanarView(models.Observation(of, xy)) for of, xy in zip(objects, images)]
    model, free, terms = DISTORTION[task["model"]]
    loss = vc.robust_none() if options.huber is None else vc.robust_huber(options.huber)
    result = vc.run_planar_intrinsics(
        models.PlanarDataset(views),
        models.PlanarCalibrationConfig(
            solver=models.SolverConfig(robust_loss=loss), distortion_model=model, fix_camera=models.CameraFixMask(distortion=free)
        ),
    )
    k, lens = result.camera.intrinsics, result.camera.distortion
    matrix = [[k.fx, k.skew, k.cx], [0, k.fy, k.cy], [0, 0, 1]]
    return {
        "camera": asked.opencv_yaml(task["size"], matrix, [getattr(lens, term) for term in terms.split()]),
        "rms_px": result.mean_reproj_error,
        "poses": {name: [*turned(pose.rotation_xyzw), *pose.translation_xyz] for name, pose in zip(names, result.camera_se3_target)},
    }


def turned(xyzw):
    """The rotation of a quaternion, row by row."""
    x, y, z, w = xyzw
    return [
        1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
        2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
        2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
    ]  # fmt: skip


asked.serve(importlib.metadata.version("vision-calibration"), calibrate)
