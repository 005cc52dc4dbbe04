"""What whole commands on points and cameras cost beside Python with pycolmap and OpenCV that does the same: a table in Markdown.

`just perf-networks` runs it, in target/peers. Each line is a process from its start to its end, files read and written; ours and the peer's take turns, and
the medians and ranges of ROUNDS rounds are printed, in seconds of the processor. `--before PROGRAM` puts an earlier build of calibench beside this one.
"""

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

import numpy as np
from commands import PEER, PROGRAM, spent

ROUNDS = 5
SIZE = (4000, 3000)
F = 3200.0
LENS = (-0.05, 0.01, 1e-4, -1e-4)
CAMERA = f"OPENCV {SIZE[0]} {SIZE[1]} {F} {F} {SIZE[0] / 2} {SIZE[1] / 2} " + " ".join(map(str, LENS))

#: COLMAP's own bundle to its end, and the covariance of all poses; calibench writes that of cameras and points too.
BUNDLE = """
import pathlib, sys, pycolmap
pycolmap.logging.minloglevel = 2
model = pycolmap.Reconstruction(sys.argv[2])
config = pycolmap.BundleAdjustmentConfig()
for image in model.images:
    config.add_image(image)
config.fix_gauge(pycolmap.BundleAdjustmentGauge.TWO_CAMS_FROM_WORLD)
options = pycolmap.BundleAdjustmentOptions(refine_principal_point=True, print_summary=False)
options.ceres.solver_options.num_threads = int(sys.argv[1])
adjuster = pycolmap.create_default_ceres_bundle_adjuster(options, config, model)
adjuster.solve()
covariance = pycolmap.estimate_ba_covariance(pycolmap.BACovarianceOptions(params=pycolmap.BACovarianceOptionsParams.POSES), model, adjuster)
assert covariance is not None
out = pathlib.Path(sys.argv[3])
out.mkdir(exist_ok=True)
model.write_text(str(out))
"""

#: What each image sees of the control: by image object coordinates and pixels.
SEEN = (
    PEER
    + """
import csv
with open(sys.argv[3]) as file:
    control = {row[0]: tuple(map(float, row[1:4])) for row in list(csv.reader(file))[1:]}
seen = {}
with open(sys.argv[2]) as file:
    rows = csv.reader(file)
    next(rows)
    for image, target, x, y in rows:
        objects, pixels = seen.setdefault(image, ([], []))
        objects.append(control[target])
        pixels.append((float(x), float(y)))
"""
)

#: Each image for itself, every point counts; nothing is sought and no precision is stated.
RESECT = (
    SEEN
    + f"""
matrix = np.array([[{F}, 0, {SIZE[0] / 2 - 0.5}], [0, {F}, {SIZE[1] / 2 - 0.5}], [0, 0, 1]])
lens = np.array({[*LENS, 0.0]})
with open(sys.argv[4], "w") as out:
    for image, (objects, pixels) in seen.items():
        _, rotation, shift = cv2.solvePnP(np.array(objects), np.array(pixels), matrix, lens)
        print(image, *rotation.ravel(), *shift.ravel(), sep=",", file=out)
"""
)

#: A list of cameras from text to bytes.
CONVERT = """
import pathlib, sys, pycolmap
pycolmap.logging.minloglevel = 2
model = pycolmap.Reconstruction()
model.read_text(sys.argv[2])
out = pathlib.Path(sys.argv[3])
out.mkdir(exist_ok=True)
model.write_binary(str(out))
"""

#: A board's corners by OpenCV, from a file to a file.
BOARD = (
    SEEN
    + """
objects, pixels = zip(*seen.values())
rms, camera, lens, _, _ = cv2.calibrateCamera([np.float32(o) for o in objects], [np.float32(p) for p in pixels], (4000, 3000), None, None)
file = cv2.FileStorage(sys.argv[4], cv2.FILE_STORAGE_WRITE)
file.write("camera_matrix", camera)
file.write("distortion_coefficients", lens)
"""
)


def rotation_about(axis, angle):
    """3 x 3."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def project(rotation, centre, points):
    """Pixels of COLMAP's frame, whose first pixel ends at (1, 1), and which of them lie in the frame."""
    inside = (points - centre) @ rotation.T
    x, y = inside[:, 0] / inside[:, 2], inside[:, 1] / inside[:, 2]
    k1, k2, p1, p2 = LENS
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * k2)
    u = F * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + SIZE[0] / 2
    v = F * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + SIZE[1] / 2
    return np.stack([u, v], axis=1), (inside[:, 2] > 0) & (u > 2) & (u < SIZE[0] - 2) & (v > 2) & (v < SIZE[1] - 2)


