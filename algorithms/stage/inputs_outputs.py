"""Inputs and outputs of stages besides points: declarations and contents of layers, rasters, files and reports."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Optional, Protocol, Union

import numpy as np

from .tunables import in_words


@dataclass(frozen=True)
class Field:
    """One attribute of a layer that a stage makes (``type`` is int, float or str).

    Values with an ``axis`` (0 east, 1 north) are positions: in local meters from the stage, in map units in the layer.
    ``of`` is the layer, made by the stage or given to it, whose ``id`` a field holds: what it belongs to.
    ``numbers`` is the dimension by which points refer to the feature, with the values of this field.
    """

    name: str
    type: type
    help: str
    unit: str = ""
    axis: Optional[int] = None
    of: str = ""
    numbers: str = ""


@dataclass(frozen=True)
class Layer:
    """A vector layer that a stage makes.

    ``name`` becomes the output's name (``FOOTPRINTS``), ``geometry`` is
    ``"Polygon"``, ``"LineString"`` or ``"Point"``, ``style`` the stem of a file in
    ``resources/styles``.

    The others say what becomes of features where a cloud is worked on in overlapping parts. ``deviation`` is the field
    with the root mean square distance of points from the plane of a polygon, for planes in space, which may be upright
    or lie above one another. ``radius`` is the field with the distance (m) of the points from a line or a point in
    space. ``around`` is how far beyond a feature points decide on it, m. ``whole``, where pieces of a long feature can
    be put together, is given the pieces, the largest first, and the number of their points, and returns one feature.
    Points must refer to it (``numbers`` of a field).

    ``on_demand`` is, for a layer that dialogs make only when asked, the advice for one who asked and got no features.
    """

    name: str
    title: str
    geometry: str
    fields: tuple[Field, ...]
    style: str = ""
    deviation: str = ""
    radius: str = ""
    around: float = 1.0
    whole: Optional[Callable[[LayerFeatures, int], LayerFeatures]] = None
    on_demand: str = ""

    def __post_init__(self) -> None:
        """Refuse fields that it does not have."""
        names = {"", *(field.name for field in self.fields)}
        absent = [name for name in (self.deviation, self.radius) if name not in names]
        if absent:
            raise TypeError(f"The layer {self.name} has no field {absent[0]!r}.")

    @property
    def numbers(self) -> str:
        """The dimension by which points refer to the features, "" where they don't."""
        return next((field.numbers for field in self.fields if field.numbers), "")


@dataclass(frozen=True)
class InputLayer:
    """A vector layer that a stage reads.

    ``name`` is the positional argument and the input (``OLD_MAP``). Without a ``title`` the dialog calls it by its name
    in words, without ``help`` it says what the docstring of the stage says of the argument. ``geometry`` is one of
    ``"Polygon"``, ``"LineString"`` and ``"Point"``. The stage is given :class:`LayerFeatures` with all attributes of
    the layer, or None where an ``optional`` one is not given. Parts of a multipart geometry come one by one, each with
    the attributes of the whole. ``upright`` polygons have no area in plan: their rings come as they are. An
    ``advanced`` one is folded away. Each polygon of one of ``buildings`` is a building, so wider ones than any are
    refused. A file with one of ``endings``, of a format that QGIS does not read, takes the place of a layer: ``read``
    turns its text into features in map units and the code of their CRS.
    """

    name: str
    title: str = ""
    help: str = ""
    geometry: str = "Polygon"
    optional: bool = False
    advanced: bool = False
    upright: bool = False
    buildings: bool = False
    endings: tuple[str, ...] = ()
    read: Optional[Callable[[str], tuple[LayerFeatures, str]]] = None

    def described(self, text: str) -> InputLayer:
        """Return the layer with its name in words as the title, and this text as its help, where it has none."""
        return replace(self, title=self.title or in_words(self.name), help=self.help or text)

    @property
    def objects(self) -> str:
        """The name of its geometries for users: polygons, lines or points."""
        return {"Polygon": "polygons", "LineString": "lines", "Point": "points"}[self.geometry]


