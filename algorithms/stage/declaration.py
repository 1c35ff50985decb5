"""The declaration next to a function, and the decorator that makes it a stage."""

import functools
import inspect
import typing
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Optional, Union

import numpy as np

from .arguments import REFERENCE_PREFIX, check_arrays
from .docstrings import ARGUMENTS, TUNABLES, described, description, sections, summary, with_tunables, with_values
from .inputs_outputs import FileContent, InputLayer, Layer, Measure, Raster, StageResults, TextFile, given_layers
from .monitor import Monitor
from .tunables import Param, Tunable, in_words

# Names of the outputs that have no declaration of their own: the cloud, and the page of a report.
CLOUD, REPORT = "output", "report"

# What an output is declared as, the last for clouds and pages.
Declared = Union[Layer, Raster, TextFile, str]

# The positional argument that is whichever dimension a tunable names, and that tunable.
VALUES, DIMENSION = "values", "dimension"

# Keyword arguments that the runner fills in: no tunables.
MONITOR, SAMPLING = "monitor", "sampling"

# Meters, or what gives them from the tunables of a run.
Reach = Union[float, Callable[[dict[str, Any]], float]]


@dataclass(frozen=True)
class Stage:
    """The declaration of a stage, known without running it."""

    function: Callable
    title: str
    group: str
    tags: str
    reads: tuple[str, ...]  #: Arrays that it needs: positional arguments without a default
    optional: tuple[str, ...]  #: Arrays that it uses where a cloud has them: positional arguments with a default
    tunables: dict[str, Tunable] = field(repr=False)
    doc: str = field(repr=False)
    writes: tuple[str, ...] = ()  #: Dimensions of the points that it returns
    #: When it writes those that it may leave out, by name: "where the cloud has them"
    written_if: dict[str, str] = field(default_factory=dict)
    creates: tuple[str, ...] = ()  #: Dimensions of the cloud that it makes
    layers: tuple[Layer, ...] = ()  #: Vector layers that it makes
    measures: tuple[Measure, ...] = ()  #: Numbers of its report
    input_layers: tuple[InputLayer, ...] = ()  #: Vector layers that it reads
    rasters: tuple[Raster, ...] = ()  #: Rasters that it makes
    files: tuple[TextFile, ...] = ()  #: Text files that it makes
    selects: bool = False  #: Whether it returns which points stay
    merges: bool = False  #: Whether it reads several clouds
    #: How far (m) from a point others may lie that decide on it, a number or a function of all tunables by name. Where
    #: a cloud is worked on in parts, each is seen with the points around it that far; infinite if all points decide.
    reach: Reach = 0.0
    #: Processor time (s) per million points of a town, as measured; in a chain, its share of the progress
    cost: float = 1.0
    packages: tuple[str, ...] = ("scipy",)  #: Packages besides numpy that it uses, by the names to install them
    #: Values that it measures on its results; a part of a cloud takes the whole's instead of its own, see
    #: :meth:`.CloudSampling.shared`
    of_whole: tuple[str, ...] = ()
    #: Input layer of which it makes one feature each: in a large cloud they are worked on block by block
    each: str = ""
    #: Does the same where all layers are given and a large cloud is read part by part. In place of arrays it gets a
    #: function that reads coordinates and classes of each cloud in a box, and the side (m) of parts that fit in memory
    windowed: Any = None
    input_title: str = "Point cloud"  #: Label of the cloud that it reads
    report_title: str = "Report"  #: What its page is called
    reference_title: str = "Reference point cloud"  #: Label of the second cloud of a stage that reads one
    #: Description of that second cloud
    reference: str = "The same points with the true values, to compare with."
    #: For a stage that makes a page of layers and, optionally, points: a function that returns the boxes (k, 2, 2), m,
    #: in which it shows every point. Elsewhere it shows the topmost points, and of a survey it gets no others there.
    shows: Optional[Callable[..., np.ndarray]] = None

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
        return summary(self.doc)

    @property
    def description(self) -> str:
        """Docstring text between the summary and the first section."""
        return description(self.doc)

    def section(self, title: str) -> str:
        """Text of one numpydoc section ("Notes", "References"), "" without it."""
        return sections(self.doc).get(title, "")

    @property
    def reads_cloud(self) -> bool:
        """Whether it works on a cloud, or on several."""
        return any(not name.startswith(REFERENCE_PREFIX) for name in (*self.reads, *self.optional))

    @property
    def needs_cloud(self) -> bool:
        """Whether it can't do without a cloud: a report, for example, may be made of layers alone."""
        return any(not name.startswith(REFERENCE_PREFIX) for name in self.reads)

    @property
    def needed_packages(self) -> tuple[str, ...]:
        """Packages that it can't run without: those that it uses, and the one that reads and writes clouds."""
        has_cloud = self.reads_cloud or self.reads_reference or self.makes_cloud
        return (*self.packages, "laspy") if has_cloud else self.packages

    @property
    def samples(self) -> bool:
        """Whether it asks how the cloud was sampled."""
        return SAMPLING in inspect.signature(self.function).parameters

    @property
    def makes_cloud(self) -> bool:
        """Whether a cloud is among its results."""
        return bool(self.writes or self.creates or self.selects or self.merges)

    @property
    def outputs(self) -> dict[str, Declared]:
        """What it makes, as declared, by name: cloud, layers, rasters, text files, report."""
        found: dict[str, Declared] = {CLOUD: CLOUD} if self.makes_cloud else {}
        found.update({layer.name: layer for layer in self.layers})
        found.update({raster.name: raster for raster in self.rasters})
        found.update({file.name: file for file in self.files})
        return {**found, REPORT: REPORT} if self.measures else found

    @property
    def reads_reference(self) -> bool:
        """Whether a second cloud is compared with."""
        return any(name.startswith(REFERENCE_PREFIX) for name in (*self.reads, *self.optional))

    @property
    def needs_reference(self) -> bool:
        """Whether it can't do without the second cloud."""
        return any(name.startswith(REFERENCE_PREFIX) for name in self.reads)

    def check(self, tunables: dict[str, Any]) -> dict[str, Any]:
        """Return all tunables, given ones checked, the others at their default."""
        unknown = sorted(set(tunables) - set(self.tunables))
        if unknown:
            raise ValueError(f"{self.name} has no tunable {unknown[0]!r}; it has {', '.join(self.tunables) or 'none'}.")
        return {name: t.check(tunables[name]) if name in tunables else t.default for name, t in self.tunables.items()}

    def reach_of(self, tunables: dict[str, Any]) -> float:
        """Return the distance (m) within which points decide on one another in the stage, with these tunables."""
        return self.reach(self.check(tunables)) if callable(self.reach) else self.reach

    def unpack(self, returned: Any) -> StageResults:
        """Name the results that the function returned."""
        results = list(returned) if isinstance(returned, tuple) else [returned]
        names = (*(self.creates or self.writes), *self.layers, *self.rasters, *self.files)
        declared = self.selects + len(names) + bool(self.measures)
        if len(results) != max(1, declared):
            raise TypeError(f"{self.name} declares {declared} results and returned {len(results)}.")
        return StageResults(
            selected=results.pop(0) if self.selects else None,
            dimensions={name: results.pop(0) for name in self.creates or self.writes},
            layers={layer.name: results.pop(0) for layer in self.layers},
            rasters={raster.name: results.pop(0) for raster in self.rasters},
            files={file.name: FileContent(results.pop(0), file.write) for file in self.files},
            report=results.pop(0) if self.measures else None,
        )


