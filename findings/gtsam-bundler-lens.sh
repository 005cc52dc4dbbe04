#!/usr/bin/env bash
# gtsam 4.3.0's Cal3Bundler has no distortion from Python: uncalibrate and calibrate are those of a pinhole, whatever k1 and k2 are (the camera says them when asked). PinholeCamera with the
# same Cal3Bundler has it in project: one package pictures one point at two places, and residuals made with calibrate are wrong by all of the distortion. 4.2.2 has it in both.
# Cal3DS2, Cal3Fisheye and Cal3Unified are right in both versions.
# Seen: gtsam 4.2.2 and 4.3.0 (Linux, CPython 3.11), f 500 px, k1 -.3, k2 .1, a ray (.5, 0, 1):
#   4.2.2: uncalibrate 872.81, project 872.81; 4.3.0: uncalibrate 890.00, project 872.81; calibrate of 872.81: .5 and .465625
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
from importlib.metadata import version

import gtsam
import numpy as np

release = version("gtsam")
lens = gtsam.Cal3Bundler(500.0, -0.3, 0.1, 640.0, 480.0)
assert (lens.k1(), lens.k2()) == (-0.3, 0.1)
formula = 640 + 500 * 0.5 * (1 - 0.3 * 0.25 + 0.1 * 0.0625)
alone = lens.uncalibrate(np.array([0.5, 0.0]))[0]
back = lens.calibrate(np.array([formula, 480.0]))[0]
camera = gtsam.PinholeCameraCal3Bundler(gtsam.Pose3(), lens).project(np.array([0.5, 0.0, 1.0]))[0]
print(f"gtsam {release}: Cal3Bundler.uncalibrate {alone:.4f}, PinholeCamera.project {camera:.4f}, the formula {formula:.4f}; calibrate {back:.6f}")
without = release == "4.3.0"
assert np.isclose(camera, formula, atol=1e-6), "not as stated"
assert np.isclose(alone, 890 if without else formula, atol=1e-6), "not as stated"
assert np.isclose(back, 0.465625 if without else 0.5, atol=1e-6), "not as stated"
other = gtsam.Cal3DS2(500.0, 500.0, 0.0, 640.0, 480.0, -0.3, 0.1, 0.0, 0.0)
assert np.isclose(other.uncalibrate(np.array([0.5, 0.0]))[0], formula, atol=1e-6), "not as stated"
PYTHON
for packages in "gtsam==4.2.2 numpy==1.26.4" "gtsam==4.3.0 numpy==2.2.6"; do
    rm -rf "$folder/tools"
    python3 -m venv "$folder/tools"
    # shellcheck disable=SC2086
    "$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check $packages
    "$folder/tools/bin/python" "$folder/asked.py"
done
echo "as stated"
