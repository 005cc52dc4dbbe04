#!/usr/bin/env bash
# Seven packages that find AprilTags, on the same upright tag of family 36h11 as the AprilTag project draws it (moms-apriltag's picture), in 16 places of the pixel: which
# corner is first, which way round, and where the origin of the pixel is. All put the origin at the outer corner of the first pixel: their corners are 0.5 px right of and below
# those of cornerSubPix. The order is that of the tag, not of the picture: a tag on its head has its first corner where its foot was.
# Seen: Linux, CPython 3.11, full resolution: first corner of the upright tag, the order on the picture, mean x and y of what is found less the pixel's centre, px:
#   pupil-apriltags 1.0.4.post11, dt-apriltags 3.1.7   bottom left, anticlockwise, .46 .47   scatter .13 px on pictures without noise
#   robotpy-apriltag 2026.2.2                          bottom left, anticlockwise, .46 .48   .14 px
#   pyapriltags 3.4.3.1, apriltag-python 3.4.5         bottom left, anticlockwise, .50 .50   .03 px
#   kornia-rs 0.2.0                                    top right, clockwise, .49 .55         .16 px
#   locus-tag 0.10.0                                   bottom right, clockwise, .50 .50      .01 px: top left of tags as OpenCV draws them (opencv-apriltag-on-its-head.sh)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/order.py" <<'PYTHON'
import sys

import apriltag
import cv2
import dt_apriltags
import kornia_rs
import locus
import numpy as np
import pupil_apriltags
import pyapriltags
import robotpy_apriltag
from moms_apriltag.generator2 import TagGenerator2

SIDE, FINER = 160, 8
CORNERS = ["top left", "top right", "bottom right", "bottom left"]
FAMILY = "tag36h11"
code = TagGenerator2(FAMILY).generate(7).astype(np.uint8)


def picture(x, y):
    """An upright tag whose outer edge begins at x, y from the corner of the frame, and its corners with the origin in the centre of the first pixel."""
    fine = np.full((280 * FINER, 300 * FINER), 255, np.float32)
    left, top, side = round(x * FINER), round(y * FINER), SIDE * FINER
    fine[top:top + side, left:left + side] = cv2.resize(code, (side, side), interpolation=cv2.INTER_NEAREST)
    pixels = fine.reshape(280, FINER, 300, FINER).mean((1, 3))
    corners = np.array([[x, y], [x + SIDE, y], [x + SIDE, y + SIDE], [x, y + SIDE]]) - 0.5
    return np.round(30 + 0.7 * cv2.GaussianBlur(pixels, (0, 0), 0.7)).astype(np.uint8), corners


def as_c(module):
    detector = module.Detector(families=FAMILY, quad_decimate=1.0)
    return lambda image: detector.detect(image)[0].corners


def robotpy(image):
    detector = robotpy_apriltag.AprilTagDetector()
    config = detector.getConfig()
    config.quadDecimate = 1.0
    detector.setConfig(config)
    detector.addFamily(FAMILY)
    found = detector.detect(image)[0]
    return [(found.getCorner(i).x, found.getCorner(i).y) for i in range(4)]


def kornia(image):
    tags = kornia_rs.apriltag
    config = tags.DecodeTagsConfig([kind for kind in tags.TagFamilyKind.all() if kind.name == "tag36_h11"])
    config.downscale_factor = 1
    size = kornia_rs.image.ImageSize(image.shape[1], image.shape[0])
    return tags.AprilTagDecoder(config, size).decode(image[..., None])[0].quad.corners


PEERS = [
    ("pupil-apriltags", as_c(pupil_apriltags), "bottom left", -1, 0.13),
    ("dt-apriltags", as_c(dt_apriltags), "bottom left", -1, 0.13),
    ("pyapriltags", as_c(pyapriltags), "bottom left", -1, 0.03),
    ("apriltag-python", lambda image: apriltag.apriltag(FAMILY, decimate=1.0).detect(image)[0]["lb-rb-rt-lt"], "bottom left", -1, 0.03),
    ("robotpy-apriltag", robotpy, "bottom left", -1, 0.14),
    ("kornia-rs", kornia, "top right", 1, 0.16),
    ("locus-tag", lambda image: locus.Detector(families=[locus.TagFamily.AprilTag36h11]).detect(image).corners[0], "bottom right", 1, 0.01),
]
failed = False
for name, detect, first, turn, scatter in PEERS:
    off, orders = [], set()
    for place in np.ndindex(4, 4):
        image, truth = picture(60 + place[0] / 4, 67 + place[1] / 4)
        found = np.asarray(detect(image), float).reshape(4, 2)
        order = np.linalg.norm(found[:, None] - truth, axis=2).argmin(1)
        orders.add((CORNERS[order[0]], {1: 1, 3: -1}[(order[1] - order[0]) % 4]))
        off.append(found - truth[order])
    mean, spread = np.mean(off, (0, 1)), np.std(off - np.mean(off, (0, 1)))
    print(f"{name}: {orders}, {mean[0]:+.2f} {mean[1]:+.2f} px from the pixel's centre, scatter {spread:.2f} px")
    good = orders == {(first, turn)} and np.allclose(mean, 0.5, atol=0.06) and abs(spread - scatter) < 0.03
    failed |= not good
sys.exit("not as stated" if failed else 0)
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check pupil-apriltags==1.0.4.post11 dt-apriltags==3.1.7 pyapriltags==3.4.3.1 apriltag-python==3.4.5 \
    robotpy-apriltag==2026.2.2 kornia-rs==0.2.0 locus-tag==0.10.0 moms-apriltag==2023.1.15 opencv-python==5.0.0.93 numpy==2.2.6
"$folder/tools/bin/python" "$folder/order.py"
echo "as stated"
