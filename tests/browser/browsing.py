"""A page in a headless browser, and what the tests do with it."""

import base64
import json
import os
import time
import warnings
from pathlib import Path

import pytest
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

FOLDER = Path(os.environ["CALIBENCH_PAGES"]).resolve() if os.environ.get("CALIBENCH_PAGES") else None
PAGES = sorted(FOLDER.rglob("*.html")) if FOLDER else []
SHOTS = os.environ.get("CALIBENCH_SHOTS")
WIDE, NARROW, HEIGHT = 1440, 360, 900

# Before any script of the page: what it hands out as a file and every dialog that it opens are written down.
WATCH = """
window.all = (selector, root = document) => [...root.querySelectorAll(selector)];
window.edges = (node) => { const box = node.getBoundingClientRect(); return [box.left, box.top, box.right, box.bottom]; };
// checkVisibility() takes parts of drawings that are not displayed for visible.
window.shows = (node) => node.getClientRects().length > 0;
window.seen = {files: [], dialogs: []};
for (const name of ["alert", "confirm", "prompt"]) window[name] = (text) => { window.seen.dialogs.push(String(text)); };
const made = new Map();
const create = URL.createObjectURL.bind(URL);
URL.createObjectURL = (blob) => { const url = create(blob); made.set(url, blob); return url; };
const click = HTMLAnchorElement.prototype.click;
HTMLAnchorElement.prototype.click = function () {
  if (!this.download) { click.call(this); return; }
  const file = {name: this.download, type: made.get(this.href).type, text: null};
  window.seen.files.push(file);
  made.get(this.href).text().then((text) => { file.text = text; });
};
"""


# Those that a selector finds and that are hardly lighter or darker than what is behind them (WCAG 2.1, 1.4.3: a ratio below 4.5).
FAINT = """
const light = (text) => {
  const [r, g, b] = text.match(/[\\d.]+/g).map(Number).map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const ground = (node) => { for (let at = node; at; at = at.parentElement) {
  const colour = getComputedStyle(at).backgroundColor;
  if (!/, 0(\\.\\d+)?\\)$/.test(colour)) return colour; } return 'rgb(255, 255, 255)'; };
return all(arguments[0]).filter((node) => shows(node))
  .map((node) => { const style = getComputedStyle(node); const [a, b] = [light(style.color), light(ground(node))];
    return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), node.tagName + ' ' + node.className + ' ' + node.textContent.slice(0, 30)]; })
  .filter(([ratio]) => ratio < 4.5);
"""


# More of one kind on a page, say plots, are tried by a sample: the same script drives each.
MOST = 16


def some(page, count, what):
    """The places of all of so many on a page, or of a sample that is spread evenly; that it is one is said."""
    if count <= MOST:
        return range(count)
    warnings.warn(f"{page.name}: {MOST} of {count} {what} are tried", stacklevel=2)
    return [round(index * (count - 1) / (MOST - 1)) for index in range(MOST)]


def show_switches(page):
    """Opens what many switches are behind."""
    page.run("const many = document.querySelector('.many'); if (many) many.closest('details').open = true")


def browser():
    """Chromium, without a window, that tells what pages ask for and complain of."""
    options = webdriver.ChromeOptions()
    options.page_load_strategy = "eager"
    options.binary_location = os.environ.get("CALIBENCH_CHROMIUM", "/usr/bin/chromium")
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    options.add_experimental_option("perfLoggingPrefs", {"enableNetwork": True, "enablePage": False})
    driver = webdriver.Chrome(options=options, service=Service(os.environ.get("CALIBENCH_CHROMEDRIVER", "/usr/bin/chromedriver")))
    driver.set_script_timeout(10)
    driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": WATCH})
    return driver


class Page:
    """A page in the browser."""

    def __init__(self, driver, path):
        self.driver, self.path, self.url = driver, path, path.as_uri()
        self.name = "-".join(path.relative_to(FOLDER).with_suffix("").parts)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def cdp(self, command, **arguments):
        return self.driver.execute_cdp_cmd(command, arguments)

    def size(self, width, height=HEIGHT):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def media(self, media="", **features):
        self.cdp("Emulation.setEmulatedMedia", media=media, features=[{"name": name.replace("_", "-"), "value": value} for name, value in features.items()])

    def open(self):
        """The page from the beginning: nothing chosen, light, wide."""
        self.size(WIDE)
        self.media(prefers_color_scheme="light")
        self.driver.get(self.url)
        self.settle()
        self.settle()
        return self

    def settle(self):
        """Until a frame was drawn after what was asked for."""
        self.driver.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => setTimeout(done));")

    def written(self):
        """The address, after the page had time to write it."""
        time.sleep(0.4)
        return self.run("return location.hash")

    def count(self, selector):
        return self.run("return document.querySelectorAll(arguments[0]).length", selector)

    def having(self, selector, what):
        """Skips the test of a page without these elements; else how many there are."""
        found = self.count(selector)
        if not found:
            pytest.skip(f"this page has no {what}")
        return found

    def key(self, *keys, modifiers=0):
        """Keys as a keyboard sends them, to what has the focus."""
        for key in keys:
            text = {"Enter": "\r", " ": " "}.get(key, key if len(key) == 1 else "")
            code = {"Enter": 13, " ": 32, "Escape": 27, "Tab": 9, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}.get(key, 0)
            down = {"key": key, "modifiers": modifiers, "windowsVirtualKeyCode": code}
            self.cdp("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", **down, **({"text": text} if text else {}))
            # Only the space bar acts when it is let go.
            if key == " ":
                self.cdp("Input.dispatchKeyEvent", type="keyUp", **down)
        self.settle()

    def mouse(self, kind, x, y, **more):
        self.cdp("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x, y, count=1):
        self.mouse("mouseMoved", x, y)
        for turn in range(1, count + 1):
            self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=turn)
            self.mouse("mouseReleased", x, y, button="left", clickCount=turn)
        self.settle()

    def drag(self, x, y, dx, dy):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        for part in (0.5, 1):
            self.mouse("mouseMoved", x + dx * part, y + dy * part, button="left", buttons=1)
        self.mouse("mouseReleased", x + dx, y + dy, button="left", clickCount=1)
        self.settle()

    def wheel(self, x, y, by, modifiers=0):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=by, modifiers=modifiers)
        self.settle()

    def files(self):
        """Files handed out since the last call."""
        return self.driver.execute_async_script("""const done = arguments[0]; const wait = () => {
            if (window.seen.files.some((file) => file.text === null)) setTimeout(wait, 10);
            else done(window.seen.files.splice(0)); }; wait();""")

    def console(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        """Addresses asked for since the last call, the page itself and data in the page aside."""
        found = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                found.append(message["params"].get("request", message["params"])["url"])
        own = (self.url, "about:blank", "data:")
        return [url for url in found if not (url.split("#")[0] == self.url or url.startswith(own[1:]))]

    def shot(self, name):
        """A picture of the whole page, if pictures are asked for."""
        if SHOTS:
            folder = Path(SHOTS)
            folder.mkdir(parents=True, exist_ok=True)
            width, height = self.run("return [innerWidth, document.documentElement.scrollHeight]")
            clip = {"x": 0, "y": 0, "width": width, "height": min(height, 12000), "scale": 1}
            data = self.cdp("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
            (folder / f"{self.name}-{name}.png").write_bytes(base64.b64decode(data))
