"""What whole commands cost beside Python scripts with OpenCV that do the same, and how they grow: tables in Markdown.

`just perf-commands` runs it. Each line is a process from its start to its end, files read and written; ours and the peer's take turns, and the medians
of ROUNDS rounds are printed, in seconds of the processor unless it says otherwise; `--no-growth` leaves the second table out.
"""

import csv
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "target/release/calibench"
DATA = ROOT.parent / "shared/data"
ROUNDS = 5

PEER = "import cv2, numpy as np, sys, glob; cv2.setNumThreads(int(sys.argv[1]))\n"

#: cornerSubPix as `measure` is asked: the same file, the same starts, a file of results.
MEASURE = PEER + """
image = cv2.imread(sys.argv[2], cv2.IMREAD_GRAYSCALE)
starts = np.loadtxt(sys.argv[3], delimiter=",", skiprows=1, usecols=(2, 3)).astype(np.float32).reshape(-1, 1, 2).copy()
found = cv2.cornerSubPix(image, starts, (7, 7), (-1, -1), (3, 40, 1e-3))
np.savetxt(sys.argv[4], found.reshape(-1, 2), fmt="%.6f", delimiter=",")
"""

#: A chessboard in photographs, to a camera file.
CALIBRATE = PEER + """
columns, rows = int(sys.argv[4]), int(sys.argv[5])
board = np.zeros((rows * columns, 3), np.float32)
board[:, :2] = np.mgrid[:columns, :rows].T.reshape(-1, 2) * 25
points, corners = [], []
for path in sorted(glob.glob(sys.argv[2])):
    image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
    if sys.argv[6] == "sb":
        found, at = cv2.findChessboardCornersSB(image, (columns, rows))
    else:
        found, at = cv2.findChessboardCorners(image, (columns, rows))
        if found:
            at = cv2.cornerSubPix(image, at, (5, 5), (-1, -1), (3, 40, 1e-3))
    if found:
        points.append(board)
        corners.append(at)
rms, camera, distortion, _, _ = cv2.calibrateCamera(points, corners, image.shape[::-1], None, None)
file = cv2.FileStorage(sys.argv[3], cv2.FILE_STORAGE_WRITE)
file.write("camera_matrix", camera)
file.write("distortion_coefficients", distortion)
print(len(points))
"""

#: A board of 12 megapixels without a lens: a texture four times as fine, warped, reduced, blurred, noisy.
RENDER = PEER + """
squares = np.kron(np.add.outer(np.arange(9), np.arange(12)) % 2, np.ones((400, 400), np.float32)) * 0.7 + 0.15
to = np.array([[3.2, 0.1, 900.0], [-0.1, 3.1, 600.0], [1e-6, 2e-6, 1.0]])
image = cv2.warpPerspective(squares, to, (16000, 12000), flags=cv2.INTER_LINEAR, borderValue=0.5)
image = cv2.GaussianBlur(cv2.resize(image, (4000, 3000), interpolation=cv2.INTER_AREA), (0, 0), 0.7)
image += np.random.default_rng(1).normal(0, 0.01, image.shape).astype(np.float32)
cv2.imwrite(sys.argv[2], (255 * np.clip(image, 0, 1) + 0.5).astype(np.uint8))
"""


def scenario(size, squares=(12, 9), pointing="", trials=1, tilts=1, methods='[[method]]\nname = "forstner"\n'):
    """A chessboard that fills about the frame."""
    width, height = size
    rows, columns = squares[1] - 1, squares[0] - 1
    pitch, c = 4.0, 4.0e-3 * max(width, height)
    side = 25.0
    distance = max(side * (columns + 1) / (0.8 * width), side * (rows + 1) / (0.8 * height)) * c / (1e-3 * pitch)
    several = ", ".join(str([round(30 * math.cos(0.7 * i)), round(30 * math.sin(1.1 * i))]) for i in range(tilts))
    return f"""why = "How long commands take."
source = "ours"
seed = 3
trials = {trials}

[camera]
size = [{width}, {height}]
pitch = {pitch}
c = {c}
x0 = 0.0
y0 = 0.0
k1 = {-0.05 / (c * c)}

[testfield]
kind = "chessboard"
unit = "mm"
rows = {rows}
columns = {columns}
square = {side}

[stations]
kind = "board"
tilts = [{several}]
distances = [{distance}]
rolls = [0]

[optics]
blur = 0.7

[sensor]
full_well = 12000
read_noise = 12
adc_bits = 8

[pointing]
sigma = 0.5
whole_pixels = false

{methods}"""


