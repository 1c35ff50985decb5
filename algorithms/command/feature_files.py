"""Vector layers in files: GeoJSON, and the formats of the package pyogrio where that is installed."""

import io
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..geometry.rings import signed_area
from ..packages import pyogrio
from ..stage import InputLayer, Layer, LayerFeatures, Monitor, all_fields, as_column, column_on_map, plain

GEOJSON = (".geojson", ".json")
_CODE = re.compile(r"EPSG:+(\d+)")


def check_format(path: Path) -> None:
    """Refuse a file of a format that can't be read or written here.

    Raises
    ------
    ValueError
        If it is no GeoJSON and the package pyogrio is not installed.
    """
    if path.suffix.lower() not in GEOJSON and pyogrio() is None:
        raise ValueError(
            f"{path.name} is no GeoJSON, and other vector formats need the package pyogrio; install it, or take the "
            "extension .geojson."
        )


def read_layer(path: Path, wanted: InputLayer, monitor: Monitor) -> tuple[LayerFeatures, str]:
    """Return the parts of geometries of a file, with all attributes, in map coordinates, and the code of their CRS.

    Features without a geometry of the wanted kind are left out, which a warning counts. The code is "" where the file
    names none: the layer is then in the CRS of the cloud.

    Raises
    ------
    ValueError
        If the file can't be read, or if there are features and all are left out.
    """
    check_format(path)
    try:
        text = path.read_bytes() if path.suffix.lower() in GEOJSON else _as_geojson(path)
        collection = json.loads(text)
        features = [(one["geometry"], one.get("properties") or {}) for one in collection["features"]]
        parts = [(part, facts) for shape, facts in features for part in _parts(shape, wanted)]
        named = _CODE.search(str(collection.get("crs")))
    except (ValueError, TypeError, KeyError, IndexError, AttributeError, RuntimeError) as error:
        raise ValueError(f"{path.name} can't be read as vector features ({error}); choose another file.") from error
    empty = sum(not _parts(shape, wanted) for shape, _ in features)
    if empty:
        monitor.warn(f"{wanted.title}: {empty} of {len(features)} features are left out; they are no {wanted.objects}.")
    if features and not parts:
        raise ValueError(f"{path.name} has no {wanted.objects}, which {wanted.title} must be; choose another file.")
    names = dict.fromkeys(name for _, facts in features for name in facts)
    columns = {name: as_column([facts.get(name) for _, facts in parts]) for name in names}
    return LayerFeatures([part for part, _ in parts], columns), f"EPSG:{named[1]}" if named else ""


def _as_geojson(path: Path) -> bytes:
    raw, stream = pyogrio(), io.BytesIO()
    meta, _, geometries, values = raw.read(path)
    kind = {"geometry_type": meta["geometry_type"], "crs": meta["crs"]}
    raw.write(stream, geometries, values, meta["fields"], driver="GeoJSON", COORDINATE_PRECISION=15, **kind)
    return stream.getvalue()


def _parts(shape: Any, wanted: InputLayer) -> list:
    """Return the parts of a GeoJSON geometry as in :class:`LayerFeatures`; none where it is of another kind."""
    if not shape or shape["type"].replace("Multi", "") != wanted.geometry:
        return []
    parts = shape["coordinates"] if shape["type"].startswith("Multi") else [shape["coordinates"]]
    if wanted.geometry == "Polygon":
        return [_rings(part, wanted.upright) for part in parts]
    return [np.array(part, float) for part in parts]


def _rings(part: list, upright: bool) -> list[np.ndarray]:
    """Return the rings of a polygon, the exterior counterclockwise and holes clockwise unless it may stand upright."""
    rings = [np.array(ring, float) for ring in part]
    turned = [not upright and (signed_area(ring[:, :2]) < 0) == (number == 0) for number, ring in enumerate(rings)]
    return [ring[::-1] if is_turned else ring for ring, is_turned in zip(rings, turned)]


def write_features(
    path: Path, layer: Layer, features: LayerFeatures, to_map: Callable[[np.ndarray], np.ndarray], code: str
) -> None:
    """Write the features of a layer.

    Parameters
    ----------
    path : Path
        GeoJSON, or a file that pyogrio writes.
    layer : Layer
        How the stage declares it.
    features : LayerFeatures
        In local meters.
    to_map : callable
        Turns local meters (n, 2 or 3) into coordinates of the CRS.
    code : str
        Of the CRS, "EPSG:28992"; "" names none.

    Raises
    ------
    ValueError
        If pyogrio can't write such a file.
    """
    fields = all_fields(layer, features)
    columns = [column_on_map(field, features, to_map) for field in fields]
    of_map = []
    for row, geometry in enumerate(features.geometries):
        facts = {field.name: plain(column[row]) for field, column in zip(fields, columns)}
        shape = {"type": layer.geometry, "coordinates": _coordinates(geometry, to_map)}
        of_map.append({"type": "Feature", "properties": facts, "geometry": shape})
    # A name of the CRS is older than RFC 7946, which knows degrees only; QGIS and GDAL read and write it.
    name = {"name": f"urn:ogc:def:crs:{code.replace(':', '::')}"}
    crs = {"crs": {"type": "name", "properties": name}} if code else {}
    text = json.dumps({"type": "FeatureCollection", "name": path.stem, **crs, "features": of_map})
    if path.suffix.lower() in GEOJSON:
        path.write_text(text, encoding="utf-8")
        return
    raw = pyogrio()
    meta, _, geometries, values = raw.read(text.encode())
    try:
        raw.write(path, geometries, values, meta["fields"], geometry_type=meta["geometry_type"], crs=meta["crs"])
    except (RuntimeError, ValueError) as error:
        raise ValueError(f"{path.name} can't be written as a layer ({error}); take the extension .gpkg.") from error


def _coordinates(geometry: Any, to_map: Callable[[np.ndarray], np.ndarray]) -> list:
    if isinstance(geometry, (list, tuple)):
        return [to_map(np.asarray(ring)).tolist() for ring in geometry]
    return to_map(np.atleast_2d(geometry)).reshape(np.shape(geometry)).tolist()
