"""Plots: zoomed, read off, taken along."""

import csv
import io
import re
import xml.etree.ElementTree as ElementTree

import pytest
from browsing import some

# The drawing of a plot, and what it shows.
PLOT = """
const figure = all('figure.plot').filter((one) => one.querySelector('svg[data-box]'))[arguments[0]];
const svg = figure.querySelector('svg[data-box]'); const marks = svg.querySelector('.marks');
"""
# Marks that can be read off, in sight: where each is on the screen, what it says.
MARKS = PLOT + """
const [bx, by, bw, bh] = svg.dataset.box.split(' ').map(Number); const m = svg.getScreenCTM();
const clip = {left: bx * m.a + m.e, right: (bx + bw) * m.a + m.e, top: by * m.d + m.f, bottom: (by + bh) * m.d + m.f};
return all('[data-t]:not(.line)', marks).filter((mark) => shows(mark)).map((mark) => {
  const box = mark.getBoundingClientRect();
  // An arrow is where its foot is: there the point was measured.
  const foot = mark.matches('.arrow') ? mark.getPointAtLength(0).matrixTransform(mark.getScreenCTM()) : {x: box.left + box.width / 2, y: box.top + box.height / 2};
  return {x: foot.x, y: foot.y, w: box.width, h: box.height,
    t: mark.dataset.t, g: (mark.closest('[data-g]') || {dataset: {}}).dataset.g || '',
    k: mark.dataset.k || '', kind: mark.classList[0], series: (mark.closest('[data-series]') || {dataset: {}}).dataset.series || ''};
}).filter(({x, y}) => x > clip.left && x < clip.right && y > clip.top && y < clip.bottom);
"""
TIP = "const tip = document.querySelector('.tip'); return tip.checkVisibility({visibilityProperty: true}) ? tip.innerText : ''"


# All series hidden, or shown again.
SWITCH_ALL = """const many = document.querySelector('.find');
if (many) all('button', many).find((one) => one.textContent === arguments[0]).click();
else all('.switches button').forEach((one) => one.click());"""


def fields(text):
    r"""Fields between bars, where `\|` is a bar and `\\` a backslash."""
    return [part.replace("\0", "|").replace("\1", "\\") for part in text.replace("\\\\", "\1").replace("\\|", "\0").split("|")]


def plots(page):
    page.having("figure.plot svg[data-box]", "plots")
    return some(page, page.run("return all('figure.plot').filter((one) => one.querySelector('svg[data-box]')).length"), "plots")


def centre(page, plot, focus=True):
    """Brings a plot into the middle of the window; where its middle is."""
    x, y = page.run(PLOT + """svg.scrollIntoView({block: 'center', inline: 'center'});
        if (arguments[1]) svg.focus({preventScroll: true}); else document.activeElement.blur();
        const [x, y, width, height] = svg.dataset.box.split(' ').map(Number); const m = svg.getScreenCTM();
        return [(x + width / 2) * m.a + m.e, (y + height / 2) * m.d + m.f];""", plot, focus)
    page.settle()
    return x, y


def zoom(page, plot):
    """How far a plot is zoomed: the scale of its marks over what it was at first."""
    return page.run(PLOT + "const own = (marks.transform.baseVal.consolidate() || {matrix: {a: 1}}).matrix; return own.a", plot)


def transform(page, plot):
    return page.run(PLOT + "return marks.getAttribute('transform') || ''", plot)


def labels(page, plot):
    return page.run(PLOT + "return all('.axis .tick text', svg).map((text) => text.textContent)", plot)


def button(page, plot, text):
    return page.run(PLOT + """const one = all('.tools button', figure).find((node) => node.textContent === arguments[1]);
        if (one) one.click(); return Boolean(one)""", plot, text)


def test_wheel_zooms_only_what_has_the_focus(fresh):
    page = fresh
    for plot in plots(page):
        x, y = centre(page, plot, focus=False)
        page.wheel(x, y, -200)
        assert zoom(page, plot) == 1, "the page scrolls past"
        x, y = centre(page, plot, focus=False)
        page.wheel(x, y, -200, modifiers=2)
        assert zoom(page, plot) > 1, "with Ctrl it zooms"
        page.run("document.activeElement.blur()")
        button(page, plot, "reset")
        page.settle()
        assert zoom(page, plot) == 1
        x, y = centre(page, plot)
        before, top = labels(page, plot), page.run("return scrollY")
        page.wheel(x, y, -200)
        assert zoom(page, plot) > 1
        assert page.run("return scrollY") == top
        page.click(x, y, count=2)
        assert zoom(page, plot) == 1, "a double click resets"
        assert labels(page, plot) == before, "and its ticks are as they were"