def block(columns, rows, points, seed=1):
    """Images that look down, 60 and 40 per cent overlapping, over rough ground of so many points: rotations, centres, points and what each image sees."""
    random = np.random.default_rng(seed)
    height, step = 100.0, (0.4 * SIZE[0] / F * 100.0, 0.5 * SIZE[1] / F * 100.0)
    extent = np.array([(columns - 1) * step[0], (rows - 1) * step[1]])
    places = np.column_stack([random.uniform(-20, extent[0] + 20, points), random.uniform(-20, extent[1] + 20, points), random.uniform(0, 15, points)])
    down = np.diag([1.0, -1.0, -1.0])
    poses, seen = [], []
    for i in range(columns * rows):
        axis = random.normal(size=3)
        turned = rotation_about(axis / np.linalg.norm(axis), random.normal(0, 0.03)) @ down
        centre = np.array([i % columns * step[0], i // columns * step[1], height]) + random.normal(0, 1.5, 3)
        pixels, visible = project(turned, centre, places)
        which = np.flatnonzero(visible)
        poses.append((turned, centre))
        seen.append((which, pixels[which] + random.normal(0, 0.5, (len(which), 2))))
    return poses, places, seen


def quaternion(rotation):
    """w, x, y, z."""
    w = 0.5 * np.sqrt(max(0.0, 1 + np.trace(rotation)))
    if w > 1e-3:
        return [w, *(np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]) / (4 * w))]
    values, vectors = np.linalg.eigh((rotation + rotation.T) / 2)
    return [w, *vectors[:, np.argmax(values)]]


def write_model(folder, poses, places, seen, seed=2):
    """COLMAP's text model with values somewhat off."""
    random = np.random.default_rng(seed)
    folder.mkdir()
    (folder / "cameras.txt").write_text(f"1 {CAMERA.replace(str(F), str(F + 3))}\n")
    tracks = [[] for _ in places]
    for i, (which, _) in enumerate(seen, 1):
        for place, point in enumerate(which):
            tracks[point].append((i, place))
    with open(folder / "images.txt", "w") as images:
        for i, ((rotation, centre), (which, pixels)) in enumerate(zip(poses, seen), 1):
            axis = random.normal(size=3)
            off = rotation_about(axis / np.linalg.norm(axis), 3e-4) @ rotation
            shift = -off @ (centre + random.normal(0, 0.05, 3))
            images.write(f"{i} {' '.join(repr(float(value)) for value in [*quaternion(off), *shift])} 1 {i:04}.jpg\n")
            images.write(" ".join(f"{x:.4f} {y:.4f} {point + 1 if len(tracks[point]) >= 2 else -1}" for point, (x, y) in zip(which, pixels)) + "\n")
    with open(folder / "points3D.txt", "w") as points:
        for point, track in enumerate(tracks):
            if len(track) >= 2:
                at = places[point] + random.normal(0, 0.05, 3)
                points.write(f"{point + 1} {at[0]} {at[1]} {at[2]} 0 0 0 0.5 " + " ".join(f"{i} {place}" for i, place in track) + "\n")
    return sum(len(track) for track in tracks if len(track) >= 2)


