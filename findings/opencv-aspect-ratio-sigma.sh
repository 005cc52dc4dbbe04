#!/usr/bin/env bash
# cv2.calibrateCameraExtended with CALIB_FIX_ASPECT_RATIO says that fx is known exactly: its standard deviation is 0, as of a parameter that was held, though fx was estimated
# (it follows fy). The other standard deviations are those of the adjustment with one focal length: that of fy is the one of fx too. Who takes 0 for "held" or weights by it is wrong.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), all alike: ten views of 9 x 6 corners, start 880 px:
#   fx = fy = 902.25 px, 22 px from the start; standard deviations 0 and 2.05 px (4.6.0: 3.00, scaled by the number of points)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

draws = np.random.default_rng(0)
board = np.array([[25.0 * column, 25.0 * row, 0] for row in range(6) for column in range(9)], np.float32)
matrix = np.array([[900.0, 0, 650], [0, 900, 470], [0, 0, 1]])
views = []
for _ in range(10):
    turn, shift = draws.uniform(-0.4, 0.4, 3), np.array([draws.uniform(-150, -50), draws.uniform(-120, -60), draws.uniform(350, 600)])
    exact = cv2.projectPoints(board, turn, shift, matrix, np.array([-0.1, 0.02, 0, 0, 0]))[0]
    views.append((exact + draws.normal(0, 0.2, exact.shape)).astype(np.float32))
start = np.array([[880.0, 0, 640], [0, 880, 480], [0, 0, 1]])
flags = cv2.CALIB_FIX_ASPECT_RATIO | cv2.CALIB_USE_INTRINSIC_GUESS
said = cv2.calibrateCameraExtended([board] * 10, views, (1280, 960), start.copy(), np.zeros(5), flags=flags)
focal, sigmas = said[1].diagonal()[:2], said[5].ravel()[:4]
print(f"{cv2.__version__}: fx, fy {np.round(focal, 3)} px, their standard deviations {np.round(sigmas[:2], 3)} px; of cx, cy {np.round(sigmas[2:], 3)} px")
assert focal[0] == focal[1] and abs(focal[0] - 902.25) < 0.05, "not as stated"
assert sigmas[0] == 0 and np.isclose(sigmas[1], 3.00 if cv2.__version__ == "4.6.0" else 2.05, atol=0.02), "not as stated"
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
