"""Scenarios to records, in one run and in parts."""

import gzip
import itertools
import os
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from conftest import PROGRAM, ROOT

import calibench as cb

SCENARIO = "operators/targets-near"


def files(folder):
    """The bytes of all files below a folder; of what is compressed those inside."""
    read = lambda path: gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    return {str(path.relative_to(folder)): read(path) for path in sorted(folder.rglob("*")) if path.is_file()}


def quiet(work, *words, **keys):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        return work(*words, **keys)


def test_it_writes_what_the_command_line_writes(tmp_path, project):
    if not PROGRAM.is_file():
        pytest.skip(f"no program at {PROGRAM}")
    methods = ["forstner", "lsm"]
    quiet(cb.run, SCENARIO, methods=methods, trials=2, seed=5, records=tmp_path / "ours")
    # The command line writes into a project: one that holds this scenario alone.
    theirs = tmp_path / "theirs"
    (theirs / "scenarios/operators").mkdir(parents=True)
    (theirs / "reference").mkdir()
    (theirs / "scenarios" / f"{SCENARIO}.toml").write_text((ROOT / "scenarios" / f"{SCENARIO}.toml").read_text())
    words = [PROGRAM, "--root", theirs, "--quiet", "run", SCENARIO, "-m", methods[0], "-m", methods[1], "--trials", "2", "--seed", "5"]
    subprocess.run(words, check=True, capture_output=True)
    ours, theirs = files(tmp_path / "ours" / SCENARIO), files(theirs / "records" / SCENARIO)
    assert ours.keys() == theirs.keys()
    revision = lambda rows: [row.rsplit(b",", 1)[0] for row in rows.splitlines()]
    for name in ours:
        same = revision(ours[name]) == revision(theirs[name]) if name.endswith(".csv.gz") else ours[name] == theirs[name]
        assert same or name.startswith("."), name


def test_records_are_columns(project):
    records = quiet(cb.run, SCENARIO, methods=["forstner", "pixel"], trials=3)
    points = records.points
    assert records.folder is None and len({len(column) for column in points.values()}) == 1
    assert points["trial"].dtype == np.int64 and sorted(set(points["trial"])) == [0, 1, 2]
    assert points["x_true"].dtype == np.float64 and set(points["method"]) == {"forstner:window=11", "pixel"}
    rejected = np.array(points["status"]) == "rejected"
    assert np.isnan(points["x"][rejected]).all() and not np.isnan(points["x"][~rejected]).any()
    assert all(reason for reason, lost in zip(points["reason"], rejected) if lost)
    assert records.adjustments == {}
    # Read once, however often it is asked for.
    assert records.points is points


def test_a_method_of_pythons_is_run_as_any_other(project, tmp_path):
    @cb.method(name="python_pixel", version="3")
    def python_pixel(image, starts):
        return starts

    records = quiet(cb.run, SCENARIO, methods=["pixel", "python_pixel"], trials=2, records=tmp_path)
    points = records.points
    mine, theirs = (np.array(points["method"]) == name for name in ("python_pixel", "pixel"))
    assert mine.sum() == theirs.sum() > 0 and np.array_equal(points["x"][mine], points["x"][theirs])
    assert set(np.array(points["version"])[mine]) == {"3"}
    again = cb.Records.read(tmp_path / SCENARIO)
    assert np.array_equal(again.points["x"], points["x"]) and again.folder == tmp_path / SCENARIO


def test_one_that_fails_does_not_change_the_others(project):
    calls = itertools.count()

    @cb.method(name="hostile", version="1")
    def hostile(image, starts):
        image[:] = np.nan
        if next(calls) % 2:
            raise MemoryError("no memory")
        return np.full((7, 7), np.inf)

    alone = quiet(cb.run, SCENARIO, methods=["forstner"], trials=2).points
    beside = quiet(cb.run, SCENARIO, methods=["hostile", "forstner"], trials=2).points
    mine = np.array(beside["method"]) == "forstner:window=11"
    assert np.array_equal(beside["x"][mine], alone["x"], equal_nan=True)
    assert set(np.array(beside["reason"])[~mine]) == {"raised", "malformed"}


def test_the_same_on_any_number_of_threads(project):
    one, two = (quiet(cb.run, SCENARIO, methods=["forstner"], trials=4, threads=threads).points for threads in (1, 2))
    assert all(np.array_equal(one[key], two[key], equal_nan=True) if isinstance(one[key], np.ndarray) else one[key] == two[key] for key in one)


