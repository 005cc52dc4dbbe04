"""Callables as methods."""

import warnings

import numpy as np
import pytest

import calibench as cb

IMAGE = np.random.default_rng(5).uniform(0, 1, (60, 80)).astype(np.float32)
STARTS = np.array([[20.0, 20.0], [40.0, 30.0], [60.5, 40.25]])


def measured(answer, **keys):
    """What comes of a callable that answers so."""

    @cb.method(name="mine", version="1", **keys)
    def mine(image, starts, **parameters):
        return answer(image, starts, **parameters) if callable(answer) else answer

    return cb.measure(IMAGE, STARTS, "mine")


def test_it_is_given_what_an_operator_gets():
    given = {}

    @cb.method(name="mine", version="7", parameters={"window": 11, "blur": {"default": 0.7, "min": 0.0, "max": 3.0}})
    def mine(image, starts, window, blur):
        given.update(image=image, starts=starts, window=window, blur=blur)
        return starts + [0.25, -0.5], np.tile(np.diag([0.01, 0.04]), (len(starts), 1, 1))

    found = cb.measure(IMAGE, STARTS, "mine:window=13")
    assert np.array_equal(given["image"], IMAGE) and given["image"].dtype == np.float32
    assert np.array_equal(given["starts"], STARTS) and given["window"] == 13 and isinstance(given["window"], int) and given["blur"] == 0.7
    assert np.array_equal(found.xy, STARTS + [0.25, -0.5])
    assert np.array_equal(found.cov, np.tile([[0.01, 0.0], [0.0, 0.04]], (3, 1, 1)))
    assert (found.method, found.version) == ("mine:window=13", "7")


@pytest.mark.parametrize(
    "answer, reason",
    [
        (None, "malformed"),
        ("three", "malformed"),
        (np.zeros((2, 2)), "malformed"),
        (np.zeros((3, 3)), "malformed"),
        (np.zeros((30, 2)), "malformed"),
        (np.full((3, 2), np.nan), "declined"),
        (np.full((3, 2), np.inf), "malformed"),
        ((np.zeros((3, 2)), np.zeros((3, 3, 3))), "malformed"),
        ((STARTS, np.full((3, 2, 2), np.inf)), "malformed"),
        ((STARTS, np.tile([[-1.0, 0.0], [0.0, 1.0]], (3, 1, 1))), "malformed"),
        (lambda image, starts: 1 / 0, "raised"),
        (lambda image, starts: [].pop(), "raised"),
        (lambda image, starts: (_ for _ in ()).throw(KeyboardInterrupt), "raised"),
        (lambda image, starts: (_ for _ in ()).throw(SystemExit(3)), "raised"),
    ],
)
def test_whatever_it_does_the_points_are_rejected_with_the_reason(answer, reason):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cb.DoubtWarning)
        found = measured(answer)
    assert found.reason == [reason] * 3 and np.isnan(found.xy).all()


def test_what_it_raised_is_said():
    with pytest.warns(cb.DoubtWarning, match="mine: .*no luck"):
        measured(lambda image, starts: (_ for _ in ()).throw(ValueError("no luck")))


def test_what_it_raised_commands_no_terminal():
    def raising(image, starts):
        raise ValueError("red \x1b[31m\u202e " + "long " * 100 + "\nand a line")

    with pytest.warns(cb.DoubtWarning, match="mine: .*red") as said:
        measured(raising)
    text = str(said[0].message)
    assert "\x1b" not in text and "\u202e" not in text and "\n" not in text and len(text) < 400


def test_one_point_that_is_missed_does_not_cost_the_others():
    missed = STARTS.copy()
    missed[1] = np.nan
    found = measured(missed)
    assert found.reason == [None, "declined", None] and np.array_equal(found.xy[[0, 2]], STARTS[[0, 2]])


def test_it_cannot_change_the_image_for_others():
    def spoil(image, starts):
        image[:] = 0
        return starts

    before = IMAGE.copy()
    measured(spoil)
    assert np.array_equal(IMAGE, before)


def test_one_that_finds_by_itself_is_matched():
    found_by_itself = STARTS[::-1] + 1.0

    @cb.method(name="finder", version="1", starts="none", radius=2.0)
    def finder(image):
        return np.vstack([found_by_itself, [[5.0, 5.0]]])

    found = cb.measure(IMAGE, np.vstack([STARTS, [[70.0, 10.0]]]), "finder")
    assert np.array_equal(found.xy[:3], STARTS + 1.0) and found.reason == [None, None, None, "no_corner"]


def test_a_later_one_of_the_same_name_takes_its_place():
    assert np.array_equal(measured(STARTS).xy, STARTS) and np.array_equal(measured(STARTS + 1).xy, STARTS + 1)


@pytest.mark.parametrize(
    "keys, said",
    [
        ({"name": "forstner"}, "method of calibench itself"),
        ({"name": "My Method"}, "lower-case"),
        ({"name": ""}, "lower-case"),
        ({"name": "1st"}, "a letter first"),
        ({"starts": "maybe"}, "'given' or 'none'"),
        ({"starts": "none", "radius": 0}, "radius"),
        ({"parameters": {"window": "eleven"}}, "window"),
        ({"parameters": {"window": {"min": 3}}}, "window"),
        ({"parameters": {"window": {"default": 2, "min": 3}}}, "window"),
        ({"parameters": {"window": {"default": 4, "odd": True}}}, "odd"),
        ({"parameters": {"unknown": 1}}, "is called with image, starts"),
    ],
)
def test_mistakes_are_named_when_it_is_declared(keys, said):
    with pytest.raises(cb.InputError, match=said):

        @cb.method(**{"name": "mine", "version": "1", **keys})
        def mine(image, starts, window=11):
            return starts


def test_parameters_outside_of_their_range_are_refused():
    @cb.method(name="mine", version="1", parameters={"window": {"default": 11, "min": 3, "max": 31, "odd": True}})
    def mine(image, starts, window):
        return starts

    for wrong in ("mine:window=33", "mine:window=4", "mine:blur=1"):
        with pytest.raises(cb.InputError):
            cb.measure(IMAGE, STARTS, wrong)


def test_a_call_tells_what_came_of_it_alone(project):
    """And so do the records of a run: what was raised in an earlier one is none of theirs."""
    failing = True

    @cb.method(name="moody", version="1")
    def moody(image, starts):
        if failing:
            raise ValueError("not today")
        return starts

    image = np.full((30, 30), 0.5, np.float32)
    with pytest.warns(cb.DoubtWarning, match="not today"):
        cb.measure(image, [[15.0, 15.0]], "moody")
    with pytest.warns(cb.DoubtWarning, match="not today"):
        first = cb.run("operators/targets", methods=["pixel", "moody"], trials=1)
    failing = False
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cb.measure(image, [[15.0, 15.0]], "moody")
        second = cb.run("operators/targets", methods=["pixel", "moody"], trials=1)
    of_moody = lambda records: {status for status, method in zip(records.points["status"], records.points["method"]) if method == "moody"}
    assert "measured" not in of_moody(first) and "measured" in of_moody(second)
