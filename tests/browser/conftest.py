"""One headless browser for all pages.

CALIBENCH_PAGES: a folder of .html files, found however deep they lie. CALIBENCH_SHOTS: a folder for pictures of them.
CALIBENCH_CHROMIUM and CALIBENCH_CHROMEDRIVER: the programs, unless they are in /usr/bin.
"""

import pytest
from browsing import FOLDER, PAGES, Page, browser


def pytest_generate_tests(metafunc):
    if "page" in metafunc.fixturenames:
        metafunc.parametrize("page", PAGES, ids=[str(path.relative_to(FOLDER)) for path in PAGES], indirect=True, scope="session")


@pytest.fixture(scope="session")
def driver():
    driver = browser()
    yield driver
    driver.quit()


@pytest.fixture(scope="session")
def page(driver, request):
    return Page(driver, request.param)


@pytest.fixture
def fresh(page):
    """The page, just opened; afterwards it must have been quiet."""
    page.console()
    page.requests()
    page.open()
    yield page
    dialogs = page.run("return window.seen ? window.seen.dialogs : []")
    assert not dialogs, f"dialogs: {dialogs}"
    assert not page.console()
    assert not page.requests()
