#!/usr/bin/env bash
# aprilgrid's corners have the order of the AprilTag project (bottom left of the upright tag first, anticlockwise) but OpenCV's origin, the centre of the first pixel, since it
# refines by cornerSubPix: half a pixel from pyapriltags, pupil-apriltags and the others of apriltag-corner-order.sh on the same picture.
# Seen: aprilgrid 0.5.0 with opencv-python 5.0.0.93 (Linux, CPython 3.11), a Kalibr grid of 3 x 3 tags of 80 px with its small squares, 9 places of the pixel:
#   mean x and y less the true corners -.02 -.02 px, scatter .02 px; of tags that stand alone, without the squares, scatter .13 px
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/grid.py" <<'PYTHON'
import aprilgrid
import cv2
import numpy as np
from moms_apriltag.generator2 import TagGenerator2

SIDE, GAP, AROUND, COUNT, FINER = 80, 24, 40, 3, 8
STEP = SIDE + GAP
SIZE = 2 * AROUND + COUNT * STEP + GAP


def sheet(dx, dy, squares):
    """A grid of tags with a border of two bits, and their corners: bottom left, bottom right, top right, top left."""
    fine = np.full((SIZE * FINER, SIZE * FINER), 255, np.float32)

    def area(x, y, width):
        return tuple(slice(round(low * FINER), round((low + width) * FINER)) for low in (AROUND + y + dy, AROUND + x + dx))

    corners = {}
    for row, column in np.ndindex(COUNT, COUNT):
        tag, x, y = (COUNT - 1 - row) * COUNT + column, GAP + column * STEP, GAP + row * STEP
        code = cv2.copyMakeBorder(TagGenerator2("tag36h11").generate(tag).astype(np.uint8), 1, 1, 1, 1, 0, value=0)
        fine[area(x, y, SIDE)] = cv2.resize(code, (SIDE * FINER, SIDE * FINER), interpolation=cv2.INTER_NEAREST)
        corners[tag] = np.array([[x, y + SIDE], [x + SIDE, y + SIDE], [x + SIDE, y], [x, y]]) + [dx, dy] + np.array(AROUND - 0.5)
    for row, column in np.ndindex(COUNT + 1, COUNT + 1) if squares else []:
        fine[area(column * STEP, row * STEP, GAP)] = 0
    pixels = cv2.GaussianBlur(fine.reshape(SIZE, FINER, SIZE, FINER).mean((1, 3)), (0, 0), 0.7)
    return np.round(30 + 0.7 * pixels).astype(np.uint8), corners


for squares, scatter in ((True, 0.022), (False, 0.130)):
    off = []
    for place in np.ndindex(3, 3):
        image, truth = sheet(place[0] / 4, place[1] / 4, squares)
        off += [found.corners.reshape(4, 2) - truth[found.tag_id] for found in aprilgrid.Detector("t36h11").detect(image)]
    off = np.array(off)
    print(f"aprilgrid 0.5.0: {len(off)} tags, squares {squares}: {np.round(off.mean((0, 1)), 3)} px from bottom left first, at most {abs(off).max():.2f}, scatter {off.std():.3f} px")
    assert len(off) == 81 and abs(off).max() < 1, "in another order, or not found"
    assert np.allclose(off.mean((0, 1)), 0, atol=0.05) and abs(off.std() - scatter) < 0.03, "not as stated"
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check aprilgrid==0.5.0 opencv-python==5.0.0.93 moms-apriltag==2023.1.15 numpy==2.2.6
"$folder/tools/bin/python" "$folder/grid.py"
echo "as stated"
