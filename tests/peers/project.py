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


def projected(matrix, distortion, fisheye, points):
    """OpenCV's projection of a camera matrix and coefficients."""
    import cv2

    zero, points = np.zeros(3), points.reshape(-1, 1, 3)
    project = cv2.fisheye.projectPoints if fisheye else cv2.projectPoints
    return project(points, zero, zero, np.asarray(matrix, float), np.asarray(distortion, float))[0].reshape(-1, 2)


def numpy_archive(path, points):
    """numpy.load, then OpenCV's projection."""
    import cv2

    with np.load(path) as arrays:
        matrix, distortion, fisheye = (arrays[name] for name in ("camera_matrix", "dist_coeffs", "fisheye_model"))
        if "xi" in arrays:
            zero = np.zeros(3)
            return cv2.omnidir.projectPoints(points.reshape(-1, 1, 3), zero, zero, matrix, float(arrays["xi"]), distortion)[0].reshape(-1, 2)
    return projected(matrix, distortion, bool(fisheye), points)


def anipose(path, points):
    """aniposelib loads the group and projects, in the axes of the first camera."""
    from aniposelib.cameras import CameraGroup

    camera = CameraGroup.load(path).cameras[0]
    camera.set_rotation(np.zeros(3))
    camera.set_translation(np.zeros(3))
    return camera.project(points).reshape(-1, 2)


def caliscope(path, points):
    """caliscope loads its own file, which holds the tables one level deeper; OpenCV's functions are what it calls."""
    from caliscope.cameras.camera_array import CameraArray

    with tempfile.TemporaryDirectory() as folder:
        deeper = os.path.join(folder, "camera_array.toml")
        with open(path) as ours, open(deeper, "w") as text:
            text.write(ours.read().split("[metadata]")[0].replace("[cam_", "[cameras."))
        (camera,) = CameraArray.from_toml(deeper).cameras.values()
    return projected(camera.matrix, camera.distortions, camera.fisheye, points)


def lensfun(path, points):
    """lensfun's own arithmetic of one point at a time, in single precision: rows of pixels it takes four at a time on some processors, with approximate reciprocals and
    the factors of other pixels. The undistorted picture is rectilinear and has the focal length of the data base; the image is `SIZE`, of several lenses the `LENS` that
    was measured at `FOCAL`: cameras with sensors of several sizes may have lenses of one name."""
    import lensfunpy

    with open(path) as text:
        database = lensfunpy.Database(xml=text.read(), load_common=False, load_bundled=False)
    name, focal = os.environ.get("LENS"), float(os.environ.get("FOCAL", "0"))
    # It holds floats of 32 bits.
    lenses = [lens for lens in database.lenses if name in (None, lens.model)]
    lens, calibration = next((lens, c) for lens in lenses for c in lens.calib_distortion if not focal or abs(c.focal - focal) < 1e-5 * focal)
    width, height = (int(side) for side in os.environ["SIZE"].split("x"))
    modifier = lensfunpy.Modifier(lens, lens.crop_factor, width, height)
    flags = lensfunpy.ModifyFlags.DISTORTION | lensfunpy.ModifyFlags.GEOMETRY
    modifier.initialize(calibration.focal, 8.0, 1000.0, 1.0, lensfunpy.LensType.RECTILINEAR, np.uint8, flags)
    # Its constructor: the diagonal between the outer pixels is that of 36 x 24 mm over the crop factor.
    scale = calibration.focal * np.hypot(width - 1, height - 1) * lens.crop_factor / np.hypot(36, 24)
    half = 0.5 * min(width - 1, height - 1)
    centre = np.array([0.5 * (width - 1) + lens.center_x * half, 0.5 * (height - 1) + lens.center_y * half])
    flat = points[:, :2] / points[:, 2:] * scale + centre
    return np.array([modifier.apply_geometry_distortion(x, y, 1, 1)[0, 0] for x, y in flat])


def usd(path, points):
    """usd-core opens the stage; OpenCV's functions are those that the schemas name."""
    from pxr import Usd

    stage = Usd.Stage.Open(path)
    prim = next(prim for prim in stage.Traverse() if prim.GetAttribute("omni:lensdistortion:model"))
    model = prim.GetAttribute("omni:lensdistortion:model").Get()
    values = {a.GetName().rsplit(":", 1)[1]: a.Get() for a in prim.GetAttributes() if a.GetName().startswith(f"omni:lensdistortion:{model}:")}
    assert list(values["imageSize"]) == [int(side) for side in os.environ["SIZE"].split("x")]
    names = {"opencvPinhole": "k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4", "opencvFisheye": "k1 k2 k3 k4"}[model].split()
    matrix = [[values["fx"], 0, values["cx"]], [0, values["fy"], values["cy"]], [0, 0, 1]]
    return projected(matrix, [values[name] for name in names], model == "opencvFisheye", points)


def hugin(path, points):
    """Hugin's pano_trafo, from an equirectangular panorama to the first image."""
    import subprocess

    with open(path) as ours:
        panorama = next(line for line in ours if line.startswith("p "))
    width, height = (int(word[1:]) for word in panorama.split()[2:4])
    x, y, z = points.T
    longitude, latitude = np.arctan2(x, z), np.arctan2(-y, np.hypot(x, z))
    at = np.column_stack([(longitude / (2 * np.pi) + 0.5) * width - 0.5, (0.5 - latitude / np.pi) * height - 0.5])
    asked = "".join(f"{float(x)!r} {float(y)!r}\n" for x, y in at)
    answer = subprocess.run(["pano_trafo", "-r", path, "0"], input=asked, capture_output=True, text=True, check=True).stdout
    return np.array([[float(word) for word in line.split()] for line in answer.splitlines()])


def mrcal(path, points):
    import mrcal

    model = mrcal.cameramodel(path)
    return mrcal.project(points, *model.intrinsics())


def cahvor(path, points):
    """mrcal reads the vectors; the points are in the world, for the axes of its camera are those of the image plane and not the lens's."""
    import mrcal
    import mrcal.cahvor

    model = mrcal.cahvor.read(path)
    return mrcal.project(mrcal.transform_point_Rt(model.extrinsics_Rt_fromref(), points), *model.intrinsics())


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


TOOLS = {f.__name__: f for f in (colmap, kapture, opencv, numpy_archive, anipose, caliscope, lensfun, usd, hugin, mrcal, cahvor, ros, theia, bundler, st_map)}


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
