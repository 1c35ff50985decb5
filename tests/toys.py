"""Stages that are small enough to know their results by heart, one of every kind."""

from __future__ import annotations

from typing import Optional

import numpy as np

from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.stage import (
    Cancelled,
    Field,
    InputLayer,
    Layer,
    LayerFeatures,
    Measure,
    Raster,
    RasterSurface,
    Report,
    stage,
    tunable,
)


@stage("Toys", writes=("height_above_ground",), tags="toy, lift")
def toy_lift(
    xyz,
    classification,
    *,
    step: float = tunable(1.5, "Added to all heights.", within="(0, 10] m"),
    base: Optional[float] = tunable(None, "Taken off all heights.", within="[0, inf) m", automatic="the lowest point."),
    times: int = tunable(2, "How often the step is added.", within="[1, 5]", advanced=True),
    sign: str = tunable("up", "Up or down.", choices=("up", "down")),
    only: tuple = tunable(
        (
            "ground",
            "building",
        ),
        "Classes that are lifted.",
        choices=("ground", "building"),
    ),
    flat: bool = tunable(False, "All heights alike."),
    monitor=None,
):
    """Lift every point.

    A text in two parts, with ``code`` and *emphasis*.

    Notes
    -----
    * One.
    * Two.

    References
    ----------
    Nobody (2000), Nothing.
    """
    monitor.progress(0.5)
    base = float(xyz[:, 2].min()) if base is None else base
    # Many stages report all values that they use, given or automatic.
    monitor.resolved(base=base)
    chosen = np.isin(classification, [{"ground": 2, "building": 6}[word] for word in only])
    lifted = xyz[:, 2] - base + times * step * (1 if sign == "up" else -1) * chosen
    return np.full(len(xyz), step) if flat else lifted


@stage(
    "Toys",
    layers=(
        Layer(
            "footprints",
            "Footprints",
            "Polygon",
            (
                Field("id", int, "Number of the polygon."),
                Field("height", float, "Mean height.", "m"),
                Field("kind", str, "A word."),
            ),
        ),
    ),
)
def toy_outline(
    xyz,
    height_above_ground=None,
    *,
    margin: float = tunable(0.0, "Around the points.", within="[0, 9] m"),
    monitor=None,
):
    """Draw a box with a hole around all points."""
    low, high = xyz[:, :2].min(axis=0) - margin, xyz[:, :2].max(axis=0) + margin
    box = np.array([low, [high[0], low[1]], high, [low[0], high[1]], low])
    hole = (box[::-1] - box[:-1].mean(axis=0)) * 0.5 + box[:-1].mean(axis=0)
    height = np.float32(np.nan if height_above_ground is None else height_above_ground.mean())
    return LayerFeatures([[box, hole]], {"id": np.array([7]), "height": [height], "kind": ["box"]})


@stage("Toys", measures=(Measure("difference", "Difference", "m"), Measure("points", "Points")))
def toy_compare(xyz, reference_xyz, *, monitor=None):
    """Compare mean heights."""
    difference = np.float64(xyz[:, 2].mean() - reference_xyz[:, 2].mean())
    return Report(
        {"difference": difference, "points": np.int64(len(xyz))}, f"<html><body>{difference:.3f}</body></html>"
    )


@stage(
    "Toys", creates=("xyz", "classification"), layers=(Layer("truth", "Truth", "Point", (Field("id", int, "Id."),)),)
)
def toy_make(*, n_points: int = tunable(10, "How many.", label="Points", within="[1, 1000]"), monitor=None):
    """Make a row of points."""
    xyz = np.column_stack([np.arange(n_points), np.zeros(n_points), np.full(n_points, 3.0)])
    return xyz, np.full(n_points, 2, np.uint8), LayerFeatures([np.array([1.0, 2.0, 3.0])], {"id": [1]})


@stage("Toys", writes=("height_above_ground",))
def toy_trouble(
    xyz,
    *,
    kind: str = tunable("value", "What goes wrong.", choices=("value", "bug", "memory", "cancel")),
    monitor=None,
):
    """Fail in a chosen way."""
    if kind == "cancel":
        raise Cancelled
    raise {
        "value": ValueError("The field is empty; choose another."),
        "bug": ZeroDivisionError("a fault"),
        "memory": MemoryError("Unable to allocate 9 GiB"),
    }[kind]


@stage("Toys", writes=("xyz", "cluster_id"), selects=True)
def toy_keep(
    xyz,
    values=None,
    *,
    dimension: str = tunable("", "What is looked at; heights, if empty."),
    low: float = tunable(12.0, "Points with less go.", within="[-1e9, inf)"),
    sink: float = tunable(0.0, "How far the others go down.", within="[0, inf) m"),
    monitor=None,
):
    """Keep what is high, and number it."""
    kept = np.flatnonzero((xyz[:, 2] if values is None else values) >= low)
    return kept, xyz[kept] - [0, 0, sink] if sink else None, np.arange(1, len(kept) + 1)


