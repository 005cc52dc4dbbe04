"""Pointing: clicks, keys, the history, what is kept and what is saved."""

import csv
import subprocess
import time
from pathlib import Path

import pytest
from browsing import FAINT, NARROW, WATCH, WIDE
from pointing import ABOUT, COPY, HEIGHT, TRUTH, WIDTH, apart, cell_name
from selenium.webdriver.common.by import By

SHIFT, CTRL = 8, 2


def test_a_click_is_where_it_is_seen(free):
    """The corner between four pixels is seen where their edges meet: half a pixel of another origin would show."""
    page = free
    x, y = page.at(*ABOUT["free"])
    for _ in range(4):
        page.wheel(x, y, -250)
    time.sleep(0.3)
    page.settle()
    page.mouse("mouseMoved", *page.middle())
    page.settle()
    left, top, right, bottom = page.stage()
    scale = page.view()[2]
    assert scale > 8
    # The brightest and the darkest quarter meet there.
    page.mouse("mouseMoved", left + 5, top + 5)
    page.settle()
    step = COPY + """const [x, y, dx, dy] = arguments; const data = copy.getImageData(x, y, dx || 1, dy || 1).data;
        const grey = [...data].filter((_, i) => i % 4 === 0); let [best, most] = [0, 0];
        for (let i = 1; i < grey.length; i += 1) if (Math.abs(grey[i] - grey[i - 1]) > most) [best, most] = [i, Math.abs(grey[i] - grey[i - 1])];
        return [best, most];"""
    near = [round(x - left), round(y - top)]
    reach = round(6 * scale)
    across, contrast = page.run(step, near[0] - reach, near[1] - round(5 * scale), 2 * reach, 0)
    down, _ = page.run(step, near[0] - round(5 * scale), near[1] - reach, 0, 2 * reach)
    assert contrast > 30
    page.click(left + near[0] - reach + across, top + near[1] - reach + down)
    found = page.only()
    assert abs(found[0] - ABOUT["free"][0]) < 1.5 / scale and abs(found[1] - ABOUT["free"][1]) < 1.5 / scale, found


def test_at_any_zoom_a_click_is_the_place_told(free):
    page = free
    for index, zooms in enumerate((0, 2, 3)):
        for _ in range(zooms):
            page.wheel(*page.middle(), -200)
        x, y = page.at(450 + 10 * index, 350)
        told = page.tell(x, y)
        page.click(x, y)
        place = page.places()[("turned.png", f"p{index + 1}")]
        assert apart(place, told) < 0.01 and apart(place, (450 + 10 * index, 350)) < 1
        page.key("Escape")


def test_the_mouse_zooms_about_itself_and_drags(free):
    page = free
    x, y = page.middle()
    x, y = x + 130, y - 70
    before = page.tell(x, y)
    _, _, scale = page.view()
    page.wheel(x, y, -250)
    assert page.view()[2] == pytest.approx(2 * scale, rel=0.01)
    assert apart(page.tell(x, y), before) < 0.02
    page.drag(x, y, -90, 40)
    assert apart(page.tell(x - 90, y + 40), before) < 0.02
    assert not page.places(), "a drag points at nothing"
    page.press("all")
    assert page.view()[2] == pytest.approx(scale, rel=0.01)


def test_keys_do_all_of_it(free):
    page = free
    page.run("document.querySelector('canvas.photo').focus()")
    page.key("0")
    assert page.place() == pytest.approx(((WIDTH - 1) / 2, (HEIGHT - 1) / 2), abs=0.006)
    page.key("1")
    page.key("d", "d", "s")
    middle = ((WIDTH - 1) / 2 + 120, (HEIGHT - 1) / 2 + 60)
    assert page.place() == pytest.approx(middle, abs=0.006)
    page.key("+", "+", "-", "Enter")
    assert page.only() == pytest.approx(middle, abs=0.001)
    page.key("ArrowRight", "ArrowDown", "ArrowDown")
    page.key("ArrowLeft", modifiers=SHIFT)
    assert page.only() == pytest.approx((middle[0] + 0.9, middle[1] + 2), abs=0.001)
    page.key("Escape", "ArrowRight", "Enter")
    assert len(page.places()) == 2
    page.key(",")
    page.key("Delete")
    assert list(page.places()) == [("turned.png", "p2")]
    page.key("n")
    assert page.run("return document.activeElement.id") == "name"


