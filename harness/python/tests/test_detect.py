"""Boards and coded fields, found; photographs, judged."""

import warnings

import numpy as np
import pytest
from conftest import ROOT

import calibench as cb


def test_a_board_is_found():
    for shot in cb.render("testfields/chessboard", root=ROOT)[:4]:
        found = cb.detect(shot.image, "9x6")
        assert found is not None and found.target[:2] == ["r1c1", "r1c2"] and set(found.kind) == {"chess_corner"}
        # Whatever corner it begins with, it finds the corners, and its axes lead from one to the next.
        off = np.linalg.norm(found.xy[:, None] - shot.truth.xy[None], axis=2).min(axis=1)
        assert off.max() < 1.0
        assert np.abs(found.xy[1] - found.xy[0] - found.axes[0][:, 0]).max() < 1e-9
    assert cb.detect(np.full((480, 640), 0.5, np.float32), "9x6") is None


def test_corners_are_refined_where_cv2_is_installed():
    pytest.importorskip("cv2")
    shot = cb.render("testfields/chessboard", root=ROOT)[0]
    refined = cb.measure(shot.image, cb.detect(shot.image, "9x6").xy, "cv2_subpix:window=9")
    assert np.linalg.norm(refined.xy[:, None] - shot.truth.xy[None], axis=2).min(axis=1).max() < 0.3
    assert refined.version.startswith("cv2 ")


def test_a_board_is_the_board_asked_for():
    shot = cb.render("testfields/chessboard", root=ROOT)[0]
    assert cb.detect(shot.image, "8x11") is None


@pytest.mark.parametrize("kind", ["chessboard", "charuco", "puzzle", "dotted"])
def test_each_of_several_boards_is_found_and_without_all_it_is_said(kind):
    shots = cb.render(f"targets/{kind}", root=ROOT)
    image = np.hstack([shots[0].image, shots[1].image])
    word = cb.identify(shots[0].image).board
    with pytest.warns(cb.DoubtWarning, match="all=True takes each of them"):
        cb.detect(image, word)
    each = cb.detect(image, word, all=True)
    assert [type(found) for found in each] == [cb.Targets] * 2
    for found, shot, begins in zip(each, shots, [0.0, shots[0].image.shape[1]]):
        place = {name: index for index, name in enumerate(found.target)}
        assert len(place) == len(found) == len(cb.board(word))
        alone = cb.detect(shot.image, word)
        own = [place[name] for name in alone.target]
        # What is beside a board moves no point of it.
        assert np.abs(found.xy[own] - [begins, 0.0] - alone.xy).max() < 0.1
    assert len(cb.detect(shots[0].image, word, all=True)) == 1
    assert cb.detect(np.full((480, 640), 0.5, np.float32), word, all=True) == []


def test_the_board_that_is_there_is_named():
    for kind, words, word, markers in [
        ("chessboard", "a chessboard of 9 x 6 inner corners", "chessboard:9x6:1", []),
        ("charuco", "a ChArUco board of 10 x 7 squares", "charuco:10x7:1:0.7:DICT_4X4_50", list(range(35))),
    ]:
        image = cb.render(f"targets/{kind}", root=ROOT)[0].image
        found = cb.identify(image)
        assert words in found.words and found.board == word and found.markers == markers
        assert found.points == len(cb.detect(image, found.board))
        assert found.words in repr(found) and found.board in repr(found)
    assert cb.identify(np.full((480, 640), 0.5, np.float32)) is None


def test_a_coded_field_is_found():
    shot = cb.render("testfields/coded", root=ROOT)[0]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        found = cb.detect(shot.image, testfield="testfields/coded", root=ROOT)
    place = {name: index for index, name in enumerate(shot.truth.target)}
    truth = shot.truth.xy[[place[name] for name in found.target]]
    assert len(found) > 50 and np.linalg.norm(found.xy - truth, axis=1).max() < 2.0


def test_what_shows_no_field_is_said():
    with pytest.warns(cb.DoubtWarning, match="not recognised"):
        assert cb.detect(np.full((480, 640), 0.5, np.float32), testfield="testfields/coded", root=ROOT) is None


def test_mistakes_are_named():
    image = np.zeros((64, 64), np.float32)
    with pytest.raises(cb.InputError, match="no chessboard"):
        cb.detect(image, "9")
    with pytest.raises(cb.InputError, match="coded"):
        cb.detect(image, testfield="testfields/wall", root=ROOT)
    with pytest.raises(cb.InputError, match="classifier"):
        cb.detect(image, testfield="testfields/coded", classifier="new", root=ROOT)
    with pytest.raises(cb.InputError, match="expected either a board"):
        cb.detect(image)
    with pytest.raises(cb.InputError, match="all=True: expected a board"):
        cb.detect(image, testfield="testfields/coded", all=True, root=ROOT)
    with pytest.raises(cb.InputError, match=r"identify\(image\) names the board"):
        cb.detect(image, "unknown")


def test_photographs_are_judged(program, tmp_path):
    pytest.importorskip("cv2")
    program("--root", ROOT, "render", "testfields/chessboard", "-o", "pictures")
    photographs = sorted(str(path) for path in (tmp_path / "pictures").glob("s*.png"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        found = cb.judge(photographs, "9x6:25", methods=["pixel", "parametric_corner"], models=["opencv4", "opencv5"])
        assert found.operator.startswith("parametric_corner") and "parametric_corner" in found.verdict
        camera = cb.calibrate(*_corners(photographs), "9x6:25", size=(640, 480), model="opencv5").camera
        again = cb.judge(photographs, "9x6:25", methods=["parametric_corner"], models=["opencv5"], camera=camera, margin=1.0)
    assert again.in_use in ("holds", "cannot tell") and again.verdict.startswith("- ")
    with pytest.raises(cb.InputError, match="at least 6|at least six|takes at least"):
        cb.judge(photographs[:3], "9x6:25", methods=["pixel"])
    with pytest.raises(cb.InputError, match="photographs say both"):
        cb.judge(photographs, "9x6:25", size=(640, 480))


def _corners(photographs):
    import cv2

    found = []
    for path in photographs:
        image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
        start = cb.detect(image, "9x6")
        found.append(np.full((54, 2), np.nan) if start is None else cb.measure(image, start.xy, "parametric_corner", kind="chess_corner").xy)
    return [found]
