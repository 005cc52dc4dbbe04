"""Tables: sorted, filtered, taken along."""

import csv
import io
import re

import pytest
from browsing import some

# A table's columns as the test sees them: the key of each cell of each row shown, in order.
ROWS = """
const table = document.querySelectorAll('table.data')[arguments[0]];
return [...table.tBodies[0].rows].filter((row) => shows(row))
  .map((row) => [...row.cells].map((cell) => [cell.innerText.trim(), cell.dataset.v === undefined ? null : cell.dataset.v]));
"""
HEAD = "document.querySelectorAll('table.data')[arguments[0]].tHead.rows[0].cells[arguments[1]]"
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE)
EMPTY = {"", "-", "–", "—", "NaN"}


def value(cell):
    text = cell[0] if cell[1] is None else cell[1]
    if text in EMPTY:
        return None
    plain = text.replace("−", "-")
    return float(plain) if NUMBER.fullmatch(plain) else text


def rows(page, table):
    return page.run(ROWS, table)


def tables(page):
    return some(page, page.having("table.data", "tables"), "tables")


def tools(page, table, selector, script):
    """Runs a script on a control of a table."""
    return page.run(
        """const box = document.querySelectorAll('table.data')[arguments[0]]; const tools = (box.closest('.table') || box).previousElementSibling;
        const node = tools.querySelector(arguments[1]); if (!node) return null; """
        + script,
        table,
        selector,
    )


def type_filter(page, table, text):
    return tools(page, table, "input", f"node.value = {text!r}; node.dispatchEvent(new Event('input', {{bubbles: true}})); return true")


def assert_sorted(found, direction, what):
    filled = [each for each in found if each is not None]
    assert found == filled + [None] * (len(found) - len(filled)), f"{what}: empty cells come last"
    numeric = [each for each in filled if isinstance(each, float)]
    assert numeric == sorted(numeric, reverse=direction == "descending"), what
    texts = [each for each in filled if isinstance(each, str)]
    plain = [each for each in texts if each.isascii() and each.isalpha() and each.islower()]
    assert plain == sorted(plain, reverse=direction == "descending"), what


def test_every_column_sorts_by_click_and_by_keyboard(fresh):
    page = fresh
    for table in tables(page):
        before = rows(page, table)
        columns = page.run("return document.querySelectorAll('table.data')[arguments[0]].tHead.rows[0].cells.length", table)
        for column in range(columns):
            for press in ("click", "key"):
                for direction in ("ascending", "descending", "none"):
                    if press == "click":
                        page.run(f"{HEAD}.click()", table, column)
                    else:
                        page.run(f"{HEAD}.querySelector('button').focus()", table, column)
                        page.key("Enter" if direction == "ascending" else " ")
                    assert page.run(f"return {HEAD}.getAttribute('aria-sort')", table, column) == direction
                    after = rows(page, table)
                    if direction == "none":
                        assert after == before
                    else:
                        assert_sorted([value(row[column]) for row in after], direction, (table, column, press))
                        assert sorted(map(str, after)) == sorted(map(str, before))
                if column:
                    break


def test_equal_rows_keep_their_order(fresh):
    page = fresh
    for table in tables(page):
        before = rows(page, table)
        for column in range(len(before[0]) if before else 0):
            keys = [value(row[column]) for row in before]
            page.run(f"{HEAD}.click()", table, column)
            after = rows(page, table)
            for key in set(keys):
                assert [row for row in after if value(row[column]) == key] == [row for row in before if value(row[column]) == key]


