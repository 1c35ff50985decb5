"""A monitor that records progress, and can stop the work."""

from __future__ import annotations

import math

from lidar_buildings.algorithms.stage import Cancelled, Monitor


class Listening(Monitor):
    """Keeps reported fractions in ``heard``, and cancels the work from the first one that reaches ``stop_at``."""

    def __init__(self, stop_at: float = math.inf) -> None:
        super().__init__()
        self.heard: list[float] = []
        self.stop_at = stop_at

    def progress(self, fraction: float) -> None:
        self.heard.append(fraction)
        if fraction >= self.stop_at:
            raise Cancelled
