"""Whether a cloud can show buildings at all: dense enough, wide enough, with ground around them."""

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.grid import Grid, distinct, grid_over
from ..rules import rule, rules
from .cloud_sampling import CloudSampling, without_noise
from .density import DENSITY


@rules
class SUFFICIENCY:
    """What a cloud has that shows buildings."""

    density: float = rule(0.5, "points/m²", "measured on three towns: mean F 95 at 4, 92 at 1, 88 at 0.5, 83 at 0.35")
    area: float = rule(900.0, "m²", "measured on squares of three towns: F 87 at 20 m, 93 at 30 m, 95 at 100 m")
    ground: float = rule(0.1, "share", "of cells with ground; dense forest has 0.25, the densest town 0.45")
    void: float = rule(0.3, "share", "of empty cells by occupied ones: up to 0.14 in surveys, 0.14 to 0.53 in roofs")
    doubt: float = rule(0.3, "share", "of a confidence above 0.5 that is left: no building is sure")


def why_doubtful(xyz: np.ndarray, classification: np.ndarray, sampling: CloudSampling) -> str:
    """Return a warning where a cloud can hardly show buildings, "" where it can.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes, with ground.
    sampling : CloudSampling
        How the cloud was sampled. Of a part of a survey, only the density is judged.
    """
    faults = []
    if sampling.effective_density < SUFFICIENCY.density:
        faults.append(
            f"it has {sampling.effective_density:.2g} points per m² where it is thin, and {SUFFICIENCY.density:g} are "
            "needed"
        )
    if sampling.lacks_points_of_images:
        needed = f"{sampling.density_of_images:g} points per m²"
        faults.append(f"it looks matched from images, and has {sampling.density:.2g} instead of {needed}")
    if not sampling.of_whole:
        faults += _faults_of_whole(xyz, classification, sampling.density)
    if not faults:
        return ""
    return f"The cloud can hardly show buildings, so that all of them are doubtful: {'; '.join(faults)}."


def doubted(confidence: np.ndarray) -> np.ndarray:
    """Return confidences (n,) of buildings in a cloud that can hardly show any: decisions stay, none is sure."""
    return np.where(confidence > 0.5, 0.5 + (confidence - 0.5) * SUFFICIENCY.doubt, confidence)


def _faults_of_whole(xyz: np.ndarray, classification: np.ndarray, density: float) -> list[str]:
    """Return the fault of the extent of a whole cloud."""
    counted = without_noise(classification)
    # Cells twice as wide as the density's: few are empty where the cloud has no gaps.
    grid = grid_over(xyz[counted], 2 * float(np.sqrt(DENSITY.points_per_cell / density)))
    cell = grid.number(xyz[counted])
    occupied = distinct(cell)[0]
    ground = distinct(cell[np.isin(classification[counted], (PointClass.GROUND, PointClass.WATER))])[0]
    faults = []
    if counted.sum() / density < SUFFICIENCY.area:
        faults.append(f"it covers less than {SUFFICIENCY.area:g} m², a few buildings")
    if _n_next_to(grid, occupied) > SUFFICIENCY.void * len(occupied):
        faults.append("its points lie in islands with nothing around")
    # Without any ground, the cloud is not classified.
    if 0 < len(ground) < SUFFICIENCY.ground * len(occupied):
        faults.append("hardly any ground is seen in it")
    return faults


def _n_next_to(grid: Grid, occupied: np.ndarray) -> int:
    """Return the number of empty cells of a grid that touch occupied ones, without those beyond the box of all."""
    touching = np.unique(np.concatenate([occupied + step for step in grid.around]))
    row, column = np.divmod(touching, grid.columns)
    is_inside = (row > 0) & (row < grid.rows - 1) & (column > 0) & (column < grid.columns - 1)
    return len(np.setdiff1d(touching[is_inside], occupied, assume_unique=True))
