#!/usr/bin/env bash
# Which circle of a grid findCirclesGrid returns first, in the picture turned by 0, 90, 180 and 270 degrees: of an asymmetric grid always the same one of the board, which its
# pattern tells; of a symmetric grid the top left one of the board or the one diagonally opposite, since nothing tells the ends apart: at 180 degrees it goes with the board, and
# 4.6 does not find the grid at 90 and 270 degrees, where 4.14 and 5 begin at another corner of the board. The origin is the centre of the first pixel.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

SIZE, FINER = 400, 4


def picture(centres):
    fine = np.full((SIZE * FINER, SIZE * FINER), 255, np.uint8)
    for x, y in centres:
        cv2.circle(fine, tuple(round((v + 0.5) * FINER * 16 - 8) for v in (x, y)), 10 * FINER * 16, 0, -1, cv2.LINE_AA, 4)
    return cv2.resize(fine, (SIZE, SIZE), interpolation=cv2.INTER_AREA)


SYMMETRIC = [(80 + 40 * column, 70 + 40 * row) for row in range(5) for column in range(6)]
ASYMMETRIC = [(80 + 60 * column + 30 * (row % 2), 70 + 30 * row) for row in range(7) for column in range(4)]
old = cv2.__version__ == "4.6.0"
for name, centres, size, flag, expected in (
    ("symmetric", SYMMETRIC, (6, 5), cv2.CALIB_CB_SYMMETRIC_GRID, ["0", "none", "29", "none"] if old else ["0", "5", "29", "24"]),
    ("asymmetric", ASYMMETRIC, (4, 7), cv2.CALIB_CB_ASYMMETRIC_GRID, ["0", "0", "0", "0"]),
):
    image, truth = picture(centres), np.array(centres, float)
    seen = []
    for turn in range(4):
        found, circles = cv2.findCirclesGrid(np.ascontiguousarray(np.rot90(image, turn)), size, flags=flag)
        if found:
            circles = circles.reshape(-1, 2)
            nearest = np.linalg.norm(circles[:, None] - truth, axis=2).argmin(1)
            assert np.abs((circles - truth[nearest]).mean(0)).max() < 0.06, "not as stated"
        seen.append(str(nearest[0]) if found else "none")
        truth = np.stack([truth[:, 1], SIZE - 1 - truth[:, 0]], 1)
    print(f"{cv2.__version__}: {name}, {size}: the board's circle that is first, by turn: {' '.join(seen)}")
    assert seen == expected, f"expected {expected}"
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
