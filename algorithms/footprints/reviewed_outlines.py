"""Outlines that a person has decided on, in the place of those that were found."""

from __future__ import annotations

import itertools
from typing import Optional

import numpy as np

from ..buildings.reviewed_buildings import ReviewedBuildings
from ..geometry.polygon_overlap import as_polygons, overlaps
from ..stage import LayerFeatures, Monitor
from .footprint_attributes import FIELDS


def with_reviewed(found: LayerFeatures, review: Optional[ReviewedBuildings]) -> LayerFeatures:
    """Return the outlines that stay as they were reviewed, with their attributes, before the others that were found.

    Those that are mostly where others were decided on are left out. Buildings keep their numbers of the reviewed layer.
    """
    if review is None:
        return found
    layer, staying = review.layer, review.rows[: review.stay]
    own, given = as_polygons(found.geometries), as_polygons(layer.geometries)
    # Ascending by what they share, so that of several the one that shares most counts.
    one, other, shared = overlaps(own, given, Monitor())
    order = np.argsort(shared)
    one, other, shared = one[order], other[order], shared[order]
    is_decided = np.isin(other, review.rows)
    covered = np.bincount(one[is_decided], shared[is_decided], len(found))
    others = np.flatnonzero(2 * covered <= own.area).tolist()
    ids = np.asarray(layer.columns.get("id", ""))
    is_numbered = ids.dtype.kind in "if"
    # "fid" is the number that a GeoPackage gives its rows.
    kept = {key: of for key, of in layer.kept(staying, () if is_numbered else FIELDS[:1]).items() if key != "map_fid"}
    cluster = dict(zip(other.tolist(), one.tolist()))
    kept["cluster_id"] = [found.columns["cluster_id"][cluster[row]] if row in cluster else 0 for row in staying]
    new = {name: [values[row] for row in others] for name, values in found.columns.items()}
    is_same = ~is_decided & is_numbered & (2 * shared > np.maximum(own.area[one], given.area[other]))
    before = dict(zip(one[is_same].tolist(), ids[other[is_same]].tolist() if is_numbered else ()))
    new["id"] = [before.get(row) for row in others]
    columns = {
        name: [*kept.get(name, [None] * len(staying)), *new.get(name, [None] * len(others))]
        for name in dict.fromkeys([*new, *kept])
    }
    free = itertools.count(1 + int(np.nanmax(ids, initial=0)) if is_numbered else 1)
    columns["id"] = [next(free) if number is None or np.isnan(number) else int(number) for number in columns["id"]]
    sources = [*(layer.sources[row] if layer.sources else None for row in staying), *[None] * len(others)]
    outlines = [[np.asarray(ring, float)[:, :2] for ring in layer.geometries[row]] for row in staying]
    return LayerFeatures([*outlines, *(found.geometries[row] for row in others)], columns, sources)
