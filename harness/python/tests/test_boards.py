"""Boards: drawn by us and read by OpenCV, drawn by OpenCV and read by us, photographs that others made."""

import numpy as np
import pytest
from conftest import ROOT

import calibench as cb

cv2 = pytest.importorskip("cv2")
aruco = pytest.importorskip("cv2.aruco")

DATA = ROOT.parent / "shared/data/targets"
FILES = ROOT / "harness/model/data/dictionaries"


def opencv_s(name):
    return aruco.getPredefinedDictionary(getattr(aruco, name))


@pytest.mark.parametrize("file", sorted(FILES.glob("*.txt")), ids=lambda file: file.stem)
def test_a_dictionary_is_opencv_s(file):
    """Every cell of every marker, as OpenCV draws it."""
    text = file.read_text()
    name = text.split("Codes of ")[1].split(":")[0]
    codes = [int(word, 16) for line in text.splitlines() if not line.startswith("#") for word in line.split()]
    theirs = opencv_s(name)
    side = theirs.markerSize
    assert len(codes) == len(theirs.bytesList)
    for marker, code in enumerate(codes):
        drawn = aruco.generateImageMarker(theirs, marker, side + 2, borderBits=1)[1:-1, 1:-1] > 127
        cells = [code >> (side * side - 1 - cell) & 1 for cell in range(side * side)]
        assert cells == drawn.ravel().astype(int).tolist(), marker


def eight_bits(image):
    return np.clip(np.rint(np.asarray(image) * 255), 0, 255).astype(np.uint8)


def scenario(tmp_path, name, change=lambda text: text):
    """One of `scenarios/targets`, turned four ways, with a change."""
    text = (ROOT / f"scenarios/targets/{name}.toml").read_text().replace("rolls = [0, 90]", "rolls = [0, 90, 180, 270]")
    assert "270" in text
    file = tmp_path / f"{name}.toml"
    file.write_text(change(text).replace("#:schema ../scenario.schema.json\n", ""))
    return str(file)


def read_charuco(image, legacy=False):
    board = aruco.CharucoBoard((10, 7), 38, 26.6, opencv_s("DICT_4X4_50"))
    board.setLegacyPattern(legacy)
    corners, ids, _, markers = aruco.CharucoDetector(board).detectBoard(eight_bits(image))
    names = [f"r{i // 9 + 1}c{i % 9 + 1}" for i in (ids.ravel() if ids is not None else [])]
    return names, corners, (0 if markers is None else len(markers))


def test_opencv_reads_a_charuco_board_of_ours_in_all_rotations(tmp_path):
    for shot in cb.render(scenario(tmp_path, "charuco"), root=ROOT):
        names, corners, markers = read_charuco(shot.image)
        assert markers == 35 and len(names) == 54, shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        off = np.array([corner.ravel() - truth[name] for name, corner in zip(names, corners)])
        # Up to OpenCV 4.13 half a pixel of another origin; never another corner.
        assert np.abs(np.median(off, axis=0)).max() < 0.55 and np.abs(off - np.median(off, axis=0)).max() < 0.5


@pytest.mark.parametrize(("kind", "border"), [("aprilgrid", 2), ("aprilgrid", 1)])
def test_opencv_reads_an_aprilgrid_of_ours_in_all_rotations(tmp_path, kind, border):
    parameters = aruco.DetectorParameters()
    parameters.markerBorderBits = border
    detector = aruco.ArucoDetector(opencv_s("DICT_APRILTAG_36h11"), parameters)
    for shot in cb.render(scenario(tmp_path, kind, lambda text: text.replace("tag = 48", f"tag = 48\nborder = {border}")), root=ROOT):
        corners, ids, _ = detector.detectMarkers(eight_bits(shot.image))
        assert sorted(ids.ravel()) == list(range(24)), shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        for found, marker in zip(corners, ids.ravel()):
            # Tags stand upside down: the upper left corner as it is read is the lower right one of the board.
            ours = np.array([truth[f"t{marker}c{k}"] for k in (1, 0, 3, 2)])
            assert np.abs(found.reshape(4, 2) - ours).max() < 8.0, (shot.name, marker)  # unrefined, tags of 85 px


