#!/usr/bin/env bash
# Columns and rows of a picture of 60 x 40 px whose EXIF says that it is to be turned (orientation 6), as JPEG, PNG and TIFF: a camera calibrated from the pixels of the one
# reader is not that of the other's. cv2.imread turns JPEG and PNG, in grey as well, but with IMREAD_UNCHANGED, as people read 16 bits, it does not. Pillow, scikit-image,
# imageio and kornia-rs do not turn; imageio's plugin of OpenCV does; Pillow turns a TIFF in reading, and it alone. COLMAP does not turn.
# TIFF: OpenCV 4.6 does as with JPEG, but turns it with IMREAD_UNCHANGED as well; 4.14 and 5.0 cannot read it at all (None, "original_ptr == real_mat.data"), at any flag.
# Seen: opencv-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, pillow 13.0.0, scikit-image 0.26.0, imageio 2.38.2, kornia-rs 0.2.0, pycolmap 3.13.0 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/turned.py" <<'PYTHON'
import sys

import numpy as np
from PIL import Image

which, folder = sys.argv[1:]
stored = Image.fromarray(np.zeros((40, 60, 3), np.uint8))
exif = stored.getexif()
exif[274] = 6
for ending in ("jpg", "png", "tif"):
    stored.save(f"{folder}/picture.{ending}", exif=exif)


def held(name, read, expected):
    seen = []
    for ending in ("jpg", "png", "tif"):
        array = read(f"{folder}/picture.{ending}")
        seen.append("none" if array is None else {(40, 60): "stored", (60, 40): "turned"}[array.shape[:2]])
    print(f"{name}: JPEG {seen[0]}, PNG {seen[1]}, TIFF {seen[2]}")
    assert seen == expected.split(), f"expected {expected}"


if which == "colmap":
    import pycolmap

    held("COLMAP " + pycolmap.__version__, lambda path: pycolmap.Bitmap.read(path, True).to_array(), "stored stored stored")
    sys.exit()

import cv2

tiff = "turned" if cv2.__version__ == "4.6.0" else "none"
for name, flags, expected in (
    ("IMREAD_COLOR", cv2.IMREAD_COLOR, "turned turned " + tiff),
    ("IMREAD_GRAYSCALE", cv2.IMREAD_GRAYSCALE, "turned turned " + tiff),
    ("IMREAD_UNCHANGED", cv2.IMREAD_UNCHANGED, "stored stored " + tiff),
):
    held(f"OpenCV {cv2.__version__}, {name}", lambda path: cv2.imread(path, flags), expected)
if which == "others":
    import imageio.v3
    import kornia_rs
    import skimage.io

    held("Pillow", lambda path: np.asarray(Image.open(path)), "stored stored turned")
    held("scikit-image", skimage.io.imread, "stored stored stored")
    held("imageio", imageio.v3.imread, "stored stored stored")
    held("kornia-rs", lambda path: np.asarray(kornia_rs.io.read_image(path)), "stored stored stored")
PYTHON
for packages in "4.6.0 opencv-python-headless==4.6.0.66 numpy==1.26.4" "4.14.0 opencv-python-headless==4.14.0.94 numpy==2.2.6" \
    "others opencv-python-headless==5.0.0.93 scikit-image==0.26.0 imageio==2.38.2 kornia-rs==0.2.0 numpy==2.2.6" "colmap pycolmap==3.13.0 numpy==2.2.6"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check ${packages#* } pillow==13.0.0
    "$folder/tools/bin/python" "$folder/turned.py" "${packages%% *}" "$folder" 2> "$folder/said" || { tail -1 "$folder/said"; exit 1; }
done
echo "as stated"