def test_zoom_is_about_the_pointer(fresh):
    page = fresh
    for plot in plots(page):
        centre(page, plot)
        marks = [mark for mark in page.run(MARKS, plot) if 60 < mark["y"] < 850]
        if not marks:
            continue
        mark = marks[len(marks) // 2]
        page.wheel(mark["x"], mark["y"], -250)
        again = [other for other in page.run(MARKS, plot) if other["t"] == mark["t"] and other["kind"] == mark["kind"] and other["k"] == mark["k"]]
        assert min(abs(other["x"] - mark["x"]) + abs(other["y"] - mark["y"]) for other in again) < 4
        page.key("0")


def test_keys_zoom_pan_and_reset(fresh):
    page = fresh
    for plot in plots(page):
        centre(page, plot)
        page.key("+", "+")
        assert zoom(page, plot) == pytest.approx(2.25, rel=1e-3)
        for key in ("ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"):
            before = transform(page, plot)
            page.key(key)
            assert transform(page, plot) != before, key
        page.key("-")
        assert zoom(page, plot) == pytest.approx(1.5, rel=1e-3)
        page.key("Escape")
        assert zoom(page, plot) == 1
        page.key("+")
        page.key("0")
        assert zoom(page, plot) == 1
        page.key(*["+"] * 14)
        assert zoom(page, plot) == pytest.approx(200, rel=1e-3), "200 times at most"
        page.key("0")
        page.key("-")
        assert zoom(page, plot) == 1, "never smaller than at first"


def test_drag_pans_within_the_box(fresh):
    page = fresh
    for plot in plots(page):
        x, y = centre(page, plot)
        first = transform(page, plot)
        page.drag(x, y, 60, 40)
        assert transform(page, plot) == first
        page.key("+", "+")
        before = transform(page, plot)
        page.drag(x, y, 60, 40)
        assert transform(page, plot) != before
        width, height = page.run(PLOT + "const r = svg.getBoundingClientRect(); return [r.width, r.height]", plot)
        for _ in range(3):
            page.drag(x - min(100, width / 4), y - min(100, height / 4), 400, 300)
        left, edge = page.run(PLOT + """const [x] = svg.dataset.box.split(' ').map(Number);
            const m = marks.transform.baseVal.consolidate().matrix; return [m.a * x + m.e, x]""", plot)
        assert left == pytest.approx(edge, abs=0.01), "the edge of the data stays at the edge of the box"
        assert page.count(".chosen") == 0, "a drag chooses nothing"
        page.key("0")


def test_two_fingers_zoom(fresh):
    page = fresh
    for plot in plots(page):
        x, y = centre(page, plot)
        page.cdp("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
        try:
            for kind, apart in (("touchStart", 30), ("touchMove", 45), ("touchMove", 60), ("touchMove", 75), ("touchEnd", None)):
                points = [] if apart is None else [{"x": x - apart, "y": y, "id": 0}, {"x": x + apart, "y": y, "id": 1}]
                page.cdp("Input.dispatchTouchEvent", type=kind, touchPoints=points)
            page.settle()
            assert zoom(page, plot) == pytest.approx(2.5, rel=0.1)
        finally:
            page.cdp("Emulation.setTouchEmulationEnabled", enabled=False)
        page.key("0")


def number(text):
    return float(text.replace("−", "-").replace(" ", ""))


def test_ticks_say_the_values_at_their_places(fresh):
    page = fresh
    tried = 0
    for plot in plots(page):
        if page.run(PLOT + "return svg.classList.contains('still')", plot):
            # What was a picture is zoomed as a whole: its ticks are drawn, and move with it.
            continue
        tried += 1
        centre(page, plot)
        page.key("+", "+", "+", "ArrowRight", "ArrowDown")
        found = page.run(PLOT + """const m = marks.transform.baseVal.consolidate().matrix; const out = [];
            for (const axis of ['x', 'y']) for (const tick of svg.querySelectorAll('.axis.' + axis + ' .tick')) {
              const place = tick.transform.baseVal.consolidate().matrix; const along = axis === 'x' ? (place.e - m.e) / m.a : (place.f - m.f) / m.d;
              out.push([axis, along, tick.querySelector('text').textContent, tick.getBoundingClientRect().left]); }
            return {ticks: out, box: svg.dataset.box.split(' ').map(Number), x: svg.dataset.x.split(' ').map(Number), y: svg.dataset.y.split(' ').map(Number),
              xlog: svg.dataset.xscale === 'log', ylog: svg.dataset.yscale === 'log'};""", plot)
        x, y, width, height = found["box"]
        for axis, start, size in (("x", x, width), ("y", y, height)):
            own = [tick for tick in found["ticks"] if tick[0] == axis]
            if not page.run(PLOT + "return svg.querySelectorAll('.axis.' + arguments[1] + ' .tick').length", plot, axis):
                continue
            assert 2 <= len(own) <= 20, (plot, axis, own)
            assert len({tick[2] for tick in own}) == len(own), "no two ticks say the same"
            low, high = found[axis]
            for _, along, text, _ in own:
                part = (along - start) / size
                wanted = low * (high / low) ** part if found[axis + "log"] else low + part * (high - low)
                size_of_all = abs(wanted) if found[axis + "log"] else abs(high - low)
                assert number(text) == pytest.approx(wanted, abs=1e-3 * size_of_all), (plot, axis, text)
        page.key("0")
    if not tried:
        pytest.skip("this page has no plots whose ticks are made anew")


def test_symbols_keep_their_size_under_zoom(fresh):
    page = fresh
    tried = 0
    for plot in plots(page):
        centre(page, plot)
        symbols = [mark for mark in page.run(MARKS, plot) if mark["kind"] == "mark"]
        if not symbols:
            continue
        tried += 1
        page.key("+", "+", "+", "+")
        by_text = {mark["t"]: mark for mark in symbols}
        for mark in page.run(MARKS, plot):
            if mark["kind"] == "mark" and mark["t"] in by_text:
                assert mark["w"] == pytest.approx(by_text[mark["t"]]["w"], abs=1.5)
        page.key("0")
    if not tried:
        pytest.skip("this page has no symbols in plots")


def test_hover_and_keys_show_what_a_mark_is(fresh):
    page = fresh
    for plot in plots(page):
        centre(page, plot)
        marks = [mark for mark in page.run(MARKS, plot) if 60 < mark["y"] < 890]
        if not marks:
            continue
        for mark in (marks[0], marks[-1], marks[len(marks) // 3]):
            page.mouse("mouseMoved", mark["x"], mark["y"])
            page.settle()
            text = page.run(TIP)
            assert text, mark
            near = [other for other in marks if abs(other["x"] - mark["x"]) < 15 and abs(other["y"] - mark["y"]) < 15]
            assert any(all(" ".join(part.split()) in " ".join(text.split()) for part in fields(other["t"])) for other in [mark, *near]), (text, mark)
            left, top, right, bottom, *window = page.run("return [...edges(document.querySelector('.tip')), innerWidth, innerHeight]")
            assert left >= 0 and top >= 0 and right <= window[0] and bottom <= window[1]
        page.mouse("mouseMoved", 2, 2)
        page.settle()
        assert page.run(TIP) == ""
        page.key("]")
        first = page.run(TIP)
        page.key("]")
        second = page.run(TIP)
        page.key("[")
        assert first and page.run(TIP) == first
        if len({mark["t"] for mark in marks[:3]}) > 2:
            assert second != first
        assert page.run("return document.querySelector('.tip').getAttribute('aria-live')") == "polite"


def test_the_tooltip_names_its_values(fresh):
    page = fresh
    page.having(".marks [data-names] [data-t]", "marks with names")
    for plot in plots(page):
        names = page.run(PLOT + """const one = all('[data-t]', marks).find((mark) => mark.closest('[data-names]'));
            return one ? one.closest('[data-names]').dataset.names : ''""", plot)
        if not names:
            continue
        centre(page, plot)
        page.key("]")
        lines = page.run("return all('.tip div').map((line) => line.innerText)")
        assert len(lines) >= 1
        for name, line in zip(fields(names), lines):
            assert line.startswith(name)


def test_csv_and_svg_hold_what_is_shown(fresh):
    page = fresh
    for plot in plots(page):
        centre(page, plot)
        for keys in ((), ("+", "+", "+", "+")):
            page.key(*keys)
            shown = page.run(MARKS, plot)
            if button(page, plot, "CSV"):
                [file] = page.files()
                head, *found = csv.reader(io.StringIO(file["text"], newline=""))
                assert head[0] == "series"
                every = [line for line in found]
                # Marks whose middle is at the very edge may be in or out.
                assert abs(len(every) - len(shown)) <= max(3, 0.06 * len(shown)) if keys else len(every) >= len(shown)
                told = {field.strip() for mark in shown for field in fields(mark["t"])[:1]}
                assert told - {""} <= {cell.lstrip("'").strip() for line in every for cell in line} | {cell.strip() for line in every for cell in line}
            assert button(page, plot, "SVG")
            [file] = page.files()
            root = ElementTree.fromstring(file["text"].encode())
            assert root.tag == "{http://www.w3.org/2000/svg}svg" and float(root.get("width")) > 0
            for node in root.iter():
                for name, text in node.attrib.items():
                    assert not name.startswith(("on", "data-", "class")) and "var(" not in text and "currentcolor" not in text.lower(), (name, text)
            assert not re.search(r"https?://(?!www\.w3\.org)", file["text"])
        page.key("0")


def test_svg_is_light_in_the_dark_and_leaves_hidden_series_out(fresh):
    page = fresh
    for plot in plots(page):
        button(page, plot, "SVG")
        [light] = page.files()
        page.run("document.documentElement.setAttribute('data-theme', 'dark')")
        button(page, plot, "SVG")
        [dark] = page.files()
        assert dark["text"] == light["text"]
        assert page.run("return document.documentElement.getAttribute('data-theme')") == "dark"
        page.run("document.documentElement.removeAttribute('data-theme')")
        switches = page.count(".switches button")
        inside = page.run(PLOT + "return new Set(all('[data-series]', marks).map((one) => one.dataset.series)).size", plot)
        if switches and inside:
            page.run(SWITCH_ALL, "none")
            button(page, plot, "SVG")
            [none] = page.files()
            assert len(none["text"]) < len(light["text"])
            page.run(SWITCH_ALL, "all")
