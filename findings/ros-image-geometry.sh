#!/usr/bin/env bash
# ROS's image_geometry reads no distortion_model: PinholeCameraModel takes the four numbers of an equidistant lens (OpenCV's fisheye) for k1, k2, p1, p2 of plumb_bob, with no
# word. With D = (.05, -.01, .003, -.001) and a focal length of 500 px rectifyPoint is 25 px off at 260 px from the middle and 755 px towards the corner. project3dToPixel takes
# P alone: pixels of the rectified image, without distortion, in either model.
# Seen: python3-image-geometry 1.16.2+ds-1 of Debian 12, which this script asks for.
set -euo pipefail
case $(dpkg-query -W -f='${Version}' python3-image-geometry 2>/dev/null) in
1.16.2*) ;;
*) echo "wants Debian 12's python3-image-geometry 1.16.2: apt-get install python3-image-geometry" >&2; exit 2 ;;
esac
/usr/bin/python3 - <<'PYTHON'
from types import SimpleNamespace

import cv2
import numpy as np
from image_geometry import PinholeCameraModel

matrix, lens = np.array([[500.0, 0, 640], [0, 500, 480], [0, 0, 1]]), np.array([0.05, -0.01, 0.003, -0.001])
for model, far in (("plumb_bob", (0, 0)), ("equidistant", (25, 755))):
    message = SimpleNamespace(width=1280, height=960, distortion_model=model, D=list(lens), K=list(matrix.ravel()), R=list(np.eye(3).ravel()))
    message.P = list(np.hstack([matrix, np.zeros((3, 1))]).ravel())
    message.roi = SimpleNamespace(x_offset=0, y_offset=0, width=0, height=0)
    message.binning_x = message.binning_y = 1
    message.header = SimpleNamespace(frame_id="camera", stamp=0)
    camera = PinholeCameraModel()
    camera.fromCameraInfo(message)
    for pixel, stated in zip(((900.0, 480.0), (1200.0, 800.0)), far):
        undistort = cv2.undistortPoints if model == "plumb_bob" else cv2.fisheye.undistortPoints
        true = undistort(np.array([[pixel]]), matrix, lens, P=matrix).ravel()
        off = np.linalg.norm(np.ravel(camera.rectifyPoint(pixel)) - true)
        print(f"image_geometry 1.16.2: {model}: rectifyPoint{pixel} is {off:.0f} px off")
        assert abs(off - stated) < 1, f"expected {stated}"
    assert np.allclose(camera.project3dToPixel((0.5, 0, 1)), (890, 480)), "not as stated"
PYTHON
echo "as stated"
