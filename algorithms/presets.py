"""Kinds of clouds as users name them, and the parameters that are better set for them than measured."""

from dataclasses import dataclass, field
from typing import Any

from .pipeline import Pipeline

_LASER, _IMAGES = "laser scanner", "matched images"


@dataclass(frozen=True)
class Preset:
    """Values of parameters for a kind of cloud, by the names that composites give them; a composite takes its own."""

    name: str
    title: str
    values: dict[str, Any] = field(default_factory=dict)

    def of(self, pipeline: Pipeline) -> dict[str, Any]:
        """Return the values of those parameters that a composite has."""
        return {name: value for name, value in self.values.items() if name in pipeline.parameters}


# Values that are not named are measured in the cloud. The smallest building holds about 20 points: 10 m² at 2 points
# per m².
_PRESETS = (
    Preset("automatic", "Automatic: measured in the cloud"),
    Preset("airborne_dense", "Airborne laser, 4 points per m² and more", {"source": _LASER, "min_area": 4.0}),
    Preset("airborne_sparse", "Airborne laser, fewer points", {"source": _LASER, "min_area": 10.0}),
    Preset("drone_laser", "Drone, laser scanner", {"source": _LASER, "min_area": 4.0, "footprints_regularize": True}),
    Preset("drone_photogrammetry", "Drone, matched images", {"source": _IMAGES, "min_area": 4.0}),
    Preset("street", "Street, vehicle or tripod", {"source": _LASER, "planes_min_area": 2.0, "complete": True}),
)

PRESETS = {preset.name: preset for preset in _PRESETS}


def presets_of(pipeline: Pipeline) -> list[Preset]:
    """Return the presets that a composite can take, the automatic one first; none where no other sets anything."""
    found = [preset for preset in PRESETS.values() if not preset.values or preset.of(pipeline)]
    return found if len(found) > 1 else []