@pytest.mark.parametrize("scenario, trials", [(SCENARIO, 5), ("galo-2011/network-coordinates-clean", 4)])
def test_parts_are_put_together_to_one_run(tmp_path, project, scenario, trials):
    quiet(cb.run, scenario, trials=trials, records=tmp_path / "whole")
    for part in (3, 1, 2):
        where = quiet(cb.run_part, scenario, f"{part}/3", tmp_path / "parts", trials=trials)
        assert where == tmp_path / "parts" / f"{part}-of-3" / scenario
    cb.merge([tmp_path / "parts"], tmp_path / "merged")
    whole, merged = files(tmp_path / "whole" / scenario), files(tmp_path / "merged" / scenario)
    assert {name for name in whole if not name.startswith(".")} == {name for name in merged if not name.startswith(".")}
    for name in whole:
        assert whole[name] == merged[name] or name.startswith("."), name


def test_mistakes_are_named(tmp_path, project):
    for keys, said in [({"trials": 0}, "trials"), ({"methods": ["forster"]}, "did you mean"), ({"seed": 2**63}, "seed")]:
        with pytest.raises(cb.InputError, match=said):
            cb.run(SCENARIO, **keys)
    with pytest.raises(cb.InputError, match="operators/target"):
        cb.run("operators/target")
    (tmp_path / "wrong.toml").write_text('seed = 1\ntrails = 3\n')
    with pytest.raises(cb.ScenarioError, match=r"wrong.toml:2:1"):
        cb.run(str(tmp_path / "wrong.toml"))
    with pytest.raises(cb.InputError, match="part"):
        cb.run_part(SCENARIO, "4/3", tmp_path)
    with pytest.raises(cb.InputError):
        cb.merge([tmp_path], tmp_path / "merged")
    with pytest.raises(cb.InputError, match="no records"):
        cb.Records.read(tmp_path)
    with pytest.raises(cb.InputError, match="did you mean `galo-2011`"):
        cb.report("galo-2012")


def test_ctrl_c_ends_a_run_and_older_records_stay(tmp_path, project):
    quiet(cb.run, SCENARIO, methods=["pixel"], trials=2, records=tmp_path)
    before = files(tmp_path / SCENARIO)

    @cb.method(name="slow", version="1")
    def slow(image, starts):
        time.sleep(0.05)
        return starts

    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        cb.run(SCENARIO, methods=["slow"], trials=10_000, records=tmp_path)
    assert time.monotonic() - started < 20
    assert files(tmp_path / SCENARIO) == before


def test_a_plug_in_of_the_project_is_a_method_here(tmp_path):
    """Started by a Python that restricts itself."""
    (tmp_path / "scenarios/operators").mkdir(parents=True)
    (tmp_path / "reference").mkdir()
    (tmp_path / "methods").mkdir()
    (tmp_path / "scenarios" / f"{SCENARIO}.toml").write_text((ROOT / "scenarios" / f"{SCENARIO}.toml").read_text())
    for name in ("plugins.toml", "start.sh"):
        text = (ROOT / "examples/plugins" / name).read_text()
        (tmp_path / "methods" / name).write_text(text)
    declared = (tmp_path / "methods/plugins.toml").read_text().split("[[plugin]]")
    shell = next(text for text in declared if "start.sh" in text)
    (tmp_path / "methods/plugins.toml").write_text("[[plugin]]" + shell)
    name = shell.split('name = "')[1].split('"')[0]
    points = quiet(cb.run, SCENARIO, methods=["pixel", name], trials=1, root=tmp_path).points
    mine = np.array(points["method"]) == name
    assert mine.any() and np.array_equal(points["x"][mine], points["x"][~mine])


def test_a_network_is_a_method(tmp_path):
    """The example of an ONNX model, which is Förstner's corner, beside the example that computes it."""
    pytest.importorskip("onnxruntime")
    pytest.importorskip("onnx")
    scenario = "testfields/chessboard"
    (tmp_path / "scenarios/testfields").mkdir(parents=True)
    (tmp_path / "reference").mkdir()
    (tmp_path / "methods").mkdir()
    (tmp_path / "scenarios" / f"{scenario}.toml").write_text((ROOT / "scenarios" / f"{scenario}.toml").read_text())
    example = ROOT / "examples/plugins"
    for file in ("onnx/refiner.py", "onnx/plugins.toml", "forstner.py"):
        text = (example / file).read_text().replace('"python3"', f'"{sys.executable}"')
        (tmp_path / "methods" / file.rpartition("/")[2]).write_text(text)
    beside = '[[plugin]]\nname = "forstner_py"\nimage = "gray8"\ncommand = ["%s", "forstner.py"]\nparameters = { window = { default = 11, min = 5, max = 31 } }\n'
    (tmp_path / "methods/python.toml").write_text(beside % sys.executable)
    subprocess.run([sys.executable, example / "onnx/make_model.py", tmp_path / "methods/refiner.onnx"], check=True)
    points = quiet(cb.run, scenario, methods=["refiner_onnx", "forstner_py"], trials=1, root=tmp_path).points
    network = np.array(points["method"]) == "refiner_onnx"
    both = np.hypot(points["x"][network] - points["x"][~network], points["y"][network] - points["y"][~network])
    assert np.isfinite(both).sum() > 100 and np.nanmax(both) < 1e-3, np.nanmax(both)
