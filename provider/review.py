"""Decisions of a reviewer on the buildings of a layer: they are attributes of it, and each can be undone."""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from typing import Any, Callable, Optional

from qgis.core import (
    NULL,
    Qgis,
    QgsExpression,
    QgsFeature,
    QgsFeatureRequest,
    QgsField,
    QgsGeometry,
    QgsProject,
    QgsProperty,
    QgsRenderContext,
    QgsSpatialIndex,
    QgsSymbol,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QMetaType

from ..algorithms.buildings.reviewed_buildings import CHANGED, DELETED, REVIEW, REVIEWED_AT
from ..algorithms.criteria import MAJORITY
from .qgis_crs import meters_per_unit

# Whether a building is marked as deleted.
IS_DELETED = f"\"{REVIEW}\" = '{DELETED}'"

# Attribute by whose values the buildings are ordered.
CONFIDENCE = "confidence"

# Attributes that add up over the parts of a building.
_SUMS = ("volume", "points")

# Characters of the name of an attribute in a Shapefile.
_SHORT = 10

# Opacity (%) of buildings that are marked as deleted: seen, and not mistaken for others.
_FAINT = 15


# Share of the area of a building by which rounding makes outlines that meet overlap, and two that are one differ.
_ROUNDED = 0.001


def changes_between(before: QgsVectorLayer, after: QgsVectorLayer) -> dict[str, int]:
    """Return the numbers of buildings that are as in another layer, drawn anew, new and gone."""
    in_plane = QgsFeatureRequest().setDestinationCrs(after.crs(), QgsProject.instance().transformContext())
    old = {one.id(): one.geometry() for one in before.getFeatures(in_plane)}
    index, matched = QgsSpatialIndex(before.getFeatures(in_plane)), set()
    found: Counter[str] = Counter()
    for outline in (one.geometry() for one in after.getFeatures()):
        both = {fid: outline.intersection(old[fid]).area() for fid in index.intersects(outline.boundingBox())}
        fid, shared = max(both.items(), key=lambda one: one[1], default=(None, 0.0))
        areas = (outline.area(), old[fid].area()) if shared else (1.0, 1.0)
        # Drawn anew where the majority of the smaller one is the same.
        is_same = shared > MAJORITY * min(areas)
        found["kept" if shared > (1 - _ROUNDED) * (sum(areas) - shared) else "redrawn" if is_same else "new"] += 1
        matched.update([fid] if is_same else [])
    return {**{name: found[name] for name in ("kept", "redrawn", "new")}, "gone": len(old) - len(matched)}


def is_reviewable(layer: Any) -> bool:
    """Whether a layer has polygons with a confidence."""
    is_polygons = isinstance(layer, QgsVectorLayer) and layer.geometryType() == Qgis.GeometryType.Polygon
    return is_polygons and layer.fields().lookupField(CONFIDENCE) >= 0


class Review:
    """The review of one layer: every outline that changes is recorded as long as it lasts, by tools of QGIS too.

    ``changed`` is called when a value of a building (by its id) is another one, or with None when the buildings are.
    """

    def __init__(self, layer: QgsVectorLayer, changed: Callable[[Optional[int]], None]) -> None:
        self.layer = layer
        self._heard = [
            (layer.geometryChanged, lambda fid, _: self._outline_changed(fid)),
            (layer.featureAdded, self._building_added),
            (layer.attributeValueChanged, lambda fid, *_: changed(fid)),
            (layer.styleManager().currentStyleChanged, self.fade_deleted),
        ]
        for signal in (layer.featureAdded, layer.featureDeleted, layer.afterCommitChanges, layer.afterRollBack):
            self._heard.append((signal, lambda *_: changed(None)))
        for signal, slot in self._heard:
            signal.connect(slot)
        self.fade_deleted()

    def end(self) -> None:
        """Stop to record, and save."""
        for signal, slot in self._heard:
            signal.disconnect(slot)
        self.save()

    def buildings(self, which: str = "TRUE") -> list[QgsFeature]:
        """Return the buildings of an expression without their outlines, the least sure first."""
        request = QgsFeatureRequest(QgsExpression(which)).setFlags(Qgis.FeatureRequestFlag.NoGeometry)
        return list(self.layer.getFeatures(request.addOrderBy(CONFIDENCE)))

    def value(self, building: QgsFeature, name: str) -> Any:
        """Return an attribute of a building, None if it has no value or the layer has no such attribute."""
        # Not by the fields of the feature: QGIS leaves out there what was added in this edit.
        at = self._index(name)
        return None if at < 0 or building[at] == NULL else building[at]

    def has(self, name: str) -> bool:
        """Whether the layer has an attribute."""
        return self._index(name) >= 0

    def _index(self, name: str) -> int:
        """Return the index of an attribute, -1 if there is none; Shapefiles cut its name."""
        fields = self.layer.fields()
        return max(fields.lookupField(name), fields.lookupField(name[:_SHORT]))

    def decide(self, fid: int, decision: str) -> None:
        """Record a decision on a building."""
        with self._command("Review of a building"):
            self._mark(fid, decision)
        self.fade_deleted()

    def merge(self, fid: int) -> int:
        """Merge a building with the selected ones, or with the only one that touches it; return the one that remains.

        That is the largest: its heights and its reason hold.

        Raises
        ------
        ValueError
            If there is nothing or more than one to choose from, or they don't touch.
        """
        parts = [self.layer.getFeature(one) for one in (fid, *self._partners(fid))]
        outline = QgsGeometry.unaryUnion([part.geometry() for part in parts])
        if outline.constGet().partCount() != 1:
            raise ValueError("These buildings don't touch; only neighbors that do become one.")
        largest = max(parts, key=lambda part: part.geometry().area()).id()
        with self._command("Merge buildings"):
            self.layer.changeGeometry(largest, outline.coerceToType(self.layer.wkbType())[0])
            for name in _SUMS:
                self._set(largest, name, sum(self.value(part, name) or 0 for part in parts))
            self.layer.deleteFeatures([part.id() for part in parts if part.id() != largest])
            self.layer.removeSelection()
        return largest

    def _partners(self, fid: int) -> list[int]:
        """Return the buildings to merge with one."""
        chosen = [one for one in self.layer.selectedFeatureIds() if one != fid]
        if chosen:
            return chosen
        outline = self.layer.getGeometry(fid)
        near = self.layer.getFeatures(QgsFeatureRequest().setFilterRect(outline.boundingBox()))
        touching = [one.id() for one in near if one.id() != fid and one.geometry().intersects(outline)]
        if len(touching) != 1:
            raise ValueError(f"{len(touching)} buildings touch this one; select those to merge it with.")
        return touching

    def overlapped(self, fid: int) -> list[QgsFeature]:
        """Return the buildings that the outline of another one overlaps, without those that are marked as deleted."""
        outline = self.layer.getGeometry(fid)
        near = self.layer.getFeatures(QgsFeatureRequest().setFilterRect(outline.boundingBox()))
        others = [one for one in near if one.id() != fid and self.value(one, REVIEW) != DELETED]
        return [one for one in others if one.geometry().intersection(outline).area() > _ROUNDED * outline.area()]

    def prepare_division(self, fid: int) -> None:
        """Have QGIS's tool split this building alone, and share its volume and points by area."""
        self._edit()
        for name in _SUMS:
            at = self._index(name)
            if at >= 0:
                self.layer.setFieldSplitPolicy(at, Qgis.FieldDomainSplitPolicy.GeometryRatio)
        self.layer.selectByIds([fid])

    def remove_deleted(self) -> None:
        """Take the buildings that are marked as deleted out of the layer."""
        with self._command("Remove deleted buildings"):
            self.layer.deleteFeatures([one.id() for one in self.buildings(IS_DELETED)])

    def save(self) -> None:
        """Write the decisions into the layer, which is edited on.

        Raises
        ------
        ValueError
            If that fails.
        """
        if self.layer.isEditable() and not self.layer.commitChanges(False):
            raise ValueError(" ".join(self.layer.commitErrors()))

    def fade_deleted(self, *_: Any) -> None:
        """Draw buildings marked as deleted faintly, whatever the style."""
        faint = QgsProperty.fromExpression(f"if({IS_DELETED}, {_FAINT}, 100)")
        for symbol in self.layer.renderer().symbols(QgsRenderContext()):
            symbol.setDataDefinedProperty(QgsSymbol.Property.Opacity, faint)
        self.layer.triggerRepaint()

    def _edit(self) -> None:
        """Begin to edit, or say that it can't be."""
        if not (self.layer.isEditable() or self.layer.startEditing()):
            raise ValueError(f"{self.layer.name()} can't be edited; export it to a GeoPackage and review that.")

    @contextmanager
    def _command(self, text: str) -> Iterator[None]:
        """Make all edits within it one step to undo."""
        self._edit()
        self.layer.beginEditCommand(text)
        try:
            yield
        finally:
            self.layer.endEditCommand()

    def _building_added(self, fid: int) -> None:
        """Give a building that was drawn or split off a number of its own."""
        self._outline_changed(fid, id=int(self.layer.maximumValue(self._index("id")) or 0) + 1)

    def _outline_changed(self, fid: int, **more: Any) -> None:
        """Record that an outline was changed, and its measures; do nothing if that is undone or redone."""
        # While a command is open nothing can be undone; where it is undone, it can.
        if self.layer.isEditCommandActive() and not self.layer.undoStack().canUndo():
            outline, unit = self.layer.getGeometry(fid), meters_per_unit(self.layer.crs())[0]
            self._mark(fid, CHANGED, area=outline.area() * unit**2, perimeter=outline.length() * unit, **more)

    def _mark(self, fid: int, decision: str, **more: Any) -> None:
        """Record a decision and its time, and other values."""
        self._add_fields()
        now = datetime.now().astimezone().isoformat(timespec="seconds")
        for name, value in {REVIEW: decision, REVIEWED_AT: now, **more}.items():
            self._set(fid, name, value)

    def _add_fields(self) -> None:
        text, kinds = QMetaType.Type.QString, self.layer.dataProvider().nativeTypes()
        # PostGIS makes no column without its own name of the type, and the first one is of a single letter.
        found = {one.mTypeName: one for one in reversed(kinds) if one.mType == text}
        kind = found.get("text") or list(found.values())[-1]
        for name in (REVIEW, REVIEWED_AT):
            if self._index(name) < 0:
                self.layer.addAttribute(QgsField(name, text, kind.mTypeName, kind.mMinLen))

    def _set(self, fid: int, name: str, value: Any) -> None:
        """Set an attribute, if the layer has it."""
        at = self._index(name)
        if at >= 0:
            self.layer.changeAttributeValue(fid, at, value)
