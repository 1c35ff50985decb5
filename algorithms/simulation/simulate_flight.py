"""A drone's laser scan of a street with known truth, for training, tests and measurements."""

from ..params import SEED
from ..stage import stage, tunable
from .drone import ANGULAR_STEP, LINE_RATE, SCANNERS, LineScan, plan_flight, pulses_per_line
from .scanner import RANGE_NOISE, RECORDED, refuse_many
from .street_site import build_site


@stage(
    "Simulation",
    title="Simulate drone flight",
    tags="synthetic,UAV,UAS,line scanner,facade,demo,example,test,truth,teaching,scene,generate",
    creates=RECORDED,
)
def simulate_flight(
    *,
    height: float = tunable(8.0, label="Flight height", within="[2, 25] m"),
    duration: float = tunable(190.0, within="[5, 600] s"),
    scanners: str = tunable("both", choices=("both", *SCANNERS)),
    trees: int = tunable(4, within="[0, 22]"),
    slope: float = tunable(1.5, within="[0, 10]°"),
    line_rate: float = LINE_RATE,
    angular_step: float = ANGULAR_STEP,
    max_range: float = tunable(30.0, within="[1, 40] m", advanced=True),
    range_noise: float = RANGE_NOISE.with_default(0.03),
    seed: int = SEED,
    monitor=None,
):
    """Simulate a street scanned from a drone by two line scanners, with the true class of every point.

    The drone takes off between houses with balconies, parked cars, lamps and trees, makes one turn and lands at the
    same position. One scanner scans horizontally: it repeatedly sees facades and crowns at the height of the drone. The
    other scans in the vertical plane across the drone: it also sees the ground, and all directions during the turn.

    Returns
    -------
    xyz, intensity, gps_time : ndarray of shape (n, ...)
        As for :func:`.simulate_town.simulate_town`; both scanners have the same coordinate system.
    classification : ndarray of shape (n,), uint8
        True class: 2 ground; 3, 4, 5 vegetation under 0.5 m, under 2 m and higher (stems are 5); 6 buildings with their
        balconies; 1 cars and lamps.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        Always 1: the scanners record the first echo only.
    scan_angle : ndarray of shape (n,), float32
        Angle of the beam to the nadir (°), 90 for horizontal beams, negative to the left of the drone.
    point_source_id : ndarray of shape (n,), uint16
        1 for the horizontal scanner, 2 for the vertical one.
    segment_id : ndarray of shape (n,), int32
        Number of the object, the same for all points of a building; 0 for ground.

    Other Parameters
    ----------------
    height
        Greatest height of the drone above the street.
    duration
        Time from take-off to landing: a fifth each for climb and landing, the rest for one turn. Longer flights have
        more points.
    scanners
        Scanners to simulate. Two runs with one scanner each give two clouds of the same flight, which can be merged.
    trees
        Trees along the street.
    slope
        Slope of the plane ground.
    max_range
        Maximum range of the scanners.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses, or no beam meets anything.

    Notes
    -----
    The scanners are as in the publication: 40 lines per second and a beam every 0.25° over 270°. The blind quarter of
    the circle is behind the drone for the horizontal scanner and above it for the vertical one. The range is 30 m, with
    3 cm of noise along the beam. The drone sways by up to 0.3 m and 2°. Its position is known exactly: points deviate
    from surfaces by the range noise only. By default there are 6.7 million points in 320,000 voxels of 0.1 m, about as
    many as in the publication.

    Not simulated: parts of the drone in view, positioning errors, echoes that mix two surfaces at edges, windows, and
    surfaces too dark or too oblique to return an echo.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented
    line scanners, sections 3.2 and 5. [weinmann2017]

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_flight import simulate_flight
    >>> xyz, classification, *_ = simulate_flight(duration=5.0, line_rate=2.0)
    >>> bool((classification == 6).any())
    True
    """
    wanted = tuple(SCANNERS) if scanners == "both" else (scanners,)
    pulses = len(wanted) * duration * line_rate * pulses_per_line(angular_step)
    remedy = "lower the duration or the line rate, or take a larger angular step"
    refuse_many(pulses, f"A flight of {duration:g} s", remedy)
    scene, settings = build_site(trees, slope, seed), LineScan(line_rate, angular_step, max_range, range_noise, seed)
    made = plan_flight(scene, height, duration, seed).scanned(scene, wanted, settings, monitor)
    if not len(made["xyz"]):
        raise ValueError(f"Nothing is within {max_range:g} m of the scanner; raise the maximum range.")
    return tuple(made[name] for name in RECORDED)