def write_control(folder, name, poses, places, seen):
    """Measured points and control, as CSV, origin at the centre of the first pixel."""
    with open(folder / f"{name}.csv", "w") as points:
        points.write("image,target,x,y\n")
        for i, (which, pixels) in enumerate(seen, 1):
            points.writelines(f"{i:04}.jpg,{point},{x - 0.5:.4f},{y - 0.5:.4f}\n" for point, (x, y) in zip(which, pixels))
    with open(folder / f"{name}-control.csv", "w") as control:
        control.write("target,X,Y,Z\n")
        control.writelines(f"{i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(places))
    return sum(len(which) for which, _ in seen)


def board(views, seed=3):
    """Views of 9 x 6 corners of 30 mm."""
    random = np.random.default_rng(seed)
    places = np.column_stack([np.tile(np.arange(9), 6) * 30.0, np.repeat(np.arange(6), 9) * 30.0, np.zeros(54)])
    seen, poses = [], []
    while len(seen) < views:
        axis = np.array([*random.normal(size=2), 0.0])
        turned = rotation_about([0, 0, 1], random.uniform(-3, 3)) @ rotation_about(axis / np.linalg.norm(axis), random.uniform(0.2, 0.6)) @ np.diag([1.0, -1.0, -1.0])
        middle = np.array([120.0, 75.0, 0.0])
        centre = middle - turned.T @ np.array([*random.uniform(-80, 80, 2), random.uniform(300, 450)])
        pixels, visible = project(turned, centre, places)
        if visible.all():
            poses.append((turned, centre))
            seen.append((np.arange(54), pixels + random.normal(0, 0.2, pixels.shape)))
    return poses, places, seen


class Table:
    """Rows of a table, printed as they come."""

    def __init__(self, folder, before):
        self.folder, self.before = folder, before
        print(f"Seconds of the processor, one thread, medians of {ROUNDS} with their ranges, in turn.\n")
        print(f"| command | calibench |{' before | gained |' if before else ''} the peer | times | MB |")
        print(f"|---|--:|{'--:|--:|' if before else ''}--:|--:|--:|")

    def row(self, what, words, script, *theirs):
        """`words` follow the program; `theirs` the script and its number of threads."""
        mine, old, peer = [], [], []
        for _ in range(ROUNDS):
            mine.append(spent([PROGRAM, *words, "--threads", 1, "--quiet"], self.folder))
            if self.before:
                old.append(spent([self.before, *words, "--threads", 1, "--quiet"], self.folder)[0])
            peer.append(spent([sys.executable, "-c", script, 1, *theirs], self.folder)[0])

        def told(seconds):
            return f"{statistics.median(seconds):.2f} ({min(seconds):.2f} to {max(seconds):.2f})"

        spent_by_us = [run[0] for run in mine]
        ours = statistics.median(spent_by_us)
        earlier = f" {told(old)} | {statistics.median(old) / ours:.2f} |" if self.before else ""
        print(f"| {what} | {told(spent_by_us)} |{earlier} {told(peer)} | {statistics.median(peer) / ours:.2f} | {max(run[2] for run in mine):.0f} |", flush=True)


def main(folder, before, only):
    def wanted(name):
        return only is None or name in only

    table = Table(folder, before)
    for name, columns, rows, points in [("bundle", 20, 10, 14_000), ("bundle-1000", 40, 25, 108_000)]:
        if wanted(name):
            count = write_model(folder / name, *block(columns, rows, points))
            table.row(
                f"`calibrate --reconstruction`, {columns * rows} images, {count:,} image points (pycolmap's bundle, covariance of poses)",
                ["calibrate", "--reconstruction", name, "--adjusted", f"{name}-ours", "-o", "camera.json"],
                BUNDLE,
                name,
                f"{name}-theirs",
            )
    if wanted("resect"):
        count = write_control(folder, "resect", *block(20, 10, 170_000))
        (folder / "camera.txt").write_text(f"# Camera list with one line of data per camera:\n1 {CAMERA}\n")
        files = ["--camera", "camera.txt", "--points", "resect.csv", "--control", "resect-control.csv"]
        for what, more in [("nothing left out", []), ("gross errors sought", ["--tolerance", "3"])]:
            table.row(f"`resect` of {count:,} rows, {what} (`solvePnP`)", ["resect", *files, *more, "-o", "poses.csv"], RESECT, "resect.csv", "resect-control.csv", "theirs.csv")
    if wanted("convert"):
        cameras = folder / "cameras"
        cameras.mkdir()
        random = np.random.default_rng(5)
        with open(cameras / "cameras.txt", "w") as file:
            for i in range(100_000):
                f, cx, cy = random.normal([F, SIZE[0] / 2, SIZE[1] / 2], 5)
                file.write(f"{i + 1} OPENCV {SIZE[0]} {SIZE[1]} {f} {f} {cx} {cy} " + " ".join(map(str, random.normal(LENS, 1e-3))) + "\n")
        for empty in ("images.txt", "points3D.txt", "rigs.txt", "frames.txt"):
            (cameras / empty).write_text("")
        table.row("`convert --all` of 100,000 cameras, COLMAP's text to bytes (pycolmap)", ["convert", "cameras/cameras.txt", "--all", "--to", "colmap", "-o", "cameras.bin"], CONVERT, "cameras", "binary")
    for views in (17, 100, 1000):
        if wanted("board"):
            name = f"board-{views}"
            write_control(folder, name, *board(views))
            files = ["--points", f"{name}.csv", "--control", f"{name}-control.csv"]
            table.row(f"`calibrate` from points, {views} views of 54 (`calibrateCamera`)", ["calibrate", *files, "--size", f"{SIZE[0]}x{SIZE[1]}", "-o", "camera.xml"], BOARD, f"{name}.csv", f"{name}-control.csv", "theirs.xml")


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--before", type=Path, help="an earlier build's program")
    options.add_argument("--only", nargs="*", help="bundle, bundle-1000, resect, convert, board")
    options.add_argument("--keep", type=Path, help="the folder of all files, in place of one that goes")
    chosen = options.parse_args()
    if chosen.keep:
        chosen.keep.mkdir(parents=True)
        main(chosen.keep, chosen.before, chosen.only)
    else:
        with tempfile.TemporaryDirectory() as there:
            main(Path(there), chosen.before, chosen.only)