def stage(group: str, *, title: str = "", tags: str = "", **fields: Any) -> Callable[[Callable], Callable]:
    """Declare a function as a stage.

    The function returns its results in the order below, and not in a tuple when there is only one. With ``selects`` the
    first are the positions of the points that its result has, int64 (m,). Then comes one array per name in ``writes``:
    of length n, with ``selects`` m, with ``merges`` of all clouds together; None for one of ``written_if`` that it
    leaves out. With ``creates`` it is one per name there, a new cloud of any length. One :class:`LayerFeatures` per
    layer follows, one :class:`RasterSurface` per raster, the items of each file, and a :class:`Report` when there are
    measures. A stage that merges and writes nothing returns None for the cloud that it makes. The decorated function
    checks its arrays and tunables on every call and carries its :class:`Stage` as ``function.stage``.

    Parameters
    ----------
    group : str
        Group in the toolbox.
    title : str
        Title in the toolbox, where it is not the name of the function in words.
    tags : str
        Words to search for, with commas between.
    **fields
        What the stage makes and reads: fields of :class:`Stage` from ``writes`` on.

    Returns
    -------
    callable
        The decorator.
    """

    def declare(function: Callable) -> Callable:
        declared = _declared(function, title or in_words(function.__name__), group, tags, fields)
        _check_declaration(declared)
        checked = _checked(function, declared)
        checked.stage = replace(declared, function=checked)  # type: ignore[attr-defined]
        checked.__doc__ = with_tunables(declared.doc, declared.tunables.values(), declared.samples)
        return checked

    return declare


