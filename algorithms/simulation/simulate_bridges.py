"""Airborne scans of bridges over water, roads and valleys, and of similar objects."""

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, stage, tunable
from .bridge_site import KINDS, build_site, land
from .scanner import PULSE_DENSITY, RANGE_NOISE, RECORDED, AirSurvey, refuse_large, scan

_ALL = "all"

# Points of a deck up to this height (m) above the land are ground: the deck rests on the land.
_ON_LAND = 0.5

_DECK_FIELDS = (
    Field("id", int, "number of the deck, as SegmentID of its points"),
    Field("kind", str, "kind of the crossing"),
    Field("angle", float, "angle to the perpendicular of the obstacle", "°"),
    Field("width", float, "width", "m"),
    Field("length", float, "length", "m"),
)


@stage(
    "Simulation",
    tags="synthetic,bridge,fly-over,tunnel,canal,quay,ramp,airborne,demo,example,test,truth,teaching",
    creates=RECORDED,
    layers=(Layer("decks", "True bridge decks", "Polygon", _DECK_FIELDS),),
)
def simulate_bridges(
    *,
    kind: str = tunable(_ALL, choices=(_ALL, *KINDS)),
    angle: float = tunable(0.0, within="[0, 50]°"),
    density: float = PULSE_DENSITY,
    cars: bool = tunable(True),
    trees: bool = tunable(True),
    range_noise: float = RANGE_NOISE,
    seed: int = SEED,
    monitor=None,
):
    """Simulate an airborne scan of bridges: decks with parapets, piers and cars, and the true class of every point.

    Each kind is on a lot of 140 m, rotated at random. Only decks above the land are bridge deck (17). The land over a
    tunnel, quays, jetties, ramps and the ends of decks on the land are ground.

    Returns
    -------
    xyz, return_number, number_of_returns, intensity, scan_angle, point_source_id, gps_time : ndarray of shape (n, ...)
        As for :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        True class: 2 ground with banks, embankments and quays; 9 water; 17 bridge decks with their sides; 1 parapets,
        piers and cars; 3, 4, 5 trees.
    segment_id : ndarray of shape (n,), int32
        Number of the deck, car or tree; 0 for ground and water.
    decks : LayerFeatures
        Outlines of the decks.

    Other Parameters
    ----------------
    kind
        A flat or arched bridge over a canal between quays, a footbridge over a stream, one or two decks over a cutting,
        a bridge over a valley, a fly-over with ramps. Without a bridge: the portals of a tunnel, a jetty, a ramp that
        ends at a wall. 'all' places one of each side by side.
    angle
        Angle of the decks to the perpendicular of the obstacle.
    cars
        Cars on the decks.
    trees
        Trees on the land.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses.

    Notes
    -----
    The scan is as in 'Simulate town', with strips, scan lines and occlusion. Terrain walls, such as at tunnel portals
    and abutments, have a slope of 60°; quays are vertical. Ramps have a slope of 12 %, steeper than real roads, to keep
    lots small.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges
    >>> xyz, classification, *_, decks = simulate_bridges(kind="canal", density=0.5)
    >>> len(decks), bool((classification == 17).any())
    (1, True)
    """
    scene, decks = build_site(tuple(KINDS) if kind == _ALL else (kind,), angle, cars, trees, seed)
    refuse_large("The site", scene.size, density, "lower the density")
    made = scan(scene, AirSurvey(density, range_noise=range_noise, noise_points=0.0, seed=seed), monitor)
    x, y, z = made["xyz"].T
    lies_on_land = land(scene, x, y) >= z - _ON_LAND
    made["classification"][(made["classification"] == PointClass.BRIDGE_DECK) & lies_on_land] = PointClass.GROUND
    rows = [(deck.object_id, deck.kind, deck.angle, deck.rect.width, deck.rect.length) for deck in decks]
    columns = {field.name: [row[i] for row in rows] for i, field in enumerate(_DECK_FIELDS)}
    outlines = [[deck.rect.corners()[[0, 1, 2, 3, 0]]] for deck in decks]
    return (*(made[name] for name in RECORDED), LayerFeatures(outlines, columns))