def test_opencv_finds_a_grid_of_circles_of_ours():
    for shot in cb.render("targets/circles", root=ROOT):
        found, centres = cv2.findCirclesGrid(eight_bits(shot.image), (10, 7), flags=cv2.CALIB_CB_SYMMETRIC_GRID)
        assert found, shot.name
        off = np.linalg.norm(centres.reshape(-1, 1, 2) - shot.truth.xy[None], axis=2).min(axis=1)
        assert off.max() < 0.5


MARKED = [("30@r7c1", "circles:10x7:38:20:30@r7c1"), ("20/8@r2c2,r5c2,r5c8", "circles:10x7:38:20:20/8@r2c2,r5c2,r5c8")]


@pytest.mark.parametrize(("marks", "word"), MARKED)
@pytest.mark.parametrize("light", [False, True])
def test_circles_with_an_origin_are_found_by_name_and_opencv_reads_them(tmp_path, marks, word, light):
    """Dark and light, in all turns; findCirclesGrid, which needs the light ones inverted, has every centre, too, and no names; rings it has not."""
    levels = "\npaper = 0.05\nink = 0.85" if light else ""
    marked = scenario(tmp_path, "circles", lambda text: text.replace("diameter = 20", f'diameter = 20\nmarks = ["{marks}"]{levels}'))
    for shot in cb.render(marked, root=ROOT):
        found = cb.detect(shot.image, word)
        assert found is not None and sorted(found.target) == sorted(shot.truth.target), shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        assert max(np.linalg.norm(xy - truth[name]) for name, xy in zip(found.target, found.xy)) < 1.5, shot.name
        if "/" in marks:
            continue
        grey = eight_bits(1.0 - np.asarray(shot.image) if light else shot.image)
        seen, centres = cv2.findCirclesGrid(grey, (10, 7), flags=cv2.CALIB_CB_SYMMETRIC_GRID | cv2.CALIB_CB_CLUSTERING)
        assert seen, shot.name
        assert np.linalg.norm(centres.reshape(-1, 1, 2) - shot.truth.xy[None], axis=2).min(axis=1).max() < 1.0


WORDS = {
    "charuco": "charuco:10x7:38:26.6:DICT_4X4_50",
    "aprilgrid": "aprilgrid:6x4:48:0.3",
    "gridboard": "gridboard:6x4:48:14.4:DICT_6X6_250",
    "circles": "circles:10x7:38:20",
    "rings": "rings:12:10x7:38:10",
    "puzzle": "puzzle:19x13:20:100,200",
    "dotted": "dotted:15x9:25",
}


@pytest.mark.parametrize("kind", WORDS)
def test_every_kind_is_found_by_name(tmp_path, kind):
    """All points that are in view, none by another's name; of a symmetric grid, which looks the same upside down, up to that."""
    for shot in cb.render(scenario(tmp_path, kind), root=ROOT):
        found = cb.detect(shot.image, WORDS[kind])
        assert found is not None and sorted(found.target) == sorted(shot.truth.target), (kind, shot.name)
        assert len(set(found.kind)) == 1 and set(found.kind) == set(shot.truth.kind)
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        off = np.array([np.linalg.norm(xy - truth[name]) for name, xy in zip(found.target, found.xy)])
        if kind == "circles":
            off = np.minimum(off, [np.linalg.norm(xy - truth[name]) for name, xy in zip(found.target[::-1], found.xy)])
        assert off.max() < 1.5, (kind, shot.name, off.max())