@dataclass
class LayerFeatures:
    """The content of a :class:`Layer` or :class:`InputLayer`: geometries and one column per field.

    ``geometries`` holds, per feature of a polygon layer, a list of rings, float64 (m, 2) or (m, 3), meters. The
    exterior comes first, counterclockwise, then the holes, clockwise; all are closed: the last vertex equals the first.
    Of a line layer it holds one (m, 2 or 3) array per feature, of points one (2 or 3,) array.
    Coordinates are relative to the cloud's origin, or, where a stage reads no cloud, to one that all its input
    layers share.
    ``columns`` maps each field's name to a sequence of the same length; an input layer's are
    arrays of int64 or float64 (NaN is NULL), or lists, with None for NULL.
    """

    geometries: list
    columns: dict[str, Any]
    #: Of an input layer the geometries as its file has them; one that is given back among the results is written so
    sources: Optional[list] = None

    def __len__(self) -> int:
        return len(self.geometries)

    @classmethod
    def numbered(cls, features: Sequence[tuple[Any, dict[str, Any]]], fields: Sequence[Field]) -> LayerFeatures:
        """Return geometries with their attributes by ``fields``, the first of which is their number, from 1."""
        number, *others = (field.name for field in fields)
        columns = {name: [facts[name] for _, facts in features] for name in others}
        return cls([geometry for geometry, _ in features], {number: list(range(1, len(features) + 1)), **columns})

    def kept(self, rows: Iterable[int], used: Sequence[Field]) -> dict[str, list]:
        """Return the attributes of some features as plain values; those with a name that is used become ``map_…``.

        So does fid, by which a GeoPackage numbers its own rows: parts of one geometry have the same.
        """
        taken, chosen = {"fid", *(field.name for field in used)}, list(rows)
        return {
            f"map_{name}" if name.lower() in taken else name: [_plain_value(values[row]) for row in chosen]
            for name, values in self.columns.items()
        }


def _plain_value(value: Any) -> Any:
    """Return a number as Python's own, None where it is undefined, and other values as text."""
    value = value.item() if isinstance(value, np.generic) else value
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, (bool, int, float)):
        return None if isinstance(value, float) and math.isnan(value) else value
    return str(value)


def all_fields(layer: Layer, features: LayerFeatures) -> list[Field]:
    """Return the fields of a layer, and of other columns that its features have: attributes of a map."""
    names = {declared.name for declared in layer.fields}
    others = [Field(name, _type_of(column), "") for name, column in features.columns.items() if name not in names]
    return [*layer.fields, *others]


def _type_of(column: Sequence) -> type:
    """Return the type of all values of a column, float for numbers of both types, text where they differ otherwise."""
    types = {type(value) for value in column if value is not None}
    return bool if types == {bool} else next((kind for kind in (int, float) if types and types <= {int, kind}), str)


def column_on_map(
    declared: Field, features: LayerFeatures, to_map: Callable[[np.ndarray], np.ndarray]
) -> Union[Sequence, np.ndarray]:
    """Return the values of a field, positions in map coordinates.

    ``to_map`` turns local meters (n, 2) into these.
    """
    column = features.columns[declared.name]
    if declared.type is str:
        return [None if value is None else str(value) for value in column]
    if declared.axis is None:
        return column
    positions = np.zeros((len(column), 2))
    positions[:, declared.axis] = column
    return to_map(positions)[:, declared.axis]


def plain(value: Any) -> Any:
    """Return a value, a numpy scalar as Python's own, None for NaN and infinity."""
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_column(values: list) -> Any:
    """Return an attribute's values: int64, or float64 with NaN for null, or what they are."""
    kinds = {type(value) for value in values}
    if kinds == {int}:
        return np.array(values, np.int64)
    if kinds & {int, float} and kinds <= {int, float, type(None)}:
        return np.array([np.nan if value is None else value for value in values], float)
    return values


