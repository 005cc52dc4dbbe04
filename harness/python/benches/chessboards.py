"""How often chessboards are found, by us and by OpenCV, in the same 500 pictures and in frames of 12 megapixels: tables in Markdown.

`just perf-boards` runs it. The pictures are drawn here with OpenCV, not by calibench: boards of many sizes, tilted to 70 degrees, blurred, noisy, in uneven
light, with wide outer squares; a fifth of them is covered in part or reaches out of the image, where nothing is to be found.
"""

import multiprocessing
import time

import cv2
import numpy as np

import calibench as cb

WIDTH, HEIGHT = 800, 600
FINE = 4
SQUARE = 48


def texture(columns, rows, wide):
    """A board with its rim, FINE-grained, and its inner corners in it; outer squares are `wide` times as wide."""
    edges = [np.cumsum([0.0, wide, *np.ones(n - 1), wide]) for n in (columns, rows)]
    u, v = [np.round(SQUARE * (edge + 1.0)) for edge in edges]
    sheet = np.full((int(v[-1] + SQUARE), int(u[-1] + SQUARE)), 0.9, np.float32)
    for row in range(rows + 1):
        for column in range(columns + 1):
            if (row + column) % 2 == 0:
                sheet[int(v[row]) : int(v[row + 1]), int(u[column]) : int(u[column + 1])] = 0.08
    corners = np.array([[x - 0.5, y - 0.5] for y in v[1:-1] for x in u[1:-1]])
    return sheet, corners


def homography(random, sheet, tilt, fill, width, height):
    """The sheet tilted and turned, `fill` of the image's height high, in its middle."""
    h, w = sheet.shape
    turn, about = random.uniform(-np.pi, np.pi), random.uniform(-np.pi, np.pi)
    axis = np.array([np.cos(about), np.sin(about), 0.0]) * np.radians(tilt)
    rotation = cv2.Rodrigues(axis)[0] @ cv2.Rodrigues(np.array([0.0, 0.0, turn]))[0]
    far = 2.2 * np.hypot(w, h)
    plane = rotation[:, :2] @ np.array([[1, 0, -w / 2], [0, 1, -h / 2]])
    project = np.vstack([plane[0], plane[1], (plane[2] + [0, 0, far]) / far])
    rim = np.array([[0, 0, 1], [w, 0, 1], [w, h, 1], [0, h, 1]]) @ project.T
    rim = rim[:, :2] / rim[:, 2:]
    low, high = rim.min(0), rim.max(0)
    scale = fill * min(width / (high - low)[0], height / (high - low)[1])
    middle = np.array([width / 2, height / 2]) - scale * (low + high) / 2
    return np.array([[scale, 0, middle[0]], [0, scale, middle[1]], [0, 0, 1]]) @ project


def draw(random, sheet, corners, width, height, tilt, fill, blur, noise, light):
    """An 8-bit picture of the sheet and where its corners are."""
    to_image = homography(random, sheet, tilt, fill, width, height)
    fine = np.array([[FINE, 0, (FINE - 1) / 2], [0, FINE, (FINE - 1) / 2], [0, 0, 1]])
    size = (FINE * width, FINE * height)
    picture = cv2.warpPerspective(sheet, fine @ to_image, size, flags=cv2.INTER_LINEAR, borderValue=0.45)
    picture = cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)
    picture = cv2.GaussianBlur(picture, (0, 0), blur)
    x, y = np.meshgrid(np.linspace(-1, 1, width), np.linspace(-1, 1, height))
    about = random.uniform(-np.pi, np.pi)
    along = 0.5 + 0.5 * (x * np.cos(about) + y * np.sin(about)) / np.sqrt(2)
    picture = picture * ((1 - light) + light * along) + random.normal(0, noise, picture.shape)
    truth = np.c_[corners, np.ones(len(corners))] @ to_image.T
    return (255 * np.clip(picture, 0, 1)).round().astype(np.uint8), truth[:, :2] / truth[:, 2:]


def ours(image, columns, rows):
    found = cb.detect(image, f"{columns}x{rows}")
    return None if found is None else found.xy


def classic(image, columns, rows):
    found, corners = cv2.findChessboardCorners(image, (columns, rows))
    return corners.reshape(-1, 2) if found else None


def sectors(image, columns, rows):
    found, corners = cv2.findChessboardCornersSB(image, (columns, rows))
    return corners.reshape(-1, 2) if found else None


DETECTORS = {"calibench": ours, "findChessboardCorners": classic, "findChessboardCornersSB": sectors}