def test_the_filter_keeps_rows_that_hold_the_text(fresh):
    page = fresh
    tried = 0
    for table in tables(page):
        before = rows(page, table)
        if not type_filter(page, table, ""):
            assert len(before) <= 8, "a table of more than 8 rows has a filter"
            continue
        tried += 1
        wanted = before[len(before) // 2][0][0]
        type_filter(page, table, wanted.upper())
        kept = [row for row in before if any(wanted.lower() in " ".join(cell[0].lower().split()) for cell in row)]
        assert rows(page, table) == kept
        count = tools(page, table, ".count", "return node.textContent")
        assert count.startswith(f"{len(kept)} of {len(before)}" if len(kept) < len(before) else str(len(before)))
        type_filter(page, table, "no row holds this")
        assert rows(page, table) == []
        assert tools(page, table, ".count", "return node.textContent").startswith(f"0 of {len(before)}")
        type_filter(page, table, "")
        assert rows(page, table) == before
    if not tried:
        pytest.skip("this page has no table of more than 8 rows")


def test_the_filter_compares_numbers_by_column(fresh):
    page = fresh
    tried = 0
    for table in tables(page):
        before = rows(page, table)
        if not type_filter(page, table, ""):
            continue
        names = page.run("return [...document.querySelectorAll('table.data')[arguments[0]].tHead.rows[0].cells].map((cell) => cell.textContent.trim())", table)
        for column, name in enumerate(names):
            numbers = sorted(each for row in before if isinstance(each := value(row[column]), float))
            if len(set(numbers)) < 2 or ";" in name or any(sign in name for sign in "<>="):
                continue
            tried += 1
            bound = numbers[len(numbers) // 2]
            for sign, holds in ((">", lambda v: v > bound), ("<", lambda v: v < bound), (">=", lambda v: v >= bound)):
                type_filter(page, table, f"{name.upper()} {sign} {bound!r}")
                assert rows(page, table) == [row for row in before if isinstance(v := value(row[column]), float) and holds(v)], (name, sign, bound)
        text = before[0][0][0]
        if text and not set(text) & set("<>=;'\\") and not isinstance(value(before[0][0]), float):
            type_filter(page, table, f"{names[0]}={text}")
            assert rows(page, table) == [row for row in before if row[0][0].lower() == text.lower()]
    if not tried:
        pytest.skip("this page has no long table with numbers")


def test_selects_filter_by_the_values_of_their_column(fresh):
    page = fresh
    page.having("table.data th[data-filter]", "column to select from")
    for table in tables(page):
        columns = page.run("""return [...document.querySelectorAll('table.data')[arguments[0]].tHead.rows[0].cells]
            .flatMap((cell, index) => cell.dataset.filter === undefined ? [] : [index])""", table)
        before = rows(page, table)
        for number, column in enumerate(columns):
            select = f"select:nth-of-type({number + 1})"
            options = tools(page, table, select, "return [...node.options].map((option) => option.textContent)")
            distinct = {" ".join(row[column][0].split()) for row in before}
            assert len(options) == len(distinct) + 1
            for index in range(1, len(options)):
                tools(page, table, select, f"node.selectedIndex = {index}; node.dispatchEvent(new Event('change'))")
                kept = rows(page, table)
                assert kept == [row for row in before if row[column][0] == kept[0][column][0]] and len(kept) > 0
            tools(page, table, select, "node.selectedIndex = 0; node.dispatchEvent(new Event('change'))")
            assert rows(page, table) == before


def test_the_csv_has_the_rows_shown(fresh):
    page = fresh
    for table in tables(page):
        before = rows(page, table)
        if type_filter(page, table, "") and before:
            type_filter(page, table, before[-1][0][0][:3].replace(";", ""))
        page.run(f"{HEAD}.click(); {HEAD}.click()", table, 0)
        shown = rows(page, table)
        tools(page, table, "button:last-of-type", "node.click()")
        [file] = page.files()
        assert file["name"].endswith(".csv")
        assert file["text"].count("\r\n") >= len(shown) + 1
        head, *found = csv.reader(io.StringIO(file["text"], newline=""))
        assert len(head) == page.run("return document.querySelectorAll('table.data')[arguments[0]].tHead.rows[0].cells.length", table)
        assert len(found) == len(shown)
        for line, row in zip(found, shown):
            for text, (seen, exact) in zip(line, row):
                wanted = " ".join((seen if exact is None or exact in EMPTY else exact).split())
                assert text.lstrip("'") == wanted.lstrip("'")
                assert is_safe(text), text


HOSTILE = ['a "b", c', "=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "<img src=x onerror=alert(1)>", "-3.5", "+7"]


def test_the_csv_quotes_and_defuses(fresh):
    page = fresh
    for table in tables(page):
        columns = len(rows(page, table)[0]) if rows(page, table) else 0
        for at in range(0, len(HOSTILE), columns or len(HOSTILE)):
            texts = HOSTILE[at : at + columns]
            page.run("""const row = document.querySelectorAll('table.data')[arguments[0]].tBodies[0].rows[0];
                arguments[1].forEach((text, index) => { delete row.cells[index].dataset.v; row.cells[index].textContent = text; });""", table, texts)
            tools(page, table, "button:last-of-type", "node.click()")
            [file] = page.files()
            found = list(csv.reader(io.StringIO(file["text"], newline="")))[1][: len(texts)]
            assert found == [text if is_safe(text) else f"'{text}" for text in texts]


def is_safe(text):
    """Whether no spreadsheet takes it for a formula."""
    if not text or text[0] not in "=+-@\t\r":
        return True
    try:
        return float(text) == float(text)
    except ValueError:
        return False


def test_rows_are_reached_and_chosen_by_keyboard(fresh):
    page = fresh
    page.having("table.data tbody tr[data-g]", "rows to choose")
    page.run("document.querySelector('table.data tbody tr[data-g][tabindex=\"0\"]').focus()")
    first = page.run("return document.activeElement.dataset.g")
    page.key("Enter")
    assert page.run("return document.activeElement.classList.contains('chosen') && document.body.classList.contains('choosing')")
    page.key("ArrowDown")
    assert page.run("return document.activeElement.tagName") == "TR"
    page.key(" ")
    second = page.run("return all('tr.chosen').map((row) => row.dataset.g)")
    assert second and (first not in second or page.count("table.data tbody tr[data-g]") == 1)
    page.key("Escape")
    assert page.count(".chosen") == 0
