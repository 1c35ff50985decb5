"""A block of which every wall and opening is known, modelled from the street and from the air."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.reconstruct_block import WallOpening, reconstruct_block, with_openings
from lidar_buildings.algorithms.models3d.solid_faults import fault_of
from lidar_buildings.algorithms.models3d.solids import Solid
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame, Monitor
from lidar_buildings.tests.blocks import outlines, seen_from
from lidar_buildings.tests.solid_validity import assert_valid_cityjson


@pytest.fixture(scope="module")
def block():
    air, layers = seen_from("airplane")
    monitor = Monitor()
    made = reconstruct_block.stage.unpack(
        reconstruct_block(
            air["xyz"],
            air["classification"],
            outlines(0.2),
            layers["facades"],
            layers["openings"],
            monitor=monitor,
        )
    )
    return made, layers, monitor


def test_outlines_follow_fronts_with_their_bays_and_recesses(block):
    """Corners of fronts within 2 cm, although the outlines have none of the steps; outlines in the yard stay."""
    made, layers, _ = block
    found = np.concatenate([rings[0][:-1, :2] for rings in made.layers["buildings"].geometries])
    fronts = np.concatenate([ring[:2, :2] for (ring,) in layers["facades"].geometries])
    off = np.linalg.norm(fronts[:, None] - found, axis=2).min(axis=1)
    assert np.quantile(off, 0.9) < 0.02
    sources = made.layers["walls"].columns["source"]
    assert {"street", "air"} == set(sources)


def test_windows_and_doors_are_faces_of_walls(block):
    made, layers, _ = block
    true = np.array([ring[:-1].mean(axis=0) for (ring,) in layers["openings"].geometries])
    openings = made.layers["set_openings"]
    middle = np.array([ring[:-1].mean(axis=0) for (ring,) in openings.geometries])
    # Doors are cut back to the level ground of their house.
    assert np.mean(np.linalg.norm(true[:, None] - middle, axis=2).min(axis=1) < 0.3) >= 0.9
    assert set(openings.columns["kind"]) == {"window", "door"}
    holes = sum(len(rings) - 1 for rings in made.layers["walls"].geometries)
    assert holes == len(openings)


def test_solids_with_openings_are_closed_and_cityjson_says_what_their_faces_are(block):
    made, _, _ = block
    models = made.files["cityjson"].items
    solids = [solid for one in models for solid in one.model.solids["3"]]
    assert not [fault_of(solid) for solid in solids if fault_of(solid)]
    text = "".join(made.files["cityjson"].pieces("CityJSON", MapFrame(np.asarray, "EPSG:25832")))
    assert_valid_cityjson(text)
    written = json.loads(text)
    assert written["version"] == "2.0"
    openings = 0
    for building in written["CityObjects"].values():
        geometry = next(one for one in building["geometry"] if one["lod"] == "3")
        surfaces = geometry["semantics"]["surfaces"]
        for number, surface in enumerate(surfaces):
            if surface["type"] in ("Window", "Door"):
                openings += 1
                wall = surfaces[surface["parent"]]
                assert wall["type"] == "WallSurface"
                assert number in wall["children"]
            else:
                assert surface["type"] in ("WallSurface", "RoofSurface", "GroundSurface")
                assert "parent" not in surface
    assert openings == len(made.layers["set_openings"])


def box(width: float = 10.0, depth: float = 6.0, height: float = 5.0) -> Solid:
    """Return a box whose front, y = 0, faces south."""
    x, y, z = width, depth, height
    vertices = [(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0), (0, 0, z), (x, 0, z), (x, y, z), (0, y, z)]
    sides = [[[k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4]] for k in range(4)]
    faces = [[[3, 2, 1, 0]], [[4, 5, 6, 7]], *sides]
    return Solid(np.array(vertices, float), faces, ["ground", "roof", *["wall"] * 4], [-1, 0, -1, -1, -1, -1])


def pane(west, low, east, high, y=0.0):
    return np.array([(west, y, low), (east, y, low), (east, y, high), (west, y, high)])


def test_openings_are_set_into_the_wall_before_them_and_cut_back_to_it():
    door, window = (
        WallOpening(1, "door", pane(1, -0.2, 2, 2.0, y=-0.2)),
        WallOpening(2, "window", pane(4, 1, 5, 2.5, y=0.15)),
    )
    solid, done = with_openings(box(), [door, window])
    assert fault_of(solid) == ""
    assert solid.volume == pytest.approx(300.0)
    assert solid.kinds[-2:] == ["door", "window"]
    assert [opening.number for opening in done] == [1, 2]
    assert done[0].ring[:, 2].min() == pytest.approx(0.03)
    assert np.abs(np.concatenate([opening.ring[:, 1] for opening in done])).max() < 1e-9
    assert len(solid.faces[2]) == 3


def test_an_opening_across_a_bend_is_set_into_the_wall_with_most_of_it():
    solid, done = with_openings(box(), [WallOpening(1, "window", pane(9, 1, 10.5, 2))])
    assert fault_of(solid) == ""
    assert done[0].ring[:, 0].max() == pytest.approx(9.97)


@pytest.mark.parametrize(
    "ring",
    [
        pane(9, 1, 11, 2),
        pane(4, 1, 5, 2, y=0.7),
        pane(4, 1, 5, 2)[::-1],
        pane(4, 4, 5, 7),
    ],
    ids=["across a corner", "0.7 m behind", "facing inward", "over the eaves"],
)
def test_openings_that_lie_in_no_wall_are_left_out(ring):
    solid, done = with_openings(box(), [WallOpening(1, "window", ring)])
    assert not done
    assert len(solid.faces) == 6


def test_of_two_openings_that_cross_the_first_is_set():
    crossing = [WallOpening(1, "window", pane(2, 1, 4, 2)), WallOpening(2, "window", pane(3, 1.5, 5, 3))]
    assert [opening.number for opening in with_openings(box(), crossing)[1]] == [1]


def test_layers_without_heights_are_reported_and_the_footprints_stay():
    air, layers = seen_from("airplane")
    flat = LayerFeatures([[ring[:, :2]] for (ring,) in layers["facades"].geometries], {})
    monitor = Monitor()
    buildings, walls, *_ = reconstruct_block(
        air["xyz"], air["classification"], outlines(), flat, LayerFeatures([], {}), monitor=monitor
    )
    assert (
        monitor.warnings[0] == "No facade is an upright polygon with heights, so all walls are taken from footprints."
    )
    assert set(walls.columns["source"]) == {"air"}
    assert len(buildings) == len(outlines())


def test_facades_without_footprints_give_no_models(block):
    """It was numpy's error, and a chain on a cloud without buildings kept nothing."""
    _, layers, _ = block
    air, _ = seen_from("airplane")
    made = reconstruct_block(
        air["xyz"], air["classification"], LayerFeatures([], {}), layers["facades"], layers["openings"]
    )
    assert [len(layer) for layer in made] == [0] * len(made)