def feature_names(features: LayerFeatures, id_field: str = "") -> list[str]:
    """Return the attribute ``id_field`` of features as text, their number from 1 where it is missing.

    Without a name it is the attribute "id" or "fid", in any case.

    Raises
    ------
    ValueError
        If the features have no attribute ``id_field``.
    """
    if id_field and id_field not in features.columns:
        raise ValueError(
            f"The layer has no attribute {id_field!r} (Identifier); choose one of {', '.join(features.columns)}."
        )
    columns = {name.lower(): values for name, values in features.columns.items()}
    ids = features.columns[id_field] if id_field else columns.get("id", columns.get("fid", [None] * len(features)))
    return [_text(value) or str(number) for number, value in enumerate(ids, start=1)]


def _text(value: object) -> str:
    """Return an attribute as text, "" where it is missing; whole numbers come as floats where some are missing."""
    if isinstance(value, (float, np.floating)):
        # Keys of 16 digits are exact as floats, but 15 significant digits would round them.
        return "" if math.isnan(value) else f"{value:.0f}" if value.is_integer() else f"{value:.15g}"
    return "" if value is None else str(value)


def given_layers(
    reader: str, input_layers: Iterable[InputLayer], given: dict[str, Optional[LayerFeatures]]
) -> dict[str, Optional[LayerFeatures]]:
    """Return the layer that is given for each input layer, None where an optional one is not; refuse what does not fit.

    Parameters
    ----------
    reader : str
        Name of the stage or pipeline that reads them.
    input_layers : iterable of InputLayer
        What it reads.
    given : dict of str to LayerFeatures
        Layers by the names of input layers.

    Raises
    ------
    ValueError
        If a layer is missing, one is given that nobody reads, or a polygon is too wide for a building.
    """
    wanted = {input_layer.name: input_layer for input_layer in input_layers}
    unknown = [name for name in given if name not in wanted]
    if unknown:
        raise ValueError(f"{reader} reads no layer {unknown[0]!r}; it reads {', '.join(wanted) or 'none'}.")
    for input_layer in wanted.values():
        if given.get(input_layer.name) is None and not input_layer.optional:
            raise ValueError(f"{input_layer.title} ({input_layer.name}) is missing; choose a layer.")
        if input_layer.buildings:
            _refuse_wide(input_layer.title, given.get(input_layer.name))
    return {name: given.get(name) for name in wanted}


# Widest building (m): the longest that there is, the gallery of a linear accelerator, has 3.1 km. A wider polygon is a
# district, an outline of the map or damage, and cells and edges of its size would fill the memory.
_WIDEST = 4000.0


def _refuse_wide(title: str, features: Optional[LayerFeatures]) -> None:
    """Refuse a layer of buildings with a polygon that none can be."""
    given = [rings[0] for rings in features.geometries if len(rings) and len(rings[0])] if features else []
    corners = [np.asarray(ring, float)[:, :2] for ring in given]
    if not corners:
        return
    vertices, first = np.concatenate(corners), np.cumsum([0, *map(len, corners[:-1])])
    width = (np.maximum.reduceat(vertices, first) - np.minimum.reduceat(vertices, first)).max()
    if width > _WIDEST:
        raise ValueError(
            f"{title}: a polygon is {width / 1000:,.1f} km wide, and no building is wider than {_WIDEST / 1000:g} km; "
            "remove it, or choose another layer."
        )


@dataclass(frozen=True)
class Raster:
    """A raster that a stage makes.

    ``name`` becomes the output's name (``DTM``), ``style`` is the stem of a file in
    ``resources/styles``, ``unit`` the values' unit.
    """

    name: str
    title: str
    style: str = ""
    unit: str = ""


