"""Drawings that were pictures: methods hidden, places read off by mouse and keyboard, what is shown taken along."""

import csv
import io
import xml.etree.ElementTree as ElementTree

import pytest
from browsing import NARROW, WIDE, show_switches
from test_plots import TIP, fields

# The figures that tell of places, each with what it tells: series, place in the drawing, values; an empty value is that of the place before.
TOLD = """return all('figure.plot').filter((figure) => figure.querySelector('[data-p]')).map((figure) => {
  const marks = figure.querySelector('.marks');
  return {id: figure.id, names: marks.dataset.names || '', of: marks.dataset.of || '',
    groups: all('[data-p]', marks).map((group) => [group.dataset.m === undefined ? null : Number(group.dataset.m), group.dataset.p])}; })"""
PLACE = """const svg = document.getElementById(arguments[0]).querySelector('svg[data-box]');
const m = svg.querySelector('.marks').getScreenCTM();
return [arguments[1] * m.a + m.e, arguments[2] * m.d + m.f];"""
FOCUS = """const svg = document.getElementById(arguments[0]).querySelector('svg[data-box]');
svg.scrollIntoView({block: 'center', inline: 'center'}); svg.focus({preventScroll: true});"""
CENTRE = """const [id, x, y] = arguments; const svg = document.getElementById(id).querySelector('svg[data-box]');
svg.focus({preventScroll: true});
const m = svg.getScreenCTM(); const wide = svg.closest('.wide');
if (wide) wide.scrollLeft += x * m.a + m.e - wide.getBoundingClientRect().left - wide.clientWidth / 2;
scrollBy(0, y * m.d + m.f - innerHeight / 2);"""
BUTTON = """const [id, text] = arguments;
all('.tools button', document.getElementById(id)).find((node) => node.textContent === text).click();"""
SWITCH = "return all('.switches button').findIndex((one) => one.textContent === arguments[0])"


def told(page):
    """Figures by their names: series, place and values of each place."""
    found = {}
    for figure in page.run(TOLD):
        series, places = fields(figure["of"]), []
        for of, text in figure["groups"]:
            last = []
            for line in text.split("\n"):
                at, *values = fields(line)
                last = [value or (last[index] if index < len(last) else "") for index, value in enumerate(values)]
                x, y = map(int, at.split())
                places.append((None if of is None else series[of], (x, y), last))
        found[figure["id"]] = (fields(figure["names"]), places)
    return found


@pytest.fixture
def drawn(fresh):
    fresh.having("[data-p]", "drawings that tell of places")
    return fresh, told(fresh)


def words(text):
    return " ".join(text.split())


def said(names, values):
    """What the tooltip says of a place."""
    return words(" ".join(f"{name} {value}" for name, value in zip(names, values) if name or value))


