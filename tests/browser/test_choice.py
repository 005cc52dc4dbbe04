"""What is chosen: series, groups, patches; and that the address holds it."""

import csv
import io

import pytest
from browsing import NARROW, WIDE, show_switches
from test_plots import MARKS, centre, plots
from test_tables import rows, tools


def test_series_vanish_everywhere(fresh):
    page = fresh
    page.having("main [data-series]", "series")
    names = page.run("return [...new Set(all('main [data-series]').map((node) => node.dataset.series))]")
    assert page.count(".switches button") == len(names)
    show_switches(page)
    left = """const found = {}; for (const node of all('main [data-series]')) {
        const name = node.dataset.series; found[name] = (found[name] || 0) + (!node.closest('.legend') && shows(node)); } return found"""
    first = page.run(left)
    for index, name in enumerate(names):
        if not first[name]:
            continue
        page.run("document.querySelectorAll('.switches button')[arguments[0]].focus()", index)
        page.key(" " if index % 2 else "Enter")
        assert page.run("return document.activeElement.getAttribute('aria-pressed')") == "false"
        assert page.run(left) == first | {name: 0}
        faint = page.run("""return all('.legend [data-series]')
            .every((node) => (getComputedStyle(node).opacity < 0.6) === (node.dataset.series === arguments[0]))""", name)
        assert faint
        # The others are as they were.
        own = page.run("""return all('table.data').flatMap((table, index) =>
            all('tr[data-series], th', table).some((node) => (node.dataset.series ?? node.textContent.trim()) === arguments[0]) ? [index] : [])""", name)
        for table in own:
            shown = rows(page, table)
            assert tools(page, table, ".count", "return node.textContent").split()[0] == str(len(shown))
            tools(page, table, "button:last-of-type", "node.click()")
            [file] = page.files()
            assert len(list(csv.reader(io.StringIO(file["text"], newline="")))) == len(shown) + 1
        # A click elsewhere folded them up.
        show_switches(page)
        page.run("document.querySelectorAll('.switches button')[arguments[0]].focus()", index)
        page.key(" ")
        assert page.run(left) == first


