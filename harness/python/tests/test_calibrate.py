"""Calibration and verdicts."""

import json
import os
import pickle
import subprocess
import sys
import warnings

import numpy as np
import pytest
from conftest import ROOT, rows, same

import calibench as cb

SCENARIO = "testfields/chessboard"


@pytest.fixture(scope="module")
def shots():
    return cb.render(SCENARIO, root=ROOT)


@pytest.fixture(scope="module")
def measured(shots):
    """Every point of the board in every image, NaN where it is not seen."""
    names = shots[0].truth.target
    place = {name: index for index, name in enumerate(names)}
    found = []
    for shot in shots:
        points = cb.measure(shot.image, shot.starts.xy, "parametric_corner", kind="chess_corner")
        xy = np.full((len(names), 2), np.nan)
        xy[[place[name] for name in shot.starts.target]] = points.xy
        found.append(xy)
    return found


def write_files(folder, shots, measured, control):
    """What the command line reads."""
    with open(folder / "points.csv", "w") as points, open(folder / "control.csv", "w") as known:
        points.write("image,target,x,y\n")
        known.write("target,X,Y,Z\n")
        for shot, xy in zip(shots, measured):
            for name, (x, y) in zip(control, xy):
                if not np.isnan(x):
                    points.write(f"{shot.name},{name},{float(x)!r},{float(y)!r}\n")
        for name, xyz in control.items():
            known.write(f"{name},{','.join(repr(value) for value in xyz)}\n")


def calibrated(*words, **keys):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        return cb.calibrate(*words, **keys)


@pytest.fixture(scope="module")
def control(shots):
    return dict(zip(shots[0].truth.target, shots[0].truth.object.tolist()))