def test_another_board_is_refused(tmp_path):
    shots = cb.render(scenario(tmp_path, "charuco"), root=ROOT)[:2]
    for wrong in ["charuco:10x7:38:26.6:DICT_5X5_50", "charuco:7x10:38:26.6:DICT_4X4_50", "charuco:10x7:38:15:DICT_4X4_50", "rings:12:10x7:38:10"]:
        for shot in shots:
            assert cb.detect(shot.image, wrong) is None, wrong
    for shot in shots:
        assert cb.detect(np.ascontiguousarray(shot.image[:, ::-1]), WORDS["charuco"]) is None, "a mirror image"
    # Its order of squares is another where the number of rows is even.
    even = scenario(tmp_path, "charuco", lambda text: text.replace("rows = 7", "rows = 6"))
    shot = cb.render(even, root=ROOT)[0]
    assert cb.detect(shot.image, "charuco:10x6:38:26.6:DICT_4X4_50") is not None
    assert cb.detect(shot.image, "charuco:10x6:38:26.6:DICT_4X4_50:legacy") is None


def seen_aside(drawn, rim, corners_at):
    """What OpenCV drew, in perspective with a grey border; and where its pixels go."""
    drawn = cv2.copyMakeBorder(drawn, rim, rim, rim, rim, cv2.BORDER_CONSTANT, value=255)
    height, width = drawn.shape
    corners = np.array([[rim, rim], [width - rim, rim], [width - rim, height - rim], [rim, height - rim]], np.float32)
    map_ = cv2.getPerspectiveTransform(corners, np.array(corners_at, np.float32))
    size = tuple(np.max(corners_at, axis=0).astype(int) + 150)
    return cv2.GaussianBlur(cv2.warpPerspective(drawn, map_, size, borderValue=120), (0, 0), 0.8), map_


@pytest.mark.parametrize("legacy", [False, True])
@pytest.mark.parametrize("size", [(8, 6), (5, 7), (7, 5), (3, 8), (9, 4), (4, 9), (6, 6), (7, 7), (12, 3)])
def test_a_board_that_opencv_drew_is_found(size, legacy):
    """More rows than columns or fewer, even or odd, of both orders: with an even number of rows each is refused as the other, with an odd one they are one."""
    columns, rows = size
    board = aruco.CharucoBoard(size, 30, 21, opencv_s("DICT_5X5_100"))
    board.setLegacyPattern(legacy)
    drawn = board.generateImage((100 * columns, 100 * rows))
    ends = np.array([[0.1, 0.05], [0.95, 0.0], [1.0, 0.95], [0.0, 1.0]]) * [100 * columns, 100 * rows] + 80
    image, map_ = seen_aside(drawn, 60, ends)
    word = f"charuco:{columns}x{rows}:30:21:DICT_5X5_100" + (":legacy" if legacy else "")
    found = cb.detect(image, word)
    assert found is not None and len(found.target) == (columns - 1) * (rows - 1)
    at = dict(cb.board(word))
    # Edges of squares of 100 px lie between pixels.
    plane = np.array([[60 + 100 + at[name][0] / 30 * 100 - 0.5, 60 + 100 - at[name][1] / 30 * 100 - 0.5] for name in found.target])
    expected = cv2.perspectiveTransform(plane[None].astype(np.float64), map_)[0]
    assert np.abs(found.xy - expected).max() < 1.5
    # OpenCV's ids of the corners, and their places, are ours.
    for place, xyz in enumerate(board.getChessboardCorners()):
        name = f"r{place // (columns - 1) + 1}c{place % (columns - 1) + 1}"
        assert np.allclose([at[name][0] + 30, 30 - at[name][1]], xyz[:2]), name
    other = cb.detect(image, f"charuco:{columns}x{rows}:30:21:DICT_5X5_100" + ("" if legacy else ":legacy"))
    assert (other is None) == (rows % 2 == 0)


#: It knows the newer order alone.
CALIB_TARGETS = '[[method]]\nname = "calib_targets"\n'


