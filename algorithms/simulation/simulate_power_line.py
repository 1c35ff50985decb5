"""Airborne scans of power lines with known truth."""

import numpy as np

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Monitor, stage, tunable
from .bodies import Body, Rect, gable
from .plants import FOREST, plant_trees
from .relief import Relief
from .scanner import PULSE_DENSITY, RANGE_NOISE, RECORDED, AirSurvey, refuse_large, scan
from .scene import Scene

# Height of a tower (m).
_TOWER = 30.0

# Heights of the three pairs of arms of a tower (m).
_ARMS = (29.0, 25.0, 21.0)

# Length of an arm (m).
_ARM = 5.0

# Height of poles (m).
_POLE = 9.0

# Wires of poles: distance across the line, and below the top of the poles (m). Three phases on a cross-arm, a vertical
# rack of four wires, and a telephone cable.
_WIRES = ((-0.8, 0.2), (0.0, 0.2), (0.8, 0.2), (0.2, 1.4), (0.2, 1.7), (0.2, 2.0), (0.2, 2.3), (-0.2, 3.2))


@stage(
    "Simulation",
    tags="synthetic,power line,wire,conductor,catenary,tower,pylon,pole,airborne,demo,example,test,truth,teaching",
    creates=RECORDED,
)
def simulate_power_line(
    *,
    size: float = tunable(200.0, within="[80, 1000] m"),
    density: float = PULSE_DENSITY,
    span: float = tunable(120.0, within="[50, 500] m"),
    angle: float = tunable(15.0, within="[0, 90]°"),
    trees: float = tunable(20.0, within="[0, 200] per ha"),
    forest: float = FOREST.with_default(0.15),
    range_noise: float = RANGE_NOISE,
    seed: int = SEED,
    monitor=None,
):
    """Simulate an airborne scan of power lines, with the true class of every point.

    A transmission line on towers of 30 m has six bundles of two conductors and a guard wire. A line on poles of 9 m has
    three wires on a cross-arm, four in a rack below it, a telephone cable, and a wire to a house at every second pole.
    Trees and a forest grow below both.

    Returns
    -------
    xyz, return_number, number_of_returns, intensity, scan_angle, point_source_id, gps_time : ndarray of shape (n, ...)
        As for :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        True class: 2 ground; 3, 4, 5 vegetation; 6 houses; 14 wires; 15 towers and poles.
    segment_id : ndarray of shape (n,), int32
        Number of the wire, mast, house or tree; 0 for ground.

    Other Parameters
    ----------------
    size
        Side of the site, a square from (0, 0).
    span
        Distance between the towers of the transmission line.
    angle
        Direction of both lines, counterclockwise from east.
    trees
        Trees outside the forest.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses.

    Notes
    -----
    Wires are parabolas with a sag of 3 % of the span, 0.8 m for low voltage. A pulse whose axis passes a wire within
    0.1 m gives a return from it with a probability of 70 %, and usually continues. The scan is as in 'Simulate town'.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_power_line import simulate_power_line
    >>> classification = simulate_power_line(size=100.0, density=1.0)[1]
    >>> bool((classification == 14).any() and (classification == 15).any())
    True
    """
    refuse_large("The site", size, density, "lower the density or the size")
    scene = build_line_site(size, span, angle, trees, forest, seed)
    made = scan(scene, AirSurvey(density, range_noise=range_noise, noise_points=0.0, seed=seed), monitor)
    return tuple(made[name] for name in RECORDED)


def build_line_site(size: float, span: float, angle: float, trees: float, forest: float, seed: int) -> Scene:
    """Return a square site with a high-voltage line, a low-voltage line with houses, and trees.

    Parameters
    ----------
    size, span : float
        Side of the square, and distance between towers, m.
    angle : float
        Direction of the lines from east, °.
    trees, forest : float
        Trees per hectare, and share of the site that is forest.
    seed : int
        The same seed gives the same site.
    """
    rng = np.random.default_rng([seed, 7])
    scene = Scene(Relief(size, gradient=0.04, angle=np.deg2rad(90.0)))
    direction = np.deg2rad(angle)
    _low_voltage(scene, direction, rng)
    _high_voltage(scene, direction, span)
    plant_trees(scene, trees, forest, rng, Monitor())
    return scene


def _line(scene: Scene, direction: float, aside: float, distance: float) -> np.ndarray:
    """Return the feet (n, 3) of the masts of a line at a distance ``aside`` (m) from the middle of the site."""
    along = np.arange(-scene.size, scene.size, distance)
    x, y = Rect(scene.size / 2, scene.size / 2, 0.0, 0.0, direction).at(along, aside)
    return np.column_stack([x, y, scene.relief.ground(x, y)])


