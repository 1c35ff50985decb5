"""A map that is updated through QGIS: what has not changed is written as its file has it."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.tiling.features_in_blocks import LARGEST
from lidar_buildings.tests.provider.helpers import run, vector

pytest.importorskip("qgis.core")

from qgis.core import QgsProcessingUtils, QgsVectorLayer

from lidar_buildings.provider import stage_algorithm
from lidar_buildings.provider.review import is_reviewable

CORNER = np.array([84_000.123, 447_000.456])


def _house(x, y, order=1):
    corners = (np.array([(0, 0), (10, 0), (10, 8), (0, 8), (0, 0)]) + [x, y] + CORNER)[::order]
    return "Polygon ((" + ", ".join(f"{u!r} {v!r}" for u, v in corners.tolist()) + "))"


@pytest.mark.parametrize(("crs", "largest"), [("EPSG:28992", LARGEST), ("EPSG:2227", LARGEST), ("EPSG:2227", 0)])
def test_outlines_that_stay_are_written_as_they_were_read(context, log, tmp_path, monkeypatch, crs, largest):
    """Clockwise rings, as Shapefiles have them, and coordinates in feet, which are no round meters; in large clouds."""
    monkeypatch.setattr(stage_algorithm, "LARGEST", largest)
    x, y = np.mgrid[-10:50:0.5, -10:40:0.5].reshape(2, -1)
    is_roof = (x > 0) & (x < 10) & (y % 20 > 0) & (y % 20 < 8) & (y > 0) & (y < 28)
    xyz = np.column_stack([x, y, np.where(is_roof, 5.0, 0.0)])
    unit = 1.0 if crs == "EPSG:28992" else 12 / 39.37
    xyz[:, :2] = (xyz[:, :2] + CORNER) * unit
    write_cloud(create_cloud({"xyz": xyz, "classification": np.where(is_roof, 6, 2)}, crs), tmp_path / "a.laz")
    wkt = [_house(0, 0, -1), _house(0, 20), _house(30, 20, -1)]
    old = vector("Polygon", [(one, [7 + row, 1.5, "a"]) for row, one in enumerate(wkt)], crs)
    targets = {"UPDATED_MAP": str(tmp_path / "map.gpkg"), "BUILDINGS_GONE": str(tmp_path / "gone.gpkg")}
    given = {"INPUT": str(tmp_path / "a.laz"), "OLD_MAP": old, **targets}
    if not largest:
        # A house has risen by 2 m since the earlier survey, which names no system.
        xyz[y < 20, 2] *= 0.6
        write_cloud(create_cloud({"xyz": xyz / unit, "classification": np.where(is_roof, 6, 2)}), tmp_path / "b.laz")
        new = vector("Polygon", [(wkt[0], [1, 0.0, ""]), (wkt[1], [2, 0.0, ""])], crs)
        given = {**given, "FOOTPRINTS": new, "REFERENCE": str(tmp_path / "b.laz")}
    made = run("updatemap", given, context, log)
    source = {feature["id"]: bytes(feature.geometry().asWkb()) for feature in old.getFeatures()}
    found, status = {}, {}
    for name in targets:
        layer = QgsProcessingUtils.mapLayerFromString(made[name], context)
        assert isinstance(layer, QgsVectorLayer)
        assert layer.crs().authid() == crs
        assert is_reviewable(layer)
        rows = list(layer.getFeatures())
        status.update({feature["id"]: feature["status"] for feature in rows if name == "UPDATED_MAP"})
        found[name] = {feature["id"]: bytes(feature.geometry().asWkb()) for feature in rows}
    assert found["UPDATED_MAP"] == {key: source[key] for key in (7, 8)}
    assert status == {7: "unchanged" if largest else "heightened", 8: "unchanged"}
    assert (made["GONE"], made["HEIGHTENED"]) == (1, 0 if largest else 1)
    assert found["BUILDINGS_GONE"] == {9: source[9]}
