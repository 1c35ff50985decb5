"""A scene of objects with known truth, to be scanned."""

from dataclasses import dataclass, field, fields
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.groups import mask_of
from ..stage import Field, LayerFeatures
from .bodies import Body, Rect, flat, rectangles
from .pairs import in_boxes
from .relief import CHANNEL, Relief


@dataclass(frozen=True)
class Building:
    """A building: kind, outline and solids."""

    object_id: int  #: ``segment_id`` of its points
    kind: str  #: Shape of its roof or plan, such as "gable" or "L", or its use, such as "hall"
    outline: np.ndarray  #: (m, 2): closed ring of the walls, counterclockwise (m)
    solids: tuple[Body, ...]  #: Wings, dormers, chimneys; the roof is the highest surface of all

    def roof(self, x, y) -> np.ndarray:
        """Return the elevation of the roof (m), NaN outside the building."""
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        height = np.full(x.shape, -np.inf)
        for solid in self.solids:
            height = np.where(solid.rect.contains(x, y), np.maximum(height, solid.top(x, y)), height)
        return np.where(np.isfinite(height), height, np.nan)

    def contains(self, x, y) -> np.ndarray:
        """Return the mask of points (m) on the building in plan."""
        return ~np.isnan(self.roof(x, y))

    @property
    def area(self) -> float:
        """Area of the outline (m²)."""
        x, y = self.outline.T
        return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2


@dataclass
class Scene:
    """All objects that a scanner can see, with their truth."""

    relief: Relief  #: Ground and water
    #: Buildings; their object ids are unique among all objects
    buildings: list[Building] = field(default_factory=list)
    solids: list[Body] = field(default_factory=list)  #: All solids, of buildings as well
    #: Ellipsoids of leaves that beams penetrate. Each has x, y, z of its center, horizontal and vertical radius (m),
    #: mean path of a beam to the next leaf (m) and object id
    crowns: list[tuple] = field(default_factory=list)
    wires: list[tuple] = field(default_factory=list)  #: Straight pieces: start and end (x, y, z each, m) and object id
    objects: int = 0  #: Number of objects, the greatest object id

    @property
    def size(self) -> float:
        """Side of the square (m)."""
        return self.relief.size

    def new_id(self) -> int:
        """Return the id of a new object."""
        self.objects += 1
        return self.objects

    def add_box(self, rect: Rect, bottom: float, top: float, classification: int, number: Optional[int] = None) -> None:
        """Add a box between two elevations (m), with object id ``number`` or a new one."""
        number = self.new_id() if number is None else number
        self.solids.append(Body(rect, flat(rect, top), bottom, classification, number))

    def add_post(self, rect: Rect, height: float, depth: float = 1.0) -> None:
        """Add an unclassified box from ``depth`` below to ``height`` above the ground at its center (m)."""
        ground = float(self.relief.ground(rect.x, rect.y))
        self.add_box(rect, ground - depth, ground + height, PointClass.UNCLASSIFIED)

    def add_building(self, kind: str, outline: np.ndarray, solids: list[Body]) -> None:
        """Add a building of ``solids``, the first of which has its id; ``outline`` (m, 2) is open."""
        ring = np.concatenate([outline, outline[:1]])
        self.buildings.append(Building(solids[0].object_id, kind, ring, tuple(solids)))
        self.solids.extend(solids)

    def near_building(self, positions: np.ndarray, margin: float) -> np.ndarray:
        """Return the mask of points (n, 2), m, within a margin (m) of a building."""
        parts = rectangles([solid for building in self.buildings for solid in building.solids])
        reach = np.hypot(parts.length, parts.width) / 2 + margin
        center = np.column_stack([parts.x, parts.y])
        position, part = in_boxes(positions, center - reach[:, None], center + reach[:, None])
        rows = Rect(*(getattr(parts, field.name)[part] for field in fields(Rect)))
        return mask_of(len(positions), position[rows.contains(positions[position, 0], positions[position, 1], margin)])

    def near_water(self, x, y) -> np.ndarray:
        """Return the mask of points (m) in the channel of the river, including its banks."""
        if self.relief.river is None:
            return np.zeros(np.shape(x), bool)
        return np.abs(self.relief.frame.local(x, y)[0] - self.relief.river) < CHANNEL


def footprint_fields(kinds: str) -> tuple[Field, ...]:
    """Return the fields of :func:`footprint_layer`, for buildings of some ``kinds``."""
    return (
        Field("id", int, "object id of the building, as SegmentID of its points"),
        Field("kind", str, kinds),
        Field("area", float, "area inside the walls", "m²"),
        Field("corners", int, "number of corners"),
    )


def footprint_layer(buildings: list[Building], fields: tuple[Field, ...]) -> LayerFeatures:
    """Return the outlines of the walls, with some of the :func:`footprint_fields`."""
    rows = [(one.object_id, one.kind, one.area, len(one.outline) - 1) for one in buildings]
    columns = {field.name: [row[i] for row in rows] for i, field in enumerate(fields)}
    return LayerFeatures([[one.outline] for one in buildings], columns)