@pytest.mark.parametrize("legacy", [False, True])
@pytest.mark.parametrize("size", [(5, 6), (6, 5), (9, 4), (4, 7)])
def test_opencv_reads_charuco_boards_of_ours_of_other_counts(tmp_path, size, legacy):
    columns, rows = size
    change = lambda text: text.replace("rows = 7", f"rows = {rows}\nlegacy = {str(legacy).lower()}").replace("columns = 10", f"columns = {columns}").replace(CALIB_TARGETS, "")
    board = aruco.CharucoBoard(size, 38, 26.6, opencv_s("DICT_4X4_50"))
    board.setLegacyPattern(legacy)
    for shot in cb.render(scenario(tmp_path, "charuco", change), root=ROOT)[:4]:
        corners, ids, _, _ = aruco.CharucoDetector(board).detectBoard(eight_bits(shot.image))
        assert ids is not None and len(ids) == (columns - 1) * (rows - 1) == len(shot.truth.target), shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        theirs = [truth[f"r{i // (columns - 1) + 1}c{i % (columns - 1) + 1}"] for i in ids.ravel()]
        # Half a pixel is OpenCV's own, up to 4.13.
        assert np.linalg.norm(corners.reshape(-1, 2) - theirs, axis=1).max() < 1.5


def opencv_s_gridboard(columns, rows, marker, separation, dictionary, first=0):
    return aruco.GridBoard((columns, rows), marker, separation, opencv_s(dictionary), np.arange(first, first + columns * rows))


def test_a_gridboard_is_opencv_s():
    """Names, corners, their order and places are those of `cv::aruco::GridBoard`; its y points down, ours up."""
    for columns, rows, marker, separation, first in [(5, 7, 40, 10, 0), (3, 2, 0.05, 0.02, 11), (1, 4, 30, 30, 5), (6, 1, 30, 4, 0)]:
        theirs = opencv_s_gridboard(columns, rows, marker, separation, "DICT_6X6_250", first)
        ours = dict(cb.board(f"gridboard:{columns}x{rows}:{marker}:{separation}:DICT_6X6_250:{first}"))
        assert len(ours) == 4 * len(theirs.getIds()) == 4 * columns * rows
        for marker_id, corners in zip(theirs.getIds().ravel(), theirs.getObjPoints()):
            for k, (x, y, z) in enumerate(corners):
                assert np.allclose(ours[f"t{marker_id}c{k}"], (x, -y, z), atol=1e-4), (marker_id, k)


def test_opencv_reads_a_gridboard_of_ours_in_all_rotations(tmp_path):
    """Every marker with its corners in order; its own matchImagePoints has the object points that ours have."""
    parameters = aruco.DetectorParameters()
    parameters.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
    board = opencv_s_gridboard(6, 4, 48, 14.4, "DICT_6X6_250")
    detector = aruco.ArucoDetector(opencv_s("DICT_6X6_250"), parameters)
    for shot in cb.render(scenario(tmp_path, "gridboard"), root=ROOT):
        corners, ids, _ = detector.detectMarkers(eight_bits(shot.image))
        assert sorted(ids.ravel()) == list(range(24)), shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        ours = np.array([[truth[f"t{marker}c{k}"] for k in range(4)] for marker in ids.ravel()])
        assert np.abs(np.array(corners).reshape(-1, 4, 2) - ours).max() < 1.0, shot.name
        object_points, image_points = board.matchImagePoints(corners, ids)
        at = dict(cb.board(WORDS["gridboard"]))
        own = np.array([at[f"t{marker}c{k}"] for marker in ids.ravel() for k in range(4)])
        assert np.allclose(object_points.reshape(-1, 3) * [1, -1, 1], own, atol=1e-4)
        assert np.abs(image_points.reshape(-1, 2) - ours.reshape(-1, 2)).max() < 1.0