def sample(places):
    return [places[index] for index in sorted({0, len(places) // 2, len(places) - 1})]


def test_every_place_has_its_values(drawn):
    page, figures = drawn
    for name, (names, places) in figures.items():
        assert places and names, name
        for series, (x, y), values in places:
            assert len(values) == len(names), (name, values)
            assert x >= 0 and y >= 0
            assert all(value for label, value in zip(names, values) if label), (name, names, values)


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_the_mouse_reads_every_drawing(drawn, width):
    page, figures = drawn
    page.size(width)
    page.settle()
    for name, (names, places) in figures.items():
        for _, (x, y), values in sample(places):
            page.run(CENTRE, name, x, y)
            page.settle()
            px, py = page.run(PLACE, name, x, y)
            page.mouse("mouseMoved", px, py)
            page.settle()
            # Places closer to each other than a pixel are one to a mouse.
            near = {said(names, other) for _, (ox, oy), other in places if abs(ox - x) <= 1 and abs(oy - y) <= 1}
            assert words(page.run(TIP)) in near, (name, values)
            assert page.run("return all('.point.now').length") == 1, "the place is ringed"
        page.mouse("mouseMoved", 2, 2)


def test_the_keyboard_goes_from_place_to_place(drawn):
    page, figures = drawn
    for name, (names, places) in figures.items():
        page.run(FOCUS, name)
        for key, index in (("ArrowRight", 0), ("ArrowRight", 1), ("]", 2), ("[", 1), ("ArrowLeft", 0), ("ArrowLeft", -1)):
            page.key(key)
            assert words(page.run(TIP)) == said(names, places[index % len(places)][2]), (name, key, index)


def test_a_zoomed_drawing_is_read_as_well(drawn):
    page, figures = drawn
    for name, (names, places) in list(figures.items())[:: max(1, len(figures) // 8)]:
        _, (x, y), values = places[len(places) // 2]
        page.run(CENTRE, name, x, y)
        px, py = page.run(PLACE, name, x, y)
        page.wheel(px, py, -250)
        px, py = page.run(PLACE, name, x, y)
        page.mouse("mouseMoved", px, py)
        page.settle()
        near = {said(names, other) for _, (ox, oy), other in places if abs(ox - x) <= 1 and abs(oy - y) <= 1}
        assert words(page.run(TIP)) in near
        size = page.run("const box = document.querySelector('.point.now').getBoundingClientRect(); return box.width")
        assert size < 30, "a ring keeps its size"
        page.key("0")


def taken(page, name, text):
    page.run(BUTTON, name, text)
    [file] = page.files()
    return file["text"]


def test_csv_and_svg_hold_what_is_shown(drawn):
    page, figures = drawn
    for name, (names, places) in figures.items():
        head, *rows = csv.reader(io.StringIO(taken(page, name, "CSV"), newline=""))
        own = [label for label in names if label]
        assert head[0] == "series" and [label for label in head[1:] if not label.startswith("value ")] == own
        assert len(rows) == len(places)
        for row, (series, _, values) in zip(rows, places):
            assert row[0].lstrip("'") == (series or "")
            by_name = dict(zip(head, row))
            assert [by_name[label].lstrip("'") for label in own] == [value for label, value in zip(names, values) if label]
        root = ElementTree.fromstring(taken(page, name, "SVG").encode())
        assert root.tag == "{http://www.w3.org/2000/svg}svg"


def test_a_method_is_hidden_everywhere_and_by_the_link(drawn):
    page, figures = drawn
    by_series = {}
    for name, (_, places) in figures.items():
        for series, *_ in places:
            if series is not None:
                by_series.setdefault(series, set()).add(name)
    if not by_series:
        pytest.skip("no drawing of methods")
    method = max(by_series, key=lambda series: (len(by_series[series]), series))
    name = sorted(by_series[method])[0]
    shown = "return all('[data-series]').filter((node) => node.dataset.series === arguments[0] && shows(node)).length"
    columns = "return all('table.data thead th').filter((head) => head.textContent.trim() === arguments[0] && shows(head)).length"
    before = page.run(shown, method)
    svg = taken(page, name, "SVG")
    assert before > 0
    show_switches(page)
    page.run("all('.switches button')[arguments[0]].focus()", page.run(SWITCH, method))
    page.key("Enter")
    assert page.run(shown, method) == 0 and page.run(columns, method) == 0
    names, places = figures[name]
    _, *rows = csv.reader(io.StringIO(taken(page, name, "CSV"), newline=""))
    assert len(rows) == sum(series != method for series, *_ in places)
    assert len(taken(page, name, "SVG")) < len(svg), "the drawing is taken along as it is shown"
    kept = [place for place in places if place[0] != method]
    if kept:
        page.run(FOCUS, name)
        page.key("ArrowRight")
        assert words(page.run(TIP)) == said(names, kept[0][2]), "hidden places are passed over"
    address = page.written()
    assert "off=" in address
    page.driver.get("about:blank")
    page.driver.get(page.url + address)
    page.settle()
    assert page.run(shown, method) == 0 and page.run(columns, method) == 0
    page.run("all('.toolbar button').find((one) => one.textContent === 'reset').click()")
    page.settle()
    assert page.run(shown, method) == before
    assert taken(page, name, "SVG") == svg


def test_many_switches_are_found_hidden_and_shown_together(drawn):
    page, _ = drawn
    page.having(".many .switches button", "many switches")
    page.run("document.querySelector('.many').closest('details').querySelector('summary').focus()")
    page.key("Enter")
    assert page.run("return shows(document.querySelector('.many'))")
    for width in (NARROW, WIDE):
        page.size(width)
        page.settle()
        left, _, right, _ = page.run("return edges(document.querySelector('.many'))")
        assert 0 <= left and right <= width
    wanted = page.run("return all('.many .switches button')[1].textContent")
    page.run("const find = document.querySelector('.many input'); find.value = arguments[0].toUpperCase(); find.dispatchEvent(new Event('input'))", wanted)
    found = page.run("return all('.many .switches button').filter((one) => shows(one)).map((one) => one.textContent)")
    assert wanted in found and all(wanted.lower() in one.lower() for one in found)
    press = "all('.many .find button').find((one) => one.textContent === arguments[0]).click()"
    summary = "return document.querySelector('.many').closest('details').querySelector('summary').textContent"
    count = page.count(".switches button")
    page.run(press, "none")
    assert page.run(summary) == f"methods: 0 of {count}"
    assert page.run("return all('.marks [data-series]').filter((node) => shows(node)).length") == 0
    page.run(press, "all")
    assert page.run(summary) == f"methods: all of {count}"
    page.run("document.querySelector('.many input').focus()")
    page.key("Escape")
    assert not page.run("return document.querySelector('.many').closest('details').open")
    assert page.run("return document.activeElement.tagName") == "SUMMARY"
