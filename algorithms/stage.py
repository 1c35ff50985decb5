"""Stages and their tunables: how a numpy function declares what it is.

A stage is an ordinary function with a declaration beside it:

* positional arguments name the dimensions it reads (``dimensions.py``); one
  with the default None is read only where the cloud has it, and the prefix
  ``reference_`` means the second cloud of a comparison;
* keyword-only arguments are tunables, each ``Annotated[type, Param(...)]``
  with its default; ``Optional`` types with the default None are *automatic*:
  the stage derives the value from the data and tells it to the monitor;
* ``monitor`` (a :class:`Monitor`) hears how far the stage is.

Everything a user sees of a stage (dialog, tooltip, help, bounds, composite
parameters) is derived from this declaration and written nowhere else. This
module needs the standard library and numpy only and knows nothing of QGIS.
"""

from __future__ import annotations

import functools
import inspect
import math
import textwrap
import typing
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Optional

import numpy as np

REFERENCE_PREFIX = "reference_"


class Cancelled(Exception):
    """Raised by a monitor's ``progress`` when the user stops the run."""


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
        """Return a number with the unit, as people write it: 4 m², 20°."""
        digits = f"{number:d}" if isinstance(number, int) else f"{number:g}"
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


@dataclass(frozen=True)
class Field:
    """One attribute of a layer that a stage makes (``type`` is int, float or str)."""

    name: str
    type: type
    help: str
    unit: str = ""


@dataclass(frozen=True)
class Layer:
    """A vector layer that a stage makes.

    ``name`` becomes the output's name (``FOOTPRINTS``), ``geometry`` is
    ``"Polygon"``, ``"LineString"`` or ``"Point"``, ``style`` the stem of a file in
    ``resources/styles``.
    """

    name: str
    title: str
    geometry: str
    fields: tuple[Field, ...]
    style: str = ""


@dataclass
class Features:
    """The content of a :class:`Layer`: geometries and one column per field.

    ``geometries`` holds, per feature of a polygon layer, a list of rings (float64
    (m, 2) or (m, 3), metres, first the exterior counterclockwise, then the holes
    clockwise, closed: last vertex equals first); for lines one (m, 2 or 3) array; for points one (2 or 3,) array.
    ``columns`` maps each field's name to a sequence of the same length.
    """

    geometries: list
    columns: dict[str, Any]

    def __len__(self) -> int:
        return len(self.geometries)


@dataclass(frozen=True)
class Measure:
    """One number that a stage's :class:`Report` holds."""

    name: str
    title: str
    unit: str = ""


@dataclass
class Report:
    """Numbers and the page that shows them to a person.

    ``values`` has one float or int per declared :class:`Measure` (NaN where the measure is
    undefined), ``html`` is a complete, self-contained page.
    """

    values: dict[str, float]
    html: str


class Monitor:
    """What a running stage tells the outside; this one keeps it, others show it.

    Attributes
    ----------
    values : dict
        What automatic tunables resolved to, and other estimates, by name.
    warnings : list of str
        Sentences for the log.
    """

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.warnings: list[str] = []

    def progress(self, fraction: float) -> None:
        """Hear how much is done, 0 to 1; may raise :class:`Cancelled`."""

    def resolved(self, **values: Any) -> None:
        """Keep the values that automatic tunables took."""
        self.values.update(values)

    def warn(self, sentence: str) -> None:
        """Keep a sentence that the user should read."""
        self.warnings.append(sentence)

    def part(self, start: float, end: float, prefix: str = "") -> Monitor:
        """Return a monitor whose 0 to 1 is ``start`` to ``end`` of this one, and whose values get a prefix here."""
        return _Part(self, start, end, prefix)


class _Part(Monitor):
    """A stretch of another monitor's progress; everything else goes straight through."""

    def __init__(self, whole: Monitor, start: float, end: float, prefix: str) -> None:
        self.whole, self.start, self.end, self.prefix = whole, start, end, prefix
        self.values, self.warnings = whole.values, whole.warnings

    def progress(self, fraction: float) -> None:
        self.whole.progress(self.start + (self.end - self.start) * fraction)

    def resolved(self, **values: Any) -> None:
        self.whole.resolved(**{self.prefix + name: value for name, value in values.items()})

    def warn(self, sentence: str) -> None:
        self.whole.warn(sentence)


@dataclass(frozen=True)
class Stage:
    """Everything that is known of a stage without running it."""

    function: Callable
    title: str
    group: str
    tags: str
    reads: tuple[str, ...]
    optional: tuple[str, ...]
    writes: tuple[str, ...]
    creates: tuple[str, ...]
    layers: tuple[Layer, ...]
    measures: tuple[Measure, ...]
    tunables: dict[str, Tunable] = field(repr=False)
    doc: str = field(repr=False)

    @property
    def name(self) -> str:
        """Function name, ``classify_ground_tin``."""
        return self.function.__name__

    @property
    def id(self) -> str:
        """Processing id, ``classifygroundtin``: frozen, saved models depend on it."""
        return self.name.replace("_", "")

    @property
    def summary(self) -> str:
        """First paragraph of the docstring, on one line."""
        return " ".join(self.doc.split("\n\n")[0].split())

    @property
    def description(self) -> str:
        """Docstring text between the summary and the first section."""
        text = self.doc.split("\n\n", 1)[1] if "\n\n" in self.doc else ""
        return _before_first_section(text).strip()

    def section(self, title: str) -> str:
        """Text of one numpydoc section ("Notes", "References"), "" without it."""
        return _sections(self.doc).get(title, "")

    @property
    def reads_reference(self) -> bool:
        """Whether a second cloud is compared with."""
        return any(name.startswith(REFERENCE_PREFIX) for name in (*self.reads, *self.optional))

    def check(self, tunables: dict[str, Any]) -> dict[str, Any]:
        """Return all tunables, given ones checked, the others at their default."""
        unknown = sorted(set(tunables) - set(self.tunables))
        if unknown:
            raise ValueError(f"{self.name} has no tunable {unknown[0]!r}; it has {', '.join(self.tunables) or 'none'}.")
        return {name: t.check(tunables[name]) if name in tunables else t.default for name, t in self.tunables.items()}