def test_a_row_chooses_its_group_everywhere(fresh):
    page = fresh
    page.having("table.data tbody tr[data-g]", "rows to choose")
    groups = page.run("return all('table.data tbody tr[data-g]').map((row) => row.dataset.g)")
    row = "const row = all('table.data tbody tr[data-g]').find((one) => one.dataset.g === arguments[0]); row.scrollIntoView({block: 'center'}); "
    for g in dict.fromkeys((groups[0], groups[len(groups) // 2])):
        x, y = page.run(row + "const box = row.cells[0].getBoundingClientRect(); return [box.left + 5, box.top + box.height / 2]", g)
        page.click(x, y)
        wrong = page.run("return all('[data-g]').filter((node) => node.classList.contains('chosen') !== (node.dataset.g === arguments[0])).length", g)
        assert wrong == 0
        assert page.run(row + "return row.getAttribute('aria-current')", g) == "true"
        dim = page.run("""return all('.marks [data-g]').filter((node) => shows(node))
            .filter((node) => { const style = getComputedStyle(node);
              return (style.opacity * style.strokeOpacity < 0.5) === (node.dataset.g === arguments[0]); }).length""", g)
        assert dim == 0, "others are dimmed, and only they"
        page.click(x, y)
        assert page.count(".chosen") == 0 and not page.run("return document.body.classList.contains('choosing')")
    page.click(x, y)
    assert page.count(".chosen") > 0
    page.key("Escape")
    assert page.count(".chosen") == 0


def test_a_mark_chooses_its_group_and_shows_its_patch(fresh):
    page = fresh
    page.having(".marks [data-g]", "marks of groups")
    for plot in plots(page):
        centre(page, plot)
        marks = [mark for mark in page.run(MARKS, plot) if mark["g"] and 60 < mark["y"] < 890]
        if not marks:
            continue
        mark = marks[0]
        page.click(mark["x"], mark["y"])
        g = page.run("return all('.marks .chosen').map((node) => node.dataset.g)")
        near = {other["g"] for other in marks if abs(other["x"] - mark["x"]) < 15 and abs(other["y"] - mark["y"]) < 15}
        assert g and len(set(g)) == 1 and g[0] in near
        page.key("Escape")
        assert page.count(".chosen") == 0
        page.key("]", "Enter")
        assert page.count(".marks .chosen") > 0
        page.key("Enter")
        assert page.count(".marks .chosen") == 0


PATCHED = """const keys = new Set(all('.patches .patch').map((node) => node.dataset.k)); """


def test_patches_open_at_the_side_and_close(fresh):
    page = fresh
    page.having(".patches .patch", "patches")
    for width in (WIDE, NARROW):
        page.open()
        page.size(width)
        page.settle()
        assert not page.run("return shows(document.querySelector('.panel'))")
        assert not page.run("return all('.patches .patch').some((node) => shows(node))")
        steps = page.run(PATCHED + """const mark = all('.marks [data-t][data-k]').find((node) => keys.has(node.dataset.k));
            if (!mark) return 0; const svg = mark.closest('svg[data-box]'); svg.focus();
            return all('.marks [data-t]', svg).indexOf(mark) + 1;""")
        if not 0 < steps < 200:
            pytest.skip("no patch of one of the first marks")
        page.key(*["]"] * steps, "Enter")
        left, top, right, bottom, k = page.run("""const panel = document.querySelector('.panel');
            return [...edges(panel), panel.querySelector('.patch').dataset.k]""")
        if width == NARROW:
            assert f"k={k}" in page.written()
        assert 0 <= left < right <= width and 0 <= top < bottom <= 900
        assert left > width / 2 if width > 1000 else top > 450
        assert page.run("return getComputedStyle(document.querySelector('.panel')).position") == "fixed"
        page.shot(f"{width}-patch")
        page.key("Escape")
        assert not page.run("return shows(document.querySelector('.panel'))")


STATE = """
return {theme: document.documentElement.getAttribute('data-theme'),
  pressed: all('.switches button').map((one) => one.getAttribute('aria-pressed')),
  sorted: all('th').map((one) => one.getAttribute('aria-sort')),
  filters: all('.tools input, .tools select').map((one) => one.value),
  rows: all('table.data tbody tr').filter((row) => shows(row)).map((row) => row.innerText),
  zooms: all('.marks').map((one) => one.getAttribute('transform')),
  ticks: all('.tick text').map((one) => one.textContent),
  chosen: all('.chosen').length, patch: document.querySelector('.panel').innerText,
  scene: all('.scene canvas').map((one) => one.toDataURL())};
"""


def change_all(page):
    """Changes whatever the page has; the script's own controls alone."""
    page.run("const select = document.querySelector('.toolbar select'); select.value = 'dark'; select.dispatchEvent(new Event('change'))")
    page.run("const [one] = document.querySelectorAll('.switches button'); if (one) one.click()")
    page.run("""for (const table of all('table.data')) {
        const head = table.tHead.rows[0].cells; head[head.length - 1].click(); head[head.length - 1].click(); }""")
    page.run("for (const input of document.querySelectorAll('.tools input')) { input.value = 'o; e'; input.dispatchEvent(new Event('input')); }")
    if page.count("figure.plot svg[data-box]"):
        for plot in plots(page):
            centre(page, plot)
            page.key("+", "+", "ArrowRight", "ArrowDown")
    if page.count("tr[data-g][tabindex='0']"):
        page.run("const row = all(\"tr[data-g][tabindex='0']\").find((one) => shows(one)); if (row) row.focus()")
        page.key("Enter")
    for index in range(page.count(".scene canvas")):
        page.run("document.querySelectorAll('.scene canvas')[arguments[0]].focus()", index)
        page.key("ArrowLeft", "ArrowUp", "+")
    page.run("document.activeElement.blur()")
    page.settle()


def test_the_address_restores_the_view(fresh):
    page = fresh
    first = page.run(STATE)
    change_all(page)
    before = page.run(STATE)
    address = page.written()
    page.driver.refresh()
    page.settle()
    page.settle()
    after = page.run(STATE)
    for part in before:
        assert after[part] == before[part], part
        if part not in ("patch", "pressed", "chosen") and first[part]:
            assert before[part] != first[part] or part in ("filters", "rows", "sorted"), part
    page.driver.get("about:blank")
    page.driver.get(page.url + address)
    page.settle()
    assert page.run(STATE)["rows"] == before["rows"]
    page.run("all('.toolbar button').find((one) => one.textContent === 'reset').click()")
    page.settle()
    page.settle()
    reset = page.run(STATE)
    for part in ("pressed", "sorted", "filters", "rows", "zooms", "ticks", "chosen"):
        if part == "zooms":
            assert [each or None for each in reset[part]] == [each or None for each in first[part]]
        else:
            assert reset[part] == first[part], part
    assert page.written() == "#theme=dark"


def test_the_address_is_followed_and_nonsense_does_no_harm(fresh):
    page = fresh
    first = page.run(STATE)
    for address in ("#theme=dark", "#off=99,x&g=nobody&k=%E0%A4%A&sort.t=1&theme=%3Cb%3E", "#=&&&=5", "#" + "a" * 5000):
        page.run("location.hash = arguments[0]", address)
        page.settle()
        theme = page.run("return document.documentElement.getAttribute('data-theme')")
        assert theme == ("dark" if address == "#theme=dark" else None)
        assert page.run(STATE)["rows"] == first["rows"]
    keys = [f"zoom.{name}" for name in page.run("return all('figure.plot').map((one) => one.id)")]
    keys += [f"sort.{name}" for name in page.run("return all('table.data').map((one) => one.id)")]
    for text in ("1e999,0,0", "NaN", "-5,1e9,1e9", "9,9,9,9,9,9", "x:y", "99999,1"):
        page.run("location.hash = arguments[0]", "#" + "&".join(f"{key}={text}" for key in keys))
        page.settle()
        assert page.run(STATE)["rows"] or not first["rows"]