def _checked(function: Callable, declared: Stage) -> Callable:
    """Return the function with a check of its arguments against its declaration."""
    signature = inspect.signature(function)
    # Up to Python 3.10 a default of None makes it optional.
    hint = typing.get_type_hints(function).get(SAMPLING)
    sampling = next(iter(typing.get_args(hint)), hint)

    @functools.wraps(function)
    def checked(*args: Any, **kwargs: Any) -> Any:
        bound = signature.bind(*args, **kwargs)
        check_arrays(bound.arguments, (*declared.reads, *declared.optional), declared.merges, declared.title)
        layers = {input_layer.name: bound.arguments.get(input_layer.name) for input_layer in declared.input_layers}
        given_layers(declared.name, declared.input_layers, layers)
        given = {name: bound.arguments[name] for name in declared.tunables if name in bound.arguments}
        bound.arguments.update(declared.check(given))
        if sampling is not None and bound.arguments.get(SAMPLING) is None and "xyz" in declared.reads:
            measured_on = [bound.arguments[name] for name in ("xyz", "classification") if name in declared.reads]
            bound.arguments[SAMPLING] = sampling.of(*measured_on)
        if bound.arguments.get(MONITOR) is None:
            bound.arguments[MONITOR] = Monitor()
        made = function(*bound.args, **bound.kwargs)
        bound.arguments[MONITOR].progress(1.0)
        return made

    shown = [
        one.replace(default=declared.tunables[one.name].default) if one.name in declared.tunables else one
        for one in signature.parameters.values()
    ]
    checked.__signature__ = signature.replace(parameters=shown)  # type: ignore[attr-defined]
    return checked


def _declared(function: Callable, title: str, group: str, tags: str, fields: dict[str, Any]) -> Stage:
    """Return the declaration of a function: what its signature and docstring say, and the ``fields`` given."""
    doc = with_values(inspect.cleandoc(function.__doc__ or ""), function.__globals__)
    helps = described(doc, TUNABLES)
    hints = typing.get_type_hints(function)
    reads: list[str] = []
    optional: list[str] = []
    tunables = {}
    texts = described(doc, ARGUMENTS)
    input_layers = tuple(one.described(texts.get(one.name, "")) for one in fields.pop("input_layers", ()))
    layers = {input_layer.name for input_layer in input_layers}
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY:
            if name not in (MONITOR, SAMPLING):
                if name not in hints or not isinstance(parameter.default, Param):
                    example = f"{name}: float = tunable(…)"
                    raise TypeError(f"{function.__name__} must declare {name!r} with its type, as in '{example}'.")
                param = parameter.default
                if not param.help:
                    param = replace(param, help=helps.pop(name, ""))
                tunables[name] = Tunable(name, _kind(hints[name]), param)
                tunables[name].check(param.default, f"the default of {name} in {function.__name__}")
        elif name not in layers:
            (reads if parameter.default is parameter.empty else optional).append(name)
    if helps:
        raise TypeError(f"{function.__name__} describes {next(iter(helps))!r}, no tunable or one that has its help.")
    return Stage(
        function, title, group, tags, tuple(reads), tuple(optional), tunables, doc, input_layers=input_layers, **fields
    )


def _check_declaration(declared: Stage) -> None:
    """Refuse a declaration that contradicts itself or the signature of its function."""
    arguments = inspect.signature(declared.function).parameters
    absent = [input_layer.name for input_layer in declared.input_layers if input_layer.name not in arguments]
    if absent:
        raise TypeError(f"{declared.name} declares the input layer {absent[0]!r} and has no argument of that name.")
    if declared.creates and (declared.reads or declared.optional or declared.input_layers):
        raise TypeError(f"{declared.name} creates a cloud, so it can't read anything.")
    if (declared.selects or declared.merges) and not declared.reads:
        raise TypeError(f"{declared.name} makes a cloud of the points it reads, so it must read some.")
    other = [name for name in declared.written_if if name not in declared.writes]
    if other:
        raise TypeError(f"{declared.name} says when it writes {other[0]!r}, which is not among what it writes.")
    if declared.selects and declared.merges:
        raise TypeError(f"{declared.name} selects and merges; make it two stages.")
    if "xyz" in declared.writes and not (declared.selects or declared.merges):
        raise TypeError(f"{declared.name} moves points, so it must select them: withheld points would stay behind.")
    if declared.samples and (declared.merges or "xyz" not in (*declared.reads, *declared.optional)):
        raise TypeError(f"{declared.name} asks how its cloud was sampled, so it must read the xyz of one cloud.")
    if declared.of_whole and not declared.samples:
        raise TypeError(f"{declared.name} takes {declared.of_whole[0]!r} of the whole, so it must take its sampling.")
    if declared.samples and arguments[SAMPLING].default is not None:
        raise TypeError(f"{declared.name} must take the sampling None, which is measured on its own points.")
    if VALUES in (*declared.reads, *declared.optional) and DIMENSION not in declared.tunables:
        raise TypeError(f"{declared.name} reads {VALUES!r} and has no tunable {DIMENSION!r} that names them.")
    if MONITOR not in arguments:
        raise TypeError(f"{declared.name} must take 'monitor=None', to which it reports progress.")


def _kind(hint: Any) -> type:
    """Return the type of a tunable, without that it may be None, and without what a tuple holds."""
    kind = typing.get_args(hint)[0] if typing.get_origin(hint) is typing.Union else hint
    return typing.get_origin(kind) or kind
