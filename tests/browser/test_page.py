"""The page as a whole: quiet, readable, of any width."""

from browsing import FAINT, NARROW, PAGES, WIDE


def test_there_are_pages():
    assert PAGES, "CALIBENCH_PAGES names a folder of .html files"


def test_nothing_is_said_asked_for_or_opened(fresh):
    page = fresh
    # The page's own policy holds the script to this, too.
    policy = page.run("""const meta = document.querySelector('meta[http-equiv="Content-Security-Policy"]'); return meta ? meta.content : ''""")
    assert "default-src 'none'" in policy
    for selector in ("img", "link", "iframe", "object", "embed", "audio", "video", "image"):
        sources = page.run("""return all(arguments[0]).map((node) =>
            node.getAttribute('src') || node.getAttribute('href') || node.getAttribute('data') || '')""", selector)
        assert all(source.startswith("data:") for source in sources), (selector, sources)
    handlers = page.run("""return all('*').flatMap((node) =>
        node.getAttributeNames().filter((name) => name.startsWith('on')).map((name) => node.tagName + ' ' + name))""")
    assert not handlers
    # Names from outside are text.
    markup = page.run("""return all('main td *, main th *, .toolbar button *, figcaption *')
        .filter((node) => /^(SCRIPT|IMG|IFRAME|STYLE)$/i.test(node.tagName) && !node.closest('.patch')).length""")
    assert markup == 0


CHOOSE_THEME = "const select = document.querySelector('.toolbar select'); select.value = arguments[0]; select.dispatchEvent(new Event('change')); "


def test_the_page_fits_its_window(fresh):
    page = fresh
    for width in (NARROW, 768, WIDE):
        page.size(width)
        page.settle()
        assert page.run("return document.documentElement.scrollWidth") <= width
        assert page.run("scrollTo(500, 0); return scrollX") == 0
        for part in ("header", "main", ".toolbar"):
            left, _, right, _ = page.run("return edges(document.querySelector(arguments[0]))", part)
            assert left >= 0 and right <= width, (part, width)
        for theme in ("light", "dark"):
            page.run(CHOOSE_THEME, theme)
            page.settle()
            page.shot(f"{width}-{theme}")


def test_without_a_script_it_is_a_page_to_read(fresh):
    page = fresh
    shown = page.count("main table.data tbody tr")
    page.cdp("Emulation.setScriptExecutionDisabled", value=True)
    try:
        page.driver.get("about:blank")
        page.driver.get(page.url)
        # The browser's own hands still run what the test asks for.
        assert page.count(".toolbar") == 0 and page.count(".tools") == 0
        hidden = page.run("""return [...document.querySelectorAll('main table, main table tbody tr, main figure:not(.patch) > svg, h1, .verdict')]
            .filter((node) => { const box = node.getBoundingClientRect(); return box.width < 1 || box.height < 1; })
            .map((node) => node.outerHTML.slice(0, 80))""")
        assert not hidden
        assert page.count("main table.data tbody tr") == shown
        for width in (NARROW, WIDE):
            page.size(width)
            assert page.run("return document.documentElement.scrollWidth") <= width
            page.shot(f"{width}-no-script")
    finally:
        page.cdp("Emulation.setScriptExecutionDisabled", value=False)


def test_dark_and_light(fresh):
    page = fresh
    ground = "return getComputedStyle(document.documentElement).backgroundColor"
    light = page.run(ground)
    assert not page.run(FAINT, "h1, h2, p, li, a, th, td, caption, figcaption, button, summary, footer")
    page.media(prefers_color_scheme="dark")
    dark = page.run(ground)
    assert dark != light
    assert not page.run(FAINT, "h1, h2, p, li, a, th, td, caption, figcaption, button, summary, footer")
    assert page.run(CHOOSE_THEME + ground, "light") == light
    page.media(prefers_color_scheme="light")
    assert page.run(CHOOSE_THEME + ground, "dark") == dark
    assert "theme=dark" in page.written()
    page.driver.refresh()
    page.settle()
    assert page.run(ground) == dark


def test_paper_has_no_tools_and_all_rows(fresh):
    page = fresh
    if page.count(".switches button"):
        page.run("document.querySelector('.switches button').click()")
    if page.count(".tools input"):
        page.run("const input = document.querySelector('.tools input'); input.value = 'nothing is called so'; input.dispatchEvent(new Event('input'))")
    page.run("document.documentElement.setAttribute('data-theme', 'dark')")
    page.media("print")
    seen = page.run("""return all('.toolbar, .tools, .tip, .panel, .space').filter((node) => shows(node)).map((node) => node.className)""")
    assert not seen
    gone = page.run("return all('main tbody tr, main .series').filter((node) => !shows(node)).length")
    assert gone == 0
    paper = page.run("return getComputedStyle(document.documentElement).getPropertyValue('--paper').trim()")
    assert paper == "#ffffff"


def test_links_within_the_page_keep_what_is_chosen(fresh):
    page = fresh
    page.having("nav a", "links to its sections")
    page.run(CHOOSE_THEME, "dark")
    target = page.run("const link = all('nav a').pop(); link.click(); return link.getAttribute('href').slice(1)")
    written = page.written()
    assert "theme=dark" in written and target in written
    top = page.run("return document.getElementById(decodeURIComponent(arguments[0])).getBoundingClientRect().top", target)
    assert -1 <= top < 900
    page.driver.back()
    page.settle()
    assert "theme=dark" in page.written()


def test_buttons_have_names_and_all_is_reached_by_tab(fresh):
    page = fresh
    nameless = page.run("""return all('button, input, select, summary').filter((node) => shows(node) &&
        !(node.textContent.trim() || node.getAttribute('aria-label'))).map((node) => node.outerHTML)""")
    assert not nameless
    page.run("document.body.focus()")
    # All that the Tab key stops at, as far as the end of the toolbar and a few stops on; what is folded up is passed over.
    stops = page.run("""const stops = all('a[href], button, select, input, summary, [tabindex="0"]')
        .filter((node) => shows(node) && !node.disabled && !node.closest('details:not([open]) > :not(summary)'));
        return stops.findLastIndex((node) => node.closest('.toolbar')) + 6""")
    assert 6 < stops < 400
    seen = []
    for _ in range(stops):
        page.key("Tab")
        # A mark of a drawing shows it by its stroke, anything else by an outline.
        seen.append(page.run("""const at = document.activeElement; const [mark] = at.matches('.spot') ? all('.mark', at) : [];
            const shown = mark ? getComputedStyle(mark).strokeWidth === '3px' : getComputedStyle(at).outlineStyle !== 'none';
            return [at === document.body || shown, at.closest('.toolbar') ? at.tagName : '']"""))
    assert all(shown for shown, _ in seen), "the focus is seen"
    assert {"BUTTON", "SELECT"} <= {tag for _, tag in seen}
    assert seen[-6][1] and not seen[-5][1], "the toolbar ends where it is said to"
