"""Ctrl-C ends what takes long, soon, and leaves nothing half done: each in a process of its own, which is sent SIGINT."""

import os
import signal
import subprocess
import sys
import time

import pytest
from conftest import ROOT
from test_run import SCENARIO

#: After this it is interrupted, and has ended so much later at most; each of the works takes twice as long as both together, most of them a minute.
BEGUN, SOON = 0.5, 2.0

#: What all of them need: points of many views of a large board, and images that take long.
MADE = f"""
import signal, sys, threading, warnings
import numpy as np, calibench as cb
warnings.simplefilter("ignore")
random = np.random.default_rng(1)

def views(count, board):
    shot = cb.render("testfields/chessboard", root={str(ROOT)!r})[0]
    plane = np.array([xyz for _, xyz in cb.board(board)])
    plane = (plane - plane.mean(axis=0)) / np.ptp(plane, axis=0).max()
    found = []
    while len(found) < count:
        axis = random.uniform(-0.5, 0.5, 3)
        skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        turn = np.linalg.solve(np.eye(3) - skew, (np.eye(3) + skew) @ np.diag([1.0, -1.0, -1.0]))
        xy = shot.camera.project(plane @ turn.T + [*random.uniform(-0.2, 0.2, 2), random.uniform(1.5, 2.5)])
        width, height = shot.camera.size
        xy[(xy < 0).any(axis=1) | (xy > [width - 1, height - 1]).any(axis=1)] = np.nan
        if np.isfinite(xy).mean() > 0.5:
            found.append(xy + random.normal(0, 0.1, xy.shape))
    return found, shot.camera.size

def small():
    image = np.random.default_rng(2).uniform(0, 1, (60, 60)).astype(np.float32)
    return repr(cb.measure(image, np.random.default_rng(3).uniform(15, 45, (500, 2)), "forstner:significance=0").xy.tolist())

before = small()
"""

#: What is made beforehand, and what is interrupted.
WORKS = {
    "measure": (
        "image = random.uniform(0, 1, (2000, 2000)).astype(np.float32); xy = random.uniform(50, 1950, (400_000, 2))",
        'cb.measure(image, xy, "lsm:window=31", kind="chess_corner")',
    ),
    "measure by a plug-in": (
        "import os; os.chdir(sys.argv[1]); image = np.zeros((50, 50), np.float32)",
        'cb.measure(image, [[20.0, 20.0]], "sleeper")',
    ),
    "measure by a plug-in that does not greet": (
        "import os; os.chdir(sys.argv[1]); image = np.zeros((50, 50), np.float32)",
        'cb.measure(image, [[20.0, 20.0]], "silent")',
    ),
    "judge by a plug-in that does not greet": (
        "import os, glob; os.chdir(sys.argv[1]); photos = sorted(glob.glob('*.png'))",
        'cb.judge(photos, "9x6:25", methods=["silent"])',
    ),
    "run a plug-in that does not greet": (
        "import os; os.chdir(sys.argv[1])",
        'cb.run("t/few", methods=["pixel", "silent"], records="records")',
    ),
    "run a scenario whose plug-in does not greet": ("import os; os.chdir(sys.argv[1])", 'cb.run("t/silent", records="records")'),
    "run a part by a plug-in that does not greet": (
        "import os; os.chdir(sys.argv[1])",
        'cb.run_part("t/few", "1/2", "parts", methods=["silent"])',
    ),
    "render a scenario whose plug-in does not greet": ("import os; os.chdir(sys.argv[1])", 'cb.render("t/silent")'),
    "run a plug-in that does not answer": ("import os; os.chdir(sys.argv[1])", 'cb.run("t/few", methods=["pixel", "sleeper"], records="records")'),
    "run it on two threads": ("import os; os.chdir(sys.argv[1])", 'cb.run("t/few", methods=["pixel", "sleeper"], threads=2, records="records")'),
    "calibrate": ('xy, size = views(300, "30x20:5")', 'cb.calibrate(xy, "30x20:5", size=size, model="opencv8", snoop=True)'),
    "judge": ('xy, size = views(150, "20x15:5")', 'cb.judge(xy, "20x15:5", size=size, splits=100)'),
    "judge photographs": (
        "import glob; photos = sorted(glob.glob(sys.argv[1] + '/*.png'))",
        'cb.judge(photos, "9x6:25", methods=["lsm:window=31", "parametric_corner:window=31"], splits=1000)',
    ),
    "detect": ("image = random.uniform(0, 1, (9000, 12000)).astype(np.float32)", 'cb.detect(image, "charuco:8x5:30:21:DICT_4X4_50")'),
    "detect a grid of circles": (
        "image = random.uniform(0, 1, (9000, 12000)).astype(np.float32)",
        'cb.detect(image, "circles:4x11:20")',
    ),
    "identify": ("image = random.uniform(0, 1, (9000, 12000)).astype(np.float32)", "cb.identify(image)"),
}

