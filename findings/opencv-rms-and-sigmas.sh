#!/usr/bin/env bash
# The RMS that OpenCV returns is per point, sqrt(sum(dx^2 + dy^2) / points), sqrt(2) of that per coordinate, from calibrateCamera (and of each view), fisheye.calibrate,
# omnidir.calibrate and stereoCalibrate (points of both cameras); but solvePnPGeneric's is per coordinate.
# The standard deviations of calibrateCameraExtended are scaled by sum(v^2) / (2 N - u) since 4.8, and before it by sum(v^2) / (N - u), points in place of observations:
# those of old files are larger by sqrt((2 N - u) / (N - u)), here by 1.46. u counts what is estimated alone, and six for each pose.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.7.0.72, 4.8.1.78, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11). 12 boards of 54 points.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/rms.py" <<'PYTHON'
import cv2
import numpy as np

VERSION, SIZE, VIEWS, SIGMA = cv2.__version__, (1280, 960), 12, 0.3
draws = np.random.default_rng(1)
board = np.array([[25.0 * column, 25.0 * row, 0] for row in range(6) for column in range(9)])
single, boards = [board.astype(np.float32).reshape(-1, 1, 3)] * VIEWS, [board[None]] * VIEWS
matrix, lens = np.array([[900.0, 0, 637], [0, 905, 482], [0, 0, 1]]), np.array([-0.1, 0.05, 0.001, -0.001, 0])
poses = [(draws.uniform(-0.5, 0.5, 3), np.array([draws.uniform(-150, -50), draws.uniform(-120, -30), draws.uniform(350, 600)])) for _ in range(VIEWS)]
aside = np.array([-40.0, 0, 0])


def seen(project, moved=0.0):
    return [(exact := project(turn, at + moved)) + draws.normal(0, SIGMA, exact.shape) for turn, at in poses]


def plain(turn, at):
    return cv2.projectPoints(board, turn, at, matrix, lens)[0].astype(np.float32)


def held(name, rms, residuals, per_point=True):
    residuals = np.concatenate([np.reshape(r, (-1, 2)) for r in residuals])
    point, coordinate = np.sqrt((residuals**2).sum() / len(residuals)), np.sqrt((residuals**2).mean())
    print(f"{VERSION}: {name}: {rms:.5f} px; per point {point:.5f}, per coordinate {coordinate:.5f}")
    assert np.isclose(rms, point if per_point else coordinate, rtol=1e-4), "not as stated"


left = [view.astype(np.float32) for view in seen(plain)]
rms, own, lenses, turns, shifts, sigmas, _, views = cv2.calibrateCameraExtended(single, left, SIZE, None, None, flags=cv2.CALIB_FIX_K3)
residuals = [left[i] - cv2.projectPoints(board, turns[i], shifts[i], own, lenses)[0] for i in range(VIEWS)]
held("calibrateCamera", rms, residuals)
held("its first view", views[0, 0], residuals[:1])

start = np.concatenate([own[[0, 1, 0, 1], [0, 1, 2, 2]], lenses.ravel()[:4], *(np.r_[a.ravel(), b.ravel()] for a, b in zip(turns, shifts))])


def pictured(x):
    camera, bent = np.array([[x[0], 0, x[2]], [0, x[1], x[3]], [0, 0, 1]]), np.r_[x[4:8], 0]
    return np.concatenate([cv2.projectPoints(board, x[i:i + 3], x[i + 3:i + 6], camera, bent)[0].ravel() for i in range(8, len(x), 6)])


columns = []
for k, step in enumerate(1e-6 * np.maximum(1, abs(start))):
    aside_k = np.eye(len(start))[k] * step
    columns.append((pictured(start + aside_k) - pictured(start - aside_k)) / (2 * step))
design = np.array(columns).T
cofactors = np.linalg.inv(design.T @ design).diagonal()[:8]
redundancy = np.sum(np.square(residuals)) * cofactors / sigmas.ravel()[:8] ** 2
observed, unknown = design.shape
print(f"{VERSION}: sigmas are scaled by the sum of squares over {redundancy.mean():.2f}; 2 N - u = {observed - unknown}, N - u = {observed // 2 - unknown}")
points = VERSION in ("4.6.0", "4.7.0")
assert np.allclose(redundancy, (observed // 2 if points else observed) - unknown, rtol=1e-5), "not as stated"

right = [view.astype(np.float32) for view in seen(plain, aside)]
rms = cv2.stereoCalibrate(single, left, right, matrix.copy(), lens.copy(), matrix.copy(), lens.copy(), SIZE, flags=cv2.CALIB_FIX_INTRINSIC)[0]
print(f"{VERSION}: stereoCalibrate: {rms:.3f} px; noise per point {SIGMA * 2**0.5:.3f}, per coordinate {SIGMA:.3f}")
assert abs(rms / SIGMA - 2**0.5) < 0.05, "not as stated"

names = cv2.fisheye if hasattr(cv2.fisheye, "CALIB_FIX_SKEW") else cv2
recompute = names.CALIB_RECOMPUTE_EXTRINSIC | names.CALIB_FIX_SKEW
wide = seen(lambda turn, at: cv2.fisheye.projectPoints(board[None], turn, at, matrix, np.zeros(4))[0])
rms, own, lenses, turns, shifts = cv2.fisheye.calibrate(boards, wide, SIZE, None, None, flags=recompute)
held("fisheye", rms, [wide[i] - cv2.fisheye.projectPoints(board[None], turns[i], shifts[i], own, lenses)[0] for i in range(VIEWS)])
wide = seen(lambda turn, at: cv2.omnidir.projectPoints(board[None], turn, at, matrix, 1.0, np.zeros((1, 4)))[0])
rms, own, xi, lenses, turns, shifts, used = cv2.omnidir.calibrate(boards, wide, SIZE, None, None, None, 0, (3, 200, 1e-8))
again = [cv2.omnidir.projectPoints(board[None], turns[k], shifts[k], own, float(xi[0, 0]), lenses)[0] for k in range(len(used.ravel()))]
held("omnidir", rms, [wide[i] - again[k] for k, i in enumerate(used.ravel())])
_, turns, shifts, error = cv2.solvePnPGeneric(board, left[0], matrix, lens, flags=cv2.SOLVEPNP_ITERATIVE)
held("solvePnPGeneric", error.item(), [left[0] - cv2.projectPoints(board, turns[0], shifts[0], matrix, lens)[0]], per_point=False)
PYTHON
for package in opencv-contrib-python-headless==4.6.0.66 opencv-contrib-python-headless==4.7.0.72 opencv-contrib-python-headless==4.8.1.78 \
    opencv-contrib-python-headless==4.14.0.94 opencv-contrib-python-headless==5.0.0.93 opencv-contrib-python==5.1.0.95; do
    numpy='numpy==2.2.6'
    case $package in *==4.6* | *==4.7* | *==4.8*) numpy='numpy==1.26.4' ;; esac
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check "$package" "$numpy"
    "$folder/tools/bin/python" "$folder/rms.py"
done
echo "as stated"
