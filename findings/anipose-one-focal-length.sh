#!/usr/bin/env bash
# aniposelib's bundle_adjust makes another camera of one that was calibrated before: fx and fy become their mean, and k2, k3, p1 and p2 zero, before the first iteration and with no word, since its
# parameters are one focal length and k1 (with extra_dist k2 as well). The principal point is held. Cameras read from a calibration.toml with fx and fy apart, or with p1, p2, do not stay what they were,
# and the residuals do not tell: the object is squeezed instead. bundle_adjust(only_extrinsics=True) leaves the interior alone.
# Seen: aniposelib 0.8.0 (Linux, CPython 3.11), three cameras, fx 900, fy 940, k1 -.1, k2 .02, p1 .001, p2 -.002, exact observations of 80 points, start at the truth:
#   error before 0 px; after: fx = fy = 901.7 px, k2, p1, p2 zero, .014 px (mean length), the object's height by its width 4.4 % off; with only_extrinsics nothing changes
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import contextlib
import io
from importlib.metadata import version

import numpy as np
from aniposelib.cameras import Camera, CameraGroup

LENS = np.array([-0.1, 0.02, 0.001, -0.002, 0])
points = np.random.default_rng(0).uniform(-1, 1, (80, 3)) * [1.5, 1.2, 1]
SHAPE = np.linalg.norm(points[:, 1] - points[:, 1].mean()) / np.linalg.norm(points[:, 0] - points[:, 0].mean())


def group():
    return CameraGroup([
        Camera(matrix=np.array([[900.0, 0, 650], [0, 940, 470], [0, 0, 1]]), dist=LENS.copy(), size=(1280, 960), rvec=np.array([0, turn, 0.0]), tvec=np.array([0, 0, 5.0]), name=name)
        for name, turn in (("a", -0.5), ("b", 0.0), ("c", 0.5))
    ])


for only in (False, True):
    cameras = group()
    seen = np.array([camera.project(points).reshape(-1, 2) for camera in cameras.cameras])
    before = cameras.average_error(seen)
    with contextlib.redirect_stdout(io.StringIO()):
        cameras.bundle_adjust(seen, verbose=False, only_extrinsics=only)
    camera = cameras.cameras[0]
    focal, lens, after = camera.get_camera_matrix().diagonal()[:2], camera.get_distortions(), cameras.average_error(seen)
    there = cameras.triangulate(seen)
    squeezed = np.linalg.norm(there[:, 1] - there[:, 1].mean()) / np.linalg.norm(there[:, 0] - there[:, 0].mean()) / SHAPE - 1
    print(f"aniposelib {version('aniposelib')}: only_extrinsics {only}: error before {before:.2g} px, after {after:.3g} px; fx, fy {np.round(focal, 2)} px, distortion {np.round(lens, 4)}; height by width {100 * squeezed:+.2f} %")
    assert before < 1e-3, "not as stated"
    if only:
        assert after < 1e-3 and abs(squeezed) < 1e-4 and np.allclose(focal, [900, 940]) and np.allclose(lens, LENS), "not as stated"
    else:
        assert after < 0.1 and 0.03 < squeezed < 0.05, "not as stated"
        assert focal[0] == focal[1] and not lens[1:].any() and np.allclose(camera.get_camera_matrix()[:2, 2], [650, 470]), "not as stated"
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check aniposelib==0.8.0 opencv-contrib-python-headless==4.14.0.94 numpy==2.2.6 scipy==1.17.1
"$folder/tools/bin/python" "$folder/asked.py"
echo "as stated"
