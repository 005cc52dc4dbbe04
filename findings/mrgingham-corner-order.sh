#!/usr/bin/env bash
# mrgingham returns the corners of a chessboard from the top left of the picture, row by row, whichever colour is there, with the
# origin in the centre of the first pixel. By default it equalises and blurs first: corners of pictures without noise then scatter by .09 px and more, without both by .04 px.
# Seen: mrgingham 1.22-1+b2 of Debian 12, which this script asks for; boards of 10 x 10 corners, places of the pixel 4 x 4.
set -euo pipefail
case $(dpkg-query -W -f='${Version}' mrgingham 2>/dev/null) in
1.22-*) ;;
*) echo "wants Debian 12's mrgingham 1.22: apt-get install mrgingham" >&2; exit 2 ;;
esac
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import subprocess
import sys

import cv2
import numpy as np

FINER, SIDE, COUNT, AROUND = 8, 40, 10, 60


def board(x, y, black):
    size = SIDE * (COUNT + 1) + 2 * AROUND
    fine = np.full((size * FINER, size * FINER), 255, np.float32)
    for row, column in np.ndindex(COUNT + 1, COUNT + 1):
        if (row + column) % 2 == black:
            top, left = round((AROUND + y + row * SIDE) * FINER), round((AROUND + x + column * SIDE) * FINER)
            fine[top:top + SIDE * FINER, left:left + SIDE * FINER] = 0
    pixels = cv2.GaussianBlur(fine.reshape(size, FINER, size, FINER).mean((1, 3)), (0, 0), 0.8)
    corners = np.array([[x + (i + 1) * SIDE, y + (j + 1) * SIDE] for j in range(COUNT) for i in range(COUNT)]) + AROUND - 0.5
    return np.round(30 + 0.7 * pixels).astype(np.uint8), corners


for options, least, most in (([], 0.07, 0.2), (["--noclahe", "--blur", "0"], 0.0, 0.06)):
    off = []
    for place in np.ndindex(4, 4):
        image, truth = board(place[0] / 4 + 0.125, place[1] / 4 + 0.125, sum(place) % 2)
        path = sys.argv[1] + "/board.png"
        cv2.imwrite(path, image)
        said = subprocess.run(["mrgingham", *options, path], capture_output=True, text=True, check=True).stdout
        found = np.array([line.split()[1:3] for line in said.splitlines() if not line.startswith("#")], float)
        assert np.linalg.norm(found - truth, axis=1).max() < 2, "in another order"
        off.append(found - truth)
    mean, scatter = np.mean(off, (0, 1)), np.std(off)
    print(f"mrgingham 1.22 {' '.join(options)}: {np.round(mean, 3)} px from the true corners, scatter {scatter:.3f} px")
    assert np.allclose(mean, 0, atol=0.02) and least <= scatter < most, "not as stated"
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check opencv-python-headless==5.0.0.93 numpy==2.2.6
"$folder/tools/bin/python" "$folder/asked.py" "$folder"
echo "as stated"
