"""Points of one image."""

import subprocess
import sys
import threading
import time
import timeit
import warnings

import numpy as np
import pytest
from conftest import ROOT, rows, same

import calibench as cb

OF_DISCS = ("parametric_circle", "ellipse_edges", "centroid", "centroid_binary")
# They find boards in whole images and measure no point from a start.
FINDERS = ("detect", "calib_targets")
OURS = [name for name, _ in cb.methods() if not name.startswith(("opencv_", "cv2_"))]


def quiet(call, *words, **keys):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        return call(*words, **keys)


@pytest.fixture(scope="module")
def shot():
    return cb.render("operators/targets", root=ROOT, trial=3)[0]


@pytest.mark.parametrize("method", [name for name in OURS if name not in FINDERS])
def test_every_method_measures_as_the_command_line_does(method, program, project, tmp_path):
    """To the last bit, of a picture that both render: values, covariances and reasons."""
    scenario = "testfields/wall" if method in OF_DISCS else "testfields/chessboard"
    shot = cb.render(scenario, trial=3)[0]
    program("--root", ROOT, "render", scenario, "-o", "pictures", "--trial", 3, "--station", shot.name)
    starts = rows(tmp_path / "pictures/starts.csv")
    program("measure", f"pictures/{shot.name}.png", "--points", "pictures/starts.csv", "-m", method, "-o", "measured.csv")
    expected = rows(tmp_path / "measured.csv")
    assert shot.starts.target == [row["target"] for row in starts]
    found = cb.measure(shot.image, shot.starts.xy, method, kind=[str(kind) for kind in shot.starts.kind], axes=shot.starts.axes)
    number = lambda text: float(text) if text else np.nan
    assert same(found.xy, [[number(row["x"]), number(row["y"])] for row in expected])
    triples = [[number(row[key]) for key in ("sxx", "sxy", "syy")] for row in expected]
    assert same(found.cov.reshape(-1, 4)[:, [0, 1, 3]], triples)
    assert found.status == [row["status"] for row in expected]
    assert [reason or "" for reason in found.reason] == [row["reason"] for row in expected]
    assert found.method == expected[0]["method"]
    assert found.status.count("measured") > 0


@pytest.mark.parametrize("method", FINDERS)
def test_what_finds_boards_is_refused_as_the_command_line_does(method, shot, program, project):
    assert method in OURS
    with pytest.raises(cb.Error) as said:
        cb.measure(shot.image, shot.starts.xy, method)
    refusal = program("measure", "none.png", "--points", "none.csv", "-m", method, "-o", "none.csv", code=2)
    assert refusal.strip() == f"error: -m {said.value}" and "finds boards" in refusal


def test_grey_values_mean_the_same_in_every_type(shot):
    levels = np.rint(shot.image * 255).astype(np.uint8)
    truth = cb.measure(levels, shot.starts.xy)
    assert truth.status.count("measured") > 0
    as_float = (levels.astype(float) / 255).astype(np.float32)
    wide = np.zeros((levels.shape[0], 2 * levels.shape[1]), np.uint8)
    wide[:, ::2] = levels
    framed = np.zeros((levels.shape[0] + 4, levels.shape[1] + 6), np.float32)
    framed[2:-2, 3:-3] = as_float
    for image in [
        as_float,
        as_float.astype(float),
        levels.astype(np.uint16) * 257,
        np.asfortranarray(levels),
        np.asfortranarray(as_float),
        wide[:, ::2],
        framed[2:-2, 3:-3],
        as_float[::-1][::-1],
        np.asfortranarray(levels.astype(np.uint16) * 257),
    ]:
        assert same(cb.measure(image, shot.starts.xy).xy, truth.xy), (image.dtype, image.strides)


def test_a_read_only_image_is_measured_and_not_changed(shot):
    image = shot.image.copy()
    image.setflags(write=False)
    before = image.copy()
    cb.measure(image, shot.starts.xy)
    assert np.array_equal(image, before)