@pytest.mark.parametrize(("columns", "rows", "dictionary", "first", "border"), [(5, 7, "DICT_6X6_250", 0, 1), (4, 3, "DICT_4X4_50", 30, 2)])
def test_a_gridboard_that_opencv_drew_is_found(columns, rows, dictionary, first, border):
    board = opencv_s_gridboard(columns, rows, 40, 20, dictionary, first)
    pitch, rim = 120, 30
    width, height = pitch * columns - 40, pitch * rows - 40
    drawn = board.generateImage((width, height), marginSize=0, borderBits=border)
    image, map_ = seen_aside(drawn, rim, [[90, 60], [width, 80], [width + 60, height + 20], [70, height + 70]])
    word = f"gridboard:{columns}x{rows}:40:20:{dictionary}:{first}" + (":border2" if border == 2 else "")
    found = cb.detect(image, word)
    assert found is not None and sorted(found.target) == sorted(name for name, _ in cb.board(word))
    at = dict(cb.board(word))
    plane = np.array([[rim + 2 * at[name][0] - 0.5, rim - 2 * at[name][1] - 0.5] for name in found.target])
    expected = cv2.perspectiveTransform(plane[None].astype(np.float64), map_)[0]
    assert np.abs(found.xy - expected).max() < 1.5
    assert cb.detect(image, word.replace(f":{columns}x{rows}:", f":{columns + 1}x{rows}:")) is None


def test_the_aprilgrid_of_a_photograph():
    file = DATA / "aprilgrid-rs_EuRoC.png"
    if not file.is_file():
        pytest.skip(f"no {file}")
    image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
    found = cb.detect(image, "aprilgrid:6x6:0.088:0.3")
    parameters = aruco.DetectorParameters()
    parameters.markerBorderBits = 2
    corners, ids, _ = aruco.ArucoDetector(opencv_s("DICT_APRILTAG_36h11"), parameters).detectMarkers(image)
    ours = dict(zip(found.target, found.xy))
    tags = {name.split("c")[0] for name in ours}
    assert len(tags) >= len(ids), "no fewer than OpenCV"
    for theirs, marker in zip(corners, ids.ravel()):
        mine = np.array([ours[f"t{marker}c{k}"] for k in (1, 0, 3, 2)])
        assert np.abs(theirs.reshape(4, 2) - mine).max() < 4.0, marker  # whole pixels, unrefined


def read_puzzle(image, side):
    """Corners by their place in the pattern, as `calib-targets` reads them; it counts from another corner than the makers."""
    other = pytest.importorskip("calib_targets")
    parameters = other.default_puzzleboard_params(20, 20).to_dict() | {"px_per_square": side}
    seen = other.detect_puzzleboard(eight_bits(image), params=other.PuzzleBoardParams.from_dict(parameters))
    return {((corner.grid.u - 168) % 501, (corner.grid.v - 168) % 501): np.array(corner.position) for corner in seen.corners}, seen.decode


@pytest.mark.parametrize("place", [(0, 0), (100, 200), (333, 165), (482, 488)])
def test_another_reader_reads_a_puzzle_board_of_ours_in_all_rotations(tmp_path, place):
    pytest.importorskip("calib_targets")
    for shot in cb.render(scenario(tmp_path, "puzzle", lambda text: text.replace("[100, 200]", f"[{place[0]}, {place[1]}]")), root=ROOT):
        corners, decode = read_puzzle(shot.image, 37.0)
        # It looks at most of the dots, and reads every one as it is drawn.
        assert decode.edges_matched == decode.edges_observed > 0.75 * (18 * 13 + 19 * 12), shot.name
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        assert len(corners) == len(truth) == 247
        for (column, row), xy in corners.items():
            assert np.linalg.norm(xy - truth[f"r{row - place[1] + 1}c{column - place[0] + 1}"]) < 0.5


