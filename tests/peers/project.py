"""Reads a file with a tool's own package and projects points with it.

    python project.py TOOL FILE < points.json > pixels.json

Points are [[x, y, z], ...] in the camera's axes: x right, y down, z forward. Pixels are [[u, v], ...] from the centre of the first pixel.
Exit code 2: the tool refuses the file.
"""

import json
import os
import shutil
import sys
import tempfile

import numpy as np


def colmap(path, points):
    """pycolmap reads a model's folder: cameras.txt or cameras.bin, of several the CAMERA of that id; its origin is the corner of the first pixel."""
    import pycolmap

    ending = path.rsplit(".", 1)[-1]
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(path, os.path.join(folder, f"cameras.{ending}"))
        for name in ("images", "points3D"):
            with open(os.path.join(folder, f"{name}.{ending}"), "wb") as empty:
                empty.write(b"\0" * 8 if ending == "bin" else b"")
        model = pycolmap.Reconstruction()
        (model.read_binary if ending == "bin" else model.read_text)(folder)
    (camera,) = [c for c in model.cameras.values() if str(c.camera_id) == os.environ.get("CAMERA", str(c.camera_id))]
    return camera.img_from_cam(points) - 0.5


def kapture(path, points):
    """kapture reads its own sensors.txt; it has COLMAP's models by name, and no projection of its own: COLMAP's."""
    import kapture
    import kapture.io.csv
    import pycolmap

    sensors = kapture.io.csv.sensors_from_file(path)
    (sensor,) = [s for s in sensors.values() if isinstance(s, kapture.Camera)]
    width, height, *params = sensor.camera_params
    camera = pycolmap.Camera(model=sensor.camera_type.name, width=int(width), height=int(height), params=params)
    return camera.img_from_cam(points) - 0.5


def opencv(path, points):
    """cv2.FileStorage, then the projection of the model that the file says."""
    import cv2

    storage = cv2.FileStorage(path, cv2.FILE_STORAGE_READ)
    matrix, distortion, xi = (storage.getNode(name).mat() for name in ("camera_matrix", "distortion_coefficients", "xi"))
    fisheye = storage.getNode("fisheye_model").real() != 0
    zero, points = np.zeros(3), points.reshape(-1, 1, 3)
    if xi is not None:
        pixels, _ = cv2.omnidir.projectPoints(points, zero, zero, matrix, float(xi[0, 0]), distortion)
    elif fisheye:
        alpha = matrix[0, 1] / matrix[0, 0]
        plain = np.array([[matrix[0, 0], 0, matrix[0, 2]], *matrix[1:]])
        pixels, _ = cv2.fisheye.projectPoints(points, zero, zero, plain, distortion, alpha=alpha)
    else:
        pixels, _ = cv2.projectPoints(points, zero, zero, matrix, distortion)
    return pixels.reshape(-1, 2)


def mrcal(path, points):
    import mrcal

    model = mrcal.cameramodel(path)
    return mrcal.project(points, *model.intrinsics())


def ros(path, points):
    """camera_calibration_parsers reads the YAML; image_geometry has no way to the distorted image, OpenCV's functions are what it calls."""
    import camera_calibration_parsers
    import cv2

    _, info = camera_calibration_parsers.readCalibration(path)
    matrix, distortion = np.array(info.K).reshape(3, 3), np.array(info.D)
    zero, points = np.zeros(3), points.reshape(-1, 1, 3)
    if info.distortion_model == "equidistant":
        pixels, _ = cv2.fisheye.projectPoints(points, zero, zero, matrix, distortion)
    else:
        pixels, _ = cv2.projectPoints(points, zero, zero, matrix, distortion)
    return pixels.reshape(-1, 2)