@pytest.mark.parametrize(
    "image, said",
    [
        (np.zeros((3, 4, 3), np.uint8), r"shape \[3, 4, 3\]"),
        (np.zeros((0, 4), np.float32), "empty"),
        (np.zeros((4, 4), np.int32), "int32"),
        (np.zeros((4, 4), complex), "complex128"),
        (np.zeros((4, 4), bool), "bool"),
        ([[0.5, 0.5], [0.5, 0.5]], "list"),
        (None, "NoneType"),
        (np.zeros(7, np.float32), r"shape \[7\]"),
    ],
)
def test_what_is_no_image_is_refused_by_name(image, said):
    with pytest.raises(cb.InputError, match=said) as error:
        cb.measure(image, [[1.0, 1.0]])
    assert "expected a two-dimensional array" in str(error.value)


@pytest.mark.parametrize("xy", [[[1, 2, 3]], "x", [["a", "b"]], np.zeros((2, 2, 2)), np.zeros((2, 2), complex), [1.0, 2.0], None])
def test_what_are_no_positions_is_refused(xy):
    with pytest.raises(cb.InputError, match="xy"):
        cb.measure(np.zeros((9, 9), np.float32), xy)


def test_no_point_is_no_result(shot):
    for nothing in ([], np.zeros((0, 2)), np.zeros((0, 2), np.float32)):
        found = cb.measure(shot.image, nothing)
        assert found.xy.shape == (0, 2) and found.cov.shape == (0, 2, 2) and len(found) == 0


def test_positions_of_any_type_and_stride(shot):
    xy = shot.starts.xy
    truth = cb.measure(np.ascontiguousarray(shot.image), np.rint(xy))
    strided = np.zeros((len(xy), 4))
    strided[:, ::2] = np.rint(xy)
    for places in (np.rint(xy).astype(int), np.rint(xy).astype(np.float32), np.asfortranarray(np.rint(xy)), strided[:, ::2], np.rint(xy).tolist()):
        assert same(cb.measure(shot.image, places).xy, truth.xy)


def test_starts_that_are_no_numbers_are_rejected(shot):
    found = cb.measure(shot.image, [[np.nan, 5.0], [1e9, 5.0], [np.inf, -np.inf]])
    assert found.reason == ["not_finite", "border", "not_finite"] and np.isnan(found.xy).all()


def test_mistakes_are_named():
    image = np.zeros((9, 9), np.float32)
    for method, said in [("forster", "did you mean `forstner`"), ("forstner:window=4", "odd"), ("forstner:windw=5", "did you mean `window`")]:
        with pytest.raises(cb.InputError, match=said):
            cb.measure(image, [[4, 4]], method)
    with pytest.raises(cb.UnavailableError, match="opencv_subpix"):
        cb.measure(image, [[4, 4]], "opencv_subpix")
    with pytest.raises(cb.InputError, match="2 names for 1 points"):
        cb.measure(image, [[4, 4]], kind=["corner", "corner"])
    with pytest.raises(cb.InputError, match="`korner`"):
        cb.measure(image, [[4, 4]], kind="korner")
    with pytest.raises(cb.InputError, match="does not say what is pictured"):
        cb.measure(image, [[4, 4]], "lsm")
    with pytest.raises(cb.InputError, match=r"axes.*\(1, 2, 2\)"):
        cb.measure(image, [[4, 4]], axes=np.zeros((2, 2)))


def test_levels_in_place_of_fractions_are_doubted():
    image = np.random.default_rng(1).uniform(0, 255, (40, 40)).astype(np.float32)
    with pytest.warns(cb.DoubtWarning, match="fractions of full scale"):
        cb.measure(image, [[20, 20]])


def test_results_own_their_memory():
    image = np.random.default_rng(1).uniform(0, 1, (40, 40)).astype(np.float32)
    found = cb.measure(image, [[20, 20]], "pixel")
    xy, cov = found.xy, found.cov
    del found, image
    assert xy.tolist() == [[20.0, 20.0]] and xy.flags.owndata is not None and xy.flags.writeable and np.isnan(cov).all()


