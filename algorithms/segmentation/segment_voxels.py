"""Segments as connected components of voxels, after operations of mathematical morphology."""

from typing import Optional

import numpy as np

from ..criteria import CELL_SPACINGS
from ..geometry import sparse_voxels
from ..geometry.boxes import by_first_point
from ..geometry.groups import number_large, placed
from ..geometry.voxel_filters import FILTERS, filter_counts
from ..geometry.voxel_skeleton import skeleton
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import Field, Layer, LayerFeatures, stage, tunable

_OPERATIONS = {
    "erosion": sparse_voxels.erode,
    "dilation": sparse_voxels.dilate,
    "opening": sparse_voxels.open_voxels,
    "closing": sparse_voxels.close_voxels,
}


@stage(
    "Segmentation",
    tags="voxel,connected components,morphology,erosion,dilation,opening,closing,distance transform,skeleton,3D grid",
    writes=("segment_id",),
    layers=(
        Layer(
            "voxels",
            "Voxels",
            "Point",
            (
                Field("segment_id", int, "segment of the voxel; 0 if unassigned"),
                Field("count", int, "points in the voxel; 0 where the operation added it"),
                Field("filtered", float, "number of points after the filter; the count without one"),
                Field("distance", float, "distance from the voxel's center to the nearest empty voxel's", "m"),
            ),
        ),
    ),
)
def segment_voxels(
    xyz,
    classification,
    *,
    voxel_size: Optional[float] = tunable(
        None, within="[0.001, 1000] m", automatic=f"{CELL_SPACINGS:g} times the point spacing on surfaces."
    ),
    neighbors: str = tunable("26", choices=("6", "18", "26")),
    count_filter: str = tunable("none", label="Filter of counts", choices=("none", *FILTERS), advanced=True),
    operation: str = tunable("none", choices=("none", *_OPERATIONS)),
    element: str = tunable("26", label="Structuring element", choices=("6", "18", "26"), advanced=True),
    steps: int = tunable(1, within="[1, 100]", advanced=True),
    min_count: int = tunable(1, label="Minimum points of a voxel", within="[1, 1_000_000]"),
    min_points: int = tunable(1, within="[1, 1_000_000]"),
    thin: bool = tunable(False, label="Skeleton only"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Group points by the connected components of the voxels that they occupy.

    The cloud becomes a 3D grid of numbers of points, which may be filtered, then of occupied and empty voxels, to which
    erosion, dilation, opening or closing may be applied. Voxels that are connected make a segment. The layer has the
    voxels as points at their centers, with counts and distances to the background (distance transform), or their
    skeleton.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Segments from 1, in the order of their first points; 0 is noise, and points of voxels that were empty by count,
        removed by the operation, or of segments that are too small.
    voxels : LayerFeatures
        Centers of voxels, from west to east, then south to north, then upward. With *Skeleton only* the centers of the
        skeleton; distances are measured before thinning.

    Other Parameters
    ----------------
    voxel_size
        Side of a voxel. Points closer than about this belong together; larger voxels bridge wider gaps.
    neighbors
        Voxels that belong together: those that share a face (6), a face or an edge (18), or a face, an edge or a corner
        (26).
    count_filter
        Applied to the number of points of a voxel and its 26 neighbors before voxels with few points are left out. Mean
        and binomial are convolutions, which smooth; the others are rank orders: the minimum thins and the maximum
        widens, and the median removes single voxels.
    operation
        Applied before voxels are connected: erosion shrinks and dilation enlarges objects, opening removes thin parts,
        closing fills narrow gaps.
    element
        Neighbors that the operation reaches with each step: 6, 18 or 26.
    steps
        How many times the operation erodes or dilates.
    min_count
        Voxels with fewer points, after the filter, count as empty: more suppress scattered points.
    min_points
        Segments with fewer points get no id.
    thin
        Thin the voxels of the layer to lines in the middle of the objects; the segments of the points stay.

    Raises
    ------
    ValueError
        If the points are spread over more voxels than can be numbered, or all lie at one position and no size is given.

    Notes
    -----
    Only voxels that are occupied are held in memory, never the box around the cloud. The space around the cloud
    counts as empty, so that objects are not cut off at its border. Voxels start at the least coordinates of the
    points used. Thinning to the skeleton takes off simple points, whose removal changes no component, tunnel or cavity.
    Where voxels inside an object are empty by chance, apply a closing first.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 2.3. [vosselman2004]
    Gorte, B. G. H., Pfeifer, N., 2004. Structuring laser-scanned trees using 3D mathematical morphology. IAPRS 35 (B5),
    929-933. [gorte2004]
    Palágyi, K., Kuba, A., 1999. Directional 3D thinning using 8 subiterations. LNCS 1568, 325-336. [palagyi1999]

    Examples
    --------
    >>> xyz = np.array([[0.0, 0, 0], [1.2, 1.1, 0], [5.0, 0, 0]])
    >>> segment_voxels(xyz, np.ones(3, np.uint8), voxel_size=1.0)[0].tolist()
    [1, 1, 2]
    >>> segment_voxels(xyz, np.ones(3, np.uint8), voxel_size=1.0, neighbors="6")[0].tolist()
    [1, 2, 3]
    """
    used = not_noise(classification)
    if not len(used):
        nothing: dict[str, list] = {"segment_id": [], "count": [], "filtered": [], "distance": []}
        return np.zeros(len(xyz), np.int32), LayerFeatures([], nothing)
    if voxel_size is None:
        density = sampling.surface_density
        if not np.isfinite(density):
            raise ValueError("All points lie at one position, so they have no spacing; set the voxel size.")
        voxel_size = CELL_SPACINGS / float(np.sqrt(density))
    monitor.resolved(voxel_size=voxel_size)
    low = xyz[used].min(axis=0)
    occupied, voxel, count = sparse_voxels.voxelize(xyz[used] - low, voxel_size)
    monitor.progress(0.3)

    filled, value = occupied, count.astype(float)
    if count_filter != "none":
        filled, value = filter_counts(occupied, count, count_filter, monitor.part(0.3, 0.4))
    cells = filled[value >= min_count]
    if operation != "none":
        cells = _OPERATIONS[operation](cells, int(element), steps)
    monitor.progress(0.5)
    component = sparse_voxels.label_components(cells, int(neighbors))
    monitor.progress(0.7)

    where = sparse_voxels.locate_voxels(cells, occupied)
    of_point = np.where(where >= 0, component[where] if len(component) else -1, -1)[voxel]
    segment_id = placed(number_large(by_first_point(of_point), min_points), used, len(xyz))
    # Points of no component write to the last position, which no component has.
    of_component = placed(segment_id[used], of_point, len(component) + 1)

    columns = {
        "segment_id": of_component[component],
        "count": _in_voxels(count, where, len(cells)),
        "filtered": _in_voxels(value, sparse_voxels.locate_voxels(cells, filled), len(cells)),
        "distance": sparse_voxels.distance_to_background(cells) * voxel_size,
    }
    shown = skeleton(cells, monitor.part(0.8, 1)) if thin else np.ones(len(cells), bool)
    centers = (cells[shown] + 0.5) * voxel_size + low
    return segment_id, LayerFeatures(list(centers), {name: values[shown] for name, values in columns.items()})


def _in_voxels(values: np.ndarray, where: np.ndarray, n_voxels: int) -> np.ndarray:
    """Return the values (n_voxels,) of voxels, of those at the positions ``where`` (k,), -1 for none; else 0."""
    return placed(values[where >= 0], where[where >= 0], n_voxels)