def spent(words, folder):
    """Seconds of the processor and of the clock, and megabytes, of a process."""
    with open(folder / "said.txt", "w") as said:
        start = time.perf_counter()
        process = subprocess.Popen([str(word) for word in words], cwd=folder, stdout=said, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        clock = time.perf_counter() - start
    # 3: done, with something in doubt, which is said.
    if os.waitstatus_to_exitcode(status) not in (0, 3):
        raise RuntimeError(f"{' '.join(map(str, words))}\n{(folder / 'said.txt').read_text()}")
    return usage.ru_utime + usage.ru_stime, clock, usage.ru_maxrss / 1024


def ours(*words, threads=1):
    return [PROGRAM, *words, "--threads", threads, "--quiet"]


def theirs(script, *words, threads=1):
    return [sys.executable, "-c", script, threads, *words]


def side_by_side(what, folder, mine, other=None):
    """One line: mine and the other's in turn, and mine on two threads."""
    one, two, peer = [], [], []
    for _ in range(ROUNDS):
        one.append(spent(mine(1), folder))
        if other:
            peer.append(spent(other(1), folder)[0])
        two.append(spent(mine(2), folder)[1])
    processor, clock = (statistics.median(run[which] for run in one) for which in (0, 1))
    gain = clock / statistics.median(two)
    ratio = f"{statistics.median(peer):.2f} | {statistics.median(peer) / processor:.2f}" if peer else " | "
    print(f"| {what} | {processor:.2f} | {ratio} | {gain:.2f} | {statistics.median(run[2] for run in one):.0f} |", flush=True)


def pictures(folder, name, text):
    """A scenario and its images."""
    (folder / f"{name}.toml").write_text(text)
    spent(ours("render", f"{name}.toml", "-o", name, threads=2), folder)
    return sorted(str(path) for path in (folder / name).glob("s*.png"))


def starts(folder, name, photograph, count):
    """A file of `count` starts in one photograph: those of its targets, over and over."""
    with open(folder / name / "starts.csv") as file:
        rows = [row for row in csv.DictReader(file) if row["image"] == Path(photograph).name]
    fields = ["image", "target", "x", "y", *[key for key in rows[0] if key not in ("image", "target", "x", "y")]]
    path = folder / f"{name}-{count}.csv"
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, fields)
        table.writeheader()
        table.writerows({**rows[i % len(rows)], "target": str(i)} for i in range(count))
    return path


