"""What the pictures of the help pages show, by the ids of the algorithms that have one.

The pictures are made of simulated scenes by ``scripts/help_pictures.py`` and ``scripts/hough_picture.py``. A stage that
is not named here, and writes a dimension of the points it reads, is shown on a simulated town by that dimension.
"""

from functools import cache

from .cloud.dimensions import DIMENSIONS
from .stage import Stage
from .stages import STAGES

# The caption of all segmentations whose picture shows nothing else.
_SEGMENTS = "Each segment in a color of its own, points without a segment in gray."

_CAPTIONS = {
    "detectbuildings": (
        "A simulated town: ground brown, plants green, buildings red with footprints, water and the bridges over it "
        "blue, wires yellow, the rest gray."
    ),
    "mapfootprints": "A simulated village from a drone's images: roofs red, and the walls below them as footprints.",
    "modelbuildings": "Edges of the closed models over the points they were made of.",
    "modelfacades": "One side of a simulated street: each facade in a color, windows and doors outlined.",
    "modelterrain": "A simulated valley: bare earth brown, the bridge over it blue, objects gray.",
    "modelindustry": "Pipes, elbows and posts of a simulated plant, each in a color of its own.",
    "interpretstructure": "Points of a simulated flight by what they lie on: lines, surfaces or volumes.",
    "classifygroundtin": "Ground of a simulated town in brown, up to the river's banks; all else gray.",
    "classifygroundcloth": "Ground of a simulated town in brown, as the cloth finds it; all else gray.",
    "classifygroundsegments": "Bare earth brown, the bridge over the valley blue, objects gray.",
    "classifybridges": "The bridge over the valley, ground before this step, in blue.",
    "completeground": "Ground of a simulated town in brown, with what lies on its surface.",
    "computeheightaboveground": "Heights from blue, the ground, to red, the highest roofs and crowns.",
    "computefeatures": "Planarity from blue, low in crowns and at edges, to red, high on roofs and ground.",
    "classifydimensionality": "Points by what they lie on: lines, surfaces or volumes.",
    "segmentregions": "Regions of neighboring points above the ground, each in a color of its own.",
    "segmentroofs": "Roof surfaces in a color each; all other points are gray.",
    "segmentclusters": "Clusters of points above the ground, each in a color of its own.",
    "segmentsurfaces": _SEGMENTS,
    "segmentscanlines": _SEGMENTS,
    "segmentrecordedlines": _SEGMENTS,
    "segmenttinplanes": _SEGMENTS,
    "segmentplanesransac": "Planes of the roofs of a simulated village, each in a color of its own.",
    "segmentplaneshough": (
        "The bins decide between accuracy and reliability, measured on planes among scattered points: in bins smaller "
        "than the noise planes get lost, in large ones those that lie close become one."
    ),
    "detectcylinders": "Pipes of a simulated plant with their axes, each in a color of its own.",
    "detectspheres": "A sphere of a simulated plant in color.",
    "segmenttree": "Stem and branches of a simulated tree in a color each; leaves are gray.",
    "segmentvoxels": "Components of connected voxels, each in a color of its own.",
    "classifybuildings": "Confidence that a cluster is a building, from blue, low, to red, high.",
    "classifyvegetation": "Crowns, hedges and bushes in green, the darker the higher; buildings red, walls gray.",
    "keepclasses": "A simulated town in the colors of the classes that it came with.",
    "classifysegments": "Segments of the terrain, picked by area, as ground in brown; all else gray.",
    "classifywater": "The river of a simulated town in blue, below its bridges.",
    "classifywires": "A simulated transmission line and a line along houses: wires yellow, masts brown.",
    "completebuildings": "Whole buildings in red, with walls, dormers and edges.",
    "refinebuildings": "The probability of building that was learned from the scene, from blue to red.",
    "extractfootprints": "Footprints around the points of buildings.",
    "classifyroofs": "Roofs of a simulated village in red; plants at their height are gray.",
    "classifywalls": "Roofs with the walls below their eaves.",
    "extractwallfootprints": "Outlines of the walls, which lie within the eaves.",
    "extractwallfootprints2022": "Edges where points lie densely between two corners, and the footprints they enclose.",
    "extractfacades": "One side of a simulated street: each facade in a color, with its boundary.",
    "extractopenings": "One side of a simulated street: windows and doors outlined.",
    "segmentfacadelines": "Pieces of a vehicle's scan lines, joined to surfaces in a color each.",
    "reconstructroofs": "Edges of the closed models over the points they were made of.",
    "computebuildingheights": "A simulated village by classes, and the footprints that get heights.",
    "regularizepolygons": "A simulated village, and the outlines of its old map drawn anew.",
    "updatemap": "A simulated village, and its old map after the update: it lacked the house in front.",
    "simulatetown": "The town from above, in the colors of the true classes.",
    "simulatevillage": "The village from above, in the colors of its images.",
    "simulatedronesite": "The site from above, in the colors of its images.",
    "simulateflight": "The site of the flight, in the colors of the true classes.",
    "simulateplant": "The rack of the plant: pipes, elbows, flanges and beams, each in a color of its own.",
    "simulatetree": "The tree, each branch in a color of its own.",
    "simulatestreet": "One side of the street, each true facade in a color of its own.",
    "simulatepowerline": "Both lines of the site, in the colors of the true classes.",
    "simulatebridges": "A bridge over a valley, in the colors of the true classes.",
}


def derived_caption(stage: Stage) -> str:
    """Return the caption of the picture of a stage that has none of its own, "" if it gets no picture."""
    is_ours = stage.function.__module__.startswith(f"{__package__}.")
    if not is_ours or not stage.writes or stage.creates or stage.selects or stage.merges or stage.reads_reference:
        return ""
    first = stage.writes[0]
    if first == "classification":
        return "A simulated town in the colors of its classes after this step; unclassified points gray."
    if first in ("segment_id", "cluster_id"):
        return _SEGMENTS
    return f"A simulated town by {DIMENSIONS[first].disk[0]}, from blue, low, to red, high."


@cache
def captions() -> dict[str, str]:
    """Return the captions of all algorithms that have a picture, by their ids."""
    derived = {stage.id: derived_caption(stage) for stage in STAGES.values()}
    return {**{one: text for one, text in derived.items() if text}, **_CAPTIONS}
