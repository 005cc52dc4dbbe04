#!/usr/bin/env bash
# Where OpenCV puts the middle of a frame, and what happens to pixels when a picture is made smaller. calibrateCamera with CALIB_FIX_PRINCIPAL_POINT and no guess holds the
# principal point at (w - 1) / 2, (h - 1) / 2. resize to half, by INTER_AREA or INTER_LINEAR, keeps the outer edges: x becomes (x + .5) / 2 - .5. pyrDown keeps the centre of
# the first pixel: x becomes x / 2. A camera matrix halved as a whole is right for pyrDown; for resize its principal point is .25 px off.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), all alike.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

SIZE = (1281, 961)
board = np.array([[25.0 * column, 25.0 * row, 0] for row in range(6) for column in range(9)], np.float32)
matrix, draws = np.array([[900.0, 0, 645], [0, 900, 470], [0, 0, 1]]), np.random.default_rng(0)
poses = [(draws.uniform(-0.5, 0.5, 3), np.array([draws.uniform(-150, -50), draws.uniform(-120, -30), draws.uniform(350, 600)])) for _ in range(8)]
views = [cv2.projectPoints(board.astype(float), turn, at, matrix, None)[0].astype(np.float32) for turn, at in poses]
found = cv2.calibrateCamera([board] * 8, views, SIZE, None, None, flags=cv2.CALIB_FIX_PRINCIPAL_POINT)[1]
print(f"{cv2.__version__}: the fixed principal point of a frame of 1281 x 961 px: {found[:2, 2]}")
assert np.allclose(found[:2, 2], [640, 480]), "not as stated"

x, y = np.meshgrid(np.arange(200), np.arange(200))
middle = np.array([90.3, 110.6])
spot = np.exp(-((x - middle[0]) ** 2 + (y - middle[1]) ** 2) / (2 * 8.0**2)).astype(np.float32)


def centroid(image):
    columns, rows = np.meshgrid(np.arange(image.shape[1]), np.arange(image.shape[0]))
    return np.array([(image * columns).sum(), (image * rows).sum()]) / image.sum()


for name, half, expected in (
    ("resize, area", cv2.resize(spot, (100, 100), interpolation=cv2.INTER_AREA), (middle + 0.5) / 2 - 0.5),
    ("resize, linear", cv2.resize(spot, (100, 100), interpolation=cv2.INTER_LINEAR), (middle + 0.5) / 2 - 0.5),
    ("pyrDown", cv2.pyrDown(spot), middle / 2),
):
    print(f"{cv2.__version__}: {name}: a spot at {middle} is at {np.round(centroid(half), 3)}")
    assert np.allclose(centroid(half), expected, atol=0.002), "not as stated"
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
