#!/usr/bin/env bash
# ChArUco boards with an even number of rows of squares, drawn before OpenCV 4.6, have a marker where those drawn since have a black square at the top left. 4.14 and 5 find
# none of the corners of such a sheet and say nothing, until setLegacyPattern(True); then none of a new sheet. With an odd number of rows the sheets are the same.
# Corner 0 is at the bottom left of the sheet in 4.5.5, with y up; since 4.6 at the top left, with y down: ids of old measurements mean other corners, of odd boards too.
# Seen: sheets of opencv-contrib-python-headless 4.5.5.64 and 4.6.0.66, asked for by 4.14.0.94 and 5.0.0.93 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import pathlib

import cv2
import numpy as np

aruco, folder = cv2.aruco, pathlib.Path(__file__).parent
codes = aruco.getPredefinedDictionary(aruco.DICT_4X4_50)
for size in ((5, 7), (6, 8), (5, 8)):
    if not hasattr(aruco, "CharucoDetector"):
        board = aruco.CharucoBoard_create(*size, 40, 30, codes)
        sheet = board.draw((size[0] * 40, size[1] * 40))
        sheet = cv2.copyMakeBorder(sheet, 40, 40, 40, 40, 0, value=255)
        cv2.imwrite(str(folder / f"{cv2.__version__}-{size[0]}x{size[1]}.png"), sheet)
        assert (sheet[42:78, 42:78].max() == 0) == (cv2.__version__ != "4.5.5" or size[1] == 7), "not as stated"
        corners, tags, _ = aruco.detectMarkers(sheet, codes)
        _, found, names = aruco.interpolateCornersCharuco(corners, tags, sheet, board)
        at = found[names.ravel() == 0].ravel()
        print(f"{cv2.__version__}: {size[0]} x {size[1]} squares: corner 0 at {at}")
        assert (at[1] > sheet.shape[0] / 2) == (cv2.__version__ == "4.5.5") and at[0] < sheet.shape[1] / 2, "not as stated"
        continue
    for drawn in ("4.5.5", "4.6.0"):
        sheet = cv2.imread(str(folder / f"{drawn}-{size[0]}x{size[1]}.png"), cv2.IMREAD_GRAYSCALE)
        counts = []
        for legacy in (False, True):
            board = aruco.CharucoBoard(size, 40, 30, codes)
            board.setLegacyPattern(legacy)
            found = aruco.CharucoDetector(board).detectBoard(sheet)[0]
            counts.append(0 if found is None else len(found))
            if len(counts) == 1 and counts[0]:
                at = found.reshape(-1, 2)[0]
                assert at[1] < sheet.shape[0] / 2 and at[0] < sheet.shape[1] / 2, "not as stated"
        every = (size[0] - 1) * (size[1] - 1)
        print(f"{cv2.__version__}: {size[0]} x {size[1]} squares drawn by {drawn}: {counts[0]} of {every} corners, with the legacy pattern {counts[1]}")
        odd = size[1] % 2 == 1
        expected = [every if odd or drawn == "4.6.0" else 0, every if odd or drawn == "4.5.5" else 0]
        assert counts == expected, f"expected {expected}"
PYTHON
for packages in "opencv-contrib-python-headless==4.5.5.64 numpy==1.26.4" "opencv-contrib-python-headless==4.6.0.66 numpy==1.26.4" \
    "opencv-contrib-python-headless==4.14.0.94 numpy==2.2.6" "opencv-contrib-python-headless==5.0.0.93 numpy==2.2.6"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check $packages
    "$folder/tools/bin/python" "$folder/asked.py"
done
echo "as stated"
