"""Power lines of which every point is known."""

from __future__ import annotations

from ..params import SEED
from ..stage import stage, tunable
from .line_site import build_line_site
from .scanner import PULSE_DENSITY, RANGE_NOISE, RECORDED, Survey, refuse_large, scan


@stage(
    "Simulation",
    tags="synthetic,power line,wire,conductor,catenary,tower,pylon,pole,airborne,demo,example,test,truth,teaching",
    creates=RECORDED,
)
def simulate_power_line(
    *,
    size: float = tunable(200.0, "Side of the site, a square from (0, 0).", within="[80, 1000] m"),
    density: float = PULSE_DENSITY,
    span: float = tunable(120.0, "Distance between the towers of the transmission line.", within="[50, 500] m"),
    angle: float = tunable(15.0, "Direction of both lines from east.", within="[0, 90]°"),
    trees: float = tunable(20.0, "Trees outside the forest.", within="[0, 200] per ha"),
    forest: float = tunable(
        0.15, "Share of the site that is forest, also under the lines.", label="Share of forest", within="[0, 1]"
    ),
    range_noise: float = RANGE_NOISE,
    seed: int = SEED,
    monitor=None,
):
    """Scan made-up power lines from the air, with the true class of every point.

    A transmission line on towers of 30 m carries six bundles of two conductors and a guard wire. A line on poles of 9 m
    carries three wires on a cross-arm, four in a rack below it, a telephone cable, and a wire to a house at every
    second pole. Trees and a forest grow under both.

    Returns
    -------
    xyz, return_number, number_of_returns, intensity, scan_angle, point_source_id, gps_time : ndarray of shape (n, ...)
        As of :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        The truth: 2 ground; 3, 4, 5 vegetation; 6 houses; 14 wires; 15 towers and poles.
    segment_id : ndarray of shape (n,), int32
        Number of the wire, mast, house or tree; 0 for ground.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses.

    Notes
    -----
    Wires are parabolas with a sag of 3 % of the span, those of low voltage of 0.8 m. A pulse whose axis passes a wire
    within 0.1 m gives a return from it in 70 of 100 cases, and most go on. Scanned as in 'Simulate town'.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_power_line import simulate_power_line
    >>> classification = simulate_power_line(size=100.0, density=1.0)[1]
    >>> bool((classification == 14).any() and (classification == 15).any())
    True
    """
    refuse_large("The site", size, density, "lower the density or the size")
    scene = build_line_site(size, span, angle, trees, forest, seed)
    made = scan(scene, Survey(density, range_noise=range_noise, noise_points=0.0, seed=seed), monitor)
    return tuple(made[name] for name in RECORDED)