def test_it_calibrates_as_the_command_line_does(shots, measured, control, program, tmp_path):
    """To the last bit: parameters, covariance, residuals and what is said."""
    size = shots[0].image.shape[::-1]
    found = calibrated(measured, control, size=size, model="opencv5", images=[shot.name for shot in shots])
    write_files(tmp_path, shots, measured, control)
    words = ["--points", "points.csv", "--control", "control.csv", "--size", f"{size[0]}x{size[1]}", "--model", "opencv5"]
    printed = program("calibrate", *words, "-o", "camera.json", "--report", "report", code=3 if found.doubts else 0)
    assert found.summary == printed
    found.camera.write(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_bytes() == (tmp_path / "camera.json").read_bytes()
    table = {(row["image"], row["target"]): row for row in rows(tmp_path / "report/residuals.csv")}
    for shot, residuals, xy in zip(shots, found.residuals, measured):
        for name, v, at in zip(control, residuals, xy):
            row = table.get((shot.name, name))
            assert (row is None) == np.isnan(at[0])
            if row is not None:
                assert abs(float(row["vx"]) - v[0]) < 1e-6 and abs(float(row["vy"]) - v[1]) < 1e-6


def test_the_camera_is_the_true_one_within_its_sigmas(shots, measured, control):
    size, true = shots[0].image.shape[::-1], shots[0].camera
    found = calibrated(measured, control, size=size, pitch=true.pitch or 6.0, solve=["c", "x0", "y0", "k1", "k2", "p1", "p2"])
    assert set(found.sigma) == set(found.solved) and found.covariance.shape == (len(found.solved),) * 2
    assert same(np.sqrt(np.diag(found.covariance)), [found.sigma[name] for name in found.solved])
    for name, sigma in found.sigma.items():
        assert abs(found.camera.parameters[name] - true.parameters[name]) < 5 * sigma, name
    assert cb.diff(found.camera, true).rms_px < 0.1
    for shot, name in zip(shots, found.poses):
        assert np.abs(found.poses[name].centre - shot.pose.centre).max() < 0.01 * np.linalg.norm(shot.pose.centre)
    predicted = found.camera.project(np.array(list(control.values())) @ found.poses["0"].R.T + found.poses["0"].t)
    seen = ~np.isnan(measured[0][:, 0])
    assert np.abs(predicted[seen] - measured[0][seen] - found.residuals[0][seen]).max() < 1e-9


def test_points_that_are_missed_are_left_out(shots, measured, control):
    size = shots[0].image.shape[::-1]
    fewer = [xy.copy() for xy in measured]
    fewer[0][:5] = np.nan
    found = calibrated(fewer, control, size=size, model="opencv4")
    assert np.isnan(found.residuals[0][:5]).all() and not any(found.used[0][:5]) and any(found.used[0][5:])


def test_gross_errors_are_found_and_said(shots, measured, control):
    size = shots[0].image.shape[::-1]
    wrong = [xy.copy() for xy in measured]
    place = int(np.flatnonzero(~np.isnan(wrong[1][:, 0]))[3])
    wrong[1][place] += [4.0, -3.0]
    for snoop, used in [(True, False), (None, False), (False, True)]:
        found = calibrated(wrong, control, size=size, model="opencv5", snoop=snoop)
        assert found.used[1][place] == used


def test_mistakes_are_named(measured, control):
    size = (640, 480)
    for keys, said in [
        ({"model": "opncv5"}, "did you mean"),
        ({"datum": "somewhere"}, "datum"),
        ({"board_shape": "wavy"}, "shape"),
        ({"sigma": -1.0}, "sigma"),
        ({"priors": ["k1"]}, "k1"),
        ({"per_image": ["c:0"]}, "c:0"),
        ({"images": ["a"]}, "images"),
        ({"huber": 2.0, "snoop": True}, "huber and snoop"),
        ({"size": (0, 3)}, "size"),
    ]:
        with pytest.raises(cb.Error, match=said):
            cb.calibrate(measured, control, **{"size": size, **keys})
    with pytest.raises(cb.InputError, match="found 3 rows"):
        cb.calibrate([np.zeros((3, 2))], control, size=size)
    with pytest.raises(cb.InputError, match="no point was measured"):
        cb.calibrate([], control, size=size)
    with pytest.raises(cb.InputError, match="no chessboard"):
        cb.calibrate(measured, "9x6", size=size)
    with pytest.raises(cb.InputError, match="not finite"):
        cb.calibrate([np.full((len(control), 2), np.inf)], control, size=size)


def test_a_verdict_on_points_is_that_of_the_command_line(shots, measured, control, program, tmp_path):
    size = shots[0].image.shape[::-1]
    if len(shots) < 6:
        pytest.skip("six images at least")
    write_files(tmp_path, shots, measured, control)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        found = cb.judge({"points": measured}, control, size=size, images=[shot.name for shot in shots], models=["opencv4", "opencv5"])
    words = ["--points", "points.csv", "--control", "control.csv", "--size", f"{size[0]}x{size[1]}", "--model", "opencv4", "--model", "opencv5"]
    printed = program("judge", *words, code=3 if found.doubt else 0)
    assert printed == found.verdict and found.model in ("opencv4", "opencv5") and found.operator == "points"
    assert len(found.columns["measure"]) == len(found.columns["value"]) > 10


def test_each_image_has_what_it_has_for_itself():
    folder = ROOT / "examples" / "per-image"
    control, seen, truth = (rows(folder / name) for name in ("control.csv", "points.csv", "truth.csv"))
    names = [row["image"] for row in truth]
    places = {(row["image"], row["target"]): [float(row["x"]), float(row["y"])] for row in seen}
    xy = [np.array([places[name, row["target"]] for row in control]) for name in names]
    board = {row["target"]: [float(row[axis]) for axis in "XYZ"] for row in control}
    found = cb.calibrate(xy, board, size=(1600, 1200), images=names, per_image=["c:6", "x0:2", "y0:2"], sigma=0.1)
    assert list(found.per_image) == names and not found.doubts
    off = [(found.per_image[row["image"]][of][0] - float(row[of])) / found.per_image[row["image"]][of][1] for row in truth for of in ("c", "x0", "y0")]
    assert 0.4 < np.mean(np.square(off)) < 2.0
    again = pickle.loads(pickle.dumps(found))
    assert again.per_image == found.per_image


def test_what_cannot_be_is_a_doubt(shots, measured):
    """A board that is turned, images whose sides are exchanged: said, whatever comes out."""
    size = shots[0].image.shape[::-1]
    with pytest.warns(cb.DoubtWarning, match="no operator's"):
        assert cb.calibrate(measured, "6x9:25", size=size).rms_px > 5
    with pytest.warns(cb.DoubtWarning, match="outside the images"):
        cb.calibrate(measured, "9x6:25", size=(64, 48))
    # In words of Python.
    assert "--" not in "".join(calibrated(measured, "9x6:25", size=(64, 48)).doubts)


def test_what_the_input_may_be_is_named(shots, measured, control, program, tmp_path):
    """Columns and rows exchanged, and no suspicion where all is well; as the command line answers."""
    size = shots[0].image.shape[::-1]
    assert calibrated(measured, control, size=size, model="opencv5").suspected == []
    turned = dict(cb.board("6x9:25"))
    found = calibrated(measured, turned, size=size, model="opencv5", images=[shot.name for shot in shots])
    write_files(tmp_path, shots, measured, turned)
    words = ["--points", "points.csv", "--control", "control.csv", "--size", f"{size[0]}x{size[1]}", "--model", "opencv5", "--json"]
    answer = json.loads(program("calibrate", *words, code=3))
    assert found.suspected == answer["suspected"] and found.suspected[0]["kind"] == "raster"
    assert [doubt["subject"] for doubt in found.doubted] == [doubt["subject"] for doubt in answer["doubted"]] and found.doubted
    assert [doubt["p"] for doubt in found.doubted] == [doubt["p"] for doubt in answer["doubted"]]
    copied = pickle.loads(pickle.dumps(found))
    assert (copied.suspected, copied.doubted, copied.warnings) == (found.suspected, found.doubted, found.warnings)
    with pytest.warns(cb.DoubtWarning, match="suspected: columns and rows of the board are exchanged"):
        cb.calibrate(measured, turned, size=size, model="opencv5")


def test_a_limit_of_ones_own_decides_what_is_hardly_known(shots, measured, control):
    size = shots[0].image.shape[::-1]
    assert any("known" in doubt for doubt in calibrated(measured, control, size=size, model="opencv5", limit=1e-6).doubts)


def test_points_and_sizes_are_taken_as_opencv_has_them(shots, measured):
    size = shots[0].image.shape[::-1]
    usual = calibrated(measured, "9x6:25", size=size, model="opencv5")
    opencv = calibrated([xy[:, None, :] for xy in measured], "9x6:25", size=list(size), model="opencv5")
    assert usual.camera.parameters == opencv.camera.parameters
    bent = calibrated(measured, "9x6:25", size=size, model="opencv5+bent")
    assert bent.camera.parameters == calibrated(measured, "9x6:25", size=size, model="opencv5", board_shape="bent").camera.parameters
    names = [name for name, _ in cb.board("9x6:25")]
    assert names[0] == "r1c1" and names[53] == "r6c9" and dict(cb.board("9x6:25"))["r2c2"] == [25.0, -25.0, 0.0]


def test_it_is_what_opencv_finds(shots, measured):
    cv2 = pytest.importorskip("cv2")
    size = shots[0].image.shape[::-1]
    flat = [np.array([xyz for _, xyz in cb.board("9x6:25")], np.float32)] * len(measured)
    for xyz in flat:
        xyz[:, 1:] *= -1
    points = [xy.astype(np.float32).reshape(-1, 1, 2) for xy in measured]
    _, matrix, distortion, *_ = cv2.calibrateCamera(flat, points, size, None, None, criteria=(3, 1000, 1e-14))
    ours = calibrated(points, "9x6:25", size=size, model="opencv5", board_shape="flat").camera.parameters
    theirs = dict(zip(["fx", "fy", "cx", "cy"], matrix[[0, 1, 0, 1], [0, 1, 2, 2]]), **dict(zip(["k1", "k2", "p1", "p2", "k3"], distortion.ravel())))
    assert all(abs(ours[name] - theirs[name]) < 1e-4 * max(1.0, abs(theirs[name])) for name in theirs), (ours, theirs)


def test_a_forked_process_goes_on(shots, measured):
    """It has none of its parent's threads."""
    if not hasattr(os, "fork"):
        pytest.skip("no fork here")
    size = shots[0].image.shape[::-1]
    calibrated(measured, "9x6:25", size=size)
    code = f"""
import multiprocessing, sys, warnings
import numpy as np, calibench as cb
warnings.simplefilter("ignore")
xy = [np.array(rows) for rows in {[xy.tolist() for xy in measured[:8]]!r}]
def work(queue=None):
    result = cb.calibrate(xy, "9x6:25", size={tuple(size)!r}).rms_px
    if queue is not None:
        queue.put(result)
    return result
own = work()
context = multiprocessing.get_context("fork")
queue = context.SimpleQueue()
child = context.Process(target=work, args=(queue,))
child.start()
child.join(60)
assert child.exitcode == 0, child.exitcode
assert queue.get() == own
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
