"""What calls return is pickled and copied, and is the same to the last bit."""

import contextlib
import copy
import inspect
import multiprocessing
import pickle
import struct
import warnings
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from conftest import ROOT

import calibench as cb

SEEDS = ROOT / "tests/calibench/fuzz/seeds/cameras"


def told(call, *words, **keys):
    """What is doubtful is not what is tested here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return call(*words, **keys)


@pytest.fixture(scope="module")
def examples(tmp_path_factory):
    """One of every class of the package, of some several."""
    shots = told(cb.render, "testfields/chessboard", root=ROOT)
    corners = []
    for shot in shots:
        found = told(cb.detect, shot.image, "9x6")
        if found is not None:
            corners.append(told(cb.measure, shot.image, found.xy, "parametric_corner", kind="chess_corner"))
    size = shots[0].image.shape[::-1]
    calibration = told(cb.calibrate, corners, "9x6:25", size=size, model="opencv5")
    models = ["opencv4:fx,fy,cx,cy,k1", "opencv4"]
    judged = told(cb.judge, corners, "9x6:25", size=size, models=models, splits=2, camera=calibration.camera)
    run = lambda **where: told(cb.run, "operators/targets", methods=["pixel"], trials=1, root=ROOT, **where)
    missed = told(cb.measure, shots[0].image, [[1.0, 1.0], [np.nan, 3.0]])
    assert missed.reason == ["border", "not_finite"]
    errors = [cb.CalibrationError, cb.CameraError, cb.DoubtWarning, cb.Error, cb.InputError, cb.LossWarning, cb.ScenarioError, cb.UnavailableError]
    return [
        calibration, calibration.camera, shots[0].camera, told(shots[0].camera.convert, "opencv4", accept=True),
        cb.diff(shots[0].camera, calibration.camera), judged, corners[0], missed, shots[0].pose,
        run(), run(records=tmp_path_factory.mktemp("records")), shots[0], told(cb.render, "operators/targets", root=ROOT)[0],
        shots[0].truth, shots[0].starts, cb.identify(shots[0].image), *(error("what is wrong") for error in errors),
    ]  # fmt: skip


def parts(thing):
    """All that an object of the package says of itself."""
    names = [name for name in dir(thing) if not name.startswith("_") and not callable(getattr(thing, name))]
    return {name: getattr(thing, name) for name in names}


def check(a, b, where="it"):
    """Equal to the last bit, NaN and the sign of zero too."""
    assert type(a) is type(b), where
    if isinstance(a, np.ndarray):
        assert (a.dtype, a.shape, a.tobytes()) == (b.dtype, b.shape, b.tobytes()), where
    elif isinstance(a, float):
        assert struct.pack("d", a) == struct.pack("d", b), where
    elif isinstance(a, dict):
        assert list(a) == list(b), where
        for key in a:
            check(a[key], b[key], f"{where}.{key}")
    elif isinstance(a, (list, tuple)):
        assert len(a) == len(b), where
        for index, (one, other) in enumerate(zip(a, b)):
            check(one, other, f"{where}[{index}]")
    elif isinstance(a, BaseException):
        assert a.args == b.args, where
    elif type(a).__module__ == "calibench":
        assert repr(a) == repr(b), where
        check(parts(a), parts(b), f"{where}: {type(a).__name__}")
    else:
        assert a == b, where


def test_every_class_is_the_same_after_it(examples):
    classes = {value for value in vars(cb).values() if inspect.isclass(value) and value.__module__.startswith("calibench")}
    assert {type(example) for example in examples} == classes, "an example for each class, and `restored` must know it"
    for example in examples:
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            check(pickle.loads(pickle.dumps(example, protocol)), example)
        check(copy.copy(example), example)
        check(copy.deepcopy(example), example)


def written(camera, folder):
    """What it writes, in its own format and in others, or why it does not."""
    found = []
    for ending in (".xml", ".yaml", ".json", ".cameramodel"):
        try:
            told(camera.write, folder / f"camera{ending}")
            found.append((folder / f"camera{ending}").read_bytes())
        except cb.Error as error:
            found.append(str(error))
    return found


def splined(folder):
    """A camera of splines, as mrcal has them."""
    grid = [((j - 7.5) * 0.2, (i - 5) * 0.2) for i in range(11) for j in range(16)]
    control = ", ".join(f"{-2e-3 * x * (x * x + y * y)}, {-2e-3 * y * (x * x + y * y)}" for x, y in grid)
    model = "'LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=16_Ny=11_fov_x_deg=120'"
    (folder / "splined.cameramodel").write_text(
        f"{{ 'lensmodel': {model}, 'intrinsics': [ 1700.5, 1701.25, 1961.125, 1087.5, {control} ],\n 'extrinsics': [ 0.1, -0.2, 0.3, 1, 2, 3 ], 'imagersize': [ 3900, 2190 ] }}\n"
    )
    return told(cb.Camera.read, folder / "splined.cameramodel")


def test_cameras_of_every_model_are_the_same_after_it(examples, tmp_path):
    read = [splined(tmp_path)]
    for path in sorted(path for path in SEEDS.rglob("*") if path.is_file()):
        with contextlib.suppress(cb.Error):
            read += told(cb.Camera.read_all, path)
    assert len(read) > 25 and any("spline" in note for note in read[0].notes)
    with pytest.raises(cb.CameraError, match="known are") as said:
        read[0].convert("nothing")
    ours = next(example for example in examples if isinstance(example, cb.Camera))
    for target in str(said.value).split("known are ")[1].split(", "):
        with contextlib.suppress(cb.Error):
            read.append(told(ours.convert, target, pitch=5.0, radius=250.0, accept=True))
    for camera in [*read, *(example for example in examples if isinstance(example, cb.Camera))]:
        again = pickle.loads(pickle.dumps(camera))
        check(again, camera, repr(camera))
        width, height = camera.size
        assert written(again, tmp_path) == written(camera, tmp_path), repr(camera)
        px = np.random.default_rng(1).uniform(0, [width - 1, height - 1], (50, 2))
        check(again.unproject(px), camera.unproject(px), repr(camera))
    assert len({camera.model for camera in read}) >= 11, {camera.model for camera in read}


def test_a_copy_owns_what_it_holds(examples):
    shot = next(example for example in examples if isinstance(example, cb.Shot))
    deep = copy.deepcopy(shot)
    deep.image[:] = 0
    deep.starts.xy[:] = 0
    assert shot.image.max() > 0.1 and shot.starts.xy.max() > 1


def test_records_of_no_folder_outlive_each_other(examples):
    temporary = next(example for example in examples if isinstance(example, cb.Records) and example.folder is None)
    data = pickle.dumps(pickle.loads(pickle.dumps(temporary)))
    check(pickle.loads(data).points, temporary.points)


@pytest.mark.parametrize("way", ["spawn", "fork"])
def test_processes_of_a_pool_take_and_give_them(way, examples):
    if way not in multiprocessing.get_all_start_methods():
        pytest.skip(f"no {way} here")
    calibration, camera, shot = (next(one for one in examples if type(one) is kind) for kind in (cb.Calibration, cb.Camera, cb.Shot))
    ray = np.array([[0.1, 0.2, 1.0]])
    with warnings.catch_warnings(), ProcessPoolExecutor(2, multiprocessing.get_context(way)) as pool:
        warnings.simplefilter("ignore")
        measured = [pool.submit(cb.measure, shot.image, shot.starts.xy, "forstner:window=9") for _ in range(3)]
        differing = pool.submit(cb.diff, camera, calibration.camera)
        projected = pool.submit(camera.project, ray)
        refused = pool.submit(cb.measure, shot.image, shot.starts.xy, "forster")
        for one in measured:
            check(one.result(60), told(cb.measure, shot.image, shot.starts.xy, "forstner:window=9"))
        check(differing.result(60), cb.diff(camera, calibration.camera))
        check(projected.result(60), camera.project(ray))
        with pytest.raises(cb.InputError, match="did you mean `forstner`"):
            refused.result(60)


def test_what_was_pickled_otherwise_is_refused(examples):
    from calibench import _calibench

    (restored, (name, version, state)) = examples[0].__reduce__()
    assert restored is _calibench.restored and version == cb.__version__
    for words, said in [
        ((name, "0.0.0", state), "pickled by calibench 0.0.0"),
        (("Error", version, state), "`Error` is no class"),
        (("Measured", version, (np.zeros((1, 2)), np.zeros((1, 2, 2)), ["bored"], "a", "1")), "`bored` is no reason"),
        (("Camera", version, ("{}", None, None)), "missing field"),
        (("Camera", version, (examples[1].__reduce__()[1][2][0], "mine", None)), "no such format as `mine`"),
        ((name, version, ("something", "else")), "Calibration: its state is not what calibench pickles"),
        (("Records", version, ("nowhere", None)), "holds no records"),
        (("Records", version, ("a", [("../a", b"")])), "is no file of records"),
    ]:
        with pytest.raises(cb.Error, match=said):
            restored(*words)
