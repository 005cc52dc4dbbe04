#!/usr/bin/env bash
# Points that a camera cannot see are pictured all the same. cv2.projectPoints pictures a point behind the camera where the opposite one in front of it is: -X as X. So does
# cv2.fisheye.projectPoints beyond 90 degrees from the axis: at 100 degrees, equidistant, at the place of 80 degrees on the other side, 1571 px off with a focal length of 500.
# cv2.fisheye.undistortPoints returns 1.8e16 for a pixel at 100 degrees, with no word. cv2.omnidir is right to its limit. COLMAP has no image of a point with z <= 0 in any of
# six models, its fisheyes among them (img_from_cam returns None), though their formulas go beyond 90 degrees.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95, pycolmap 3.13.0 and 4.2.1 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import numpy as np

try:
    import pycolmap
except ImportError:
    pycolmap = None
F, ANGLE = 500.0, np.radians(100)
beyond = np.array([np.sin(ANGLE), 0, np.cos(ANGLE)])

if pycolmap:
    models = {"SIMPLE_RADIAL": 4, "PINHOLE": 4, "OPENCV": 8, "OPENCV_FISHEYE": 8, "THIN_PRISM_FISHEYE": 12, "FOV": 5}
    for model, count in models.items():
        values = [F, 640, 480, 0] if model == "SIMPLE_RADIAL" else [F, F, 640, 480] + [0.01] * (count - 4)
        camera = pycolmap.Camera(model=model, width=1280, height=960, params=values)
        ahead = camera.img_from_cam(np.array([0.1, 0.0, 1.0]))
        found = [camera.img_from_cam(point) for point in (beyond, np.array([-0.1, 0.0, -1.0]))]
        print(f"pycolmap {pycolmap.__version__}: {model}: ahead {ahead}, at 100 degrees and behind {found}")
        assert ahead is not None and found == [None, None], "not as stated"
    raise SystemExit

import cv2

matrix, zero = np.array([[F, 0, 640], [0, F, 480], [0, 0, 1]]), np.zeros(3)
ahead = np.array([[0.2, 0.1, 1.0]])
both = [cv2.projectPoints(point, zero, zero, matrix, None)[0].ravel() for point in (ahead, -ahead)]
wide = cv2.fisheye.projectPoints(beyond[None, None], zero, zero, matrix, np.zeros(4))[0].ravel()[0]
back = cv2.fisheye.undistortPoints(np.array([[[640 + F * ANGLE, 480.0]]]), matrix, np.zeros(4)).ravel()[0]
omni = cv2.omnidir.projectPoints(beyond[None, None], zero, zero, matrix, 1.0, np.zeros((1, 4)))[0].ravel()[0]
print(f"{cv2.__version__}: X and -X at {both[0]} and {both[1]}; 100 degrees at x {wide:.1f}, should be {640 + F * ANGLE:.1f}, and back {back:.2g}; omnidir {omni:.1f}")
assert np.allclose(*both) and np.isclose(wide, 640 - F * np.radians(80)), "not as stated"
assert back > 1e12 and np.isclose(omni, 640 + F * np.sin(ANGLE) / (1 + np.cos(ANGLE))), "not as stated"
PYTHON
for packages in "opencv-contrib-python-headless==4.6.0.66 numpy==1.26.4" "opencv-contrib-python-headless==4.14.0.94 numpy==2.2.6" "opencv-contrib-python-headless==5.0.0.93 numpy==2.2.6" \
    "opencv-contrib-python==5.1.0.95 numpy==2.2.6" "pycolmap==3.13.0 numpy==2.2.6" "pycolmap==4.2.1 numpy==2.2.6"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check $packages
    "$folder/tools/bin/python" "$folder/asked.py"
done
echo "as stated"
