#!/usr/bin/env bash
# Which corner of a chessboard is first, in the picture turned by 0, 90, 180 and 270 degrees. findChessboardCorners and findChessboardCornersSB return the same corners in
# opposite order where the board says which end is which (one side odd, the other even): the first begins at the end with the black corner square, the second at the other,
# so that the poses of one tool are those of the other turned by 180 degrees. Boards whose sides are both odd say it not: the first begins at the top or left, the second at
# the bottom or right. calib-targets numbers from the top left of the picture whatever the board's turn. All have the origin in the centre of the first pixel.
# chess-corners and libcbdetect's find_corners have corners alone, in no order of the board; their origin is the centre of the first pixel as well.
# Seen: opencv-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, calib-targets 0.15.5, chess-corners 1.6.0, libcbdetect 1.0.5 (Linux, CPython 3.11).
# Corners less true ones over 40 boards in all places of the pixel, px, mean of x and y: SB +.00, cornerSubPix .00, calib-targets .00, chess-corners .00, libcbdetect .00.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/chess.py" <<'PYTHON'
import sys

import cv2
import numpy as np

FINER, SIDE = 8, 32


def board(columns, rows, x=50.0, y=45.0):
    """With the black corner square at the top left, and its inner corners, row by row from there."""
    size = SIDE * (columns + 1) + 100, SIDE * (rows + 1) + 90
    fine = np.full((size[1] * FINER, size[0] * FINER), 255, np.float32)
    for row, column in np.ndindex(rows + 1, columns + 1):
        if (row + column) % 2 == 0:
            low = round((y + row * SIDE) * FINER), round((x + column * SIDE) * FINER)
            fine[low[0]:low[0] + SIDE * FINER, low[1]:low[1] + SIDE * FINER] = 0
    pixels = fine.reshape(size[1], FINER, size[0], FINER).mean((1, 3))
    corners = np.array([[x + (i + 1) * SIDE, y + (j + 1) * SIDE] for j in range(rows) for i in range(columns)]) - 0.5
    return np.round(30 + 0.7 * cv2.GaussianBlur(pixels, (0, 0), 0.8)).astype(np.uint8), corners


def classic(image, size):
    found = cv2.findChessboardCorners(image, size)[1]
    return cv2.cornerSubPix(image, found, (5, 5), (-1, -1), (3, 40, 1e-4)).reshape(-1, 2)


def sector(image, size):
    return cv2.findChessboardCornersSB(image, size)[1].reshape(-1, 2)


def starts(detect, columns, rows):
    """Where the first corner is in the picture, and where the end with the black square that was at the top left is, for each turn."""
    image, corners = board(columns, rows)
    seen, size, black = [], np.array(image.shape[::-1]), corners[0]
    for turn in range(4):
        turned = np.ascontiguousarray(np.rot90(image, turn))
        name = lambda at: ("B" if at[1] > turned.shape[0] / 2 else "T") + ("R" if at[0] > turned.shape[1] / 2 else "L")
        seen.append(name(detect(turned, (columns, rows))[0]) + "/" + name(black))
        black, size = np.array([black[1], size[0] - 1 - black[0]]), size[::-1]
    return " ".join(seen)


def centred(name, detect):
    off = []
    for place in np.ndindex(5, 8):
        image, truth = board(7, 5, 50 + place[0] / 5, 45 + place[1] / 8)
        found = np.asarray(detect(image, (7, 5)), float)
        near = np.linalg.norm(found[:, None] - truth, axis=2)
        off.append((found - truth[near.argmin(1)])[near.min(1) < 2].mean(0))
    print(f"{name}: {np.mean(off, 0)[0]:+.3f} {np.mean(off, 0)[1]:+.3f} px from the true corners")
    assert np.allclose(np.mean(off, 0), 0, atol=0.04), "not as stated"


for name, detect, unlike, alike in (
    ("classic", classic, "TL/TL BL/BL BR/BR TR/TR", "TL/TL BL/BL TL/BR BL/TR"),
    ("SB", sector, "BR/TL TR/BL TL/BR BL/TR", "BR/TL TR/BL BR/BR TR/TR"),
):
    for size, expected in (((8, 5), unlike), ((7, 5), alike)):
        seen = starts(detect, *size)
        print(f"{cv2.__version__}: {name}, {size}: first corner / black end: {seen}")
        assert seen == expected, f"expected {expected}"
    centred(f"{cv2.__version__}: {name}", detect)
if sys.argv[1] == "others":
    import calib_targets
    import chess_corners
    import libCBDetect

    def targets(image, _):
        return np.array([corner.position for corner in calib_targets.detect_chessboard(image).corners])

    def growing(image, _):
        finder = libCBDetect.Checkerboard()
        finder.show_processing = False
        finder.array_to_image(image.astype(float), *image.shape)
        finder.find_corners()
        u, v = np.zeros(finder.number_of_corners), np.zeros(finder.number_of_corners)
        finder.get_corners(u, v)
        return np.stack([u, v], 1)

    seen = starts(targets, 8, 5)
    print("calib-targets:", seen)
    assert seen == "TL/TL TL/BL TL/BR TL/TR"
    for name, detect in (("calib-targets", targets), ("chess-corners", lambda image, _: chess_corners.Detector().detect(image).xy), ("libcbdetect", growing)):
        centred(name, detect)
PYTHON
for packages in "4.6.0 opencv-python-headless==4.6.0.66 numpy==1.26.4" "4.14.0 opencv-python-headless==4.14.0.94 numpy==2.2.6" \
    "others opencv-python-headless==5.0.0.93 numpy==2.2.6 calib-targets==0.15.5 chess-corners==1.6.0 libcbdetect==1.0.5"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check ${packages#* }
    "$folder/tools/bin/python" "$folder/chess.py" "${packages%% *}"
done
echo "as stated"