def theia(path, points):
    """Theia's package has no reader of calibration files: the priors of the file by their names, then its own camera."""
    import pytheia

    with open(path) as text:
        (entry,) = json.load(text)["priors"]
    stated = entry["CameraIntrinsicsPrior"]
    prior = pytheia.sfm.CameraIntrinsicsPrior()
    prior.image_width, prior.image_height = stated["width"], stated["height"]
    prior.camera_intrinsics_model_type = stated["camera_intrinsics_type"]

    def put(name, value):
        part = getattr(prior, name)
        whole = np.array(part.value, dtype=float).ravel()
        whole[: np.size(value)] = value
        part.value = whole if np.ndim(part.value) else float(whole[0])
        part.is_set = True
        setattr(prior, name, part)

    names = {
        "focal_length": "focal_length",
        "principal_point": "principal_point",
        "aspect_ratio": "aspect_ratio",
        "skew": "skew",
        "radial_distortion_coeffs": "radial_distortion",
        "tangential_distortion_coeffs": "tangential_distortion",
    }
    for key, name in names.items():
        if key in stated:
            put(name, stated[key])
    camera = pytheia.sfm.Camera()
    camera.SetFromCameraIntrinsicsPriors(prior)
    return np.array([camera.ProjectPoint(np.append(point, 1.0))[1] for point in points])


def bundler(path, points):
    """Theia's reader of Bundler's files; the formula of Bundler's manual, as the package has no camera of it with y up. The image is `SIZE` of the environment."""
    import pytheia

    with tempfile.TemporaryDirectory() as folder:
        images, whole = (os.path.join(folder, name) for name in ("list.txt", "bundle.out"))
        with open(images, "w") as text:
            text.write("a.jpg 0 500\n")
        # It wants a point besides the cameras.
        with open(path) as ours, open(whole, "w") as text:
            comment, _, *cameras = ours
            text.writelines([comment, "1 1\n", *cameras, "0 0 5\n255 255 255\n1 0 0 1.0 2.0\n"])
        reader = pytheia.io.BundlerFileReader(images, whole)
        reader.ParseListsFile()
        reader.ParseBundleFile()
        (camera,) = reader.cameras()
    width, height = (int(side) for side in os.environ["SIZE"].split("x"))
    flat = points[:, :2] / points[:, 2:]
    r2 = (flat**2).sum(axis=1, keepdims=True)
    bent = flat * camera.focal_length * (1 + camera.radial_coeff_1 * r2 + camera.radial_coeff_2 * r2 * r2)
    return bent + [width / 2 - 0.5, height / 2 - 0.5]


def st_map(path, points):
    """The map of cv2.initUndistortRectifyMap for the camera in FILE, beside ours in the TIFF that MAP names: places of our map, px, at the points' x and y."""
    import cv2

    ours = cv2.imread(os.environ["MAP"], cv2.IMREAD_UNCHANGED)[:, :, ::-1]
    storage = cv2.FileStorage(path, cv2.FILE_STORAGE_READ)
    matrix, distortion = (storage.getNode(name).mat() for name in ("camera_matrix", "distortion_coefficients"))
    height, width = ours.shape[:2]
    x, y = cv2.initUndistortRectifyMap(matrix, distortion, None, matrix, (width, height), cv2.CV_32FC1)
    places = np.dstack([ours[:, :, 0] * width - 0.5, ours[:, :, 1] * height - 0.5])
    columns, rows = points[:, 0].astype(int), points[:, 1].astype(int)
    return places[rows, columns] - np.dstack([x, y])[rows, columns]


TOOLS = {f.__name__: f for f in (colmap, kapture, opencv, mrcal, ros, theia, bundler, st_map)}


def main():
    tool, path = sys.argv[1:3]
    points = np.array(json.load(sys.stdin), dtype=float)
    try:
        pixels = TOOLS[tool](path, points)
    except Exception as error:  # whatever a tool throws is its answer
        print(f"{tool}: {type(error).__name__}: {error}", file=sys.stderr)
        return 2
    json.dump(np.asarray(pixels, dtype=float).tolist(), sys.stdout)
    return 0


if __name__ == "__main__":
    sys.exit(main())
