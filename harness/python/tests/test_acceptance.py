"""Acceptance and tasks: what Python answers is what the command line answers."""

import json

import calibench as cb
import numpy as np
import pytest

DOWN = """sigma = 0.1
scale_sigma = 1e-4
unit = "mm"
[measure]
length = [[-50, 0, 0], [50, 0, 0]]
[known_plane]
point = [0, 0, 0]
normal = [0, 0, 1]
[[image]]
centre = [0, 0, 800]
angles = [0, 0, 0]
"""
CAMERA = """%YAML:1.0
---
image_width: 2000
image_height: 1500
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 2000., 0., 999.5, 0., 2000., 749.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
"""


def lengths(error):
    """Seven lines of five lengths, 200 to 1000."""
    calibrated = np.tile(np.arange(200.0, 1001.0, 200.0), 7)
    return np.column_stack([calibrated, np.full(35, 0.004), calibrated + error]), [str(k // 5 + 1) for k in range(35)]


def test_lengths_pass_fail_and_cannot_be_told():
    for error, decision in [(0.03, "pass"), (0.09, "fail"), (0.05, "cannot tell")]:
        given, lines = lengths(error)
        found = cb.accept_lengths(given, (0.05,), lines, diagonal=1200, unit="mm")
        assert found["decision"] == decision and found["command"] == "accept" and found["unit"] == "mm"
        assert found["lengths"]["rms"] == pytest.approx(error)
    given, lines = lengths(0.03)
    given[3, 2] = np.nan
    assert cb.accept_lengths(given, (0.05, 0, 0.06), lines, diagonal=1200)["lengths"]["lengths"][3]["outcome"] == "not measured"
    assert cb.accept_lengths(given, (0.05,), lines, guard_band=2.0)["lengths"]["guard_band"] == 2.0


def test_check_points_have_classes():
    surveyed = np.arange(120.0).reshape(40, 3)
    measured = surveyed + np.where(np.arange(40) % 2, 0.02, -0.02)[:, None]
    found = cb.accept_points(surveyed, measured, vertical=0.05, horizontal=0.01, survey=(0.001, 0.001))
    assert found["decision"] == "fail"
    assert [one["decision"] for one in found["check_points"]["accuracies"]] == ["fail", "pass", None]
    measured[5] = np.nan
    assert cb.accept_points(surveyed, measured, vertical=0.05)["check_points"]["missing"] == ["5"]


def test_what_is_no_acceptance_is_refused():
    given, lines = lengths(0.0)
    for call, words in [
        (lambda: cb.accept_lengths(given, (0.05,), lines[1:]), "lines: found 34 names"),
        (lambda: cb.accept_lengths(given, (), lines), "limit: "),
        (lambda: cb.accept_lengths(-given, (0.05,), lines), "lengths: row 0"),
        (lambda: cb.accept_lengths(given, (0.05,), lines, probability=0.3), "probability: found 0.3"),
        (lambda: cb.accept_points(np.zeros((3, 3)), np.zeros((2, 3)), vertical=1), "measured: found 2 points"),
        (lambda: cb.accept_points(np.zeros((3, 3)), np.zeros((3, 3)), vertical=-1), "vertical: found -1"),
    ]:
        with pytest.raises(cb.InputError, match=words):
            call()


def test_a_task_is_answered_as_on_the_command_line(program, tmp_path):
    (tmp_path / "task.toml").write_text(DOWN)
    (tmp_path / "camera.yaml").write_text(CAMERA)
    answered = program("task", "task.toml", "--camera", "camera.yaml", "--json", code=3)
    camera = cb.Camera.read(tmp_path / "camera.yaml")
    with pytest.warns(cb.DoubtWarning, match="nothing of its uncertainty"):
        found = cb.task(DOWN, camera)
    assert found == json.loads(answered)
    # By hand: two ends of 0.1 px at 0.4 mm a pixel, and 0.01 mm from the scale.
    assert found["numbers"][0]["sigma"] == pytest.approx(np.hypot(0.04 * np.sqrt(2), 0.01), rel=1e-6)
    with pytest.warns(cb.DoubtWarning):
        assert len(cb.task(DOWN, camera, slices=[0.0])["maps"]) == 1
    with pytest.raises(cb.ScenarioError, match="unknown field `sigmas`"):
        cb.task("sigmas = 1\n" + DOWN, camera)
    with pytest.raises(cb.InputError, match="either a camera"):
        cb.task(DOWN)
