"""The explorer of the atlas says what the page of the same records says, and interpolates between cells alone."""

import math

import pytest

ASK = "return JSON.parse(all('.explorer-data')[0].textContent)"
SET = """const [index, value] = arguments;
const node = all('.asked select')[index];
node.value = String(value);
node.dispatchEvent(new Event('change'));"""
FIELD = """const [index, value] = arguments;
const node = all('.asked input[type=number]')[index];
node.value = String(value);
node.dispatchEvent(new Event('change'));"""
TAKE = "const node = document.querySelector('[data-take]'); return node ? node.dataset.take : null"
RANKING = "return all('table.ranking tbody tr').map((row) => [...row.cells].map((cell) => cell.textContent))"
GROUPS = """const found = {};
for (const heading of all('#atlas-which-operator h3')) {
  const table = heading.nextElementSibling && [...document.querySelectorAll('#atlas-which-operator table')]
    .find((one) => heading.compareDocumentPosition(one) & 4);
  if (table) found[heading.textContent.trim()] = [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent.trim()));
}
return found"""


@pytest.fixture
def asked(fresh):
    fresh.having(".explorer", "explorer")
    return fresh, fresh.run(ASK)


def takes(cell):
    return "" if cell.startswith("none") else cell


def test_its_answer_is_the_page_s_at_every_cell(asked):
    page, data = asked
    groups = page.run(GROUPS)
    checked = 0
    for number, question in enumerate(data["questions"]):
        table = groups[question["title"]]
        assert [row[0] for row in table] == [row["title"] for row in question["rows"]]
        page.run(SET, 0, number)
        if not question["axes"]:
            for place, row in enumerate(table):
                page.run(SET, 1, place)
                assert page.run(TAKE) == takes(row[1]), (question["title"], row[0])
                checked += 1
            continue
        for at, place in zip(question["cells"]["at"], question["cells"]["row"]):
            for axis, index in enumerate(at):
                page.run(FIELD, axis, question["axes"][axis]["values"][index])
            assert page.run(TAKE) == takes(table[place][1]), (question["title"], at)
            checked += 1
    assert checked > 40


def test_its_answer_with_a_speed_is_the_page_s(asked):
    page, data = asked
    rows = page.run(GROUPS)["Chess corners, by the speed that is needed"]
    number = next(index for index, one in enumerate(data["questions"]) if one["title"] == "Chess corners, by image")
    page.run(SET, 0, number)
    for axis, value in enumerate([0.7, 2]):
        page.run(FIELD, axis, value)
    speeds = page.run("return [...all('.asked select')[1].options].map((one) => [one.textContent, one.value])")
    for row in rows:
        speed = next(value for text, value in speeds if text == row[0])
        page.run(SET, 1, speed)
        assert page.run(TAKE) == takes(row[1]), row[0]


def test_it_interpolates_between_cells_and_never_beyond(asked):
    page, data = asked
    question = data["questions"][0]
    cells, (blur, noise) = question["cells"], question["axes"]
    page.run(SET, 0, 0)
    place = {tuple(at): cell for cell, at in enumerate(cells["at"])}
    level = noise["values"].index(2)
    low, high = blur["values"].index(0.7), blur["values"].index(1)
    page.run(FIELD, 0, math.sqrt(0.7 * 1))
    page.run(FIELD, 1, 2)
    method = 0
    ends = [cells["rmse"][place[(index, level)]][method] for index in (low, high)]
    shown = {row[0]: float(row[1]) for row in page.run(RANKING)}
    # Half way in logarithms is the geometric mean; the blur was typed in three digits at least.
    assert shown[cells["names"][method]] == pytest.approx(math.sqrt(ends[0] * ends[1]), rel=6e-3)
    assert "between 0.7 and 1" in page.run("return document.querySelector('.where').textContent")
    for wanted, held in ((99, max(blur["values"])), (0.001, min(blur["values"]))):
        page.run(FIELD, 0, wanted)
        assert float(page.run("return all('.asked input[type=number]')[0].value")) == held


def test_slider_ranking_plot_and_address_answer(asked):
    page, data = asked
    page.run(SET, 0, 0)
    before = page.run(RANKING)
    page.run("const node = all('.asked input[type=range]')[1]; node.value = '1'; node.dispatchEvent(new Event('input'))")
    after = page.run(RANKING)
    assert len(before) == len(after) > 10 and before != after
    sound = [float(row[1]) for row in after if float(row[3]) <= 100 * data["most"]]
    assert sound == sorted(sound)
    assert page.count(".frontier .spot") > 5
    page.run("document.querySelector('.frontier .spot').focus()")
    assert "RMSE" in page.run("return document.querySelector('.tip').textContent")
    address, told = page.written(), page.run("return document.querySelector('.told').textContent")
    assert "ask=" in address
    page.driver.get("about:blank")
    page.driver.get(page.url + address)
    page.settle()
    assert page.run("return document.querySelector('.told').textContent") == told


def test_only_what_differs(fresh):
    page = fresh
    page.having("button.differs", "printed rows with verdicts")
    rows = "return all('table.data tbody tr').filter((row) => shows(row)).length"
    before = page.run(rows)
    page.run("document.querySelector('button.differs').click()")
    label = page.run("return document.querySelector('button.differs').textContent")
    count, of = (int(label.split(":")[1].split()[place]) for place in (0, 2))
    assert before - page.run(rows) == of - count > 0
    page.run("document.querySelector('button.differs').click()")
    assert page.run(rows) == before