def _inside(scene: Scene, xy: np.ndarray) -> np.ndarray:
    """Return the mask of positions (n, 2 or 3) on the site, at least 1 m from its edge."""
    return ((xy[:, :2] > 1.0) & (xy[:, :2] < scene.size - 1.0)).all(axis=1)


def _high_voltage(scene: Scene, direction: float, span: float) -> None:
    """Add towers and wires; spans to towers beyond the site are cut at its edge."""
    feet = _line(scene, direction, 0.22 * scene.size, span)
    across = np.array([-np.sin(direction), np.cos(direction), 0.0])
    for foot in feet[_inside(scene, feet)]:
        _tower(scene, foot, direction)
    # Bundles of two conductors 0.4 m apart hang 1 m below the arms; the guard wire is at the top.
    bundles = [(side * _ARM + apart, arm - 1.0) for arm in _ARMS for side in (-1, 1) for apart in (-0.2, 0.2)]
    for aside, height in [*bundles, (0.0, _TOWER)]:
        # The sag of 3 % of the span is usual at 20 °C.
        _string(scene, feet + (aside * across + [0.0, 0.0, height]), 0.03 * span)


def _tower(scene: Scene, foot: np.ndarray, direction: float) -> None:
    """Add a tower: four legs, a body and three pairs of arms."""
    number, (x, y, ground) = scene.new_id(), (float(value) for value in foot)
    frame = Rect(x, y, 1.0, 1.0, direction)
    # The legs are 3.2 m apart.
    legs = [(frame.part(u, v, 0.3, 0.3), -1.0, 0.5 * _TOWER) for u in (-1.6, 1.6) for v in (-1.6, 1.6)]
    body = (frame.part(0.0, 0.0, 0.8, 0.8), 0.5 * _TOWER, _TOWER)
    arms = [(frame.part(0.0, 0.0, 0.5, 2 * _ARM), height - 0.4, height) for height in _ARMS]
    for rect, bottom, top in [*legs, body, *arms]:
        scene.add_box(rect, ground + bottom, ground + top, PointClass.TRANSMISSION_TOWER, number)


def _low_voltage(scene: Scene, direction: float, rng: np.random.Generator) -> None:
    """Add poles 40 m apart with their wires, and 16 m from every second pole a house with a wire from the pole."""
    feet = _line(scene, direction, -0.22 * scene.size, 40.0)
    across = np.array([-np.sin(direction), np.cos(direction), 0.0])
    for i, foot in enumerate(feet):
        if not _inside(scene, foot[None])[0]:
            continue
        x, y, ground = (float(value) for value in foot)
        scene.add_box(Rect(x, y, 0.3, 0.3, direction), ground - 1.0, ground + _POLE, PointClass.TRANSMISSION_TOWER)
        middle = foot - 16.0 * across
        if i % 2 == 0 and _inside(scene, np.array([middle - 10.0, middle + 10.0])).all():
            eave = _house(scene, middle, direction, rng)
            # The wire ends at the wall, 4 m from the middle of the house.
            drop = np.append((middle + 4.0 * across)[:2], eave - 0.2)
            _string(scene, np.array([foot + [0.0, 0.0, _POLE - 1.7], drop]), sag=0.3)
    for aside, below in _WIRES:
        _string(scene, feet + (aside * across + [0.0, 0.0, _POLE - below]), sag=0.8)


def _house(scene: Scene, middle: np.ndarray, direction: float, rng: np.random.Generator) -> float:
    """Add a gable house; return the elevation (m) of its eaves."""
    rect = Rect(float(middle[0]), float(middle[1]), float(rng.uniform(9, 13)), 8.0, direction)
    ground = scene.relief.ground(*rect.corners().T)
    eave = float(ground.max()) + float(rng.uniform(3.5, 5.5))
    solid = Body(rect, gable(rect, eave, 0.7), float(ground.min()) - 1.0, PointClass.BUILDING, scene.new_id())
    scene.add_building("gable", rect.corners(), [solid])
    return eave


def _string(scene: Scene, points: np.ndarray, sag: float) -> None:
    """Add a wire between successive points (n, 3), m, with a sag (m) in the middle of each span."""
    number, share = scene.new_id(), np.linspace(0.0, 1.0, 25)[:, None]
    for start, end in zip(points, points[1:]):
        line = start + share * (end - start) - 4 * sag * share * (1 - share) * [0.0, 0.0, 1.0]
        inside = _inside(scene, line)
        scene.wires += [(*line[k], *line[k + 1], number) for k in np.flatnonzero(inside[1:] & inside[:-1])]