def test_changes_are_undone_and_done_again(file):
    page = file
    page.point(*TRUTH["A"])
    page.point(*TRUTH["B"])
    first = page.places()
    assert [name for _, name in first] == ["A", "B"] and page.next_name() == "C"
    page.key("ArrowUp")
    moved = page.places()
    page.key("Delete")
    for expected in (moved, first):
        page.key("z", modifiers=CTRL)
        assert page.places() == expected
    page.key("z", modifiers=CTRL)
    assert [name for _, name in page.places()] == ["A"] and page.next_name() == "B"
    for expected in (first, moved):
        page.key("y", modifiers=CTRL)
        assert page.places() == expected
    page.press("redo")
    assert [name for _, name in page.places()] == ["A"]
    # A point that is dragged is one change.
    x, y = page.at(*page.only())
    page.drag(x, y, 40, 30)
    _, _, scale = page.view()
    there = page.only()
    assert there == pytest.approx((first[(ABOUT["photos"][0], "A")][0] + 40 / scale, first[(ABOUT["photos"][0], "A")][1] + 30 / scale), abs=0.02)
    page.press("undo")
    assert page.only() == first[(ABOUT["photos"][0], "A")]


def test_a_reload_keeps_everything(file):
    page = file
    page.point(*TRUTH["A"])
    page.switch(1)
    page.point(*TRUTH["A"])
    page.type_name("other")
    time.sleep(0.3)
    before = page.places()
    page.driver.refresh()
    page.settle()
    time.sleep(0.2)
    assert page.places() == before and len(before) == 2
    assert page.next_name() == "other" and page.run("return document.querySelector('.photos select').value") == "1"


def test_it_works_where_nothing_is_kept(file):
    page = file
    script = """for (const name of ['getItem', 'setItem']) Storage.prototype[name] = () => { throw new Error('no'); };
        Object.defineProperty(window, 'localStorage', { get() { throw new Error('no'); } });"""
    added = page.cdp("Page.addScriptToEvaluateOnNewDocument", source=script)["identifier"]
    try:
        page.driver.refresh()
        page.settle()
        page.point(*TRUTH["A"])
        page.wait("return document.querySelector('.how').textContent.includes('keeps nothing')")
        assert len(page.places()) == 1
    finally:
        page.cdp("Page.removeScriptToEvaluateOnNewDocument", identifier=added)


def test_names_are_proposed_in_order_and_are_free(file):
    page = file
    names = list(TRUTH)
    for name in names[:2]:
        assert page.next_name() == name
        page.point(*TRUTH[name])
    page.press("skip")
    assert page.next_name() == names[3]
    page.type_name("my own 7")
    page.point(450, 640)
    assert page.next_name() == "my own 8"
    offered = page.run("return all('#names option').map((node) => node.value)")
    assert offered == names[2:]
    page.press("delete")
    assert page.next_name() == "my own 7"


