#!/usr/bin/env bash
# What "grey" is, of all pairs of red and green with five blues, in a PNG. By Rec. 601 (.299, .587, .114) and rounded: cv2.cvtColor, Pillow's convert("L"), imageio's mode="L",
# kornia-rs. By Rec. 601 and cut: cv2.imread(..., IMREAD_GRAYSCALE) of a PNG, on the mean half a grey value below cv2.cvtColor of the same file read in colour.
# By Rec. 709 (.2126, .7152, .0722): COLMAP, whose features and refined points see up to 33 other grey values, and scikit-image, whose weights are .2125, .7154, .0721.
# Of a JPEG cv2's IMREAD_GRAYSCALE takes the file's own luminance, which is not that of its decoded colours: up to 3 grey values, .07 RMS, on a smooth picture.
# Seen: opencv-python-headless 4.14.0.94 and 5.0.0.93, pillow 13.0.0, imageio 2.38.2, scikit-image 0.26.0, kornia-rs 0.2.0, pycolmap 3.13.0 and 4.0.2 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/picture.py" <<'PYTHON'
import sys

import numpy as np
from PIL import Image

axes = np.meshgrid(np.arange(256), np.arange(256), [0, 1, 30, 128, 255], indexing="ij")
colours = np.stack(axes, -1).astype(np.uint8).reshape(256, -1, 3)
Image.fromarray(colours).save(sys.argv[1])
smooth = Image.fromarray(np.random.default_rng(0).integers(0, 255, (32, 32, 3), dtype=np.uint8)).resize((256, 256), Image.BICUBIC)
smooth.save(sys.argv[2], quality=95)
PYTHON
cat > "$folder/grey.py" <<'PYTHON'
import sys

import numpy as np
from PIL import Image

colours = np.array(Image.open(sys.argv[1]))
WEIGHTS = {"601": [0.299, 0.587, 0.114], "709": [0.2126, 0.7152, 0.0722], "skimage": [0.2125, 0.7154, 0.0721]}


def held(name, grey, weights, cut=False):
    exact = colours @ np.array(WEIGHTS[weights])
    off = np.asarray(grey, float).reshape(exact.shape) - exact
    print(f"{name}: less Rec. {weights}: mean {off.mean():+.3f}, at most {abs(off).max():.2f} grey values")
    assert abs(off).max() < (1.02 if cut else 0.51) and abs(off.mean() + 0.5 * cut) < 0.01, "not as stated"


if sys.argv[3] == "colmap":
    import pycolmap

    held("pycolmap " + pycolmap.__version__, pycolmap.Bitmap.read(sys.argv[1], False).to_array(), "709")
    sys.exit()

import cv2
import imageio.v3
import kornia_rs
import skimage.color

held("cv2.cvtColor " + cv2.__version__, cv2.cvtColor(colours, cv2.COLOR_RGB2GRAY), "601")
held("cv2.imread of PNG", cv2.imread(sys.argv[1], cv2.IMREAD_GRAYSCALE), "601", cut=True)
held("Pillow", Image.open(sys.argv[1]).convert("L"), "601")
held("imageio", imageio.v3.imread(sys.argv[1], mode="L"), "601")
held("kornia-rs", kornia_rs.gray_from_rgb(colours), "601")
held("scikit-image", skimage.color.rgb2gray(colours) * 255, "skimage")
luminance = cv2.imread(sys.argv[2], cv2.IMREAD_GRAYSCALE)
off = cv2.cvtColor(cv2.imread(sys.argv[2]), cv2.COLOR_BGR2GRAY).astype(float) - luminance
print(f"cv2 {cv2.__version__}: grey of a JPEG's colours less IMREAD_GRAYSCALE: at most {abs(off).max():.0f}, {off.std():.2f} RMS")
assert 2 <= abs(off).max() <= 4 and 0.04 < off.std() < 0.2, "not as stated"
PYTHON
for packages in "opencv-python-headless==4.14.0.94 imageio==2.38.2 scikit-image==0.26.0 kornia-rs==0.2.0" \
    "opencv-python-headless==5.0.0.93 imageio==2.38.2 scikit-image==0.26.0 kornia-rs==0.2.0" pycolmap==3.13.0 pycolmap==4.0.2; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check $packages pillow==13.0.0 numpy==2.2.6
    "$folder/tools/bin/python" "$folder/picture.py" "$folder/all.png" "$folder/smooth.jpg"
    "$folder/tools/bin/python" "$folder/grey.py" "$folder/all.png" "$folder/smooth.jpg" "$(case $packages in pycolmap*) echo colmap ;; *) echo others ;; esac)"
done
echo "as stated"