def stage(
    title: str,
    *,
    group: str,
    tags: str = "",
    writes: tuple[str, ...] = (),
    creates: tuple[str, ...] = (),
    layers: tuple[Layer, ...] = (),
    measures: tuple[Measure, ...] = (),
) -> Callable[[Callable], Callable]:
    """Declare a function as a stage.

    The function returns, in this order and bare when there is one thing only:
    one array per name in ``writes`` (length n; None for one that the user did not
    ask for) or ``creates`` (a new cloud of any length), one :class:`Features` per
    layer, and a :class:`Report` when there are measures. The decorated function
    checks its arrays and tunables on every call and carries its :class:`Stage` as ``function.stage``.
    """

    def declare(function: Callable) -> Callable:
        declared = _declared(function, title, group, tags, writes, creates, layers, measures)
        signature = inspect.signature(function)

        @functools.wraps(function)
        def checked(*args: Any, **kwargs: Any) -> Any:
            bound = signature.bind(*args, **kwargs)
            _check_arrays(bound.arguments, declared)
            for name, tunable in declared.tunables.items():
                if name in bound.arguments:
                    bound.arguments[name] = tunable.check(bound.arguments[name])
            if bound.arguments.get("monitor") is None:
                bound.arguments["monitor"] = Monitor()
            return function(*bound.args, **bound.kwargs)

        checked.stage = replace(declared, function=checked)  # type: ignore[attr-defined]
        checked.__doc__ = _documented(declared)
        return checked

    return declare


def _declared(function: Callable, title, group, tags, writes, creates, layers, measures) -> Stage:
    hints = typing.get_type_hints(function, include_extras=True)
    reads, optional, tunables = [], [], {}
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY:
            if name != "monitor":
                tunables[name] = _tunable(name, hints[name], parameter.default)
        elif parameter.default is parameter.empty:
            reads.append(name)
        else:
            optional.append(name)
    doc = inspect.cleandoc(function.__doc__ or "")
    return Stage(
        function, title, group, tags, tuple(reads), tuple(optional), writes, creates, layers, measures, tunables, doc
    )


def _tunable(name: str, hint: Any, default: Any) -> Tunable:
    base, param = typing.get_args(hint)[:2]
    inner = [arg for arg in typing.get_args(base) if arg is not type(None)]
    kind = inner[0] if typing.get_origin(base) is typing.Union else base
    return Tunable(name, typing.get_origin(kind) or kind, default, param)


def _check_arrays(arguments: dict[str, Any], declared: Stage) -> None:
    """Refuse arrays that don't belong together, in the same words for every stage."""
    lengths: dict[str, tuple[str, int]] = {}
    for name in (*declared.reads, *declared.optional):
        if arguments.get(name) is None:
            continue
        array = arguments[name] = np.asarray(arguments[name])
        if name.endswith("xyz"):
            _check_coordinates(name, array)
        cloud = "reference" if name.startswith(REFERENCE_PREFIX) else "input"
        first, length = lengths.setdefault(cloud, (name, len(array)))
        if len(array) != length:
            raise ValueError(f"{name} has {len(array)} values, {first} has {length}; they must be of the same points.")
        if length == 0:
            raise ValueError(f"The {'reference' if cloud == 'reference' else 'point'} cloud has no points.")


def _check_coordinates(name: str, array: np.ndarray) -> None:
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must be of shape (n, 3), got {array.shape}.")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        bad = int((~np.isfinite(array).all(axis=1)).sum())
        raise ValueError(f"{bad} of {len(array)} points have coordinates that are not finite; remove them first.")


_HEADINGS = ("Parameters", "Returns", "Raises", "Other Parameters", "Notes", "References", "Examples", "See Also")


def _sections(doc: str) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    lines, current = doc.splitlines(), None
    for line, below in zip(lines, [*lines[1:], ""]):
        if line in _HEADINGS and set(below.strip()) == {"-"}:
            current = found.setdefault(line, [])
        elif current is not None and not (set(line.strip()) == {"-"} and not current):
            current.append(line)
    return {title: "\n".join(text).strip() for title, text in found.items()}


def _before_first_section(doc: str) -> str:
    lines = doc.splitlines()
    for i, (line, below) in enumerate(zip(lines, [*lines[1:], ""])):
        if line in _HEADINGS and set(below.strip()) == {"-"}:
            return "\n".join(lines[:i])
    return doc


def _documented(declared: Stage) -> str:
    """Docstring with its tunables, so that ``help()`` shows what the dialog shows."""
    if not declared.tunables:
        return declared.doc
    rows = ["Other Parameters", "----------------"]
    for t in declared.tunables.values():
        kind = t.type.__name__ + (" or None" if t.is_automatic else "")
        facts = [kind, *([t.param.unit] if t.param.unit else []), *([t.param.range] if t.param.range else [])]
        rows.append(f"{t.name} : {', '.join(facts)}, default {t.default!r}")
        text = t.param.help + (f" Automatic: {t.param.automatic}" if t.is_automatic else "")
        rows.extend(textwrap.wrap(text, 88, initial_indent="    ", subsequent_indent="    "))
    rows.append("monitor : Monitor, optional\n    Hears progress, automatic values and warnings.")
    return f"{declared.doc}\n\n" + "\n".join(rows) + "\n"
