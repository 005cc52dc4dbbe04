"""Cameras: read, converted, written, projected with."""

import warnings

import numpy as np
import pytest
from conftest import ROOT, same

import calibench as cb

YAML = """%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 536.07, 0., 342.37, 0., 536.01, 235.53, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.265, -0.046, 0.0018, -0.0003, 0.252 ]
"""
PX = np.array([[0.0, 0.0], [320.0, 240.0], [639.0, 0.0], [10.5, 470.25], [600.0, 479.0]])


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "camera.yaml"
    path.write_text(YAML)
    return path


@pytest.fixture
def camera(file):
    return cb.Camera.read(file)


def test_a_camera_is_what_its_file_says(camera):
    assert camera.size == (640, 480) and camera.fit is None and camera.covariance is None
    assert camera.parameters["fx"] == 536.07 and camera.parameters["k3"] == 0.252 and camera.units["fx"] == "px"


def test_rays_and_pixels_belong_together(camera):
    rays = camera.unproject(PX)
    assert np.allclose(np.linalg.norm(rays, axis=1), 1) and (rays[:, 2] > 0).all()
    assert np.abs(camera.project(rays) - PX).max() < 1e-9
    assert np.abs(camera.project(rays * 17.0) - PX).max() < 1e-9
    # x right, y down.
    assert camera.project([[0.1, 0.0, 1.0]])[0, 0] > 342.37 and camera.project([[0.0, 0.1, 1.0]])[0, 1] > 235.53
    assert np.isnan(camera.project([[0.0, 0.0, -1.0]])).all()


def test_it_projects_as_opencv_does(camera):
    cv2 = pytest.importorskip("cv2")
    k = np.array([[536.07, 0, 342.37], [0, 536.01, 235.53], [0, 0, 1]])
    d = np.array([-0.265, -0.046, 0.0018, -0.0003, 0.252])
    points = np.random.default_rng(3).uniform([-0.5, -0.4, 1], [0.5, 0.4, 1.2], (500, 3))
    theirs, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), k, d)
    assert np.abs(camera.project(points) - theirs.reshape(-1, 2)).max() < 1e-9
    pixels = camera.project(points)
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-12)
    pixels = pixels.reshape(-1, 1, 2)
    older = getattr(cv2, "undistortPointsIter", None)  # before OpenCV 5
    plain = older(pixels, k, d, np.eye(3), k, criteria) if older else cv2.undistortPoints(pixels, k, d, None, np.eye(3), k, criteria)
    plain, pixels = plain.reshape(-1, 2), pixels.reshape(-1, 2)
    assert np.abs(camera.undistort(pixels) - plain).max() < 1e-6


def test_undistorted_points_are_those_of_a_pinhole(camera):
    points = np.array([[0.2, -0.1, 1.0], [-0.3, 0.2, 1.0]])
    plain = camera.undistort(camera.project(points))
    assert np.abs(plain - (points[:, :2] * [536.07, 536.01] + [342.37, 235.53])).max() < 1e-8


def test_it_is_converted_and_written_as_the_command_line_does(camera, file, program, tmp_path):
    for tool, ending in [("colmap", "txt"), ("kalibr", "yaml"), ("metashape", "xml"), ("ros", "yaml"), ("photogrammetric", "toml")]:
        pitch = {"pitch": 10.0} if tool == "photogrammetric" else {}
        words = ["--pitch", "10"] if pitch else []
        program("convert", file, "--to", tool, "-o", tmp_path / f"theirs.{ending}", "--accept", *words)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cb.DoubtWarning)
            camera.convert(tool, accept=True, **pitch).write(tmp_path / f"ours.{ending}")
        assert (tmp_path / f"ours.{ending}").read_bytes() == (tmp_path / f"theirs.{ending}").read_bytes(), tool


def test_a_fit_says_what_it_cost(camera):
    with pytest.raises(cb.CameraError, match="differs by up to"):
        camera.convert("opencv4")
    with pytest.warns(cb.DoubtWarning, match="fitted with residuals"):
        poor = camera.convert("opencv4", accept=True)
    assert poor.fit[0] > 0.5 or poor.fit[1] > 0.5
    assert camera.convert("opencv8").fit is None