def test_two_tabs_of_a_file_lose_no_point(free):
    page = free
    first = page.driver.current_window_handle
    rows = "return all('.points tbody th').map((cell) => cell.textContent).sort().join() === arguments[0]"
    page.type_name("first")
    page.point(450, 640)
    page.wait("return localStorage.length === 1")
    page.driver.switch_to.new_window("tab")
    second = page.driver.current_window_handle
    try:
        page.cdp("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
        page.open()
        page.wait(rows, "first")
        page.type_name("second")
        page.point(600, 600)
        page.driver.switch_to.window(first)
        page.wait(rows, "first,second")
        # What is deleted in one tab does not come back from the other.
        page.press("delete")
        page.type_name("third")
        page.point(500, 500)
        page.driver.switch_to.window(second)
        page.wait(rows, "second,third")
        assert {name for _, name in page.places()} == {"second", "third"}
    finally:
        page.driver.switch_to.window(second)
        page.driver.close()
        page.driver.switch_to.window(first)
    assert {name for _, name in page.places()} == {"second", "third"}


def test_what_is_saved_is_measured(file):
    """In a photograph whose name is markup, in one that is turned and in one of 16 bits."""
    page = file
    for index in range(3):
        page.switch(index)
        for name in TRUTH:
            assert page.next_name() == name
            page.point(*TRUTH[name])
        assert page.next_name() == ""
    rows, text = page.saved()
    assert [row["target"] for row in rows] == 3 * [cell_name(name) for name in TRUTH]
    assert all(apart((float(row["x"]), float(row["y"])), place) < 1 for row, place in zip(rows, 3 * list(TRUTH.values())))
    folder = Path(ABOUT["folder"])
    (folder / "saved.csv").write_text(text)
    done = subprocess.run([ABOUT["program"], "measure", *ABOUT["photos"], "--points", "saved.csv", "-m", "parametric_corner"],
        cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    measured = list(csv.DictReader(done.stdout.splitlines()))
    assert len(measured) == 21
    for row, place in zip(measured, 3 * list(TRUTH.values())):
        assert row["status"] == "measured", row
        assert apart((float(row["x"]), float(row["y"])), place) < 0.1, row
    # And read back: as measured points, and as points.
    page.type_name("")
    (folder / "found.csv").write_text(done.stdout)
    page.driver.find_element(By.ID, "files").send_keys(str(folder / "found.csv"))
    page.wait("return document.querySelector('.words').textContent.includes('found.csv: 21 measured')")
    before = page.places()
    while page.places():
        page.press("undo")
    page.driver.find_element(By.ID, "files").send_keys(str(folder / "saved.csv"))
    page.wait("return document.querySelector('.words').textContent.includes('saved.csv: 21 points')")
    assert page.places() == before


def test_measured_points_are_shown_with_their_ellipses_and_reasons(file):
    page = file
    rows = page.table()
    assert set(rows) == {*TRUTH, "flat"}
    assert rows["flat"].startswith("✕ rejected: ") and "±" in rows["A"]
    # In words, and said once: what a style puts before it is none of its text.
    assert len(rows["flat"].split(", ")[1]) > 10, rows["flat"]
    assert page.run("return all('.points .found').every((cell) => getComputedStyle(cell, '::before').content === 'none')")
    [row] = [row for row in csv.DictReader((Path(ABOUT["folder"]) / "measured.csv").read_text().splitlines()) if row["target"] == "A"]
    x, y = page.at(*TRUTH["A"])
    for _ in range(3):
        page.wheel(x, y, -250)
    left, top, scale = page.view()
    # Large enough to be told from the mark.
    page.run("const select = document.querySelector('[aria-label=ellipses]'); select.value = '1000'; select.dispatchEvent(new Event('change'))")
    page.settle()
    page.settle()
    radius = float(row["sxx"]) ** 0.5 * 1000 * scale
    assert radius > 12
    at = (left + float(row["x"]) * scale + radius, top + float(row["y"]) * scale)
    near = [page.colour(at[0] + d, at[1]) for d in (-2, -1, 0, 1, 2)]
    assert any(r < 140 and g > 150 and b > 200 for r, g, b, _ in near), near
    page.shot("ellipses")


def test_a_file_that_is_none_is_refused_in_words(file):
    page = file
    wrong = Path(ABOUT["folder"]) / "<b>wrong.csv"
    for text, said in (("name,x\na,1\n", "has no column image"), ("image,target,x,y\na,b,1\n", "expected 4 cells")):
        wrong.write_text(text)
        page.driver.find_element(By.ID, "files").send_keys(str(wrong))
        page.wait("return document.querySelector('.problem').textContent.includes(arguments[0])", said)
    assert page.run("return document.querySelector('.problem').children.length") == 0


def test_deep_photographs_are_stretched_in_a_stated_way(file):
    page = file
    page.switch(2)
    assert "16 bits: black is 0.0" in page.run("return document.querySelector('.about').textContent")
    x, y = TRUTH["B"]
    page.wheel(*page.at(x, y), -250)
    time.sleep(0.3)
    dark, bright = page.colour(*page.at(x + 9, y - 9)), page.colour(*page.at(x + 9, y + 9))
    assert dark[0] < 20 and bright[0] > 235, (dark, bright)


def test_it_fits_any_window_in_either_theme(file):
    page = file
    page.point(*TRUTH["A"])
    page.point(*TRUTH["B"])
    for width in (NARROW, 768, WIDE):
        page.size(width)
        page.settle()
        assert page.run("return document.documentElement.scrollWidth") <= width
        for theme in ("light", "dark"):
            page.media(prefers_color_scheme=theme)
            time.sleep(0.2)
            assert not page.run(FAINT, "h1, p, li, th, td, button:not(:disabled), summary, label, footer")
            page.shot(f"{width}-{theme}")
    nameless = page.run("""return all('button, input, select, summary').filter((node) => shows(node) && node.type !== 'file' &&
        !(node.textContent.trim() || node.getAttribute('aria-label') || node.labels?.length)).map((node) => node.outerHTML)""")
    assert not nameless


# Names of the last frame as they are drawn: text, left, top, right, bottom.
NAMES = """window.names = []; const {fillText, clearRect} = CanvasRenderingContext2D.prototype;
const ofPhoto = (context) => context.canvas.classList.contains('photo');
CanvasRenderingContext2D.prototype.clearRect = function (...box) {
  if (ofPhoto(this)) window.names = [];
  clearRect.apply(this, box); };
CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
  if (ofPhoto(this)) window.names.push([text, x, y - 12, x + this.measureText(text).width, y + 2]);
  fillText.call(this, text, x, y); };"""


@pytest.mark.parametrize("width", [NARROW, WIDE])
def test_no_name_is_drawn_on_another(free, width):
    page = free
    page.size(width)
    time.sleep(0.3)
    page.settle()
    page.run(NAMES)
    x, y = page.middle()
    for index, (dx, dy) in enumerate([(0, 0), (14, 0), (28, 3), (0, 15), (16, 14), (30, 16), (120, 60)]):
        page.type_name(f"a long name {index}")
        page.click(x + dx, y + dy)
    page.key("Escape")
    page.settle()
    drawn = page.run("return window.names")
    assert 3 <= len(drawn) <= 7 and any(name == "a long name 6" for name, *_ in drawn), drawn
    for index, (name, left, top, right, bottom) in enumerate(drawn):
        for other, ol, ot, orr, ob in drawn[:index]:
            assert left >= orr or ol >= right or top >= ob or ot >= bottom, (name, other)
