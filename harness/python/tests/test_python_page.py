"""docs/python.md: its Python runs from top to bottom as one program, in a project, beside photographs and a camera file."""

import re
import shutil

import pytest
from conftest import ROOT

import calibench as cb

BLOCK = re.compile(r"(?:^(?: {4}.*)?\n)+", re.MULTILINE)
# Needs a cluster; test_cluster.py runs the same call on workers of its own.
ELSEWHERE = "from distributed import Client"


def blocks(text):
    """The indented blocks of a page that are Python: line and text."""
    for block in BLOCK.finditer(text):
        lines = [line[4:] for line in block[0].splitlines()]
        source = "\n".join(lines).strip("\n")
        if source and not source.startswith("./"):
            yield text.count("\n", 0, block.start()) + 1, source


def bring(folder):
    """What a reader has: a project, photographs of a board, a camera file."""
    cv2 = pytest.importorskip("cv2")
    for name in ["testfields/chessboard.toml", "operators/targets.toml", "league/good.toml", "league/camera.yaml"]:
        name = f"scenarios/{name}"
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    (folder / "reference").mkdir()
    (folder / "photos").mkdir()
    for number, shot in enumerate(cb.render("testfields/chessboard")):
        grey = (255 * shot.image + 0.5).clip(0, 255).astype("uint8")
        cv2.imwrite(f"photos/{number:02}.jpg", grey, [cv2.IMWRITE_JPEG_QUALITY, 98])
        shot.camera.convert("metashape").write("camera.xml")


def test_the_page_s_python_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    bring(tmp_path)
    known, ran = {}, 0
    for line, source in blocks((ROOT / "docs/python.md").read_text(encoding="utf-8")):
        if source.startswith(ELSEWHERE):
            continue
        exec(compile("\n" * line + source, "docs/python.md", "exec"), known)  # noqa: S102
        ran += 1
    assert ran >= 4
    # What the page shows is what is meant: every photograph was found, and the camera is that of the file.
    assert len(known["corners"]) == 16 and known["m"].xy.shape == (54, 2)
    assert known["c"].camera and "px" in capsys.readouterr().out
    # The board of these photographs is bent: their camera is not the true one to the last digit, but near.
    assert cb.diff(known["camera"], known["c"].camera).rms_px < 5
    assert len(known["cameras"]) == 2 and len(known["found"].xy) == 54
    assert len(known["rows"]["frame"]) == 10
    assert abs(known["pixels"] - [[320.0, 240.0]]).max() < 1e-9


def test_what_is_python_on_a_page_is_found():
    text = "words\n\n    a = 1\n\n    b = a\n\nwords\n\n    ./run\n\nwords\n\n    c = 2\n"
    assert [source for _, source in blocks(text)] == ["a = 1\n\nb = a", "c = 2"]