def test_two_cameras_are_compared_as_on_the_command_line(camera, file, program, tmp_path):
    other = tmp_path / "other.yaml"
    other.write_text(YAML.replace("-0.265", "-0.262"))
    text = program("diff", file, other)
    found = cb.diff(camera, cb.Camera.read(other))
    assert f"{found.rms_px:.3g}"[:4] in text and found.max_px > found.rms_px > 0 and found.vectors.shape[1] == 4
    assert cb.diff(camera, camera).rms_px < 1e-9
    assert cb.diff(camera, cb.Camera.read(other), rotation=False).rms_px >= found.rms_px
    with pytest.raises(cb.InputError, match="differ in size"):
        smaller = tmp_path / "smaller.yaml"
        smaller.write_text(YAML.replace("640", "641"))
        cb.diff(camera, cb.Camera.read(smaller))


def test_it_is_the_same_in_other_images(camera, file, program, tmp_path):
    half = camera.reframe(size=(320, 240))
    program("convert", file, "--size", "320x240", "-o", tmp_path / "half.yaml")
    theirs = cb.Camera.read(tmp_path / "half.yaml")
    assert half.size == (320, 240) and np.allclose(list(half.parameters.values()), list(theirs.parameters.values()), rtol=1e-14)
    points = np.array([[0.1, 0.2, 1.0], [-0.3, 0.1, 1.2], [0.0, 0.0, 1.0]])
    assert np.allclose(half.project(points), (camera.project(points) + 0.5) / 2 - 0.5, atol=1e-9)
    part = camera.reframe(crop=(10, 20, 600, 400), binned=4, turn=90)
    seen = ((camera.project(points) + 0.5 - [10, 20]) / 4) - 0.5
    turned = points * [1, 1, 1] @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    assert part.size == (100, 150) and np.allclose(part.project(turned), np.column_stack([99 - seen[:, 1], seen[:, 0]]), atol=1e-9)
    assert cb.diff(camera, half.reframe(scale=2.0)).rms_px < 1e-9
    for wrong in ({"size": (320, 240), "scale": 0.5}, {"turn": 45}, {"crop": (0, 0, 641, 480)}, {"scale": 0.0}, {"binned": 0}, {"crop": (-1, 0, 9, 9)}):
        with pytest.raises(cb.InputError):
            camera.reframe(**wrong)
    with pytest.raises(cb.InputError, match="perhaps the same camera, its images times 1/2; its method `reframe`"):
        cb.diff(half, camera)


def test_mistakes_are_named(tmp_path, camera):
    with pytest.raises(cb.CameraError, match="nowhere.yaml"):
        cb.Camera.read(tmp_path / "nowhere.yaml")
    (tmp_path / "no.yaml").write_text("a: 1\n")
    with pytest.raises(cb.CameraError, match="no.yaml"):
        cb.Camera.read(tmp_path / "no.yaml")
    with pytest.raises(cb.CameraError, match="did you mean|known are"):
        camera.convert("colmapp")
    with pytest.raises(cb.CameraError, match="pitch"):
        camera.convert("photogrammetric")
    with pytest.raises(cb.InputError, match="points"):
        camera.project([[1.0, 2.0]])
    with pytest.raises(cb.CameraError):
        camera.write(tmp_path / "nowhere" / "camera.toml")


def test_the_true_camera_pictures_the_truth():
    shot = cb.render("testfields/chessboard", root=ROOT)[0]
    points = shot.truth.object @ shot.pose.R.T + shot.pose.t
    seen = ~np.isnan(shot.truth.xy[:, 0])
    assert np.abs(shot.camera.project(points)[seen] - shot.truth.xy[seen]).max() < 1e-9
    assert np.abs(shot.pose.R @ shot.pose.centre + shot.pose.t).max() < 1e-9 and np.linalg.det(shot.pose.R) == pytest.approx(1)


def test_what_is_lost_is_said_apart(camera, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error", cb.DoubtWarning)
        warnings.simplefilter("ignore", cb.LossWarning)
        camera.convert("colmap").write(tmp_path / "cameras.txt")


def test_the_name_of_a_file_is_no_option(tmp_path):
    """Options of the command line are said as keywords; what looks like one in a name is left."""
    with pytest.raises(cb.CameraError) as error:
        cb.Camera.read(tmp_path / "my--size.yaml")
    assert "my--size.yaml" in str(error.value)