def test_twelve_megapixels_are_not_copied():
    """In a process of its own: memory is that of the image alone."""
    code = """
import resource, numpy as np, calibench as cb
image = np.full((3000, 4000), 0.5, np.float32)
cb.measure(image[:20, :20], [[9, 9]], "pixel")
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
cb.measure(image, [[9, 9]] * 100, "forstner")
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 12_000, f"{done.stdout} kB more, a copy is 48,000"


def test_other_threads_of_python_run_while_it_measures():
    """The lock of the interpreter is released: another thread counts meanwhile."""
    image = np.random.default_rng(1).uniform(0, 1, (800, 800)).astype(np.float32)
    xy = np.random.default_rng(2).uniform(20, 780, (200_000, 2))
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    time.sleep(0.05)
    before, started = counted[0], time.perf_counter()
    cb.measure(image, xy, "forstner:window=15")
    seconds, during = time.perf_counter() - started, counted[0] - before
    stop.set()
    thread.join()
    assert during > 10 or seconds < 0.05, f"{during} in {seconds} s"


def test_levels_of_twelve_bits_are_doubted():
    image = (np.random.default_rng(1).uniform(0, 1, (40, 40)) * 4095).astype(np.uint16)
    with pytest.warns(cb.DoubtWarning, match="10 or 12 bits"):
        cb.measure(image, [[20, 20]])


def test_a_light_call_costs_microseconds():
    """Nothing is looked for and no thread is woken for a few points. The bounds are ten times what it takes, and half of what either would cost."""
    camera = cb.render("testfields/chessboard", root=ROOT)[0].camera
    image, point, ray = np.full((8, 8), 0.5, np.float32), np.array([[4.0, 4.0]]), np.array([[0.0, 0.0, 1.0]])

    def microseconds(call):
        return 1e3 * min(timeit.repeat(call, number=1000, repeat=20))

    assert microseconds(lambda: camera.project(ray)) < 6
    assert microseconds(lambda: camera.unproject(point)) < 6
    assert microseconds(lambda: camera.undistort(point)) < 8
    assert microseconds(lambda: cb.measure(image, point, "pixel")) < 14


def test_plug_ins_are_looked_for_where_a_name_is_none_of_ours(tmp_path, monkeypatch):
    image, point = np.full((50, 50), 0.5, np.float32), [[20.0, 21.0]]
    project = tmp_path / "project"
    for name in ("scenarios", "reference", "methods"):
        (project / name).mkdir(parents=True)
    monkeypatch.chdir(project)
    with pytest.raises(cb.InputError, match="no method is called `start_sh`"):
        cb.measure(image, point, "start_sh")
    # What is new is seen at once, and so is what is gone, and that one is elsewhere.
    (project / "methods/start.sh").write_text((ROOT / "examples/plugins/start.sh").read_text())
    declared = '[[plugin]]\nname = "start_sh"\ncommand = ["sh", "start.sh"]\n'
    (project / "methods/start.toml").write_text(declared)
    assert quiet(cb.measure, image, point, "start_sh").xy.tolist() == point
    monkeypatch.chdir(tmp_path)
    with pytest.raises(cb.InputError, match="no method is called"):
        cb.measure(image, point, "start_sh")
    monkeypatch.chdir(project)
    (project / "methods/start.toml").write_text(declared.replace("name", "nome"))
    with pytest.raises(cb.ScenarioError, match="nome"):
        cb.measure(image, point, "start_sh")
    # Ours need nothing of it, nor a folder at all.
    for method in ("pixel", "corner+cross=forstner:window=9", "chess_corner = pixel"):
        cb.measure(image, point, method, kind="corner" if "corner+" in method else "chess_corner")
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert cb.measure(image, point, "pixel").status == ["measured"]
