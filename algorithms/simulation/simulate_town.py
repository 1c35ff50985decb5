"""Airborne scans of a town with known truth, for training, tests and measurements."""

from ..params import SEED
from ..stage import stage, tunable
from .plants import FOREST
from .scanner import PATTERNS, PULSE_DENSITY, RANGE_NOISE, RECORDED, AirSurvey, refuse_large, scan
from .town_layout import MAX_BUILDINGS, TownPlan, build_town


@stage(
    "Simulation", tags="synthetic,scanner,airborne,demo,example,test,truth,teaching,scene,generate", creates=RECORDED
)
def simulate_town(
    *,
    size: float = tunable(200.0, within="[50, 2000] m"),
    density: float = PULSE_DENSITY,
    buildings: float = tunable(20.0, within=f"[0, {MAX_BUILDINGS}] per ha"),
    trees: float = tunable(20.0, within="[0, 200] per ha"),
    forest: float = FOREST,
    slope: float = tunable(3.0, within="[0, 40]°"),
    relief: float = tunable(2.0, within="[0, 10] m"),
    terrace_height: float = tunable(1.5, within="[0, 5] m"),
    river: bool = tunable(True),
    clutter: bool = tunable(True, label="Cars, hedges, walls and wires"),
    pattern: str = tunable("lines", label="Scan pattern", choices=PATTERNS, advanced=True),
    max_scan_angle: float = tunable(20.0, within="[5, 30]°", advanced=True),
    overlap: float = tunable(0.3, label="Strip overlap", within="[0, 0.8]", advanced=True),
    range_noise: float = RANGE_NOISE,
    noise_points: float = tunable(10.0, within="[0, 1000] per ha", advanced=True),
    returns: bool = tunable(True, label="Several returns", advanced=True),
    seed: int = SEED,
    monitor=None,
):
    """Simulate an airborne scan of a town: houses, trees, a river, and the true class of every point.

    Streets with plots run up a slope. Houses have gable, hip, flat and L-shaped roofs with dormers and chimneys; there
    are rows of different heights with party walls, sheds and a hall. Beams partly penetrate trees, hedges and a forest.
    There are cars, walls, wires on poles, a river with bridges, birds and multipath points.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m), sorted by time, then by return.
    classification : ndarray of shape (n,), uint8
        True class. Ground is 2; vegetation under 0.5 m, under 2 m and higher 3, 4 and 5 (stems are 5); buildings with
        walls, chimneys and dormers are 6. Low and high noise is 7 and 18, water 9. Wires are 14, their poles 15, bridge
        decks 17; cars, walls and the rails of bridges 1.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        Up to five returns per pulse; all 0 without ``returns``.
    intensity : ndarray of shape (n,), uint16
        Intensity by material; the returns of a pulse share its energy.
    scan_angle : ndarray of shape (n,), float32
        Angle of the beam to the vertical (°), negative to the left of the flight.
    point_source_id : ndarray of shape (n,), uint16
        Flight line, from 1.
    gps_time : ndarray of shape (n,), float64
        Time of the pulse (s), from the start of the flight.
    segment_id : ndarray of shape (n,), int32
        Number of the object, the same for all points of a building; 0 for ground, water and noise.

    Other Parameters
    ----------------
    size
        Side of the town, a square from (0, 0).
    buildings
        Plots with a house or a short row, per hectare of streets and plots; 0 gives open fields. The river valley and
        the forest have no houses.
    trees
        Trees outside the forest, single and in clumps, if space permits.
    slope
        Mean slope of the ground.
    relief
        Approximate height difference between hollows and hills.
    terrace_height
        Rise of the terraces, one every 45 m up the slope.
    river
        Add a river in a channel, with a bridge for every street.
    clutter
        Add objects that are not buildings.
    pattern
        Parallel lines of a rotating mirror, the zigzag of an oscillating mirror, or random positions.
    max_scan_angle
        Angle to the vertical at the edge of a strip. Large angles show more of the walls and occlude more of the yards
        behind them.
    overlap
        Share of a strip that the next strip overlaps. Without overlap, roofs and crowns are cut at the seam.
    noise_points
        Noise points, half of them high above the ground (birds), half below it (multipath).
    returns
        Record all returns of a pulse. Otherwise only the first is recorded, with unknown return number, as in clouds of
        matched images.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses.

    Notes
    -----
    The scanner flies parallel strips in alternate directions, 600 m above the ground. Rays are traced to the first
    surface: walls that face the scanner have points, occluded yards have none. Points deviate from roofs, walls and
    ground only by the range noise along the beam. Hits of leaves are random; their number increases with the path
    through the crown, and 70 % of the pulses continue after each. The beam is 0.2 m wide on the ground, so that the
    edge of a roof gives two returns. Echoes less than 0.7 m apart are not separated.

    Not simulated: overhanging eaves, windows, curved roofs, moving objects, errors between strips, drift of the
    position, grass, and reflecting walls.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_town import simulate_town
    >>> xyz, classification, *_ = simulate_town(size=50.0, density=1.0)
    >>> bool((classification == 2).any())
    True
    """
    refuse_large("A town", size, density, "lower size or density")
    plan = TownPlan(size, slope, relief, terrace_height, buildings, trees, forest, river, clutter, seed)
    survey = AirSurvey(density, pattern, max_scan_angle, overlap, range_noise, returns, noise_points, seed)
    made = scan(build_town(plan, monitor.part(0.0, 0.15)), survey, monitor.part(0.15, 1.0))
    return tuple(made[name] for name in RECORDED)
