"""Bridges over water, roads and valleys, and what looks like them, scanned from the air."""

from __future__ import annotations

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, stage, tunable
from .bridge_site import KINDS, Deck, build_site, land
from .scanner import PULSE_DENSITY, RANGE_NOISE, RECORDED, AirSurvey, refuse_large, scan

_ALL = "all"

# Height over the land (m) up to which points of a deck are ground: the deck lies on the land.
_ON_LAND = 0.5

_DECK_FIELDS = (
    Field("id", int, "number of the deck, as SegmentID of its points"),
    Field("kind", str, "kind of the crossing"),
    Field("angle", float, "angle to the shortest way across", "°"),
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
    kind: str = tunable(
        _ALL,
        "A flat or arched bridge over a canal between quays, a footbridge over a stream, one or two decks over a "
        "cutting, a bridge over a valley, a fly-over with ramps. Or no bridge: the mouths of a tunnel, a "
        "jetty, a ramp that ends over a wall. 'all' lays them side by side.",
        choices=(_ALL, *KINDS),
    ),
    angle: float = tunable(0.0, "Angle of the decks to the shortest way across.", within="[0, 50]°"),
    density: float = PULSE_DENSITY,
    cars: bool = tunable(True, "Cars on the decks."),
    trees: bool = tunable(True, "Trees on the land."),
    range_noise: float = RANGE_NOISE,
    seed: int = SEED,
    monitor=None,
):
    """Scan made-up bridges from the air: decks with parapets, piers and cars, and the true class of every point.

    Each kind lies on a lot of 140 m, turned at random. Nothing but decks is bridge deck (17), and only where they do
    not lie on the land: the land over a tunnel, quays, jetties and ramps are ground.

    Returns
    -------
    xyz, return_number, number_of_returns, intensity, scan_angle, point_source_id, gps_time : ndarray of shape (n, ...)
        As of :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        The truth: 2 ground with banks, embankments and quays; 9 water; 17 bridge decks with their sides; 1 parapets,
        piers and cars; 3, 4, 5 trees.
    segment_id : ndarray of shape (n,), int32
        Number of the deck, car or tree; 0 for ground and water.
    decks : LayerFeatures
        Outlines of the decks.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses.

    Notes
    -----
    Scanned as in 'Simulate town', with strips, lines and occlusion. Walls of terrain, such as at tunnel mouths
    and abutments, rise at 60°, quays at 90°. Ramps rise at 12 %, steeper than roads, to keep lots small.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges
    >>> xyz, classification, *_, decks = simulate_bridges(kind="canal", density=0.5)
    >>> len(decks), bool((classification == 17).any())
    (1, True)
    """
    kinds = tuple(KINDS) if kind == _ALL else (kind,)
    scene, decks = build_site(kinds, angle, cars, trees, seed)
    refuse_large("The site", scene.size, density, "lower the density")
    made = scan(scene, AirSurvey(density, range_noise=range_noise, noise_points=0.0, seed=seed), monitor)
    x, y, z = made["xyz"].T
    lies_on_land = land(scene, x, y) >= z - _ON_LAND
    made["classification"][(made["classification"] == PointClass.BRIDGE_DECK) & lies_on_land] = PointClass.GROUND
    return (*(made[name] for name in RECORDED), _layer(decks))


def _layer(decks: list[Deck]) -> LayerFeatures:
    columns = {
        "id": [deck.object_id for deck in decks],
        "kind": [deck.kind for deck in decks],
        "angle": [deck.angle for deck in decks],
        "width": [deck.rect.width for deck in decks],
        "length": [deck.rect.length for deck in decks],
    }
    rings = [deck.rect.corners() for deck in decks]
    return LayerFeatures([[ring[[0, 1, 2, 3, 0]]] for ring in rings], columns)
