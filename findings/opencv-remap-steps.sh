#!/usr/bin/env bash
# cv2.remap moves in steps of 1/32 px in OpenCV 4: of 1000 places between two pixels 33 are told apart, and a linear ramp is up to 1/64 px off. In 5 linear is exact in
# floats. Cubic and Lanczos do not reproduce a ramp in either: cubic is up to .063 px off in 4 and .048 px in 5; Lanczos up to .030 px, in steps of 1/32 px in 5 as well.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), a ramp of 32 bit floats.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import cv2
import numpy as np

five = cv2.__version__.startswith("5")
ramp = np.tile(np.arange(64, dtype=np.float32), (16, 1))
x = (20 + np.arange(1000, dtype=np.float32) / 1000)[None]
y = np.full_like(x, 8)
for name, kernel, off, places in (
    ("linear", cv2.INTER_LINEAR, 0.0 if five else 1 / 64, 1000 if five else 33),
    ("cubic", cv2.INTER_CUBIC, 0.048 if five else 0.063, 1000 if five else 33),
    ("Lanczos", cv2.INTER_LANCZOS4, 0.030, 33),
):
    seen = cv2.remap(ramp, x, y, kernel)
    steps = len(np.unique(seen))
    print(f"{cv2.__version__}: {name}: up to {abs(seen - x).max():.4f} px off, {steps} places of 1000")
    assert abs(abs(seen - x).max() - off) < 0.001 and (steps > 500 if places == 1000 else abs(steps - places) < 3), "not as stated"
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
