"""gtsam: a graph of GeneralSFMFactor2, the board's points and no skew held, Levenberg and Marquardt at their defaults, marginals of the camera.
gtsam has no start of poses: OpenCV's solvePnP at the start camera makes it."""
import importlib.metadata

import asked
import cv2
import gtsam
import numpy as np
from gtsam.symbol_shorthand import K, P, X

MODELS = {
    "opencv4": (gtsam.Cal3DS2, gtsam.GeneralSFMFactor2Cal3DS2, gtsam.PriorFactorCal3DS2, "fx fy skew cx cy k1 k2 p1 p2"),
    "opencv-fisheye": (gtsam.Cal3Fisheye, gtsam.GeneralSFMFactor2Cal3Fisheye, gtsam.PriorFactorCal3Fisheye, "fx fy skew cx cy k1 k2 k3 k4"),
}


def calibrate(task):
    lens, factor, prior, names = MODELS[task["model"]]
    names, start, fisheye = names.split(), task["start"], task["model"] == "opencv-fisheye"
    values = np.array([start["f"], start["f"], 0, start["cx"], start["cy"], 0, 0, 0, 0])
    matrix = np.array([[start["f"], 0, start["cx"]], [0, start["f"], start["cy"]], [0, 0, 1]])
    sigma = task["sigma_px"] or 1.0
    noise = gtsam.noiseModel.Isotropic.Sigma(2, sigma)
    graph, initial = gtsam.NonlinearFactorGraph(), gtsam.Values()
    initial.insert(K(0), lens(values))
    # Skew is held at 0, by a spread of 1e-6 px: with a constraint in its place the marginals of all are zero.
    spread = np.array([np.inf if name != "skew" else 1e-6 for name in names])
    graph.add(prior(K(0), lens(values), gtsam.noiseModel.Diagonal.Sigmas(spread)))
    seen, count = set(), 0
    views = list(zip(*asked.views(task)))
    for view, (_, places, objects, images) in enumerate(views):
        xy = np.array(images)[:, None]
        at = cv2.fisheye.undistortPoints(xy, matrix, np.zeros(4), P=matrix) if fisheye else xy
        found, rotation, translation = cv2.solvePnP(np.array(objects), at, matrix, None)
        camera_from_board = gtsam.Pose3(gtsam.Rot3(cv2.Rodrigues(rotation)[0]), translation.ravel())
        initial.insert(X(view), camera_from_board.inverse())
        for place, of in zip(places, images):
            graph.add(factor(np.array(of), noise, X(view), P(place), K(0)))
            count += 1
        seen.update(places)
    for place in seen:
        point = np.array(task["points"][place][1:4], float)
        initial.insert(P(place), point)
        graph.add(gtsam.PriorFactorPoint3(P(place), point, gtsam.noiseModel.Constrained.All(3)))
    optimizer = gtsam.LevenbergMarquardtOptimizer(graph, initial, gtsam.LevenbergMarquardtParams())
    result = optimizer.optimize()
    camera = getattr(result, f"at{lens.__name__}")(K(0))
    free = [i for i, name in enumerate(names) if name != "skew"]
    covariance = gtsam.Marginals(graph, result).marginalCovariance(K(0))[np.ix_(free, free)]
    matrix = [[camera.fx(), 0, camera.px()], [0, camera.fy(), camera.py()], [0, 0, 1]]
    poses = [result.atPose3(X(view)).inverse() for view in range(len(views))]
    return {
        "camera": asked.opencv_yaml(task["size"], matrix, [getattr(camera, name)() for name in names[5:]], fisheye=fisheye),
        "covariance": {"names": [names[i] for i in free], "matrix": covariance},
        "scaled": "stated" if task["sigma_px"] else "unit",
        "rms_px": sigma * (2 * graph.error(result) / count) ** 0.5 if count else None,
        "iterations": optimizer.iterations(),
        "poses": {name: [*pose.rotation().matrix().ravel(), *pose.translation()] for (name, *_), pose in zip(views, poses)},
    }


asked.serve(importlib.metadata.version("gtsam"), calibrate)
