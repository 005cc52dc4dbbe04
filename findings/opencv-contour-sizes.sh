#!/usr/bin/env bash
# Diameters that OpenCV has from contours are a pixel short of a bright disc and a pixel too long of a dark one: cv2.findContours goes through the centres of the region's outermost
# pixels, and for a hole through those of the pixels around it. So are fitEllipse's axes, the area of moments of the contour, and SimpleBlobDetector's size, whose documented meaning is a diameter.
# Moments of the mask itself are right. Centres are not shifted. A plane's eccentricity corrected by such radii, and a scale from them, is wrong by 5 % at 20 px.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94, 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), all alike, discs of 20.6, 41.4 and 80.4 px:
#   bright: fitEllipse -.80 to -.98 px, moments of the contour -.90 to -.93 px, size -.92 to -.96 px; dark: fitEllipse +.82 to +1.07 px, size +.8 to +1.1 px; moments of the mask within .03 px
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

SIDE, PARTS, CENTRE = 128, 16, (63.3, 64.8)
fine = (np.arange(SIDE * PARTS) + 0.5) / PARTS - 0.5


def blob(picture, colour):
    settings = cv2.SimpleBlobDetector_Params()
    settings.filterByConvexity = settings.filterByInertia = False
    settings.blobColor, settings.maxArea = colour, 9000
    return cv2.SimpleBlobDetector_create(settings).detect(picture)[0]


for diameter in (20.6, 41.4, 80.4):
    disc = (fine[None] - CENTRE[0]) ** 2 + (fine[:, None] - CENTRE[1]) ** 2 < diameter**2 / 4
    bright = (disc.reshape(SIDE, PARTS, SIDE, PARTS).mean((1, 3)) * 255).round().astype(np.uint8)
    mask = cv2.threshold(bright, 127, 255, cv2.THRESH_BINARY)[1]
    contour = cv2.findContours(mask, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)[0][0]
    hole = min(cv2.findContours(255 - mask, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)[0], key=cv2.contourArea)
    spots = blob(bright, 255), blob(255 - bright, 0)
    found = {
        "fitEllipse, bright": (np.mean(cv2.fitEllipse(contour)[1]), -0.9),
        "moments of the contour": (2 * np.sqrt(cv2.moments(contour)["m00"] / np.pi), -0.9),
        "size, bright": (spots[0].size, -0.9),
        "fitEllipse, dark": (np.mean(cv2.fitEllipse(hole)[1]), 0.9),
        "size, dark": (spots[1].size, 0.9),
        "moments of the mask": (2 * np.sqrt(cv2.moments(mask, True)["m00"] / np.pi), 0),
    }
    print(f"{cv2.__version__}: {diameter} px:", ", ".join(f"{name} {size - diameter:+.2f}" for name, (size, _) in found.items()), "px")
    for size, off in found.values():
        assert abs(size - diameter - off) < (0.2 if off else 0.04), "not as stated"
    for spot in spots:
        assert np.allclose(spot.pt, CENTRE, atol=0.05), "not as stated"
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
