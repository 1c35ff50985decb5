"""Stages that are small enough to know their results by heart, one of every kind."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from lidar_buildings.algorithms.pipelines import Pipeline, Step
from lidar_buildings.algorithms.stage import Cancelled, Features, Field, Layer, Measure, Param, Report, stage


@stage("Toy lift", group="Toys", writes=("height_above_ground",), tags="toy, lift")
def toy_lift(
    xyz,
    classification,
    *,
    step: Annotated[float, Param("Step", "Added to all heights.", unit="m", low=0, high=10, open_low=True)] = 1.5,
    base: Annotated[
        Optional[float], Param("Base", "Taken off all heights.", unit="m", low=0, automatic="the lowest point.")
    ] = None,
    times: Annotated[int, Param("Times", "How often the step is added.", low=1, high=5, advanced=True)] = 2,
    sign: Annotated[str, Param("Sign", "Up or down.", choices=("up", "down"))] = "up",
    only: Annotated[tuple, Param("Only", "Classes that are lifted.", choices=("ground", "building"))] = (
        "ground",
        "building",
    ),
    flat: Annotated[bool, Param("Flat", "All heights alike.")] = False,
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
    if base is None:
        base = float(xyz[:, 2].min())
        monitor.resolved(base=base)
    chosen = np.isin(classification, [{"ground": 2, "building": 6}[word] for word in only])
    lifted = xyz[:, 2] - base + times * step * (1 if sign == "up" else -1) * chosen
    return np.full(len(xyz), step) if flat else lifted


@stage(
    "Toy outline",
    group="Toys",
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
    margin: Annotated[float, Param("Margin", "Around the points.", unit="m", low=0, high=9)] = 0.0,
    monitor=None,
):
    """Draw a box with a hole around all points."""
    low, high = xyz[:, :2].min(axis=0) - margin, xyz[:, :2].max(axis=0) + margin
    box = np.array([low, [high[0], low[1]], high, [low[0], high[1]], low])
    hole = (box[::-1] - box[:-1].mean(axis=0)) * 0.5 + box[:-1].mean(axis=0)
    height = np.float32(np.nan if height_above_ground is None else height_above_ground.mean())
    return Features([[box, hole]], {"id": np.array([7]), "height": [height], "kind": ["box"]})


@stage("Toy compare", group="Toys", measures=(Measure("difference", "Difference", "m"), Measure("points", "Points")))
def toy_compare(xyz, reference_xyz, *, monitor=None):
    """Compare mean heights."""
    difference = np.float64(xyz[:, 2].mean() - reference_xyz[:, 2].mean())
    return Report(
        {"difference": difference, "points": np.int64(len(xyz))}, f"<html><body>{difference:.3f}</body></html>"
    )


@stage(
    "Toy make",
    group="Toys",
    creates=("xyz", "classification"),
    layers=(Layer("truth", "Truth", "Point", (Field("id", int, "Id."),)),),
)
def toy_make(*, n_points: Annotated[int, Param("Points", "How many.", low=1, high=1000)] = 10, monitor=None):
    """Make a row of points."""
    xyz = np.column_stack([np.arange(n_points), np.zeros(n_points), np.full(n_points, 3.0)])
    return xyz, np.full(n_points, 2, np.uint8), Features([np.array([1.0, 2.0, 3.0])], {"id": [1]})


@stage("Toy trouble", group="Toys", writes=("height_above_ground",))
def toy_trouble(
    xyz,
    *,
    kind: Annotated[str, Param("Kind", "What goes wrong.", choices=("value", "bug", "cancel"))] = "value",
    monitor=None,
):
    """Fail in a chosen way."""
    if kind == "cancel":
        raise Cancelled
    raise {"value": ValueError("The field is empty; choose another."), "bug": ZeroDivisionError("a fault")}[kind]


TOYS = {function.stage.name: function.stage for function in (toy_lift, toy_outline, toy_compare, toy_make, toy_trouble)}

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

TOY_FAILURE = Pipeline(
    "toy_failure",
    "Toy failure",
    "Toys",
    "toy",
    "Fail after writing.",
    "",
    "",
    (Step("good", "toy_lift"), Step("bad", "toy_trouble_later")),
)
