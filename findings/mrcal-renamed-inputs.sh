#!/usr/bin/env bash
# mrcal 2.5 calls the poses of the board rt_ref_frame and those of the cameras rt_cam_ref in what cameramodel.optimization_inputs() returns. The names of 2.2 to 2.4 are there
# as well, with a sentence (a str) in place of the numbers: a program that asks whether the old name is there, or takes it with get(), has no KeyError and a text. In the
# file itself the old names stand with the numbers, and no new ones, so that older versions read it. A whole `pip install mrcal` of this version ends without a wheel of
# pyfltk, which draws windows alone, and whose sources do not build with the setuptools of today; what reads, calibrates and projects runs without it.
# Seen: mrcal 2.5.2.post1, with Python 3.12, of which alone there is a wheel.
set -euo pipefail
for python in python3.12 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.12.*/bin/python3.12; do "$python" -c "" 2>/dev/null && break; done
"$python" -c "" 2>/dev/null || { echo "wants Python 3.12, of which alone there is a wheel of mrcal 2.5.2" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/env"
"$folder/env/bin/python" -m pip install --quiet --no-deps mrcal==2.5.2.post1 numpy==2.2.6 numpysane==0.45 packaging==26.4 gnuplotlib==0.47 scipy==1.17.1 shapely==2.2.0 \
    opencv-python-headless==4.14.0.94 pyyaml==6.0.4
cd "$folder"
"$folder/env/bin/python" - <<'PYTHON'
import base64
import importlib.metadata
import io
import re

import mrcal
import numpy as np

lens = ("LENSMODEL_PINHOLE", np.array([900.0, 900.0, 639.5, 479.5]))
pose = np.array([[0.1, 0.2, 0.0, -0.1, 0.0, 1.0]])
model = mrcal.cameramodel(
    icam_intrinsics=0,
    optimization_inputs={
        "lensmodel": lens[0], "intrinsics": lens[1][None], "imagersizes": np.array([[1280, 960]], dtype=np.int32), "rt_ref_frame": pose,
        "rt_cam_ref": np.zeros((0, 6)), "observations_board": np.ones((1, 6, 9, 3)), "calibration_object_spacing": 0.025,
        "indices_frame_camintrinsics_camextrinsics": np.array([[0, 0, -1]], dtype=np.int32),
    },
)
model.write("camera.cameramodel")
inputs = mrcal.cameramodel("camera.cameramodel").optimization_inputs()
print(f"mrcal {importlib.metadata.version('mrcal')}: rt_ref_frame is {type(inputs['rt_ref_frame']).__name__}, frames_rt_toref is {type(inputs['frames_rt_toref']).__name__}:")
print(f"  {inputs['frames_rt_toref']}")
assert np.array_equal(inputs["rt_ref_frame"], pose)
for old in ("frames_rt_toref", "extrinsics_rt_fromref"):
    assert isinstance(inputs[old], str) and inputs[old].startswith("ERROR: mrcal 2.5 renamed"), old

# What stands in the file: an npz in base 85.
text = re.search(r"optimization_inputs['\"]?\s*[:=]\s*b?['\"]([^'\"]+)", open("camera.cameramodel").read()).group(1)
stored = np.load(io.BytesIO(base64.b85decode(text)))
print(f"  in the file: {', '.join(sorted(name for name in stored if 'rt_' in name))}")
assert np.array_equal(stored["frames_rt_toref"], pose) and "rt_ref_frame" not in stored
PYTHON
echo "as stated"
