#!/usr/bin/env bash
# pycolmap's covariances of poses: the standard deviations of rotations are half of those in radians (its parameters are the imaginary part of a quaternion, turned on the
# left), those of translations are whole: the block of a pose times 4, times 2 across, is the covariance of radians. Neither is scaled: they are those of 1 px for each coordinate,
# whatever the residuals are. Reprojection errors are the mean over the points of lengths in px, no RMS: of residuals that are 0 and .5 px in turn, .25 and not .354.
# A new camera has its principal point at half of the width, which is the middle of the frame with the origin in the outer corner of the first pixel.
# Seen: pycolmap 3.13.0 and 4.2.1 (Linux, CPython 3.11): ratio to the inverse of the normal equations .5 .5 .5 1 1 1.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/sigmas.py" <<'PYTHON'
import numpy as np
import pycolmap
from scipy.spatial.transform import Rotation

pycolmap.set_random_seed(0)
options = pycolmap.SyntheticDatasetOptions()
options.num_points3D, options.num_rigs, options.num_cameras_per_rig, options.num_frames_per_rig = 60, 1, 1, 4
options.camera_model_id, options.camera_params = pycolmap.CameraModelId.PINHOLE, [1000.0, 1000.0, 512.0, 384.0]
options.camera_width, options.camera_height = 1024, 768
model = pycolmap.synthesize_dataset(options)

config = pycolmap.BundleAdjustmentConfig()
for image in model.images:
    config.add_image(image)
for point in model.points3D:
    config.add_constant_point(point)
for camera in model.cameras:
    config.set_constant_cam_intrinsics(camera)
make = getattr(pycolmap, "create_default_ceres_bundle_adjuster", None) or pycolmap.create_default_bundle_adjuster
adjuster = make(pycolmap.BundleAdjustmentOptions(), config, model)
adjuster.solve()
wanted = pycolmap.BACovarianceOptions()
wanted.params = pycolmap.BACovarianceOptionsParams.POSES
covariances = pycolmap.estimate_ba_covariance(wanted, model, adjuster)

name = sorted(model.images)[1]
image = model.images[name]
pose = image.cam_from_world()
turn, shift = pose.rotation.matrix(), pose.translation
points = np.array([model.points3D[point.point3D_id].xyz for point in image.points2D if point.has_point3D()])


def pictured(change):
    """With the pose turned by the first three, radians, on the left, and moved by the others."""
    ahead = points @ (Rotation.from_rotvec(change[:3]).as_matrix() @ turn).T + shift + change[3:]
    return (1000 * ahead[:, :2] / ahead[:, 2:]).ravel()


steps = 1e-6 * np.eye(6)
design = np.stack([(pictured(step) - pictured(-step)) / 2e-6 for step in steps], 1)
own = np.linalg.inv(design.T @ design)
found = covariances.get_cam_cov_from_world(name)
ratio = np.sqrt(found.diagonal() / own.diagonal())
print(f"pycolmap {pycolmap.__version__}: sigmas of rotation and translation, by those of the normal equations: {np.round(ratio, 4)}")
scale = np.array([0.5, 0.5, 0.5, 1, 1, 1])
assert np.allclose(found, own * np.outer(scale, scale), rtol=1e-3, atol=1e-3 * abs(own).min()), "not as stated"

for image in model.images.values():
    for index, point in enumerate(image.points2D):
        point.xy = point.xy + np.array([0.3, 0.4]) * (index % 2)
odd = np.mean([index % 2 for image in model.images.values() for index, point in enumerate(image.points2D) if point.has_point3D()])
model.update_point_3d_errors()
error = model.compute_mean_reprojection_error()
print(f"pycolmap {pycolmap.__version__}: error {error:.4f} px; mean of lengths {0.5 * odd:.4f}, RMS {0.5 * odd**0.5:.4f}")
assert np.isclose(error, 0.5 * odd, atol=0.01), "not as stated"
make = getattr(pycolmap.Camera, "create_from_model_id", None) or pycolmap.Camera.create
camera = make(1, pycolmap.CameraModelId.PINHOLE, 1000.0, 1281, 961)
print(f"pycolmap {pycolmap.__version__}: a new camera of 1281 x 961 px: {camera.params}")
assert np.allclose(camera.params[2:], [640.5, 480.5]), "not as stated"
PYTHON
for version in 3.13.0 4.2.1; do
    python3 -m venv "$folder/$version"
    "$folder/$version/bin/pip" install --quiet --no-compile --disable-pip-version-check pycolmap==$version numpy==2.2.6 scipy==1.17.1
    "$folder/$version/bin/python" "$folder/sigmas.py"
done
echo "as stated"
