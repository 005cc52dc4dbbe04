#!/usr/bin/env bash
# OpenCV 5.0.0's fisheye.calibrate refuses points in columns, shape (n, 1, 2), as findChessboardCorners and its own projectPoints return them, with an error of core
# that names no argument ("Sizes of input arguments do not match"); in rows, shape (1, n, 2), it takes the same numbers. 4.14.0 and 5.1.0 take both and give the same.
# Its flags have left cv2.fisheye in 5.0.0 as well (cv2.fisheye.CALIB_FIX_SKEW is no attribute), and are there again in 5.1.0.
# Seen: opencv-contrib-python-headless 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/columns.py" <<'PYTHON'
import cv2
import numpy as np

SIZE, VIEWS = (1280, 960), 20
board = np.array([[25.0 * column, 25.0 * row, 0.0] for row in range(6) for column in range(9)]).reshape(-1, 1, 3)
matrix, lens = np.array([[489.0, 0, 637], [0, 489, 482], [0, 0, 1]]), np.array([0.02, -0.004, 0.001, -0.0002])
draws = np.random.default_rng(0)
poses = [(draws.uniform(-0.6, 0.6, 3), np.array([draws.uniform(-250, 50), draws.uniform(-180, 50), draws.uniform(150, 300)])) for _ in range(VIEWS)]
views = [cv2.fisheye.projectPoints(board, turn, at, matrix, lens)[0].reshape(-1, 1, 2) for turn, at in poses]
recompute = getattr(cv2.fisheye, "CALIB_RECOMPUTE_EXTRINSIC", None) or cv2.CALIB_RECOMPUTE_EXTRINSIC

for name, shape in (("rows", (1, -1)), ("columns", (-1, 1))):
    try:
        objects, images = [board.reshape(*shape, 3)] * VIEWS, [view.reshape(*shape, 2) for view in views]
        rms = cv2.fisheye.calibrate(objects, images, SIZE, None, None, flags=recompute)[0]
        seen = "calibrated" if rms < 1e-9 else f"RMS {rms}"
    except cv2.error as error:
        seen = "refused" if "Sizes of input arguments do not match" in str(error) else str(error)
    print(f"{cv2.__version__}: points in {name}: {seen}")
    is_broken = cv2.__version__ == "5.0.0"
    assert seen == ("refused" if is_broken and name == "columns" else "calibrated"), "not as stated"
    assert hasattr(cv2.fisheye, "CALIB_FIX_SKEW") != is_broken, "not as stated"
PYTHON
for package in opencv-contrib-python-headless==4.14.0.94 opencv-contrib-python-headless==5.0.0.93 opencv-contrib-python==5.1.0.95; do
    python3 -m venv "$folder/${package#*==}"
    "$folder/${package#*==}/bin/pip" install --quiet --disable-pip-version-check "$package" numpy==2.2.6
    "$folder/${package#*==}/bin/python" "$folder/columns.py"
done
echo "as stated"
