"""Stages and their tunables: how a numpy function declares what it is.

A stage is an ordinary function with a declaration beside it:

* positional arguments name the dimensions it reads (``dimensions.py``); one
  with the default None is read only where the cloud has it, and the prefix
  ``reference_`` means the second cloud of a comparison. ``values`` is the
  dimension that the tunable ``dimension`` names, whichever the file has;
* positional arguments after them are the vector layers that it reads, each
  declared as a :class:`Source`; a stage that reads layers only has no cloud;
* keyword-only arguments are tunables, each ``Annotated[type, Param(...)]``
  with its default; ``Optional`` types with the default None are *automatic*:
  the stage derives the value from the data and tells it to the monitor;
* ``monitor`` (a :class:`Monitor`) hears how far the stage is.

It returns values for the points it was given (``writes``), a new cloud
(``creates``), vector layers (``layers``), rasters (``rasters``), numbers with a
page (``measures``), or several of these. Two kinds make a cloud of other points:
one that ``selects`` says first which points its result has, and in which order;
one that ``merges`` reads several clouds, each argument a list with one array per
cloud, and its result has the points of all. Both may write ``xyz``, and both
leave withheld points out.

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
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Optional

import numpy as np

REFERENCE_PREFIX = "reference_"
# The positional argument that is whichever dimension a tunable names, and that tunable.
VALUES, DIMENSION = "values", "dimension"


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


@dataclass(frozen=True)
class Source:
    """A vector layer that a stage reads.

    ``name`` is the positional argument and the input (``OLD_MAP``), ``geometry`` is one of
    ``"Polygon"``, ``"LineString"`` and ``"Point"``. The stage is given :class:`Features` with
    all attributes of the layer, or None where an ``optional`` one is not given. Parts of a
    multipart geometry come one by one, each with the attributes of the whole.
    """

    name: str
    title: str
    geometry: str
    help: str
    optional: bool = False


@dataclass
class Features:
    """The content of a :class:`Layer` or :class:`Source`: geometries and one column per field.

    ``geometries`` holds, per feature of a polygon layer, a list of rings (float64
    (m, 2) or (m, 3), metres, first the exterior counterclockwise, then the holes
    clockwise, closed: last vertex equals first); for lines one (m, 2 or 3) array; for points one (2 or 3,) array.
    Coordinates are relative to the cloud's origin, or, where a stage reads no cloud, to one that all its sources share.
    ``columns`` maps each field's name to a sequence of the same length; those of a source are
    arrays of int64 or float64 (NaN is NULL), or lists, with None for NULL.
    """

    geometries: list
    columns: dict[str, Any]

    def __len__(self) -> int:
        return len(self.geometries)


def given_layers(
    reader: str, sources: Iterable[Source], given: dict[str, Optional[Features]]
) -> dict[str, Optional[Features]]:
    """Return the layer that is given for each source, None where an optional one is not; refuse what does not fit.

    Parameters
    ----------
    reader : str
        Name of the stage or pipeline that reads them.
    sources : iterable of Source
        What it reads.
    given : dict of str to Features
        Layers by the names of sources.

    Raises
    ------
    ValueError
        If a layer is missing, or one is given that nobody reads.
    """
    wanted = {source.name: source for source in sources}
    unknown = [name for name in given if name not in wanted]
    if unknown:
        raise ValueError(f"{reader} reads no layer {unknown[0]!r}; it reads {', '.join(wanted) or 'none'}.")
    for source in wanted.values():
        if given.get(source.name) is None and not source.optional:
            raise ValueError(f"{source.title} ({source.name}) is missing; choose a layer.")
    return {name: given.get(name) for name in wanted}


@dataclass(frozen=True)
class Raster:
    """A raster that a stage makes.

    ``name`` becomes the output's name (``DTM``), ``style`` is the stem of a file in
    ``resources/styles``, ``unit`` that of the values.
    """

    name: str
    title: str
    style: str = ""
    unit: str = ""


@dataclass
class Surface:
    """The content of a :class:`Raster`.

    ``values`` is float32 (rows, columns), the northernmost row first, NaN where there is nothing;
    ``west`` and ``north`` are the outer edges (m, from the cloud's origin), ``cell_size`` the side of a cell (m).
    """

    values: np.ndarray
    west: float
    north: float
    cell_size: float


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


@dataclass
class Made:
    """What a stage's function returned, each thing under its name; see :meth:`Stage.sorted`."""

    selected: Optional[np.ndarray] = None
    dimensions: dict[str, Optional[np.ndarray]] = field(default_factory=dict)
    layers: dict[str, Features] = field(default_factory=dict)
    rasters: dict[str, Surface] = field(default_factory=dict)
    report: Optional[Report] = None


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
    tunables: dict[str, Tunable] = field(repr=False)
    doc: str = field(repr=False)
    writes: tuple[str, ...] = ()
    creates: tuple[str, ...] = ()
    layers: tuple[Layer, ...] = ()
    measures: tuple[Measure, ...] = ()
    sources: tuple[Source, ...] = ()
    rasters: tuple[Raster, ...] = ()
    selects: bool = False
    merges: bool = False

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
    def reads_cloud(self) -> bool:
        """Whether it works on a cloud, or on several."""
        return any(not name.startswith(REFERENCE_PREFIX) for name in (*self.reads, *self.optional))

    @property
    def makes_cloud(self) -> bool:
        """Whether a cloud is among its results."""
        return bool(self.writes or self.creates or self.selects or self.merges)

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

    def sorted(self, returned: Any) -> Made:
        """Give what the function returned its names."""
        results = list(returned) if isinstance(returned, tuple) else [returned]
        names = (*(self.creates or self.writes), *self.layers, *self.rasters)
        declared = self.selects + len(names) + bool(self.measures)
        if len(results) != max(1, declared):
            raise TypeError(f"{self.name} declares {declared} results and returned {len(results)}.")
        return Made(
            selected=results.pop(0) if self.selects else None,
            dimensions={name: results.pop(0) for name in self.creates or self.writes},
            layers={layer.name: results.pop(0) for layer in self.layers},
            rasters={raster.name: results.pop(0) for raster in self.rasters},
            report=results.pop(0) if self.measures else None,
        )


def stage(
    title: str,
    *,
    group: str,
    tags: str = "",
    writes: tuple[str, ...] = (),
    creates: tuple[str, ...] = (),
    layers: tuple[Layer, ...] = (),
    measures: tuple[Measure, ...] = (),
    sources: tuple[Source, ...] = (),
    rasters: tuple[Raster, ...] = (),
    selects: bool = False,
    merges: bool = False,
) -> Callable[[Callable], Callable]:
    """Declare a function as a stage.

    The function returns, in this order and bare when there is one thing only:
    with ``selects`` the positions of the points that its result has, int64 (m,);
    one array per name in ``writes`` (length n, with ``selects`` m, with ``merges`` that of all
    clouds together; None for one that the user did not ask for) or ``creates`` (a new
    cloud of any length), one :class:`Features` per layer, one :class:`Surface` per raster,
    and a :class:`Report` when there are measures. A stage that merges and writes nothing
    returns None for the cloud that it makes. The decorated function checks its arrays
    and tunables on every call and carries its :class:`Stage` as ``function.stage``.
    """
    makes = {
        "writes": writes,
        "creates": creates,
        "layers": layers,
        "measures": measures,
        "sources": sources,
        "rasters": rasters,
        "selects": selects,
        "merges": merges,
    }

    def declare(function: Callable) -> Callable:
        declared = _declared(function, title, group, tags, makes)
        _check_declaration(declared)
        signature = inspect.signature(function)

        @functools.wraps(function)
        def checked(*args: Any, **kwargs: Any) -> Any:
            bound = signature.bind(*args, **kwargs)
            _check_arrays(bound.arguments, declared)
            layers = {source.name: bound.arguments.get(source.name) for source in declared.sources}
            given_layers(declared.name, declared.sources, layers)
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


def _declared(function: Callable, title: str, group: str, tags: str, makes: dict[str, Any]) -> Stage:
    hints = typing.get_type_hints(function, include_extras=True)
    reads: list[str] = []
    optional: list[str] = []
    tunables = {}
    layers = {source.name for source in makes["sources"]}
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY:
            if name != "monitor":
                tunables[name] = _tunable(name, hints[name], parameter.default)
        elif name not in layers:
            (reads if parameter.default is parameter.empty else optional).append(name)
    doc = inspect.cleandoc(function.__doc__ or "")
    return Stage(function, title, group, tags, tuple(reads), tuple(optional), tunables, doc, **makes)


def _check_declaration(declared: Stage) -> None:
    """Refuse what no run could keep to."""
    arguments = inspect.signature(declared.function).parameters
    absent = [source.name for source in declared.sources if source.name not in arguments]
    if absent:
        raise TypeError(f"{declared.name} declares the source {absent[0]!r} and has no argument of that name.")
    if declared.creates and (declared.reads or declared.optional or declared.sources):
        raise TypeError(f"{declared.name} creates a cloud, so it can't read anything.")
    if (declared.selects or declared.merges) and not declared.reads:
        raise TypeError(f"{declared.name} makes a cloud of the points it reads, so it must read some.")
    if declared.selects and declared.merges:
        raise TypeError(f"{declared.name} selects and merges; make it two stages.")
    if "xyz" in declared.writes and not (declared.selects or declared.merges):
        raise TypeError(f"{declared.name} moves points, so it must select them: withheld points would stay behind.")
    if VALUES in (*declared.reads, *declared.optional) and DIMENSION not in declared.tunables:
        raise TypeError(f"{declared.name} reads {VALUES!r} and has no tunable {DIMENSION!r} that names them.")


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
        if declared.merges:
            arrays = arguments[name] = [np.asarray(array) for array in arguments[name]]
            if len(arrays) < 2:
                raise ValueError(f"{declared.title} needs at least two point clouds, got {len(arrays)}; add another.")
        else:
            arrays = [np.asarray(arguments[name])]
            arguments[name] = arrays[0]
        clouds = ["reference cloud"] if name.startswith(REFERENCE_PREFIX) else _clouds(declared, len(arrays))
        for cloud, array in zip(clouds, arrays):
            _check_array(name, array, cloud, lengths)


def _clouds(declared: Stage, n: int) -> list[str]:
    return [f"point cloud {i}" for i in range(1, n + 1)] if declared.merges else ["point cloud"]


def _check_array(name: str, array: np.ndarray, cloud: str, lengths: dict[str, tuple[str, int]]) -> None:
    if name.endswith("xyz"):
        _check_coordinates(name, array)
    first, length = lengths.setdefault(cloud, (name, len(array)))
    if len(array) != length:
        raise ValueError(f"{name} has {len(array)} values, {first} has {length}; they must be of the same points.")
    if length == 0:
        raise ValueError(f"The {cloud} has no points.")


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
