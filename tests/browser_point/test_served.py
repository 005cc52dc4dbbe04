"""A page with a server behind it: what is pointed at is measured, and the rest is predicted."""

import time

import pytest
from pointing import ABOUT, TRUTH, apart, cell_name

NAMES = list(TRUTH)
KNOWN = NAMES[:4]


def found(page, name):
    page.wait("return all('.points tbody tr').some((row) => row.querySelector('th').textContent === arguments[0] && row.querySelector('.found').textContent)", name)
    return page.table()[name]


def test_a_click_is_measured(served):
    page = served
    x, y = TRUTH["A"]
    page.point(x + 2, y - 1)
    assert "from the point" in found(page, "A")
    [row], _ = page.saved("save measured")
    assert row["status"] == "measured" and row["method"].startswith("parametric_corner")
    assert apart((float(row["x"]), float(row["y"])), (x, y)) < 0.1
    assert float(row["sxx"]) > 0
    # Moved, it is measured again.
    page.key("ArrowLeft", "ArrowLeft", "ArrowLeft", "ArrowLeft")
    time.sleep(0.5)
    [row], _ = page.saved("save measured")
    assert apart((float(row["x"]), float(row["y"])), (x, y)) < 0.1


def test_what_cannot_be_measured_says_why(served):
    page = served
    page.type_name("flat")
    page.point(600, 600)
    assert found(page, "flat").startswith("✕ rejected: ")
    page.point(*TRUTH["A"])
    [row] = [row for row in page.saved("save measured")[0] if row["target"] == "flat"]
    assert row["status"] == "rejected" and row["x"] == "" and row["reason"]
    page.shot("rejected")


@pytest.mark.parametrize("photo", [0, 1, 2])
def test_four_points_predict_the_others(served, photo):
    page = served
    page.switch(photo)
    for name in KNOWN:
        x, y = TRUTH[name]
        page.point(x + 1, y + 1)
        found(page, name)
    page.wait("return document.querySelector('.how').textContent.includes('Predicted from 4 points by their plane')")
    time.sleep(0.4)
    page.shot(f"predicted-{photo}")
    page.press("take predicted")
    image = ABOUT["photos"][photo]
    places = page.places()
    for name in NAMES[4:]:
        assert apart(places[(image, cell_name(name))], TRUTH[name]) < 0.3, name
        found(page, name)
    rows = {row["target"]: row for row in page.saved("save measured")[0]}
    for name in NAMES:
        row = rows[cell_name(name)]
        assert apart((float(row["x"]), float(row["y"])), TRUTH[name]) < 0.1, row
    page.press("undo")
    assert len(page.places()) == 4


def test_a_reload_measures_again(served):
    page = served
    page.point(*TRUTH["A"])
    found(page, "A")
    time.sleep(0.3)
    page.driver.refresh()
    page.settle()
    assert "from the point" in found(page, "A")


def test_the_script_of_another_page_gets_nothing(served):
    page = served
    url = page.url
    page.driver.get("data:text/html,<p>elsewhere</p>")
    got = page.driver.execute_async_script("""const done = arguments[1];
        fetch(arguments[0], { mode: 'no-cors' }).then((answer) => done(answer.type), () => done('refused'));""", url)
    assert got in ("refused", "opaque")
    page.console()
    page.requests()
    page.open()