def pictures(count):
    """What is drawn: (group, image, truth or None, columns, rows)."""
    random = np.random.default_rng(7)
    for index in range(count):
        columns, rows = int(random.integers(4, 13)), int(random.integers(3, 10))
        wide = random.uniform(1.2, 1.8) if index % 5 == 1 else 1.0
        sheet, corners = texture(columns, rows, wide)
        tilt = random.uniform(0, 70)
        blur, noise = random.choice([0.4, 0.7, 1.0, 1.5]), random.choice([0.0, 0.01, 0.03])
        light = random.uniform(0.5, 0.85) if index % 5 == 2 else 0.0
        hidden = index % 5 == 3
        fill = random.uniform(0.6, 0.95)
        image, truth = draw(random, sheet, corners, WIDTH, HEIGHT, tilt, fill, blur, noise, light)
        if hidden:
            covered = truth[random.integers(len(truth))]
            cv2.circle(image, tuple(int(at) for at in covered), int(0.1 * HEIGHT), 110, -1)
        group = ["plain", "wide outer squares", "uneven light", "hidden in part", "plain"][index % 5]
        yield group, image, None if hidden else truth, columns, rows


def verdict(found, truth):
    """found, missed or wrong: all corners within 2 px of the true ones, each once."""
    if found is None:
        return "none"
    if truth is None or len(found) != len(truth):
        return "wrong"
    off = np.linalg.norm(found[:, None] - truth[None], axis=2)
    return "found" if off.min(1).max() < 2.0 and len(set(off.argmin(1))) == len(truth) else "wrong"


def many(count):
    """Counts by group and detector."""
    counts, seconds = {}, {name: [] for name in DETECTORS}
    for group, image, truth, columns, rows in pictures(count):
        for name, detect in DETECTORS.items():
            start = time.perf_counter()
            found = detect(image, columns, rows)
            seconds[name].append(time.perf_counter() - start)
            key = (group, name, verdict(found, truth))
            counts[key] = counts.get(key, 0) + 1
    groups = list(dict.fromkeys(group for group, _, _ in counts))
    print(f"| {count} pictures of {WIDTH} x {HEIGHT} px | pictures | " + " | ".join(f"{name}: found, wrong" for name in DETECTORS) + " |")
    print("|---|--:|" + "--:|" * len(DETECTORS))
    for group in groups:
        of = [[counts.get((group, name, what), 0) for what in ("found", "wrong", "none")] for name in DETECTORS]
        print(f"| {group} | {sum(of[0])} | " + " | ".join(f"{found}, {wrong}" for found, wrong, _ in of) + " |")
    print("| ms a picture, median; longest | | " + " | ".join(f"{1e3 * np.median(t):.1f}; {1e3 * max(t):.0f}" for t in seconds.values()) + " |")


#: A search that takes longer than this is stopped, seconds.
LONGEST = 60


def timed(detect, image, rounds, told):
    """Median seconds of a detector, and whether it found the board."""
    times = []
    while len(times) < rounds and sum(times) < 10:
        start = time.perf_counter()
        found = detect(image, 9, 6)
        times.append(time.perf_counter() - start)
    told.put((np.median(times), found is not None))


def cell(detect, image, rounds=5):
    """Milliseconds, as a cell of the table; in a process of its own, which can be stopped."""
    told = multiprocessing.Queue()
    process = multiprocessing.Process(target=timed, args=(detect, image, rounds, told))
    process.start()
    process.join(LONGEST)
    if process.is_alive():
        process.kill()
        return f"over {1000 * LONGEST}"
    seconds, found = told.get()
    return f"{1e3 * seconds:.0f}{'' if found else ' (none)'}"


def large():
    """Milliseconds in frames of 12 megapixels, with and without a board."""
    random = np.random.default_rng(3)
    frames = {}
    for tilt in (10, 40):
        sheet, corners = texture(9, 6, 1.0)
        frames[f"9 x 6, tilted by {tilt} degrees"], _ = draw(random, sheet, corners, 4000, 3000, tilt, 0.6, 1.2, 0.01, 0.3)
    frames["no board, noise"] = (255 * np.clip(random.normal(0.5, 0.02, (3000, 4000)), 0, 1)).astype(np.uint8)
    blobs = cv2.GaussianBlur(random.normal(0, 1, (3000, 4000)).astype(np.float32), (0, 0), 9)
    frames["no board, smooth blobs"] = (255 * np.clip(0.5 + 3 * blobs, 0, 1)).astype(np.uint8)
    print("\n| ms, 4000 x 3000 px | " + " | ".join(DETECTORS) + " |")
    print("|---|" + "--:|" * len(DETECTORS))
    for what, image in frames.items():
        print(f"| {what} | " + " | ".join(cell(detect, image) for detect in DETECTORS.values()) + " |", flush=True)


if __name__ == "__main__":
    cv2.setNumThreads(1)
    print(f"calibench {cb.__version__}, OpenCV {cv2.__version__}, one thread\n")
    many(500)
    large()
