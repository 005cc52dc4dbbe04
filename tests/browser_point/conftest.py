"""A page to point at targets, in one headless browser.

CALIBENCH_PAGES: a folder with points.html, free.html, and about.json, which says where a server is and where the targets are in truth.
CALIBENCH_SHOTS: a folder for pictures. CALIBENCH_CHROMIUM and CALIBENCH_CHROMEDRIVER: as for the other pages.
"""

import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "browser"))

from browsing import browser  # noqa: E402
from pointing import ABOUT, Pointing  # noqa: E402


@pytest.fixture(scope="session")
def driver():
    driver = browser()
    yield driver
    driver.quit()


def opened(driver, url, name):
    page = Pointing(driver, url, name)
    page.console()
    page.requests()
    page.driver.get(url)
    # Nor does a page that is left write its copy once more.
    page.run("try { localStorage.clear(); Storage.prototype.setItem = () => {}; } catch {}")
    page.open()
    return page


def quiet(page):
    """Nothing is said, asked for elsewhere or opened."""
    dialogs = page.run("return window.seen ? window.seen.dialogs : []")
    assert not dialogs, f"dialogs: {dialogs}"
    assert not page.console()
    assert not page.requests()
    assert page.run("""return all('main *').filter((node) => /^(SCRIPT|IMG|IFRAME|STYLE)$/i.test(node.tagName)).length""") == 0


@pytest.fixture
def file(driver):
    """The page with control and measured points, as a file."""
    page = opened(driver, (Path(ABOUT["folder"]) / "points.html").as_uri(), "points")
    yield page
    quiet(page)


@pytest.fixture
def free(driver):
    """A page without control."""
    page = opened(driver, (Path(ABOUT["folder"]) / "free.html").as_uri(), "free")
    yield page
    quiet(page)


@pytest.fixture
def served(driver):
    # Points of the test before are on the disk, and what the server has not got yet waits in the browser: a page of the same server without a script lets go of both.
    driver.get(ABOUT["url"] + "nothing")
    time.sleep(0.5)
    driver.execute_script("localStorage.clear()")
    (Path(ABOUT["folder"]) / "pointed.csv").unlink(missing_ok=True)
    page = opened(driver, ABOUT["url"], "served")
    yield page
    quiet(page)
