#!/usr/bin/env bash
# multical 0.4.0 takes the 50 views that cover the frame best (limit_intrinsic, its default) out of NumPy arrays of objects. Where all views have equally many points, NumPy
# makes one array of three dimensions of them, and OpenCV refuses it: "Can't parse 'objectPoints'". A chessboard, and a ChArUco board that is seen whole in every view, so
# have no calibration; with one corner less in one view there is one. With limit_intrinsic off the first round takes such views.
# Seen: multical 0.4.0 beside NumPy 1.23.5 and OpenCV 4.6, with Python 3.11.
set -euo pipefail
for python in python3.11 python3.10 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.1[01].*/bin/python3; do "$python" -c "" 2>/dev/null && break; done
"$python" -c "" 2>/dev/null || { echo "wants Python 3.10 or 3.11, for numba 0.57" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/env"
"$folder/env/bin/python" -m pip install --quiet multical==0.4.0 opencv-contrib-python==4.6.0.66 numpy==1.23.5 scipy==1.10.1 numba==0.57.1 matplotlib==3.7.5 \
    numpy-quaternion==2023.0.3 omegaconf==2.3.0
cd "$folder"
"$folder/env/bin/python" - 2> log <<'PYTHON' || { tail -5 log; exit 1; }
import cv2
import numpy as np
from multical import tables
from multical.board import CharucoBoard
from multical.config.arguments import CameraOpts
from multical.workspace import Workspace
from structs.struct import struct

SIZE = (1280, 960)
board = CharucoBoard((10, 7), 25.0, 18.0, aruco_dict="5X5_1000", min_points=10)
corners = np.array([[25.0 * column, 25.0 * row, 0.0] for row in range(6) for column in range(9)])
lens = np.array([[900.0, 0, 639.5], [0, 900.0, 479.5], [0, 0, 1]])


def focal_length(last, **options):
    """What is found from 12 views, the last of which has so many corners."""
    random = np.random.default_rng(0)
    views = []
    for view in range(12):
        turn = random.normal(0, 0.35, 3)
        shift = np.array([-100.0, -60.0, 400.0]) + random.normal(0, 20.0, 3)
        seen = cv2.projectPoints(corners, turn, shift, lens, None)[0][:, 0] + random.normal(0, 0.1, (54, 2))
        count = last if view == 11 else 54
        views.append(struct(corners=seen[:count].astype(np.float32), ids=np.arange(count)))
    workspace = Workspace("workspace")
    workspace.names = struct(camera=["camera"], image=[f"{view}.png" for view in range(12)], board=["board"])
    workspace.image_size, workspace.boards, workspace.detected_points = [SIZE], [board], [[[view] for view in views]]
    workspace.point_table = tables.make_point_table(workspace.detected_points, [board])
    camera = CameraOpts()
    limit = options.get("limit", camera.limit_intrinsic)
    workspace.calibrate_single(camera.distortion_model, camera.intrinsic_error_limit, max_images=limit)
    return workspace.cameras[0].intrinsic[0, 0]


try:
    focal_length(54)
    raise SystemExit("it takes 12 whole views: no longer as stated")
except cv2.error as error:
    assert "objectPoints" in str(error), error
    print("multical 0.4.0, 12 views of 54 corners each:", str(error).strip().splitlines()[-1].strip("> -"))
for what, found in (("the last of 53", focal_length(53)), ("no limit of views", focal_length(54, limit=None))):
    print(f"{what}: fx {found:.1f} px of 900")
    assert abs(found - 900) < 5
PYTHON
echo "as stated"
