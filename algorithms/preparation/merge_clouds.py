"""Merge several clouds in one frame."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np

from ..criteria import MILLIMETER
from ..stage import Monitor, stage, tunable

# Largest deviation of a matrix times its transpose from the identity: a rotation with four decimals has it. The
# nearest rotation is taken.
_RIGID = 2e-4

# Clouds whose boxes are farther apart than this (m) are likely not of one site, or one is misplaced.
_APART = 1.0

# A file of numbers is never longer (characters).
_LONGEST_FILE = 10_000


@dataclass(frozen=True)
class Transform:
    """A rotation and an offset: x becomes ``rotation @ x + offset``."""

    rotation: np.ndarray  #: (3, 3): a rotation, exact to rounding
    offset: np.ndarray  #: (3,): in meters
    given: np.ndarray  #: (3, 3): the rotation as the user wrote it

    def __call__(self, xyz: np.ndarray) -> np.ndarray:
        """Return points (n, 3) (m) where the transform puts them."""
        return xyz @ self.rotation.T + self.offset

    @property
    def angle(self) -> float:
        """How far it turns (°), about whichever axis."""
        return float(np.rad2deg(np.arccos(np.clip((np.trace(self.rotation) - 1) / 2, -1.0, 1.0))))


@stage(
    "Preparation",
    title="Merge point clouds",
    tags="las,laz,copc,pdal,combine,append,join,union,tiles,scans,register,lasmerge,"
    "relative orientation,transform,rotate,shift,matrix,4x4",
    writes=("xyz", "point_source_id", "previous_source_id"),
    written_if={"previous_source_id": "where PointSourceId was not 0 everywhere"},
    merges=True,
    cost=0.2,
    packages=(),
)
def merge_clouds(xyz, point_source_id, *, transforms: str = tunable(""), monitor=None):
    """Make one cloud of several, each but the first turned and moved if need be; PointSourceId identifies them.

    The clouds may differ in scale, offset, point format and extra dimensions. The result has the finest scale, the
    smallest point format that holds the colors, times and waveform references of all, and all extra dimensions. What a
    cloud lacks is NaN, or 0 in whole numbers, colors and times. It has the coordinate reference system that the clouds
    have; different ones are refused, and a cloud without any is taken to be in the system of the others.

    Parameters
    ----------
    xyz : list of ndarray of shape (n, 3)
        Coordinates (m) of each cloud.
    point_source_id : list of ndarray of shape (n,)
        Flight lines or scanners, as they are in each cloud.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64, or None
        Coordinates (m) of all clouds, one after the other; None if nothing was moved.
    point_source_id : ndarray of shape (n,), uint16
        The number of the cloud: 1 for the first, 2 for the second.
    previous_source_id : ndarray of shape (n,), uint16, or None
        What ``point_source_id`` was before; None if it was 0 everywhere.

    Other Parameters
    ----------------
    transforms
        Positions of the clouds after the first, in their order and separated by semicolons; empty for a cloud that
        stays. Six numbers: rotations about the axes to the east, to the north and up (°, in this order,
        counterclockwise), then offsets to the east, to the north and up (m). Or the 16 numbers of a 4x4 matrix, row by
        row. Or the path of a text file with either. '0 0 90 5 0 0; ; matrix.txt' turns and moves the second cloud,
        leaves the third and moves the fourth as the file says.

    Raises
    ------
    ValueError
        If a transform is not understood or not rigid, or there are more of them than clouds after the first.

    Notes
    -----
    A point x goes to R x + t, with the rotation R about the zero of the coordinates: the three angles are three
    rotations about fixed axes, one after the other, R = Rz Ry Rx. A matrix must be rigid, that is turn and move only.
    Its upper left part times its own transpose may differ from the identity by ``_RIGID``, as with four decimals; the
    nearest rotation is taken. A warning is given if that moves points by more than a millimeter. With coordinates of
    millions of meters, give nine decimals or more.

    Clouds that lie apart are merged all the same; a warning names a cloud whose bounding box is more than ``_APART`` m
    away from all others. Ids of segments and clusters stay as they are, so that two clouds may have the same ones. The
    order of points is kept; withheld points are left out.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented
    line scanners, section 5. [weinmann2017]

    Examples
    --------
    >>> import numpy as np
    >>> from lidar_buildings.algorithms.preparation.merge_clouds import merge_clouds
    >>> clouds, sources = [np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0]])], [np.zeros(1), np.zeros(1)]
    >>> xyz, number, _ = merge_clouds(clouds, sources, transforms="0 0 90 10 0 0")
    >>> xyz.round(6).tolist(), number.tolist()
    ([[0.0, 0.0, 0.0], [10.0, 1.0, 0.0]], [1, 2])
    """
    wanted = read_transforms(transforms, len(xyz))
    moved = []
    for i, (part, transform) in enumerate(zip(xyz, wanted)):
        moved.append(part if transform is None else _moved(i + 1, part, transform, monitor))
        monitor.progress((i + 1) / len(xyz))
    _warn_of_gaps(moved, monitor)
    number = np.repeat(np.arange(1, len(xyz) + 1), [len(part) for part in xyz])
    previous = np.concatenate(point_source_id)
    whole = np.concatenate(moved) if any(wanted) else None
    return whole, number.astype(np.uint16), previous.astype(np.uint16) if previous.any() else None


def read_transforms(text: str, n_clouds: int) -> list[Optional[Transform]]:
    """Return the transform of each cloud in the text, None for one that stays, as the first does.

    Raises
    ------
    ValueError
        If it names a cloud that is not given, or a transform that is not rigid.
    """
    parts = [part.strip() for part in text.split(";")] if text.strip() else []
    while parts and not parts[-1]:
        parts.pop()
    if len(parts) > n_clouds - 1:
        raise ValueError(
            f"There are {len(parts)} transforms for {n_clouds} clouds, of which the first stays; "
            f"give at most {n_clouds - 1}, separated by semicolons."
        )
    found = [_transform(f"The transform of cloud {i}", part) for i, part in enumerate(parts, start=2)]
    return [None, *found, *[None] * (n_clouds - 1 - len(parts))]


def _transform(name: str, text: str) -> Optional[Transform]:
    """Return the movement that six numbers, the 16 of a matrix or a file of these describe; None for no text."""
    if not text:
        return None
    numbers = _numbers(text)
    if numbers is None:
        name = f"{name} ({Path(text).name})"
        numbers = _numbers(_content(name, text))
    if numbers is None or len(numbers) not in (6, 16):
        what = "something else" if numbers is None else f"{len(numbers)} numbers"
        raise ValueError(
            f"{name} must be six numbers (three angles, three offsets) or the 16 of a 4x4 matrix, got {what}."
        )
    if not np.isfinite(numbers).all():
        raise ValueError(f"{name} has a number that is not finite; correct it.")
    if len(numbers) == 6:
        rotation = _from_angles(np.deg2rad(numbers[:3]))
        return Transform(rotation, numbers[3:], rotation)
    matrix = numbers.reshape(4, 4)
    return Transform(_nearest_rotation(name, matrix), matrix[:3, 3], matrix[:3, :3])


def _numbers(text: str) -> Optional[np.ndarray]:
    """Return the numbers of a text, float64, None if there is anything else in it."""
    words = re.sub(r"[\s,;\[\]()]+", " ", re.sub("#.*", "", text)).split()
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        return None


def _content(name: str, path: str) -> str:
    try:
        with Path(path.strip("\"'")).open(encoding="utf-8-sig") as stream:
            return stream.read(_LONGEST_FILE)
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or "it is not text"
        raise ValueError(f"{name} is neither numbers nor a text file that can be read ({why}); correct it.") from None


def _from_angles(angles: np.ndarray) -> np.ndarray:
    """Return the rotation about x, then y, then z by angles (rad)."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def _nearest_rotation(name: str, matrix: np.ndarray) -> np.ndarray:
    """Return the rotation (3, 3) nearest to the upper left of ``matrix`` (4, 4); raise if it is not rigid."""
    if np.abs(matrix[3] - [0, 0, 0, 1]).max() > _RIGID:
        last = " ".join(f"{value:g}" for value in matrix[3])
        raise ValueError(f"{name} must have 0 0 0 1 in its last row, got {last}; is it transposed?")
    linear = matrix[:3, :3]
    off = np.abs(linear @ linear.T - np.eye(3)).max()
    if off > _RIGID:
        raise ValueError(
            f"{name} is not rigid: it scales or shears, its rotation times the transpose is off the identity by "
            f"{off:.2g}; give a rotation and an offset only."
        )
    if np.linalg.det(linear) < 0:
        raise ValueError(f"{name} is not rigid: it mirrors the cloud; give a rotation and an offset only.")
    left, _, right = np.linalg.svd(linear)
    return left @ right