def commands(folder):
    print(f"Seconds of the processor, one thread, medians of {ROUNDS}; beside Python with OpenCV.\n")
    print("| command | calibench | the peer | times | two threads gain (clock) | MB |")
    print("|---|--:|--:|--:|--:|--:|")
    (folder / "large.toml").write_text(scenario((4000, 3000)))
    side_by_side(
        "`render`, a board in 12 megapixels with lens, blur and noise (the peer: without lens)",
        folder,
        lambda n: ours("render", "large.toml", "-o", "large-again", threads=n),
        lambda n: theirs(RENDER, "peer.png", threads=n),
    )
    (folder / "huge.toml").write_text(scenario((11600, 8700)))
    side_by_side("`render`, the same in 101 megapixels", folder, lambda n: ours("render", "huge.toml", "-o", "huge-again", threads=n))
    (folder / "stations.toml").write_text(scenario((1600, 1200), tilts=60))
    side_by_side("`render`, 60 stations of 2 megapixels", folder, lambda n: ours("render", "stations.toml", "-o", "stations-again", threads=n))
    fine = pictures(folder, "fine", scenario((4000, 3000), (112, 84)))
    points = starts(folder, "fine", fine[0], 10_000)
    for method in ("forstner", "parametric_corner:window=15", "lsm:window=15"):
        side_by_side(
            f"`measure` of 10,000 corners in 12 megapixels, `{method}` (cornerSubPix 15 x 15)",
            folder,
            lambda n, method=method: ours("measure", fine[0], "--points", points, "-m", method, "-o", "measured.csv", threads=n),
            lambda n: theirs(MEASURE, fine[0], points, "subpix.csv", threads=n),
        )
    left = sorted(str(path) for path in (DATA / "opencv-left").glob("*.jpg"))
    sixty = pictures(folder, "sixty", scenario((4000, 3000), (10, 7), tilts=60))
    for what, photographs, pattern in [("13 photographs", left, DATA / "opencv-left/*.jpg"), ("60 of 12 megapixels", sixty, folder / "sixty/s*.png")]:
        for detector, name in [("classic", "findChessboardCorners"), ("sb", "findChessboardCornersSB")]:
            if not photographs:
                print(f"| `calibrate` of {what} | skipped: not there | | | | |")
                continue
            side_by_side(
                f"`calibrate` of {what} ({name}, cornerSubPix, calibrateCamera)".replace("SB, cornerSubPix", "SB"),
                folder,
                lambda n, photographs=photographs: ours("calibrate", *photographs, "--board", "9x6:25", "-o", "camera.xml", threads=n),
                lambda n, pattern=pattern, detector=detector: theirs(CALIBRATE, pattern, "peer.xml", 9, 6, detector, threads=n),
            )
    if left:
        side_by_side("`judge` of 13 photographs", folder, lambda n: ours("judge", *left, "--chessboard", "9x6:25", "--report", "judged", threads=n))
    for words in (["list", "scenarios"], ["show", "testfields/chessboard"], ["--help"]):
        side_by_side(f"`{' '.join(words)}`", folder, lambda n, words=words: [PROGRAM, "--root", ROOT, *words])


def growth(folder):
    """Exponents of time over size: 1 is proportional."""
    print("\n| grows with | sizes | s of the processor, one thread | exponent |")
    print("|---|---|---|--:|")

    def line(what, sizes, words):
        seconds = [statistics.median(spent(words(size), folder)[0] for _ in range(3)) for size in sizes]
        # Over the last decade, where the start of the program no longer counts.
        exponent = math.log(seconds[-1] / seconds[-2]) / math.log(sizes[-1] / sizes[-2])
        print(f"| {what} | {', '.join(f'{size:,}' for size in sizes)} | {', '.join(f'{s:.2f}' for s in seconds)} | {exponent:.2f} |", flush=True)

    def rendered(megapixels):
        width = int(math.sqrt(megapixels * 4 / 3 * 1e6))
        name = f"growth-{megapixels}.toml"
        (folder / name).write_text(scenario((width, int(megapixels * 1e6 / width))))
        return ours("render", name, "-o", "growth")

    line("`render`, megapixels", [1, 10, 100, 400], rendered)
    fine = sorted(str(path) for path in (folder / "fine").glob("s*.png"))
    for method in ("forstner", "parametric_corner:window=15"):
        line(
            f"`measure`, points, `{method}`",
            [10, 1000, 100_000, 1_000_000],
            lambda count, method=method: ours("measure", fine[0], "--points", starts(folder, "fine", fine[0], count), "-m", method, "-o", "measured.csv"),
        )
    small = pictures(folder, "small", scenario((640, 480), (10, 7), tilts=1000))
    line("`calibrate`, photographs of 640 x 480", [10, 100, 1000], lambda count: ours("calibrate", *small[:count], "--board", "9x6:25", "-o", "camera.xml"))

    def run(trials):
        (folder / "project/scenarios/grow").mkdir(parents=True, exist_ok=True)
        (folder / "project/reference").mkdir(exist_ok=True)
        (folder / "project/scenarios/grow/trials.toml").write_text(scenario((200, 150), (6, 5)))
        return ours("--root", folder / "project", "run", "grow/trials", "--trials", trials)

    line("`run`, trials of 20 corners in 200 x 150", [100, 1000, 10_000, 100_000], run)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as there:
        commands(Path(there))
        if "--no-growth" not in sys.argv:
            growth(Path(there))
