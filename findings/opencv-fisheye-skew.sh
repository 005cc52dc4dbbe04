#!/usr/bin/env bash
# cv2.fisheye.calibrate estimates a skew unless it is told not to, and returns it in the camera matrix; cv2.fisheye.projectPoints does not look there: it wants it as alpha,
# the matrix's skew by its focal length. Without alpha the residuals of its own calibration are larger than the RMS that it returned; with it they are the same.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11). Skew of 3 px at a focal length of 500, RMS in px:
#   returned .40, projected by matrix and coefficients .89, with alpha .40
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

board = np.array([[25.0 * column, 25.0 * row, 0] for row in range(6) for column in range(9)])[None]
matrix, lens, alpha = np.array([[500.0, 0, 637], [0, 500, 482], [0, 0, 1]]), np.array([0.02, -0.004, 0.001, -0.0002]), 3 / 500
draws = np.random.default_rng(3)
views = []
for _ in range(12):
    turn, at = draws.uniform(-0.5, 0.5, 3), np.array([draws.uniform(-200, 0), draws.uniform(-120, -10), draws.uniform(150, 300)])
    exact = cv2.fisheye.projectPoints(board, turn, at, matrix, lens, alpha=alpha)[0]
    views.append(exact + draws.normal(0, 0.3, exact.shape))
recompute = getattr(cv2.fisheye, "CALIB_RECOMPUTE_EXTRINSIC", None) or cv2.CALIB_RECOMPUTE_EXTRINSIC
rms, found, lens, turns, shifts = cv2.fisheye.calibrate([board] * 12, views, (1280, 960), None, None, flags=recompute)


def again(alpha):
    off = [view - cv2.fisheye.projectPoints(board, turn, at, found, lens, alpha=alpha)[0] for view, turn, at in zip(views, turns, shifts)]
    return np.sqrt(2 * np.mean(np.square(off)))


with_alpha = again(found[0, 1] / found[0, 0])
print(f"{cv2.__version__}: skew {found[0, 1]:.2f} px; RMS returned {rms:.4f}, by matrix and coefficients {again(0.0):.4f}, with alpha {with_alpha:.4f} px")
assert abs(found[0, 1] - 3) < 0.5 and np.isclose(with_alpha, rms, rtol=1e-4) and again(0.0) > 1.2 * rms, "not as stated"
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