def _moved(number: int, xyz: np.ndarray, transform: Transform, monitor: Monitor) -> np.ndarray:
    """Return a cloud (n, 3) in its new position, and log the length of its motion."""
    moved = transform(xyz)
    middle = (xyz.min(axis=0) + xyz.max(axis=0)) / 2
    shift = float(np.linalg.norm(transform(middle) - middle))
    monitor.resolved(
        **{
            f"rotation_of_cloud_{number}_in_degrees": transform.angle,
            f"shift_of_the_middle_of_cloud_{number}_in_meters": shift,
        }
    )
    farthest = np.abs(xyz).max(axis=0)
    off = float(np.linalg.norm(np.abs(transform.rotation - transform.given) @ farthest))
    if off > MILLIMETER:
        monitor.warn(
            f"The matrix of cloud {number} has too few decimals for its coordinates: the nearest rotation puts points "
            f"up to {off:.3g} m elsewhere."
        )
    return moved


def _warn_of_gaps(clouds: list[np.ndarray], monitor: Monitor) -> None:
    """Warn of clouds that lie apart from all others."""
    low = np.array([part.min(axis=0) for part in clouds])
    high = np.array([part.max(axis=0) for part in clouds])
    gap = np.linalg.norm(np.maximum(np.maximum(low[:, None] - high, low - high[:, None]), 0.0), axis=2)
    np.fill_diagonal(gap, np.inf)
    nearest = gap.min(axis=1)
    # A single cloud has no other.
    apart = np.flatnonzero((nearest > _APART) & np.isfinite(nearest))
    if len(apart):
        monitor.warn(
            f"Some clouds lie apart, {nearest[apart].min():,.0f} m or more from the nearest other (cloud "
            f"{', '.join(str(i + 1) for i in apart)}); if they are of one site, check the transforms."
        )
