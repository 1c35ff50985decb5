"""Tunables: what the signature of a stage says of a value, and what only its declaration can say."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np


@dataclass(frozen=True)
class Param:
    """One tunable: what its name and default in the signature don't say.

    Parameters
    ----------
    label : str
        What the dialog calls it, sentence case, without the unit.
    help : str
        One or two sentences: what it does and when to change it.
    unit : str
        Unit of the number ("m", "°", "points/m²", ""), appended to labels.
    low, high : float, optional
        Bounds, inclusive unless ``open_low`` / ``open_high``.
    choices : tuple of str
        Allowed words of a ``str``, or the elements of a ``tuple``.
    automatic : str
        For tunables that may be None: what the stage takes then, as the end of
        the sentence "Automatic: …".
    advanced : bool
        Folded away in the dialog.
    """

    label: str
    help: str
    unit: str = ""
    low: Optional[float] = None
    high: Optional[float] = None
    open_low: bool = False
    open_high: bool = False
    choices: tuple[str, ...] = ()
    automatic: str = ""
    advanced: bool = False

    @property
    def title(self) -> str:
        """Label with its unit, as people read it."""
        return f"{self.label} ({self.unit})" if self.unit else self.label

    @property
    def unset(self) -> str:
        """What an automatic tunable is when nobody sets it, in a word: a value found by the stage, or none at all."""
        return "none" if self.automatic.startswith("none") else "automatic"

    @property
    def unset_text(self) -> str:
        """The same in a sentence, empty where a value is needed."""
        return f"{'Empty' if self.unset == 'none' else 'Automatic'}: {self.automatic}" if self.automatic else ""

    @property
    def range(self) -> str:
        """Allowed values in words, empty when there is no bound."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        low = high = ""
        if self.low is not None:
            low = f"{'greater than' if self.open_low else 'at least'} {self.written(self.low)}"
        if self.high is not None:
            high = f"{'less than' if self.open_high else 'at most'} {self.written(self.high)}"
        return " and ".join(part for part in (low, high) if part)

    def written(self, number: float) -> str:
        """Return a number with the unit, as people write it: 4 m², 20°, 10,000 m."""
        digits = f"{number:,d}" if isinstance(number, int) else f"{number:g}"
        return digits + self.unit if self.unit == "°" else f"{digits} {self.unit}".rstrip()


@dataclass(frozen=True)
class Tunable:
    """A :class:`Param` with the name, type and default that the signature gives."""

    name: str
    type: type
    default: Any
    param: Param

    @property
    def is_automatic(self) -> bool:
        """Whether None is allowed and means "derive it from the data"."""
        return self.default is None

    def check(self, value: Any) -> Any:
        """Return ``value`` in the declared type, or raise ValueError in one sentence."""
        if value is None and self.is_automatic:
            return None
        try:
            value = self._converted(value)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(self._refusal(_KINDS[self.type], value)) from None
        if not self._inside(value):
            raise ValueError(self._refusal(self.param.range, value))
        return value

    def _converted(self, value: Any) -> Any:
        if self.type is tuple:
            if isinstance(value, str):
                raise TypeError
            return tuple(str(item) for item in value)
        if self.type is bool:
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError
            return bool(value)
        if self.type is str:
            if not isinstance(value, str):
                raise TypeError
            return value
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

    def _refusal(self, wanted: str, value: Any) -> str:
        return f"{self.param.label} ({self.name}) must be {wanted or 'a finite number'}, got {value!r}."


_KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "a word", tuple: "a list of words"}