@stage("Toys", writes=("xyz", "point_source_id"), merges=True)
def toy_merge(
    xyz,
    *,
    apart: float = tunable(0.0, "Each cloud higher than the last.", within="[0, inf)"),
    monitor=None,
):
    """Put clouds together and number them."""
    sizes = [len(one) for one in xyz]
    number = np.repeat(np.arange(len(xyz)), sizes)
    return np.concatenate(xyz) + apart * np.outer(number, [0, 0, 1]) if apart else None, number + 1


@stage(
    "Toys",
    writes=("cluster_id",),
    input_layers=(InputLayer("areas", "Areas", "Boxes of these number the points.", optional=True),),
)
def toy_mask(xyz, areas=None, *, monitor=None):
    """Number the points by the box they are in, with the attribute ``id`` of its polygon."""
    cluster_id = np.zeros(len(xyz), np.int32)
    for (box, *_), number in zip(areas.geometries, areas.columns["id"]) if areas else ():
        inside = ((xyz[:, :2] >= box[:, :2].min(axis=0)) & (xyz[:, :2] <= box[:, :2].max(axis=0))).all(axis=1)
        cluster_id[inside] = number
    return cluster_id


@stage(
    "Toys",
    input_layers=(
        InputLayer("old", "Old map", "What it was."),
        InputLayer("new", "New map", "What it is."),
        InputLayer("extra", "Extra", "Anything.", "Point", optional=True),
    ),
    layers=(Layer("arrows", "Arrows", "LineString", (Field("length", float, "How far.", "m"),)),),
    measures=(Measure("longest", "Longest", "m"),),
)
def toy_arrows(old, new, extra=None, *, monitor=None):
    """Draw an arrow from the middle of each old polygon to the new one's in the same row."""
    arrows = [
        np.array([rings[0][:-1, :2].mean(axis=0) for rings in pair]) for pair in zip(old.geometries, new.geometries)
    ]
    length = [float(np.hypot(*(arrow[1] - arrow[0]))) for arrow in arrows]
    longest = max(length, default=np.nan)
    return LayerFeatures(arrows, {"length": length}), Report({"longest": longest}, f"<html>{longest:.3f}</html>")


@stage("Toys", rasters=(Raster("top", "Top", unit="m"), Raster("floor", "Floor", "top", "m")))
def toy_heights(
    xyz,
    *,
    cell_size: float = tunable(2.0, "Side of a cell.", within="[0.1, inf) m"),
    monitor=None,
):
    """Draw the highest and the lowest point of each cell."""
    west, north = float(xyz[:, 0].min()), float(xyz[:, 1].max()) + cell_size / 2
    column, row = ((xyz[:, :2] - [west, north]) / [cell_size, -cell_size]).astype(int).T
    shape = (row.max() + 1, column.max() + 1)
    top, floor = np.full(shape, -np.inf, np.float32), np.full(shape, np.inf, np.float32)
    np.maximum.at(top, (row, column), xyz[:, 2])
    np.minimum.at(floor, (row, column), xyz[:, 2])
    empty = np.isinf(top)
    return tuple(RasterSurface(np.where(empty, np.nan, values), west, north, cell_size) for values in (top, floor))


@stage("Toys", rasters=(Raster("picture", "Picture"),))
def toy_picture(xyz, *, monitor=None):
    """Draw two cells, one of them empty."""
    return RasterSurface(np.array([[1.5, np.nan]]), 0.0, 0.0, 3.0)


_FUNCTIONS = (
    toy_lift,
    toy_outline,
    toy_compare,
    toy_make,
    toy_trouble,
    toy_keep,
    toy_merge,
    toy_mask,
    toy_arrows,
    toy_heights,
    toy_picture,
)
TOYS = {function.stage.name: function.stage for function in _FUNCTIONS}

TOY_CHAIN = Pipeline(
    "toy_chain",
    "Toy chain",
    "Toys",
    "toy",
    "Lift twice and draw.",
    "A longer text.",
    "Nobody (2000), Nothing.",
    (
        Step("first", "toy_lift", {"step": 2.5, "only": ("building",)}),
        Step("second", "toy_lift", {"times": 3}),
        Step("outline", "toy_outline", {"margin": 1.0}),
    ),
    shared={"sign": ("first", "second")},
    shown=("second_step", "sign"),
)

# Clouds merged, a branch, layers of steps and of users, rasters, a report, and every cloud kept.
TOY_MAPPING = Pipeline(
    "toy_mapping",
    "Toy mapping",
    "Toys",
    "toy",
    "Compare roofs with an old map.",
    "A longer text.",
    "Nobody (2000), Nothing.",
    (
        Step("together", "toy_merge", {"apart": 0.5}),
        Step("lift", "toy_lift", {"base": 2.0}),
        Step("high", "toy_keep", {"low": 13.0, "dimension": "Z"}),
        Step("outline", "toy_outline", {"margin": 0.25}),
        Step("mask", "toy_mask", cloud="lift", layers={"areas": "outline.footprints"}),
        Step("heights", "toy_heights"),
        Step("arrows", "toy_arrows", layers={"new": "outline.footprints"}),
    ),
    kept=("lift", "high"),
)