WATCHED = """
print("begins", flush=True)
try:
    {call}
except KeyboardInterrupt:
    assert small() == before
    print("interrupted", flush=True)
    sys.exit(3)
print("done", flush=True)
"""


def interrupted(script, *words):
    """Runs a script and interrupts it a while after it has said that it begins; what it said, its exit code, and how long it took to end."""
    process = subprocess.Popen([sys.executable, "-c", script, *map(str, words)], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begins\n"
        time.sleep(BEGUN)
        process.send_signal(signal.SIGINT)
        started = time.monotonic()
        said = process.communicate(timeout=120)[0]
        return said, process.returncode, time.monotonic() - started
    finally:
        process.kill()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A project with plug-ins that answer after a minute or do not greet, scenarios, and photographs of a board."""
    import warnings

    import numpy as np

    import calibench as cb

    folder = tmp_path_factory.mktemp("project")
    for name in ("scenarios/t", "reference", "methods"):
        (folder / name).mkdir(parents=True)
    answer = '"""Answers late."""\nimport json, sys, time\nprint(json.dumps({"version": "1"}), flush=True)\ntime.sleep(60)\n'
    (folder / "methods/sleeper.py").write_text(answer)
    (folder / "methods/silent.py").write_text('"""Never greets."""\nimport time\ntime.sleep(60)\n')
    for name in ("sleeper", "silent"):
        declared = f'[[plugin]]\nname = "{name}"\ncommand = ["{sys.executable}", "{name}.py"]\nseconds = 60\n'
        (folder / f"methods/{name}.toml").write_text(declared)
    scenario = (ROOT / f"scenarios/{SCENARIO}.toml").read_text()
    (folder / "scenarios/t/few.toml").write_text(scenario)
    (folder / "scenarios/t/silent.toml").write_text(scenario + '\n[[method]]\nname = "silent"\n')
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        shots = cb.render("testfields/chessboard", root=ROOT)
    cv2 = pytest.importorskip("cv2")
    for shot in shots:
        cv2.imwrite(str(folder / f"{shot.name}.png"), np.rint(shot.image * 255).astype(np.uint8))
    return folder


@pytest.mark.parametrize("work", WORKS)
def test_it_ends_soon_and_the_process_goes_on(work, folder):
    made, call = WORKS[work]
    there = sorted(path for path in folder.rglob("*"))
    said, code, seconds = interrupted(MADE + made + WATCHED.format(call=call), folder)
    assert (said, code) == ("interrupted\n", 3), said
    assert seconds < SOON, seconds
    assert sorted(path for path in folder.rglob("*")) == there
    running = subprocess.run(["pgrep", "-f", str(folder)], capture_output=True, text=True).stdout
    assert not running, "a plug-in outlives who asked it"


def test_what_other_threads_do_is_not_ended(folder):
    """Signals are the main thread's; what another one measures meanwhile is whole."""
    script = (
        MADE
        + WORKS["measure"][0]
        + """
xy_of_other, found = xy[:8_000], []
whole = cb.measure(image, xy_of_other[:50], "forstner").xy
other = threading.Thread(target=lambda: found.append(cb.measure(image, xy_of_other, "parametric_corner")))
other.start()
"""
        + WATCHED.format(call=WORKS["measure"][1]).replace("    sys.exit(3)", '    other.join()\n    assert found[0].status.count("measured") + found[0].status.count("rejected") == 8_000\n    sys.exit(3)')
    )
    said, code, _ = interrupted(script, folder)
    assert (said, code) == ("interrupted\n", 3), said


def test_a_pool_s_processes_end_too(folder):
    """An interruption of a terminal goes to all processes of the group."""
    made, call = WORKS["measure"]
    script = MADE + made + WATCHED.format(call=call)
    child = f"import subprocess, sys\nprint('begins', flush=True)\nsys.exit(subprocess.run([sys.executable, '-c', {script!r}, sys.argv[1]], stdout=subprocess.DEVNULL).returncode)"
    process = subprocess.Popen([sys.executable, "-c", child, str(folder)], stdout=subprocess.PIPE, text=True, start_new_session=True)
    assert process.stdout.readline() == "begins\n"
    time.sleep(BEGUN + 2)
    os.killpg(process.pid, signal.SIGINT)
    started = time.monotonic()
    process.communicate(timeout=120)
    assert time.monotonic() - started < SOON
