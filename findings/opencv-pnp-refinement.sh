#!/usr/bin/env bash
# cv2.solvePnPRefineLM returns the start unchanged, and no error, where rvec and tvec are rows: (1, 3) in all versions, and in 5 also NumPy's plain (3,), which 4 takes for a column.
# solvePnPRefineVVS raises in these cases. It minimises normalised coordinates, not px: with fx twice fy its RMS is above solvePnPRefineLM's. solvePnPRansac with EPNP, P3P or AP3P
# ends with EPnP on the inliers, with SQPNP by SQPnP: no minimum either; only with ITERATIVE it is one.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11):
#   start .05 rad off: (3,) 1e-13 in 4 and .05 in 5; (3, 1) below 1e-7 in all; (1, 3) .05 in all
#   1 px of noise, fx 1800 and fy 900 px: LM 1.3637 px, VVS 1.3725 px; RANSAC: EPNP, P3P, AP3P 1.3876 px, SQPNP 1.3853 px, the minimum and ITERATIVE 1.3847 px
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

points = np.random.default_rng(0).uniform(-1, 1, (20, 3)) + [0, 0, 6]
lens, turn, shift = np.array([-0.2, 0.05, 0.001, -0.002, 0]), np.array([0.1, -0.2, 0.3]), np.array([0.1, 0.2, 0.3])
matrix = np.array([[900.0, 0, 640], [0, 900, 480], [0, 0, 1]])
major = int(cv2.__version__[0])
seen = cv2.projectPoints(points, turn, shift, matrix, lens)[0]
for shape in ((3,), (3, 1), (1, 3)):
    left = cv2.solvePnPRefineLM(points, seen, matrix, lens, (turn + 0.05).reshape(shape), (shift + 0.05).reshape(shape))[0].ravel() - turn
    kept = shape == (1, 3) or (shape == (3,) and major == 5)
    print(f"{cv2.__version__}: solvePnPRefineLM, rvec {shape}: {abs(left).max():.2g} rad off")
    assert np.allclose(left, 0.05, atol=1e-12) if kept else abs(left).max() < 1e-6, "not as stated"
    try:
        cv2.solvePnPRefineVVS(points, seen, matrix, lens, (turn + 0.05).reshape(shape), (shift + 0.05).reshape(shape))
        raised = False
    except cv2.error:
        raised = True
    assert raised == kept, "not as stated"


def rms(turn, shift, which):
    return np.sqrt(((cv2.projectPoints(points[which], turn, shift, matrix, lens)[0] - noisy[which]) ** 2).sum(-1).mean())


draws = np.random.default_rng(3)
draws.normal(0, 1, seen.shape)
matrix[0, 0], every = 1800, slice(None)
exact = cv2.projectPoints(points, turn, shift, matrix, lens)[0]
noisy = exact + draws.normal(0, 1, exact.shape)
for name, expected in (("LM", 1.3637), ("VVS", 1.3725)):
    found = rms(*getattr(cv2, f"solvePnPRefine{name}")(points, noisy, matrix, lens, (turn + 0.02)[:, None], (shift + 0.02)[:, None]), every)
    print(f"{cv2.__version__}: fx 1800, fy 900: {name} {found:.4f} px")
    assert abs(found - expected) < 2e-4, "not as stated"
matrix[0, 0] = 900
points = np.random.default_rng(1).uniform(-1, 1, (60, 3)) + [0, 0, 6]
exact = cv2.projectPoints(points, turn, shift, matrix, lens)[0]
noisy = exact + draws.normal(0, 1, exact.shape)
noisy[:15] += draws.uniform(20, 60, (15, 1, 2))
for name, expected in (("ITERATIVE", 1.3847), ("EPNP", 1.3876), ("P3P", 1.3876), ("AP3P", 1.3876), ("SQPNP", 1.3853)):
    flags = getattr(cv2, f"SOLVEPNP_{name}")
    _, found_turn, found_shift, inliers = cv2.solvePnPRansac(points, noisy, matrix, lens, flags=flags, reprojectionError=8.0)
    which = inliers.ravel()
    found = rms(found_turn, found_shift, which)
    least = rms(*cv2.solvePnPRefineLM(points[which], noisy[which], matrix, lens, found_turn.copy(), found_shift.copy()), which)
    print(f"{cv2.__version__}: solvePnPRansac, {name}: {len(which)} inliers, {found:.4f} px, after refinement {least:.4f} px")
    assert len(which) == 45 and abs(found - expected) < 2e-4 and abs(least - 1.3847) < 2e-4, "not as stated"
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
