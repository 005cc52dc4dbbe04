"""lensboy: calibrate_camera, with what it does by itself: outliers left out, the board's warp adjusted."""
import argparse
import importlib.metadata

import asked
import lensboy as lb
import numpy as np

options = argparse.ArgumentParser()
options.add_argument("--splined", action="store_true", help="its spline in place of the model that is asked for")
options.add_argument("--knots", type=int, nargs=2, default=[16, 12])
options = options.parse_args()


def config(task):
    width, height = task["size"]
    if options.splined:
        return lb.PinholeSplinedConfig(image_height=height, image_width=width, num_knots_x=options.knots[0], num_knots_y=options.knots[1])
    terms = np.arange(14) < int(task["model"][6:])
    return lb.OpenCVConfig(image_height=height, image_width=width, included_distortion_coefficients=terms)


def calibrate(task):
    names, places, _, images = asked.views(task)
    points = np.reshape([point[1:4] for point in task["points"]], (-1, 3)).astype(float)
    frames = [lb.Frame(np.array(of), np.array(xy, float)) for of, xy in zip(places, images)]
    result = lb.calibrate_camera(points, frames, config(task))
    camera = result.camera_model
    masks = [np.zeros(len(of), bool) if found is None else found.inlier_mask for of, found in zip(places, result.frame_diagnostics)]
    answer = {
        "rms_px": result.residual_sigma_map(),
        "outliers": [[view, int(i)] for view, mask in enumerate(masks) for i in np.flatnonzero(~mask)],
        "poses": {name: [*pose.rotmat.ravel(), *pose.translation] for name, pose in zip(names, result.cameras_from_target) if pose is not None},
    }
    if result.target_warp is not None:
        answer["board_shape"] = result.target_warp.warp_target(points)
    if options.splined:
        rays = camera.normalize_points(np.array(task["grid"], float))
        answer["rays"] = [list(ray) if np.isfinite(ray).all() else None for ray in rays]
    else:
        matrix = [[camera.fx, 0, camera.cx], [0, camera.fy, camera.cy], [0, 0, 1]]
        answer["camera"] = asked.opencv_yaml(task["size"], matrix, camera.distortion_coeffs[: int(task["model"][6:])])
    return answer


asked.serve(importlib.metadata.version("lensboy"), calibrate)
