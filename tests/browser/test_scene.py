"""The scene in space: it turns, zooms, pans, and says what is where."""

import json
import re

import pytest

from test_plots import TIP

CANVAS = "const canvas = document.querySelectorAll('figure.scene canvas')[arguments[0]]; "


def scenes(page):
    return range(page.having("figure.scene canvas", "scene"))


def pixels(page, scene):
    page.settle()
    return page.run(CANVAS + "return canvas.toDataURL()", scene)


def centre(page, scene):
    x, y = page.run(CANVAS + """canvas.scrollIntoView({block: 'center'}); canvas.focus({preventScroll: true});
        const box = canvas.getBoundingClientRect(); return [box.left + box.width / 2, box.top + box.height / 2]""", scene)
    page.settle()
    return x, y


def source(page, scene):
    return json.loads(page.run("return document.querySelectorAll('figure.scene script[type=\"application/json\"]')[arguments[0]].textContent", scene))


def view(page, scene):
    """Yaw, pitch, distance and centre, as the address holds them."""
    name = page.run("return document.querySelectorAll('figure.scene')[arguments[0]].id", scene)
    [values] = re.findall(rf"view\.{re.escape(name)}=([-\d.,e]+)", page.written())
    return [float(value) for value in values.split(",")]


def test_the_still_drawing_gives_way(fresh):
    page = fresh
    scenes(page)
    assert not page.run("return all('figure.scene > svg').some((node) => shows(node))")
    sizes = page.run("""return all('figure.scene canvas')
        .map((one) => [one.width, one.clientWidth * devicePixelRatio, one.height, one.clientHeight * devicePixelRatio])""")
    for width, wanted, height, high in sizes:
        assert width == pytest.approx(wanted, abs=1) and height == pytest.approx(high, abs=1) and height > 100


def test_something_is_drawn_in_both_themes(fresh):
    page = fresh
    colours = CANVAS + """const copy = document.createElement('canvas'); [copy.width, copy.height] = [canvas.width, canvas.height];
        const context = copy.getContext('2d', {willReadFrequently: true}); context.drawImage(canvas, 0, 0);
        const data = context.getImageData(0, 0, canvas.width, canvas.height).data; const seen = new Map();
        for (let at = 0; at < data.length; at += 4) { const key = data[at] + ',' + data[at + 1] + ',' + data[at + 2]; seen.set(key, (seen.get(key) || 0) + 1); }
        return [seen.size, [...seen].sort((a, b) => b[1] - a[1])[0][0]]"""
    for scene in scenes(page):
        page.settle()
        many, paper = page.run(colours, scene)
        assert many > 20
        page.media(prefers_color_scheme="dark")
        page.settle()
        again, dark = page.run(colours, scene)
        assert again > 20 and dark != paper
        page.media(prefers_color_scheme="light")


def test_the_mouse_turns_pans_and_zooms(fresh):
    page = fresh
    for scene in scenes(page):
        x, y = centre(page, scene)
        first = pixels(page, scene)
        page.drag(x, y, 80, 30)
        turned = pixels(page, scene)
        assert turned != first
        page.wheel(x, y, -200)
        nearer, place = pixels(page, scene), view(page, scene)
        assert nearer != turned
        page.mouse("mousePressed", x, y, button="right", buttons=2, clickCount=1)
        page.mouse("mouseMoved", x + 30, y + 10, button="right", buttons=2)
        page.mouse("mouseMoved", x + 60, y + 20, button="right", buttons=2)
        page.mouse("mouseReleased", x + 60, y + 20, button="right", clickCount=1)
        assert pixels(page, scene) != nearer
        moved = view(page, scene)
        assert moved[:3] == place[:3] and moved[3:] != place[3:], "the right button moves and does not turn"
        page.key("0")
        page.mouse("mouseMoved", 1, 1)
        assert pixels(page, scene) == first, "0 shows what was at first"
        page.run("document.activeElement.blur()")
        page.wheel(x, y, -100)
        assert pixels(page, scene) == first, "without focus the page scrolls past"


def test_the_keyboard_turns_pans_zooms_and_resets(fresh):
    page = fresh
    for scene in scenes(page):
        centre(page, scene)
        first = before = pixels(page, scene)
        for key, shift in (("ArrowLeft", 0), ("ArrowUp", 0), ("+", 0), ("ArrowRight", 8), ("ArrowDown", 8), ("-", 0), ("ArrowRight", 0)):
            page.key(key, modifiers=shift)
            after = pixels(page, scene)
            assert after != before, (key, shift)
            before = after
        page.key("0")
        assert pixels(page, scene) == first


def test_points_and_stations_say_their_names(fresh):
    page = fresh
    for scene in scenes(page):
        data = source(page, scene)
        centre(page, scene)
        still = pixels(page, scene)
        for keys, part in (("]", "points"), ("}", "stations")):
            names = data[part]["name"]
            for index in range(min(3, len(names))):
                page.key(keys)
                text = page.run(TIP)
                assert " ".join(str(names[index]).split()) in " ".join(text.split()), (part, index)
                value = data[part]["X"][index]
                told = [word.replace("−", "-") for word in text.split() if re.fullmatch(r"−?\d+(\.\d+)?", word)]
                assert any(abs(float(word) - value) <= 0.51 * 10 ** -len(word.partition(".")[2]) for word in told)
            assert pixels(page, scene) != still or not names
        if not data["points"]["name"]:
            continue
        page.key("0", "]")
        left, top, right, bottom = page.run("return edges(document.querySelector('.tip'))")
        # The tooltip stands 14 px beside the point, on the side where there is room.
        corners = [(x, y) for x in (left - 14, right + 14) for y in (top - 14, bottom + 14)]
        told = []
        for x, y in corners:
            page.mouse("mouseMoved", 1, 1)
            page.mouse("mouseMoved", x, y)
            page.settle()
            told.append(page.run(TIP))
        assert any(str(data["points"]["name"][0]) in text for text in told), "the pointer finds the point that the key found"
        covariances = data["points"].get("C")
        if covariances and covariances[0]:
            page.key("0")
            page.key("]")
            assert "±" in page.run(TIP)


def test_a_station_chosen_in_a_table_shows_in_the_scene(fresh):
    page = fresh
    for scene in scenes(page):
        data = source(page, scene)
        rows = page.run("return all('table.data tr[data-g]').map((row) => row.dataset.g)")
        both = [g for g in map(str, data["stations"].get("g", [])) if g in rows]
        if not both:
            pytest.skip("no table of the stations")
        before = pixels(page, scene)
        page.run("all('table.data tr[data-g]').find((row) => row.dataset.g === arguments[0]).cells[0].click()", both[0])
        assert pixels(page, scene) != before
        page.key("Escape")
        assert pixels(page, scene) == before
        centre(page, scene)
        page.key("}", "Enter")
        assert page.run("return document.body.classList.contains('choosing')")
