"""The protocol of calibrators, docs/calibrators.md: a line asked, a line answered. Import it first: what a library prints goes to standard error from then on,
and a library that is not there is said."""
import contextlib
import io
import json
import math
import os
import sys
import warnings

METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254}
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def say(answer):
    print(json.dumps(answer), file=answers, flush=True)


def missing(kind, error, _):
    sys.stdin.readline()
    say({"error": short(error)})


sys.excepthook = missing


def short(said):
    """A text, or an exception with its name, in a line."""
    text = f"{type(said).__name__}: {said}" if isinstance(said, BaseException) else said
    return " ".join(text.split())[:300]


def serve(version, calibrate):
    """Answers every task with what `calibrate(task)` returns: {"status": "calibrated"} and what it adds. What it raises has failed; what it warns of is a message."""
    sys.excepthook = sys.__excepthook__
    sys.stdin.readline()
    say({"version": version})
    for line in sys.stdin:
        task = json.loads(line)
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            warnings.simplefilter("ignore", DeprecationWarning)
            try:
                answer = {"status": "calibrated", **calibrate(task)}
            except Exception as error:
                answer = {"status": "failed", "messages": [short(error)]}
        answer = without_nan({"task": task["task"], **answer})
        answer["messages"] = answer.get("messages", []) + list(dict.fromkeys(short(warning.message) for warning in warned))
        if any(None in row for row in answer.get("covariance", {}).get("matrix", [])):
            answer["messages"].append("its covariance is not finite")
            del answer["covariance"]
        say(answer)


def without_nan(value):
    """Numbers as JSON has them: what is not finite is null in lists, and left out of groups."""
    if isinstance(value, dict):
        pairs = ((key, without_nan(of)) for key, of in value.items())
        return {key: of for key, of in pairs if of is not None}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [without_nan(of) for of in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def views(task):
    """Of the images that show points: names, places in `points`, object coordinates and image coordinates, four lists."""
    seen = [image for image in task["images"] if image["points"]]
    places = [[int(place) for place, _, _ in image["points"]] for image in seen]
    objects = [[task["points"][place][1:4] for place in of] for of in places]
    return [image["name"] for image in seen], places, objects, [[xy for _, *xy in image["points"]] for image in seen]


def grid(points):
    """Of a plane grid: its spacing, columns and rows, and of each point its (row, column)."""
    xs, ys, zs = zip(*((x, y, z) for _, x, y, z in points))
    steps = sorted({round(x, 9) for x in xs})
    spacing = min((b - a for a, b in zip(steps, steps[1:])), default=0) or 1
    cells = [((y - min(ys)) / spacing, (x - min(xs)) / spacing) for x, y in zip(xs, ys)]
    if max(zs) > min(zs) or any(abs(v - round(v)) > 1e-6 for cell in cells for v in cell):
        raise ValueError("takes a plane grid of one spacing, and no other control")
    cells = [(round(row), round(column)) for row, column in cells]
    return spacing, max(c for _, c in cells) + 1, max(r for r, _ in cells) + 1, cells


@contextlib.contextmanager
def printed():
    """What Python code prints meanwhile, as a text that is filled."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        yield text


def opencv_yaml(size, matrix, distortion, fisheye=False, xi=None):
    """The camera as OpenCV's FileStorage has it: `matrix` of 3 x 3, `distortion` flat."""
    def of(name, rows, values):
        return f"{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {len(values) // rows}\n   dt: d\n   data: [ {', '.join(repr(float(v)) for v in values)} ]\n"

    return (
        f"%YAML:1.0\n---\nimage_width: {size[0]}\nimage_height: {size[1]}\nfisheye_model: {int(fisheye)}\n"
        + of("camera_matrix", 3, [v for row in matrix for v in row])
        + of("distortion_coefficients", len(distortion), distortion)
        + ("" if xi is None else of("xi", 1, [xi]))
    )
