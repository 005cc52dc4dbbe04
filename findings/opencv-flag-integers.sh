#!/usr/bin/env bash
# Flags that are stored or passed as integers mean something else in OpenCV 5. SOLVEPNP_AP3P, IPPE, IPPE_SQUARE and SQPNP went from 5, 6, 7, 8 to 3, 4, 5, 6: 6 asks 4.14 for
# IPPE and 5.0 for SQPnP. The fisheye flags of 4 (2 recompute, 8 fix skew, 16 fix k1, ...) are those of calibrateCamera
# in 5.0 and 5.1 (8388608, 33554432, 32, ...). 10, which recomputes and fixes the skew in 4, says neither in 5.0, which finds no minimum then; 5.1 refuses it by name.
# CALIB_DISABLE_SCHUR_COMPLEMENT has three values in three releases, and that of 4.14 is CALIB_RECOMPUTE_EXTRINSIC in 5.
# Seen: opencv-contrib-python-headless 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11). A fisheye calibrated from exact points, RMS in px:
#   flags 10: 4.14 1e-13, 5.0 above 5, 5.1 refused     flags of the names: all 1e-13     solvePnP of exact points in space, flag 6: 4.14 wrong or an error, 5.0 and 5.1 exact
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/flags.py" <<'PYTHON'
import cv2
import numpy as np

five = cv2.__version__.startswith("5")
fisheye = {"RECOMPUTE_EXTRINSIC": (2, 8388608), "FIX_SKEW": (8, 33554432), "FIX_K1": (16, 32), "FIX_PRINCIPAL_POINT": (512, 4), "FIX_FOCAL_LENGTH": (2048, 16)}
for name, values in fisheye.items():
    holder = cv2 if cv2.__version__.startswith("5.0") else cv2.fisheye
    assert getattr(holder, "CALIB_" + name) == values[five], name
for name, values in {"AP3P": (5, 3), "IPPE": (6, 4), "IPPE_SQUARE": (7, 5), "SQPNP": (8, 6)}.items():
    assert getattr(cv2, "SOLVEPNP_" + name) == values[five], name
schur = {"4.14": 8388608, "5.0": 262144, "5.1": 134217728}[cv2.__version__.rpartition(".")[0]]
assert cv2.CALIB_DISABLE_SCHUR_COMPLEMENT == schur
assert not five or cv2.CALIB_RECOMPUTE_EXTRINSIC == 8388608

SIZE = (1280, 960)
board = np.array([[25.0 * column, 25.0 * row, 0.0] for row in range(6) for column in range(9)])[None]
matrix, lens = np.array([[489.0, 0, 637], [0, 489, 482], [0, 0, 1]]), np.array([0.02, -0.004, 0.001, -0.0002])
draws = np.random.default_rng(0)
poses = [(draws.uniform(-0.6, 0.6, 3), np.array([draws.uniform(-250, 50), draws.uniform(-180, 50), draws.uniform(150, 300)])) for _ in range(20)]
views = [cv2.fisheye.projectPoints(board, turn, at, matrix, lens)[0] for turn, at in poses]
for name, flags in (("10", 10), ("of the names", fisheye["RECOMPUTE_EXTRINSIC"][five] | fisheye["FIX_SKEW"][five])):
    try:
        rms = cv2.fisheye.calibrate([board] * 20, views, SIZE, None, None, flags=flags)[0]
        result = "exact" if rms < 1e-9 else "no minimum" if rms > 5 else rms
    except cv2.error as error:
        result = "refused" if "Unsupported fisheye flags" in str(error) else str(error)
    print(f"{cv2.__version__}: fisheye, flags {name}: {result}")
    old = {"4.14.0": "exact", "5.0.0": "no minimum", "5.1.0": "refused"}[cv2.__version__]
    assert result == (old if name == "10" else "exact"), "not as stated"

points, turn, at = draws.uniform(-1, 1, (12, 3)), np.array([0.2, -0.3, 0.4]), np.array([0.1, 0.2, 6.0])
seen = cv2.projectPoints(points, turn, at, matrix, None)[0]
try:
    found = cv2.solvePnP(points, seen, matrix, None, flags=6)
    result = "exact" if found[0] and np.allclose(found[1].ravel(), turn, atol=1e-6) else "wrong"
except cv2.error:
    result = "an error"
print(f"{cv2.__version__}: solvePnP, flag 6, points in space: {result}")
assert (result == "exact") == five, "not as stated"
PYTHON
for package in opencv-contrib-python-headless==4.14.0.94 opencv-contrib-python-headless==5.0.0.93 opencv-contrib-python==5.1.0.95; do
    python3 -m venv "$folder/${package#*==}"
    "$folder/${package#*==}/bin/pip" install --quiet --no-compile --disable-pip-version-check "$package" numpy==2.2.6
    "$folder/${package#*==}/bin/python" "$folder/flags.py"
done
echo "as stated"
