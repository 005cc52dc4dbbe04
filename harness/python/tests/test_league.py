"""Callables as calibrators, beside calibench's own."""

import re
import warnings

import numpy as np
import pytest

import calibench as cb

CLASS = "league/good"
#: The true camera of the class, as its file has it.
CAMERA = "scenarios/league/camera.yaml"


@pytest.fixture
def asked(project):
    """Two trials of ours and of callables, and the calls that these got."""
    camera = cb.Camera.read(project / CAMERA)
    tasks = []

    def exact(task):
        tasks.append(task)
        return {"rays": camera.unproject(task["grid"]), "rms_px": np.float64(0.1), "outliers": np.array([[0, 1]])}

    def longer(task):
        text = (project / CAMERA).read_text().replace("921.3", "930.0").replace("919.8", "928.5")
        return {"camera": text, "sigmas": {"fx": 0.5, "fy": 0.5}}

    def broken(task):
        raise ValueError("no\nlens")

    def wordless(task):
        return None

    exact.__version__ = "7"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return cb.league(CLASS, ["ours", exact, longer, broken, wordless], trials=2, threads=2, root=project), tasks


def of(rows, name, column):
    return [value for value, calibrator in zip(rows[column], rows["calibrator"]) if calibrator == name]


def test_all_get_the_same_trials_and_are_compared_with_the_truth(asked):
    rows, tasks = asked
    assert of(rows, "exact", "trial") == of(rows, "ours", "trial") == [0, 1]
    assert max(of(rows, "exact", "frame")) < 1e-6 and max(of(rows, "exact", "length")) < 1e-6
    assert of(rows, "exact", "left_out") == [1, 1] and of(rows, "exact", "rms") == [0.1, 0.1] and of(rows, "exact", "version") == ["7", "7"]
    assert of(rows, "ours", "status") == ["calibrated"] * 2 and all(0.05 < px < 2 for px in of(rows, "ours", "frame"))
    # 8.7 px longer with a standard deviation of 0.5 px.
    assert of(rows, "longer", "silent") == [True, True] and min(of(rows, "longer", "z2_parameters")) > 100
    assert len(tasks) == 2 and tasks[0]["model"] == "opencv5" and len(tasks[0]["images"]) == 20 and tasks[0]["start"]["f"] == 900


def test_what_a_callable_raises_has_failed(asked):
    rows, _ = asked
    assert of(rows, "broken", "status") == ["failed"] * 2 and of(rows, "broken", "message") == ["ValueError: no lens"] * 2
    assert "found NoneType" in of(rows, "wordless", "message")[0]
    assert np.isnan(of(rows, "broken", "frame")).all()


def test_the_number_of_threads_changes_nothing(project):
    rows = cb.league([CLASS], ["ours"], trials=1, root=project)
    again = cb.league(CLASS, ["ours"], trials=1, root=project, threads=1)
    assert list(rows["frame"]) == list(again["frame"])


@pytest.mark.parametrize(
    "words, keys, expected",
    [
        ((CLASS, ["opencv"]), {}, "no calibrator is called `opencv`: expected some of ours"),
        ((CLASS, []), {}, "calibrators: none"),
        ((CLASS, ["ours", "ours"]), {}, "`ours` is there twice"),
        ((CLASS, [lambda task: task]), {}, "`<lambda>`; expected a callable whose name"),
        ((CLASS, [3]), {}, "calibrators: 3; expected names and callables"),
        ((CLASS, ["ours"]), {"trials": 0}, "trials: 0"),
        (("operators/targets-near", ["ours"]), {}, "expected a scenario with [calibrators]"),
    ],
)
def test_bad_input_is_named(project, words, keys, expected):
    with pytest.raises(cb.InputError, match=re.escape(expected)):
        cb.league(*words, root=project, **keys)
