#!/usr/bin/env bash
# OpenCV's detectMarkers has the corners of a Kalibr grid's tags two pixels inside in x and two in y, whatever the size of the tag, and says nothing: the small squares
# that touch the corners make the outline that it follows the inner one. CORNER_REFINE_SUBPIX mends it up to 4.8; since 4.9 its window is at most 0.3 of a bit of the
# tag, for tags of 40 and 80 px too small to reach the corner, and they are returned unrefined; 120 px are refined. (`relativeCornerRefmentWinSize`.)
# Corners of a tag that stands alone lie half a pixel inside in x and in y. CORNER_REFINE_CONTOUR mends neither.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.8.0.76, 4.9.0.80 and 5.0.0.93 (Linux, CPython 3.11). Displacement along the tag's diagonals, px, median of nine tags:
#   4.8.0   grid 40 px: none -2.83, subpix -0.00, contour -2.15, apriltag -0.01     alone 40 px: none -0.71
#   4.9.0   grid 40 px: none -2.83, subpix -2.83, contour -2.15, apriltag -0.01     alone 40 px: none -0.71
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/tags.py" <<'PYTHON'
import sys

import cv2
import numpy as np

aruco = cv2.aruco
codes = aruco.getPredefinedDictionary(aruco.DICT_APRILTAG_36h11)
FINER, AROUND, COUNT = 8, 20, 3


def sheet(side, squares):
    """Nine tags with a border of two bits, 0.3 of their side apart, with or without the squares between them, and where their corners are."""
    gap = 0.3 * side
    size = round((COUNT * (side + gap) + gap + 2 * AROUND) * FINER) // FINER * FINER
    fine = np.full((size, size), 255, np.float32)
    corners = {}

    def area(x, y, width):
        low = [round(v * FINER) for v in (y, x)]
        high = [round((v + width) * FINER) for v in (y, x)]
        return slice(low[0], high[0]), slice(low[1], high[1])

    for row in range(COUNT):
        for column in range(COUNT):
            x, y = (AROUND + gap + place * (side + gap) for place in (column, row))
            tag = row * COUNT + column
            draw = getattr(aruco, "drawMarker", None) or aruco.generateImageMarker
            where = area(x, y, side)
            shape = fine[where].shape[::-1]
            fine[where] = cv2.resize(draw(codes, tag, 10, borderBits=2), shape, interpolation=cv2.INTER_NEAREST)
            corners[tag] = np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]]) - 0.5
    for place in np.ndindex(COUNT + 1, COUNT + 1) if squares else []:
        x, y = (AROUND + step * (side + gap) for step in place)
        fine[area(x, y, gap)] = 0
    pixels = fine.reshape(size // FINER, FINER, size // FINER, FINER).mean((1, 3))
    return np.round(30 + 0.7 * cv2.GaussianBlur(pixels, (0, 0), 0.7)).astype(np.uint8), corners


def outwards(side, squares, refinement):
    image, truth = sheet(side, squares)
    modern = hasattr(aruco, "ArucoDetector")
    parameters = aruco.DetectorParameters() if modern else aruco.DetectorParameters_create()
    parameters.markerBorderBits = 2
    parameters.cornerRefinementMethod = refinement
    if modern:
        found, tags, _ = aruco.ArucoDetector(codes, parameters).detectMarkers(image)
    else:
        found, tags, _ = aruco.detectMarkers(image, codes, parameters=parameters)
    assert sorted(tags.ravel()) == list(range(9)), tags
    off = []
    for four, tag in zip(found, tags.ravel()):
        rays = truth[tag] - truth[tag].mean(0)
        off += list(((four[0] - truth[tag]) * rays).sum(1) / np.linalg.norm(rays, axis=1))
    return float(np.median(off))


small = float(sys.argv[1])
expected = [
    (40, True, 0, -2.83), (80, True, 0, -2.83), (200, True, 0, -2.83),
    (40, True, 1, small), (80, True, 1, small), (120, True, 1, 0.0),
    (40, True, 2, -2.15), (40, True, 3, 0.0), (40, False, 0, -0.71), (40, False, 3, 0.0),
]
for side, squares, refinement, value in expected:
    seen = outwards(side, squares, refinement)
    print(f"{cv2.__version__}: tags of {side} px, {'in a grid' if squares else 'alone'}, refinement {refinement}: {seen:+.2f} px outwards")
    assert abs(seen - value) < 0.03, f"expected {value}"
PYTHON
for version in "4.6.0.66 0" "4.8.0.76 0" "4.9.0.80 -2.83" "5.0.0.93 -2.83"; do
    read -r opencv small <<< "$version"
    python3 -m venv "$folder/$opencv"
    numpy='numpy==1.26.4'
    [ "${opencv%%.*}" = 5 ] && numpy='numpy==2.2.6'
    "$folder/$opencv/bin/pip" install --quiet --disable-pip-version-check "opencv-contrib-python-headless==$opencv" "$numpy"
    "$folder/$opencv/bin/python" "$folder/tags.py" "$small"
done
echo "as stated"
