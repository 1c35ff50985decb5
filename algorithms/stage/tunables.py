"""Tunables: name, type and default from the signature of a stage, the rest from its declaration."""

import math
import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Optional

import numpy as np


@dataclass(frozen=True)
class Param:
    """One tunable: everything but its name and type, which the signature gives."""

    default: Any  #: Value where none is given; None for one that is automatic, or that may be left empty
    #: One or two sentences, what it does and when to change it; "" where the docstring of its stage says it
    help: str = ""
    #: Interval and unit of a number: "(0, 100] m" is above 0 and at most 100 m, "[3, inf)" at least 3
    within: str = ""
    choices: tuple[str, ...] = ()  #: Allowed words of a ``str``, or the elements of a ``tuple``
    #: For tunables whose value the stage finds itself when it is None: which, as the end of the sentence "Automatic: …"
    automatic: str = ""
    #: For tunables that have no effect when they are None: what happens then, as the end of the sentence "Empty: …"
    empty: str = ""
    advanced: bool = False  #: Folded away in the dialog
    label: str = ""  #: What the dialog calls it, sentence case, without the unit; where that is not its name in words

    def with_default(self, default: Any) -> Any:
        """Return the same tunable with another default, for a stage that shares it."""
        return replace(self, default=default)

    def with_automatic(self, automatic: str) -> Any:
        """Return the same tunable with another automatic value, for a stage that shares it."""
        return replace(self, automatic=automatic)

    @cached_property
    def _interval(self) -> re.Match:
        found = _INTERVAL.fullmatch(self.within)
        if found is None:
            raise ValueError(f"A tunable lies within an interval such as '(0, 100] m', got {self.within!r}.")
        return found

    @property
    def unit(self) -> str:
        """Unit of the number ("m", "°", "points/m²", ""), appended to labels."""
        return self._interval["unit"] or ""

    @property
    def low(self) -> Optional[float]:
        """Lower bound, None without one."""
        return _bound(self._interval["low"])

    @property
    def high(self) -> Optional[float]:
        """Upper bound, None without one."""
        return _bound(self._interval["high"])

    @property
    def open_low(self) -> bool:
        """Whether the lower bound itself is refused."""
        return self._interval["opens"] == "("

    @property
    def open_high(self) -> bool:
        """Whether the upper bound itself is refused."""
        return self._interval["closes"] == ")"

    @property
    def unset(self) -> str:
        """The word for a tunable that is None: its value is automatic, or it has no effect."""
        return "none" if self.empty else "automatic"

    @property
    def unset_text(self) -> str:
        """What a tunable does that is None, as a sentence; "" where it needs a value."""
        if self.empty:
            return f"Empty: {self.empty}"
        return f"Automatic: {self.automatic}" if self.automatic else ""

    @property
    def bounds(self) -> str:
        """Bounds of a number in words, empty without bounds."""
        low = high = ""
        if self.low is not None:
            low = f"{'greater than' if self.open_low else 'at least'} {self.written(self.low)}"
        if self.high is not None:
            high = f"{'less than' if self.open_high else 'at most'} {self.written(self.high)}"
        return " and ".join(part for part in (low, high) if part)

    def written(self, number: float) -> str:
        """Return a number with the unit, as text: 4 m², 20°, 10,000 m."""
        digits = f"{number:,d}" if isinstance(number, int) else f"{number:,g}"
        return digits + self.unit if self.unit == "°" else f"{digits} {self.unit}".rstrip()


def with_unit(title: str, unit: str) -> str:
    """Return a title with its unit, for users: "Height (m)"."""
    return f"{title} ({unit})" if unit else title


def tunable(default: Any, help: str = "", **fields: Any) -> Any:
    """Declare a keyword argument of a stage, in place of its default: see :class:`Param`.

    What it does is said under "Other Parameters" in the docstring of the stage; a tunable that several stages share
    has its ``help`` with it.
    """
    return Param(default, help, **fields)


# What ``Param.within`` may be.
_INTERVAL = re.compile(r"(?:(?P<opens>[\[(])(?P<low>\S+), (?P<high>[^\s\])]+)(?P<closes>[\])]) ?(?P<unit>.*))?")


def _bound(text: Optional[str]) -> Optional[float]:
    """Return the number of a bound, None for an infinite or missing one."""
    value = float(text or "inf")
    return None if math.isinf(value) else int(value) if value.is_integer() else value


# What names begin with, in words.
_WORDS = {"min": "minimum", "max": "maximum"}


def in_words(name: str) -> str:
    """Return a name as users read it, "Minimum height" of ``min_height``."""
    first, *others = name.split("_")
    return " ".join([_WORDS.get(first, first), *others]).capitalize()


@dataclass(frozen=True)
class Tunable:
    """A :class:`Param` with the name and type that the signature gives."""

    name: str
    type: type
    param: Param

    @property
    def default(self) -> Any:
        """Value where none is given."""
        return self.param.default

    @property
    def label(self) -> str:
        """What the dialog calls it: "Minimum height" of ``min_height``, unless its declaration says otherwise."""
        return self.param.label or in_words(self.name)

    @property
    def title(self) -> str:
        """Label with its unit, for users."""
        return with_unit(self.label, self.param.unit)

    @property
    def is_optional(self) -> bool:
        """Whether None is allowed: the stage derives the value from the data, or does without."""
        return self.default is None

    @property
    def range(self) -> str:
        """Allowed values in words, empty when there is no bound."""
        if self.param.choices:
            return f"{'any' if self.type is tuple else 'one'} of {', '.join(self.param.choices)}"
        return self.param.bounds

    def check(self, value: Any, called: str = "") -> Any:
        """Return ``value`` in the declared type, or raise ValueError in one sentence.

        The sentence names the tunable ``called``, as the user knows it, or by its own name if that is empty.
        """
        if value is None and self.is_optional:
            return None
        try:
            value = self._converted(value)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(self._refusal(called, _KINDS[self.type], value)) from None
        if not self._inside(value):
            raise ValueError(self._refusal(called, self.range, value))
        return value

    def _converted(self, value: Any) -> Any:
        if self.type is tuple:
            if isinstance(value, str):
                raise TypeError
            return tuple(str(item) for item in value)
        if self.type in (bool, str):
            if not isinstance(value, (bool, np.bool_) if self.type is bool else str):
                raise TypeError
            return self.type(value)
        if isinstance(value, (bool, np.bool_, str)):
            raise TypeError
        if self.type is int and value != int(value):
            raise TypeError
        return self.type(value)

    def _inside(self, value: Any) -> bool:
        param = self.param
        if param.choices:
            return all(item in param.choices for item in (value if self.type is tuple else (value,)))
        if self.type not in (int, float):
            return True
        if not math.isfinite(value):
            return False
        too_low = param.low is not None and (value < param.low or (param.open_low and value == param.low))
        too_high = param.high is not None and (value > param.high or (param.open_high and value == param.high))
        return not (too_low or too_high)

    def _refusal(self, called: str, wanted: str, value: Any) -> str:
        return f"{self.label} ({called or self.name}) must be {wanted or 'a finite number'}, got {value!r}."


_KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "a word", tuple: "a list of words"}
