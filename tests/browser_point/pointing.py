"""What the tests do with a page to point at targets."""

import csv
import io
import json
import time

from browsing import FOLDER, Page

ABOUT = json.loads((FOLDER / "about.json").read_text()) | {"folder": str(FOLDER)}
TRUTH = dict(ABOUT["targets"])
WIDTH, HEIGHT = ABOUT["size"]

# What is drawn, to be read often.
COPY = """const drawn = document.querySelector('canvas.photo');
const copy = Object.assign(document.createElement('canvas'), { width: drawn.width, height: drawn.height }).getContext('2d', { willReadFrequently: true });
copy.drawImage(drawn, 0, 0);
"""


class Pointing(Page):
    """A page in the browser, with its photograph."""

    def __init__(self, driver, url, name):
        self.driver, self.url, self.name = driver, url, name

    def requests(self):
        """Those that do not go to where the page came from."""
        if not self.url.startswith("http"):
            return super().requests()
        return [url for url in super().requests() if not url.startswith(self.url)]

    def open(self):
        super().open()
        self.wait("return document.querySelector('canvas.photo') !== null")
        time.sleep(0.3)
        self.settle()
        return self

    def wait(self, script, *arguments, seconds=30):
        until = time.time() + seconds
        while not self.run(script, *arguments):
            assert time.time() < until, script
            time.sleep(0.03)
        self.settle()

    def stage(self):
        return self.run("return edges(document.querySelector('canvas.photo'))")

    def middle(self):
        left, top, right, bottom = self.stage()
        # A wheel turns at whole pixels.
        return round((left + right) / 2), round((top + bottom) / 2)

    def place(self):
        """The image coordinates that the page tells, to a hundredth of a pixel."""
        words = self.run("return document.querySelector('.place').textContent")
        x, y = words.split(" px;")[0].split(", ")
        return float(x.removeprefix("x ")), float(y.removeprefix("y "))

    def tell(self, x, y):
        """What the page tells of a place in the window."""
        self.mouse("mouseMoved", x, y)
        self.settle()
        self.settle()
        return self.place()

    def view(self):
        """Where image coordinate 0, 0 is in the window, and px of it for one of the image."""
        left, top, right, bottom = self.stage()
        (ax, ay), (bx, by) = self.tell(left + 20, top + 20), self.tell(right - 20, bottom - 20)
        scale = (right - left - 40) / (bx - ax)
        assert abs(scale - (bottom - top - 40) / (by - ay)) < 0.01 * scale
        return left + 20 - ax * scale, top + 20 - ay * scale, scale

    def at(self, x, y):
        """Where an image coordinate is in the window."""
        left, top, scale = self.view()
        return left + x * scale, top + y * scale

    def point(self, x, y):
        self.click(*self.at(x, y))

    def press(self, text):
        """A button by what stands on it."""
        self.run("const one = all('button').find((node) => node.textContent === arguments[0]); one.click()", text)
        self.settle()
        self.settle()

    def next_name(self):
        return self.run("return document.querySelector('#name').value")

    def type_name(self, name):
        self.run("const input = document.querySelector('#name'); input.value = arguments[0]; input.dispatchEvent(new Event('input'))", name)

    def switch(self, index):
        self.run("const select = document.querySelector('.photos select'); select.value = arguments[0]; select.dispatchEvent(new Event('change'))", index)
        self.settle()
        time.sleep(0.2)
        self.settle()

    def saved(self, button="save points"):
        """The rows of the file that a button hands out, and its text."""
        self.press(button)
        [file] = self.files()
        return list(csv.DictReader(io.StringIO(file["text"], newline=""))), file["text"]

    def places(self):
        """What was pointed at: places by image and name."""
        return {(row["image"], row["target"]): (float(row["x"]), float(row["y"])) for row in self.saved()[0]}

    def only(self):
        [place] = self.places().values()
        return place

    def table(self):
        """The texts of the table's rows, by name."""
        return dict(self.run("return all('.points tbody tr').map((row) => [row.querySelector('th').textContent, row.querySelector('.found').textContent])"))

    def colour(self, x, y):
        """The colour drawn at a place of the window."""
        left, top, _, _ = self.stage()
        return self.run(COPY + "return [...copy.getImageData(arguments[0], arguments[1], 1, 1).data]", round(x - left), round(y - top))


def apart(a, b):
    return ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5


def cell_name(name):
    """A name as it stands in a CSV file that no spreadsheet runs."""
    return f"'{name}" if name.startswith("=") else name