@dataclass
class RasterSurface:
    """The content of a :class:`Raster`.

    ``values`` is float32 (rows, columns), the northernmost row first, NaN where there is nothing;
    ``west`` and ``north`` are the outer edges (m, from the cloud's origin), ``cell_size`` the side of a cell (m).
    """

    values: np.ndarray
    west: float
    north: float
    cell_size: float


@dataclass(frozen=True)
class MapFrame:
    """Where local meters are on the map: what turns them (m, 3) into coordinates, and the CRS ("EPSG:7415" or "").

    ``to_degrees``, where the CRS is known, turns coordinates (n, 2) into longitudes and latitudes of WGS 84. ``file``
    is the name, without its ending, of the file that is written.
    """

    to_map: Callable[[np.ndarray], np.ndarray]
    crs: str = ""
    to_degrees: Optional[Callable[[np.ndarray], np.ndarray]] = None
    file: str = "models"

    @property
    def units(self) -> tuple[float, float]:
        """Map units per meter, in plan and in height."""
        ends = np.asarray(self.to_map(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]])))
        plan, _, height = np.round(ends[1] - ends[0], 6).tolist()
        return plan, height


class FileItem(Protocol):
    """One item of a :class:`TextFile`, which can be kept as JSON."""

    @property
    def name(self) -> str:
        """What it is called: the ``id`` of the feature that it belongs to."""

    def record(self) -> dict[str, Any]:
        """Return it as plain values."""

    @classmethod
    def of_record(cls, record: dict[str, Any], name: str) -> Any:
        """Return the item of plain values, under a name."""

    @classmethod
    def of_features(cls, features: LayerFeatures) -> list[Any]:
        """Return the items of features of the layer that the file has, too."""


# A part of a file, or the name and the content of another one that belongs next to it.
Piece = Union[str, bytes, tuple[str, bytes]]


@dataclass(frozen=True)
class TextFile:
    """A file that a stage makes, in the format of its extension.

    ``name`` becomes the output's name (``CITYJSON``); ``formats`` gives the file extensions of each format by
    its name, the preferred one first. ``write`` returns the text or bytes, in parts, of any number of items in
    a format and for a map; it goes through the items as often as it likes, and keeps none. Where runs in tiles make it,
    ``item`` is what they are, a class of :class:`FileItem`, and ``of`` the layer, made by the stage or given to it,
    whose ``id`` is their name. Features of the layer ``also`` are items, too.
    """

    name: str
    title: str
    formats: Mapping[str, tuple[str, ...]]
    write: Callable[[Collection[Any], str, MapFrame], Iterator[Piece]]
    item: type[FileItem] = FileItem  # type: ignore[type-abstract]
    of: str = ""
    also: str = ""

    def format_of(self, file_name: str) -> str:
        """Return the format by a file's extension.

        Raises
        ------
        ValueError
            If the extension is unknown.
        """
        endings = {ending: format_name for format_name, endings in self.formats.items() for ending in endings}
        for ending in sorted(endings, key=len, reverse=True):
            if file_name.lower().endswith(ending):
                return endings[ending]
        raise ValueError(f"{file_name} can't be written as {self.title}: give it the extension {' or '.join(endings)}.")


@dataclass(frozen=True)
class FileContent:
    """The content of a :class:`TextFile`: its items, and what writes them."""

    items: Collection[Any]
    write: Callable[[Collection[Any], str, MapFrame], Iterator[Piece]]

    def pieces(self, format_name: str, frame: MapFrame) -> Iterator[Piece]:
        """Return the text or bytes, in parts, in a format and for a map."""
        return self.write(self.items, format_name, frame)


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
class StageResults:
    """What a stage's function returned, each result under its name; see :meth:`Stage.unpack`."""

    selected: Optional[np.ndarray] = None
    dimensions: dict[str, Optional[np.ndarray]] = field(default_factory=dict)
    layers: dict[str, LayerFeatures] = field(default_factory=dict)
    rasters: dict[str, RasterSurface] = field(default_factory=dict)
    files: dict[str, FileContent] = field(default_factory=dict)
    report: Optional[Report] = None
