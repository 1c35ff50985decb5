"""The points of a survey that its pages show: the topmost ones for a hillshade, and all around single buildings."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..cloud.asprs import NOISE
from ..cloud.cloud import Cloud
from ..geometry.grid import fixed_grid_over
from ..geometry.groups import topmost
from .array_files import write_arrays


@dataclass(frozen=True)
class View:
    """What pages show of a survey, and the folder in which tiles leave it.

    ``cell`` is the side (m) of the cells of which the topmost point is shown. ``boxes`` (k, 2, 2), m, are lower and
    upper corners in plan: all points in them are shown. Cells and boxes are measured from ``origin`` (3,), m.
    """

    folder: Path
    origin: np.ndarray
    cell: float
    boxes: np.ndarray

    def add(self, name: str, cloud: Cloud) -> None:
        """Keep what is shown of the points of a tile."""
        classes = cloud.get("classification")
        rows = np.flatnonzero(~np.isin(classes, NOISE) & ~cloud.withheld)
        xyz = cloud.get("xyz")[rows] + (cloud.origin - self.origin)
        shown = np.zeros(len(xyz), bool)
        if len(xyz):
            shown[topmost(xyz[:, 2], fixed_grid_over(xyz, self.cell).number(xyz))] = True
        for low, high in self.boxes:
            shown |= ((xyz[:, :2] >= low) & (xyz[:, :2] <= high)).all(axis=1)
        points = {"xyz": xyz[shown], "classification": classes[rows[shown]]}
        write_arrays(self.folder / f"view-{name}.npz", points)

    def points(self, tiles: Iterable[Path]) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates (n, 3), m from the origin, and classes (n,) of what tiles have left."""
        xyz, classes = [np.zeros((0, 3))], [np.zeros(0, np.uint8)]
        for tile in tiles:
            with np.load(self.folder / f"view-{tile.name}.npz", allow_pickle=False) as stored:
                xyz.append(stored["xyz"])
                classes.append(stored["classification"])
        return np.concatenate(xyz), np.concatenate(classes)
