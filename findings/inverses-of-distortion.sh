#!/usr/bin/env bash
# cv2.undistortPoints takes five steps of a fixed point and says nothing of what is left: with k1 -.3, k2 .1 and a focal length of 500 px, whose image grows outwards without
# end, it is .07 px off at .8 of the focal length and .57 px at 1.4. undistortPointsIter with 100 steps is exact; 5.1 has it no more, and the criteria are an argument.
# cv2.fisheye.undistortPoints is exact to 88 degrees. COLMAP's cam_from_img is exact to 1.4 and beyond.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95, pycolmap 3.13.0 and 4.2.1 (Linux, CPython 3.11), all alike.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import numpy as np

try:
    import pycolmap
except ImportError:
    pycolmap = None
F, K1, K2 = 500.0, -0.3, 0.1
RADII = np.array([0.2, 0.5, 0.8, 1.4])
pictured = np.stack([640 + F * RADII * (1 + K1 * RADII**2 + K2 * RADII**4), np.full(4, 480.0)], 1)
assert (np.diff(pictured[:, 0]) > 0).all()

if pycolmap:
    camera = pycolmap.Camera(model="OPENCV", width=1280, height=960, params=[F, F, 640, 480, K1, K2, 0, 0])
    off = F * (np.array([np.asarray(camera.cam_from_img(pixel)).ravel()[0] for pixel in pictured]) - RADII)
    print(f"pycolmap {pycolmap.__version__}: {off} px")
    assert abs(off).max() < 1e-6, "not as stated"
    raise SystemExit

import cv2

matrix = np.array([[F, 0, 640], [0, F, 480], [0, 0, 1]])
lens = np.array([K1, K2, 0, 0, 0])
off = F * (cv2.undistortPoints(pictured[:, None], matrix, lens)[:, 0, 0] - RADII)
print(f"{cv2.__version__}: undistortPoints: {np.round(off, 4)} px at {RADII} of the focal length")
assert np.allclose(off, [0, -0.0007, -0.0694, 0.5734], atol=0.001), "not as stated"
if hasattr(cv2, "undistortPointsIter"):
    off = F * (cv2.undistortPointsIter(pictured[:, None], matrix, lens, None, None, (3, 100, 1e-12))[:, 0, 0] - RADII)
    assert abs(off).max() < 1e-6, "not as stated"
angles = np.radians([20, 60, 88])
bent = np.array([-0.02, 0.01, -0.005, 0.001])
rays = np.stack([np.tan(angles), 0 * angles, 1 + 0 * angles], 1)[None]
seen = cv2.fisheye.projectPoints(rays, np.zeros(3), np.zeros(3), matrix, bent)[0]
back = np.degrees(np.arctan(cv2.fisheye.undistortPoints(seen, matrix, bent)[..., 0]) - angles)
print(f"{cv2.__version__}: fisheye.undistortPoints: at most {abs(back).max():.1g} degrees off")
assert abs(back).max() < 1e-6, "not as stated"
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
