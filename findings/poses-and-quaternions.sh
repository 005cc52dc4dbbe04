#!/usr/bin/env bash
# Which way a pose goes, and the order of a quaternion, of a camera at (1, 0, 0) and of a turn of 90 degrees about z. camera_from_world: OpenCV's rvec and tvec, COLMAP's
# cam_from_world, PoseLib's CameraPose. OpenCV's stereoCalibrate has camera2_from_camera1: a second camera to the right has T < 0. world_from_camera: gtsam's PinholeCamera.
# Order x y z w: pycolmap's Rotation3d, SciPy, gtsam's coeffs(). Order w x y z: PoseLib, pyquaternion, transforms3d, pytransform3d. All mean the same turn (Hamilton's).
# AprilTag's own poses (pyapriltags, pupil-apriltags, apriltag-python) are camera_from_tag with y down and z into the paper, the identity for an upright tag in front of the
# camera; OpenCV's square (SOLVEPNP_IPPE_SQUARE, aruco) has y up and z out of the paper, turned by 180 degrees about x.
# Seen: opencv-python 5.0.0.93, pycolmap 4.2.1, poselib 2.0.5, gtsam 4.3.0, scipy 1.17.1, pyquaternion 0.9.9, transforms3d 0.4.2, pytransform3d 3.17.0,
# pyapriltags 3.4.3.1, pupil-apriltags 1.0.4.post11, apriltag-python 3.4.5 (Linux, CPython 3.11).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/asked.py" <<'PYTHON'
import apriltag
import cv2
import gtsam
import numpy as np
import poselib
import pupil_apriltags
import pyapriltags
import pycolmap
import pyquaternion
import pytransform3d.rotations
import transforms3d
from moms_apriltag.generator2 import TagGenerator2
from scipy.spatial.transform import Rotation

points = np.random.default_rng(0).uniform(-1, 1, (12, 3)) + [0, 0, 5]
seen = (points - [1.0, 0, 0])[:, :2] / points[:, 2:] * 500 + [640, 480]
matrix, size = np.array([[500.0, 0, 640], [0, 500, 480], [0, 0, 1]]), {"model": "PINHOLE", "width": 1280, "height": 960, "params": [500, 500, 640, 480]}
camera = pycolmap.Camera(**size)
shifts = {
    "OpenCV": cv2.solvePnP(points, seen, matrix, None)[2].ravel(),
    "pycolmap": pycolmap.estimate_and_refine_absolute_pose(seen, points, camera)["cam_from_world"].translation,
    "PoseLib": poselib.estimate_absolute_pose(seen, points, size, {}, {})[0].t,
}
for name, shift in shifts.items():
    print(f"{name}: translation {np.round(shift, 6)} of a camera at (1, 0, 0): camera_from_world")
    assert np.allclose(shift, [-1, 0, 0], atol=1e-6), "not as stated"
at = gtsam.PinholeCameraCal3_S2(gtsam.Pose3(gtsam.Rot3(), np.array([1.0, 0, 0])), gtsam.Cal3_S2(500, 500, 0, 640, 480)).project(np.array([0, 0, 5.0]))
print(f"gtsam: a pose with translation (1, 0, 0) sees (0, 0, 5) at {at}: world_from_camera")
assert np.allclose(at, [540, 480]), "not as stated"

board = np.array([[25.0 * column, 25.0 * row, 0] for row in range(6) for column in range(9)])
pairs = [[], []]
for k in range(4):
    tilt, ahead = np.array([0.3 * (-1) ** k, 0.2 * k - 0.3, 0.1]), np.array([-100.0 + 10 * k, -60, 400])
    for camera, moved in enumerate((np.zeros(3), np.array([-40.0, 0, 0]))):
        pairs[camera].append(cv2.projectPoints(board, tilt, ahead + moved, matrix, None)[0].astype(np.float32))
flat = [board.astype(np.float32)] * 4
stereo = cv2.stereoCalibrate(flat, *pairs, matrix.copy(), np.zeros(5), matrix.copy(), np.zeros(5), (1280, 960), flags=cv2.CALIB_FIX_INTRINSIC)[6]
print(f"OpenCV: stereoCalibrate's T of a second camera 40 to the right: {np.round(stereo.ravel(), 2)}: camera2_from_camera1")
assert np.allclose(stereo.ravel(), [-40, 0, 0], atol=0.1), "not as stated"

turn, half = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), 0.5**0.5
pose = poselib.CameraPose()
pose.R = turn
orders = {
    "pycolmap": (pycolmap.Rotation3d(turn).quat, "xyzw"),
    "SciPy": (Rotation.from_matrix(turn).as_quat(), "xyzw"),
    "gtsam": (gtsam.Rot3(turn).toQuaternion().coeffs(), "xyzw"),
    "PoseLib": (pose.q, "wxyz"),
    "pyquaternion": (pyquaternion.Quaternion(matrix=turn).elements, "wxyz"),
    "transforms3d": (transforms3d.quaternions.mat2quat(turn), "wxyz"),
    "pytransform3d": (pytransform3d.rotations.quaternion_from_matrix(turn), "wxyz"),
}
for name, (quaternion, order) in orders.items():
    print(f"{name}: {np.round(quaternion, 4)}: {order}")
    assert np.allclose(quaternion, [0, 0, half, half] if order == "xyzw" else [half, 0, 0, half]), "not as stated"

image = np.full((280, 300), 220, np.uint8)
code = TagGenerator2("tag36h11").generate(7).astype(np.uint8)
image[60:220, 70:230] = np.minimum(cv2.resize(code, (160, 160), interpolation=cv2.INTER_NEAREST), 220)
intrinsics, side = (500, 500, 150, 140), 0.16
found = {}
for module in (pyapriltags, pupil_apriltags):
    tag = module.Detector(families="tag36h11").detect(image, estimate_tag_pose=True, camera_params=intrinsics, tag_size=side)[0]
    found[module.__name__] = tag.pose_R
detector = apriltag.apriltag("tag36h11")
found["apriltag-python"] = detector.estimate_tag_pose(detector.detect(image)[0], side, *intrinsics)["R"]
for name, rotation in found.items():
    assert np.allclose(rotation, np.eye(3), atol=0.05), "not as stated"
half_side = side / 2 * np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]])
corners = np.array([[70.0, 60], [230, 60], [230, 220], [70, 220]]) - 0.5
matrix = np.array([[500.0, 0, 150], [0, 500, 140], [0, 0, 1]])
rotation = cv2.Rodrigues(cv2.solvePnP(half_side, corners, matrix, None, flags=cv2.SOLVEPNP_IPPE_SQUARE)[1])[0]
print(f"an upright tag: {', '.join(found)}: identity; OpenCV's square: diagonal {np.round(rotation.diagonal(), 2)}")
assert np.allclose(rotation, np.diag([1.0, -1, -1]), atol=0.05), "not as stated"
PYTHON
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check opencv-python==5.0.0.93 pycolmap==4.2.1 poselib==2.0.5 gtsam==4.3.0 scipy==1.17.1 pyquaternion==0.9.9 \
    transforms3d==0.4.2 pytransform3d==3.17.0 pyapriltags==3.4.3.1 pupil-apriltags==1.0.4.post11 apriltag-python==3.4.5 moms-apriltag==2023.1.15 numpy==2.2.6
"$folder/tools/bin/python" "$folder/asked.py"
echo "as stated"
