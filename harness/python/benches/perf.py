"""What the package costs beyond the program: seconds of a call, of copies, and what a second thread gains, beside the command line.

    just perf-python
"""

import csv
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "target/release/calibench"
ROUNDS = 5
POINTS = 20_000
METHOD = "parametric_corner:window=15"

#: Runs in a process of its own, whose threads RAYON_NUM_THREADS gives.
CALLS = f"""
import sys, time
import numpy as np, calibench as cb
image = np.load(sys.argv[1])
xy = np.load(sys.argv[2])
def best(call, rounds={ROUNDS}):
    times = []
    for _ in range(rounds):
        start = time.perf_counter(); call(); times.append(time.perf_counter() - start)
    return sorted(times)[len(times) // 2]
print(best(lambda: cb.measure(image, xy, "{METHOD}", kind="chess_corner")))
"""


def median(work, rounds=ROUNDS):
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def gain(seconds_on):
    """What a second thread gains: seconds on one over seconds on two, interleaved."""
    pairs = [(seconds_on(1), seconds_on(2)) for _ in range(ROUNDS)]
    return statistics.median(one for one, _ in pairs) / statistics.median(two for _, two in pairs), statistics.median(one for one, _ in pairs)


def imports():
    def seconds(code):
        return median(lambda: subprocess.run([sys.executable, "-c", code], check=True), 15)

    return seconds("import numpy, calibench") - seconds("import numpy")


def main():
    import numpy as np

    import calibench as cb

    print(f"calibench {cb.__version__}, numpy {np.__version__}, {os.cpu_count()} cores; medians of {ROUNDS}\n")
    print(f"import beyond numpy                    {1e3 * imports():8.1f} ms")
    small = np.full((480, 640), 0.5, np.float32)
    point = np.array([[320.0, 240.0]])
    calls = 2000

    def call(image):
        return median(lambda: [cb.measure(image, point, "pixel") for _ in range(calls)], 3) / calls

    tiny = np.full((8, 8), 0.5, np.float32)
    print(f"a call, one point of 8 x 8             {1e6 * call(tiny):8.1f} us")
    print(f"the same of 640 x 480, float32         {1e6 * call(small):8.1f} us (not copied)")
    print(f"the same of 640 x 480, uint8           {1e6 * call((small * 255).astype(np.uint8)):8.1f} us")
    camera = cb.render("testfields/chessboard", root=ROOT)[0].camera
    ray = np.array([[0.0, 0.0, 1.0]])
    print(f"a point projected                      {1e6 * median(lambda: [camera.project(ray) for _ in range(calls)], 3) / calls:8.1f} us")
    rays = np.random.default_rng(1).uniform([-0.4, -0.3, 1], [0.4, 0.3, 1], (1_000_000, 3))
    print(f"a million points projected             {1e3 * median(lambda: camera.project(rays)):8.1f} ms")
    with tempfile.TemporaryDirectory() as folder:
        threads(np, Path(folder))


def threads(np, folder):
    """Corners of a large rendered board, by the package and by the command line."""
    import calibench as cb

    shots = cb.render("testfields/chessboard", root=ROOT)
    shot = shots[0]
    starts = shot.starts.xy
    xy = np.tile(starts, (POINTS // len(starts) + 1, 1))[:POINTS] + np.random.default_rng(1).uniform(-0.3, 0.3, (POINTS, 2))
    np.save(folder / "image.npy", shot.image)
    np.save(folder / "xy.npy", xy)
    subprocess.run([PROGRAM, "render", "testfields/chessboard", "--station", shot.name, "-o", folder / "pictures"], cwd=ROOT, check=True, capture_output=True)
    with open(folder / "points.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["image", "target", "x", "y", "kind"])
        table.writerows([f"{shot.name}.png", str(i), repr(float(x)), repr(float(y)), "chess_corner"] for i, (x, y) in enumerate(xy))

    def package(count):
        words = [sys.executable, "-c", CALLS, folder / "image.npy", folder / "xy.npy"]
        environment = {**os.environ, "RAYON_NUM_THREADS": str(count)}
        return float(subprocess.run(words, check=True, capture_output=True, text=True, env=environment, cwd=folder).stdout)

    def program(count):
        words = [PROGRAM, "measure", folder / f"pictures/{shot.name}.png", "--points", folder / "points.csv", "-m", METHOD]
        words += ["-o", folder / "out.csv", "--threads", str(count), "--quiet"]
        start = time.perf_counter()
        subprocess.run(words, check=True, capture_output=True, cwd=folder)
        return time.perf_counter() - start

    ours, seconds = gain(package)
    theirs, whole = gain(program)
    print(f"{POINTS} corners, {METHOD}: {seconds:.3f} s on one thread, a second one gains {ours:.2f}")
    print(f"the same as a whole command            {whole:.3f} s on one thread, a second one gains {theirs:.2f}")
    print(f"the package gains {100 * ours / theirs:.0f} % of what the command line gains")


if __name__ == "__main__":
    main()
