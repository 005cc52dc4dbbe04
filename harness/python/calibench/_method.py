"""Callables as methods."""

from __future__ import annotations

import inspect
import sys
from typing import Any, Callable, Mapping, Optional, TypeVar, Union

from ._calibench import InputError, add_method

_F = TypeVar("_F", bound=Callable[..., Any])

#: Parameters are floats in the program; whole ones go no further than this.
_MOST_WHOLE = 4294967295


def method(
    *,
    name: str,
    version: Union[str, Callable[[], str]],
    parameters: Optional[Mapping[str, Union[float, Mapping[str, Any]]]] = None,
    about: str = "",
    source: str = "",
    starts: str = "given",
    radius: float = 3.0,
) -> Callable[[_F], _F]:
    """Make a callable an operator in `measure`, `run`, `check` and reports.

    It is called as `f(image, starts, **parameters)` with the grey values (rows, columns; float32, fractions of full
    scale) and approximate positions (n, 2; px, the centre of the first pixel is 0, 0), and answers positions (n, 2), or
    these and their covariances (n, 2, 2; px^2). A row of NaN says that it cannot measure the point. With `starts="none"`
    it is called as `f(image, **parameters)`, answers all that it finds, and of each target the nearest within `radius` px
    counts.

    An exception, another shape or an infinite number rejects the points with the reason and never ends a run.

    `parameters` are defaults, or dicts of default, min, max, odd and about. `version` stands in records: change it when
    results change; it may be a function that knows it. Registering another callable under the same name replaces the first.

    A callable runs in the process that also knows the truth. Whoever wants to be believed enters as a plug-in, a program
    of its own that is kept from it (docs/plugins.md).
    """
    if starts not in ("given", "none"):
        raise InputError(f"starts: {starts!r}; expected 'given' or 'none'")
    if not radius > 0:
        raise InputError(f"radius: {radius}; expected px above 0")
    declared = [_parameter(key, value) for key, value in (parameters or {}).items()]

    def register(callable_: _F) -> _F:
        named = {key: default for key, default, *_ in declared}
        positional = (None, None) if starts == "given" else (None,)
        try:
            inspect.signature(callable_).bind(*positional, **named)
        except TypeError as error:
            given = "image, starts" if starts == "given" else "image"
            raise InputError(f"{name}: is called with {given} and the parameters by name: {error}") from None
        except ValueError:  # a builtin without a signature
            pass
        text = about or (inspect.getdoc(callable_) or "").partition("\n")[0]
        where = source or f"{getattr(callable_, '__module__', '?')}.{getattr(callable_, '__qualname__', name)}"
        add_method(name, version, text, where, callable_, declared, radius if starts == "none" else None)
        return callable_

    return register


def _parameter(key: str, value: Union[float, Mapping[str, Any]]) -> "tuple[str, float, float, float, bool, bool, str]":
    given: Mapping[str, Any] = value if isinstance(value, Mapping) else {"default": value}
    unknown = set(given) - {"default", "min", "max", "odd", "about"}
    if unknown or "default" not in given:
        raise InputError(f"parameters: {key}: expected a number, or a dict of default, min, max, odd and about")
    default, odd = given["default"], bool(given.get("odd", False))
    if isinstance(default, bool) or not isinstance(default, (int, float)):
        raise InputError(f"parameters: {key}: default {default!r}; expected a number")
    whole = isinstance(default, int)
    least = given.get("min", 0 if whole else -sys.float_info.max)
    most = given.get("max", _MOST_WHOLE if whole else sys.float_info.max)
    if not least <= default <= most or (whole and (least < 0 or most > _MOST_WHOLE)) or (odd and default % 2 != 1):
        raise InputError(f"parameters: {key}: default {default} is not in [{least}, {most}]{', odd' if odd else ''}")
    return key, float(default), float(least), float(most), odd, whole, str(given.get("about", ""))