@pytest.mark.parametrize("origin", [(0, 0), (10, 20), (300, 77)])
def test_a_puzzle_board_that_another_drew_is_found(origin):
    """Its last one has its squares exchanged, since the makers' pattern begins elsewhere."""
    other = pytest.importorskip("calib_targets")
    document = other.puzzleboard_document(12, 12, 12.0, origin_row=origin[1], origin_col=origin[0])
    drawn = cv2.imdecode(np.frombuffer(other.render_target_bundle(document).png_bytes, np.uint8), cv2.IMREAD_GRAYSCALE)
    image = cv2.resize(drawn, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    place = [(value + 1 - 168) % 501 for value in origin]
    found = cb.detect(image, f"puzzle:11x11:12:{place[0]},{place[1]}")
    assert found is not None and len(found.target) == 121
    assert cb.detect(image, f"puzzle:11x11:12:{(place[0] + 20) % 490},{place[1]}") is None, "another part of the pattern"


@pytest.mark.parametrize("place", [(8, 5), (3, 2), (11, 6)])
def test_opencv_reads_a_board_with_three_dots_of_ours_in_all_rotations(tmp_path, place):
    """Its squares with dots are where ours are, and no other has one."""
    flags = cv2.CALIB_CB_LARGER | cv2.CALIB_CB_MARKER
    for shot in cb.render(scenario(tmp_path, "dotted", lambda text: text.replace("square = 25", f"square = 25\nplace = {list(place)}")), root=ROOT):
        found, corners, meta = cv2.findChessboardCornersSBWithMeta(eight_bits(shot.image), (5, 5), flags)
        assert found and meta.size == 135, shot.name
        corners, meta = corners.reshape(-1, 2), meta.ravel()
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        at = lambda column, row: truth[f"r{row}c{column}"]
        squares = [[at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)] for x, y in [place, (place[0] + 1, place[1]), (place[0], place[1] + 1)]]
        for mark, expected in [(4, squares[:1]), (3, squares[1:])]:
            marked = corners[meta == mark]
            assert len(marked) == len(expected), shot.name
            # A square is told by one of its corners.
            for square in expected:
                assert np.linalg.norm(marked[:, None] - np.array(square)[None], axis=2).min() < 1.0, shot.name


def test_a_board_with_three_dots_that_another_drew_is_found():
    """As OpenCV's gen_pattern draws it: squares with dots of 0.34 of a square, the first in a light square in the middle."""
    square, columns, rows = 40, 10, 7
    drawn = np.full(((rows + 2) * square * 4, (columns + 2) * square * 4), 255, np.uint8)
    s = 4 * square
    dark = lambda x, y: (x + y) % 2 == 0
    for y in range(rows):
        for x in range(columns):
            if dark(x, y):
                drawn[(y + 1) * s : (y + 2) * s, (x + 1) * s : (x + 2) * s] = 0
    for x, y in [(4, 3), (5, 3), (4, 4)]:
        cv2.circle(drawn, (int((x + 1.5) * s), int((y + 1.5) * s)), round(0.17 * s), 255 if dark(x, y) else 0, -1)
    image = cv2.GaussianBlur(cv2.resize(drawn, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA), (0, 0), 0.8)
    for turns in range(4):
        turned = np.ascontiguousarray(np.rot90(image, turns))
        part = np.ascontiguousarray(turned[70:, 70:])
        for picture, shift in [(turned, 0), (part, 70)]:
            found = cb.detect(picture, "dotted:9x6:25")
            assert found is not None and len(found.target) >= 35, turns
            off = []
            for name, (x, y) in zip(found.target, found.xy + shift):
                row, column = (int(number) for number in name[1:].split("c"))
                u, v = (column + 1) * square - 0.5, (row + 1) * square - 0.5
                for _ in range(turns):
                    # A quarter turn counterclockwise of an image whose side it was.
                    u, v = v, ((columns + 2) * square if _ % 2 == 0 else (rows + 2) * square) - 1 - u
                off.append(np.hypot(x - u, y - v))
            assert max(off) < 1.0, turns
        assert cb.detect(np.ascontiguousarray(turned[:, ::-1]), "dotted:9x6:25") is None, "a mirror image"
