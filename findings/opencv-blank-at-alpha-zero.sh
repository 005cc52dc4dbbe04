#!/usr/bin/env bash
# cv2.getOptimalNewCameraMatrix with alpha 0 promises that "all the pixels in the undistorted image are valid", and returns the rectangle of those. Of a lens of 104 degrees (focal
# length 500 px for 1280 x 960 px, k1 -.2, k2 .05, one to one over the whole frame) neither holds: the corners have no source, up to 77 px outside of the frame, and the rectangle has them too.
# The rectangle of alpha 1 has such pixels as well. With 700 px all is as promised. The last row and column are never in the rectangle. cv2.stereoRectify with alpha 0 has the same.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), of 1228800 pixels, those more than 1 px outside:
#   500 px: 16741 blank (4.6.0: 17359), 16155 of them in the rectangle 0, 0, 1279 x 959; of alpha 1 14980 in the rectangle; 700 px: none
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

WIDTH, HEIGHT = 1280, 960
LENS = np.array([-0.2, 0.05, 0, 0, 0])


def outside(matrix, turn, new):
    """How far outside of the frame's outer edges the source of each pixel of the undistorted picture is, px."""
    x, y = cv2.initUndistortRectifyMap(matrix, LENS, turn, new, (WIDTH, HEIGHT), cv2.CV_32FC1)
    return np.maximum.reduce([-0.5 - x, x - WIDTH + 0.5, -0.5 - y, y - HEIGHT + 0.5]) 


radii = np.linspace(0, 3, 1000)
assert (np.diff(radii * (1 + LENS[0] * radii**2 + LENS[1] * radii**4)) > 0).all()
for focal, blank in ((500.0, True), (700.0, False)):
    matrix = np.array([[focal, 0, 640], [0, focal, 480], [0, 0, 1]])
    for alpha in (0, 1):
        new, valid = cv2.getOptimalNewCameraMatrix(matrix, LENS, (WIDTH, HEIGHT), alpha)
        off = outside(matrix, None, new)
        x, y, width, height = valid
        inside = (off[y : y + height, x : x + width] > 1).sum()
        print(f"{cv2.__version__}: {focal:.0f} px, alpha {alpha}: {(off > 1).sum()} pixels blank, up to {off.max():.0f} px outside, {inside} of them in the rectangle {valid}")
        assert (10000 < inside < 25000) if blank else inside == 0, "not as stated"
        if alpha == 0:
            assert ((off > 1).sum() > 10000 and 60 < off.max() < 100) if blank else off.max() < 1, "not as stated"
            assert tuple(valid) == (0, 0, WIDTH - 1, HEIGHT - 1), "not as stated"
    said = cv2.stereoRectify(matrix, LENS, matrix, LENS, (WIDTH, HEIGHT), np.eye(3), np.array([[-1.0], [0], [0]]), alpha=0)
    lost = (outside(matrix, said[0], said[2]) > 1).sum()
    print(f"{cv2.__version__}: {focal:.0f} px, stereoRectify, alpha 0: {lost} pixels blank")
    assert lost > 10000 if blank else lost == 0, "not as stated"
PYTHON
for packages in "opencv-contrib-python-headless==4.6.0.66 numpy==1.26.4" "opencv-contrib-python-headless==4.14.0.94 numpy==2.2.6" "opencv-contrib-python-headless==5.0.0.93 numpy==2.2.6" \
    "opencv-contrib-python==5.1.0.95 numpy==2.2.6"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check $packages
    "$folder/tools/bin/python" "$folder/asked.py"
done
echo "as stated"
