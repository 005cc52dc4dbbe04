#!/usr/bin/env bash
# PoseLib takes any name for a camera model and says nothing: of COLMAP's it knows SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, OPENCV_FISHEYE and FULL_OPENCV; RADIAL_FISHEYE,
# SIMPLE_RADIAL_FISHEYE, FOV, THIN_PRISM_FISHEYE, RAD_TAN_THIN_PRISM_FISHEYE and lower case are none. Such a camera has model_id -1 and a focal length of 0; estimate_absolute_pose returns
# the pose at the origin with 0 inliers of exact points, no error: it looks like a picture without matches.
# Seen: poselib 2.0.5 (Linux, CPython 3.11): 60 exact points of a camera at the origin turned by .2 rad: PINHOLE and the like: 60 inliers; the others: 0 inliers, rotation the identity
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
from importlib.metadata import version

import numpy as np
import poselib

known = {"SIMPLE_PINHOLE": 3, "PINHOLE": 4, "SIMPLE_RADIAL": 4, "RADIAL": 5, "OPENCV": 8, "OPENCV_FISHEYE": 8, "FULL_OPENCV": 12}
unknown = {"RADIAL_FISHEYE": 5, "SIMPLE_RADIAL_FISHEYE": 4, "FOV": 5, "THIN_PRISM_FISHEYE": 12, "RAD_TAN_THIN_PRISM_FISHEYE": 16, "pinhole": 4}
single = {"SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "RADIAL_FISHEYE", "SIMPLE_RADIAL_FISHEYE"}
turn = np.array([[np.cos(0.2), 0, np.sin(0.2)], [0, 1, 0], [-np.sin(0.2), 0, np.cos(0.2)]])
rays = np.random.default_rng(0).uniform(-1, 1, (60, 3)) + [0, 0, 5]
points = rays @ turn
for name, count in (known | unknown).items():
    core = [500.0, 640, 480] if name in single else [500.0, 500, 640, 480]
    flat = rays[:, :2] / rays[:, 2:]
    radius = np.linalg.norm(flat, axis=1, keepdims=True)
    seen = (flat * np.arctan(radius) / radius if "FISHEYE" in name else flat) * 500 + [640, 480]
    camera = {"model": name, "width": 1280, "height": 960, "params": core + [0.0] * (count - len(core))}
    pose, info = poselib.estimate_absolute_pose(seen, points, camera, {"max_reproj_error": 2.0}, {})
    number = poselib.Camera(name, camera["params"], 1280, 960).model_id
    right = np.allclose(pose.R, turn, atol=1e-4)
    print(f"PoseLib {version('poselib')}: {name}: model_id {number}, {info['num_inliers']} inliers, the pose {'right' if right else 'wrong'}")
    assert (number >= 0 and info["num_inliers"] == 60 and right) if name in known else (number, info["num_inliers"], right) == (-1, 0, False), "not as stated"
    if name in unknown:
        assert np.allclose(pose.R, np.eye(3)), "not as stated"
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check poselib==2.0.5 numpy==2.2.6
"$folder/tools/bin/python" "$folder/asked.py"
echo "as stated"
