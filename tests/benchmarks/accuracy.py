#!/usr/bin/env python3
"""Print how good the results are: ``accuracy.py [table …]``, all by default.

``buildings``, ``classes`` (all of them, compared with Whitebox), ``ground``, ``noise`` and ``noise_apart`` are of real
clouds, ``turned`` of the same when cells fall elsewhere, ``harder`` of the same with fewer points or more noise,
``uneven`` of the same with points on lines, in bands or in pairs, ``pieces`` of squares cut out of clouds, ``objects``
of real houses, trees, cars, fences and poles on simulated ground, ``footprints`` of outlines, ``outlines`` of how
stable these are, compared with Building-Regulariser's, ``towns``, ``pits``, ``scenes``, ``villages``, ``places`` and
``confidence`` of simulated scenes, whose truth is exact, and ``maps`` of old maps with known differences. ``photos``
are real clouds of matched images, ``drone`` simulated ones, ``likeness`` compares the two. ``review`` is how many
decisions on buildings of real clouds and simulated towns it takes until no false one is left.

Each table comes as Markdown for people, as a JSON file for programs (in ``--output``), and tables of real clouds as the
Python lines that the tests hold the program to.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.asprs import NOISE, PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud  # noqa: E402
from lidar_buildings.algorithms.geometry.grid import turned_in_plan  # noqa: E402
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps  # noqa: E402
from lidar_buildings.algorithms.geometry.rings import signed_area  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.stage import Monitor  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.aged_maps import aged, with_plain_corners  # noqa: E402
from lidar_buildings.tests.benchmarks.classes import classes  # noqa: E402
from lidar_buildings.tests.benchmarks.drone import drone, photos  # noqa: E402
from lidar_buildings.tests.benchmarks.drone_scenes import places as drone_places  # noqa: E402
from lidar_buildings.tests.benchmarks.likeness import likeness  # noqa: E402
from lidar_buildings.tests.benchmarks.outlines import outlines  # noqa: E402
from lidar_buildings.tests.benchmarks.real_objects import CAR, FENCE, POLE, TREE, scene  # noqa: E402
from lidar_buildings.tests.benchmarks.results import Table, print_tables  # noqa: E402
from lidar_buildings.tests.benchmarks.review import review  # noqa: E402
from lidar_buildings.tests.benchmarks.scenes import SCENES, estate, scanned  # noqa: E402
from lidar_buildings.tests.benchmarks.uneven import evenly, in_bands, in_pairs, on_lines, on_zigzags  # noqa: E402
from lidar_buildings.tests.pits import scene as with_pits  # noqa: E402
from lidar_buildings.tests.real.clouds import (  # noqa: E402
    DATA,
    GROUND_IN_TOWN,
    GROUND_SAMPLES,
    OUTLIERS,
    WITH_BUILDINGS,
    WITHOUT_BUILDINGS,
    classified,
    detected,
    made_harder,
    path_of,
    run_on,
    score,
    score_against,
    truth,
)
from lidar_buildings.tests.villages import corner_distances, mapped, village  # noqa: E402

# Points per square meter, noise (m) and seed of simulated villages of 150 m.
VILLAGES = [(density, noise, 11) for density in (50, 100) for noise in (0.02, 0.05)]

# Chains that are compared, and what tables call them.
CHAINS = {"detect_buildings": "default", "detect_buildings_2019": "2019"}

# Headings of the rates (%) of points of buildings.
RATES = ("completeness", "correctness", "F")


def buildings() -> list[Table]:
    """Print completeness, correctness and F of both chains, per point, cell and object."""
    rates = [f"{of}: {rate}" for of in ("points", "cells") for rate in ("compl.", "corr.", "F")]
    table = Table("buildings", "cloud", "chain", *rates, "objects: compl.", "objects: corr.", "s", texts=2)
    f_scores: dict[str, list[float]] = {}
    for name in WITH_BUILDINGS:
        for pipeline, chain in CHAINS.items():
            result = detected(name, pipeline)
            found = score("buildings", name, result)
            figures = [found[of][rate] for of in ("points", "cells") for rate in ("completeness", "correctness", "F")]
            figures += [found["objects"]["completeness"], found["objects"]["correctness"], result.seconds]
            table.add(name.split("/")[1], chain, *figures)
            f_scores.setdefault(name, []).append(found["points"]["F"])
    without = Table("without_buildings", "cloud without buildings", "chain", "called building, m²", texts=2)
    areas = {}
    for name in WITHOUT_BUILDINGS:
        for pipeline, chain in CHAINS.items():
            area = detected(name, pipeline).area
            without.add(name.split("/")[1], chain, area)
            areas.setdefault(name, area)
    paste("REACHED", {name: "(" + ", ".join(f"{f:.1f}" for f in both) + ")" for name, both in f_scores.items()})
    paste("REACHED_WITHOUT_BUILDINGS", {name: f"{area:.1f}" for name, area in areas.items()})
    return [table, without]


# What is taken from clouds, or added to them.
HARDER: tuple[tuple[str, dict[str, Any]], ...] = (
    ("buildings/ahn-amsterdam-1", {"noise": 0.1}),
    ("buildings/ahn-amsterdam-1", {"returns": False}),
    ("buildings/ahn-amsterdam-1", {"keep": 0.25}),
    ("buildings/ign-stbarth", {"noise": 0.1}),
    ("buildings/ahn3-delft", {"noise": 0.1}),
    ("buildings/ign-bridge-none", {"keep": 0.25}),
    *((f"buildings/{name}", {"step": 0.3}) for name in ("ign-chalet", "ahn-amsterdam-1", "ign-stbarth")),
)


def harder() -> list[Table]:
    """Print how well the default chain does on harder versions of real clouds."""
    columns = ("points", *RATES, "wrong points", "wrong, m²")
    table = Table("harder", "cloud", "made harder", *columns, texts=2)
    for name, change in HARDER:
        cloud, true = made_harder(name, **change)
        result = run_on(cloud)
        found = score_against(true, "buildings", result)["points"]
        figures = [found[rate] for rate in ("completeness", "correctness", "F")]
        wrong = (result.classification == PointClass.BUILDING) & (true != PointClass.BUILDING)
        about = name.split("/")[1], changes_cell(change), len(true)
        table.add(*about, *figures, int(wrong.sum()), area_of(cloud, wrong))
    return [table]


# How points are spread (m, points per square meter).
SPREADS = {
    "lines 1 m apart": (on_lines, 1.0, 0.25),
    "lines 1.5 m apart": (on_lines, 1.5, 0.3),
    "lines 2 m apart": (on_lines, 2.0, 0.25),
    "zigzag lines": (on_zigzags, 1.5, 0.3),
    "bands": (in_bands, 2.0, 20.0),
    "pairs": (in_pairs, 2.0),
}


def uneven() -> list[Table]:
    """Print how well the default chain does where points are spread unevenly, and where as many as on lines evenly."""
    table = Table("uneven", "cloud", "spread", "points", *RATES, texts=2)
    for name in ("buildings/ahn3-delft", "buildings/ahn-amsterdam-1", "buildings/ign-stbarth"):
        xyz = made_harder(name)[0].get("xyz")
        for spread, (choose, *how) in SPREADS.items():
            chosen = choose(xyz, *how)
            table.add(name.split("/")[1], spread, *_rates_of(name, *chosen))
            if "lines" in spread:
                even = evenly(xyz, len(chosen[0]))
                table.add(name.split("/")[1], "as many, evenly", *_rates_of(name, *even))
    return [table]


def _rates_of(name: str, rows: np.ndarray, xyz: np.ndarray) -> tuple[float, ...]:
    """Return the number of points, completeness, correctness and F of a cloud of these points of another."""
    whole, true = made_harder(name)
    returns = {name: whole.get(name)[rows] for name in ("return_number", "number_of_returns")}
    return len(rows), *_found(create_cloud({"xyz": xyz, **returns}), true[rows])[:3]


# Clouds that are cut into squares, their sides (m), and of how many squares one is taken.
PIECES = (
    ("buildings/ahn3-delft", 100.0, 1),
    ("buildings/ahn3-delft", 50.0, 1),
    ("halls", 80.0, 1),
    ("halls", 60.0, 1),
    ("scale/autzen", 100.0, 3),
)

# Smaller pieces are slivers at the border of a cloud.
LEAST_PIECE = 200


def pieces() -> list[Table]:
    """Print how well the default chain does on squares of clouds, each by itself: buildings are cut off at their ends.

    The truth of the survey without truth is what the chain makes of the whole.
    """
    table = Table("pieces", "cloud", "side, m", "pieces", *RATES)
    for name, side, every in PIECES:
        whole, true = _cloud_and_classes(name)
        place = np.floor((whole.get("xyz")[:, :2] - whole.get("xyz")[:, :2].min(axis=0)) / side)
        square = np.unique(place, axis=0, return_inverse=True)[1].ravel()
        found = np.zeros(len(whole), np.uint8)
        rows = [np.flatnonzero(square == number) for number in range(0, square.max() + 1, every)]
        rows = [chosen for chosen in rows if len(chosen) >= LEAST_PIECE]
        for chosen in rows:
            found[chosen] = run_on(whole.take(chosen)).classification
        taken = np.concatenate(rows)
        table.add(name.split("/")[-1], int(side), len(rows), *_rates(true[taken], found[taken]))
    return [table]


def _cloud_and_classes(name: str) -> tuple[Cloud, np.ndarray]:
    """Return a cloud and its true classes."""
    if name == "halls":
        made = scanned(estate, False, 8.0)
        returns = {name: made[name] for name in ("return_number", "number_of_returns")}
        return create_cloud({"xyz": made["xyz"], **returns}), made["classification"]
    has_truth = path_of(name).with_suffix(".truth.npz").exists()
    return read_cloud(path_of(name)), truth(name) if has_truth else detected(name).classification


def area_of(cloud: Cloud, chosen: np.ndarray) -> float:
    """Return the area (m²) of the cells of 0.5 m with chosen points."""
    return len(np.unique(np.floor(cloud.get("xyz")[chosen, :2] / 0.5), axis=0)) * 0.5**2


def changes_cell(changes: dict[str, Any]) -> str:
    """Return what differs from the usual, as a cell of a table."""
    return ", ".join(f"{name} {value}" for name, value in changes.items()) or "as it comes"


# Slope of the ground (rise per meter) and share of the points.
OBJECT_SCENES = ((0.04, 0.1), (0.2, 0.1), (0.08, 0.3))


def objects() -> list[Table]:
    """Print how well the default chain distinguishes real houses from real trees, cars, fences and poles."""
    others = {"trees": TREE, "cars": CAR, "fences": FENCE, "poles": POLE}
    wrongly = [f"{kind}, %" for kind in others]
    table = Table("objects", "slope, %", "points", *RATES, "houses", "missed", *wrongly, texts=0)
    for slope, share in OBJECT_SCENES:
        xyz, truth, number = scene(slope, share)
        cloud = create_cloud({"xyz": xyz})
        run_pipeline(PIPELINES["detect_buildings"], cloud)
        is_building, is_found = truth == PointClass.BUILDING, cloud.get("classification") == PointClass.BUILDING
        rates = _rates(truth, cloud.get("classification"))
        houses = np.unique(number[is_building], return_inverse=True)[1]
        seen = np.bincount(houses, is_found[is_building]) / np.bincount(houses)
        wrong = [100.0 * float(is_found[truth == kind].mean()) for kind in others.values()]
        table.add(100 * slope, len(xyz), *rates, len(seen), int((seen < 0.5).sum()), *wrong)
    return [table]


def ground() -> list[Table]:
    """Print the errors of the ground filter, and of the one as published on the samples."""
    table = Table("ground", "cloud", "filter", "type I", "type II", "total", "kappa", "s", texts=2)
    totals, stages = {}, ("classify_ground_tin", "classify_ground_tin_2000")
    for name in (*GROUND_SAMPLES, *GROUND_IN_TOWN):
        for stage in stages if name in GROUND_SAMPLES else stages[:1]:
            result = classified(name, stage)
            found = score("ground", name, result)
            figures = [found[measure] for measure in ("type_1", "type_2", "total", "kappa")]
            table.add(name.split("/")[1], stage, *figures, result.seconds)
            totals[name, stage] = found["total"]
    own, published = ({name: total for (name, stage), total in totals.items() if stage == of} for of in stages)
    paste("REACHED", {name: f"{own[name]:.1f}" for name in GROUND_SAMPLES})
    print(f"REACHED_MEAN = {np.mean([own[name] for name in GROUND_SAMPLES]):.2f}")
    paste("REACHED_IN_TOWN", {name: f"{own[name]:.1f}" for name in GROUND_IN_TOWN})
    paste("REACHED_AS_PUBLISHED", {name: f"{total:.1f}" for name, total in published.items()})
    print(f"Mean of all samples as published: {np.mean(list(published.values())):.2f}")
    return [table]


# Angles (°) by which clouds are turned, so that cells fall elsewhere.
GROUND_TURNS, BUILDING_TURNS = np.arange(0.0, 90.0, 8.0), np.arange(0.0, 90.0, 15.0)


def turned() -> list[Table]:
    """Print what the errors of the ground filter and F of buildings are in the mean of positions, and how they vary."""
    table = Table("turned", "cloud", "measure, %", "mean", "least", "greatest", texts=2)
    totals = np.array([[_total_error(name, angle) for name in GROUND_SAMPLES] for angle in GROUND_TURNS])
    for name, errors in (*zip(GROUND_SAMPLES, totals.T), ("ground/mean of them", totals.mean(axis=1))):
        table.add(name.split("/")[1], "total error", *_spread(errors), digits=2)
    for name in WITH_BUILDINGS:
        rates = [_found(_turned(name, angle), truth(name))[2] for angle in BUILDING_TURNS]
        table.add(name.split("/")[1], "F", *_spread(np.array(rates)), digits=2)
    return [table]


def _turned(name: str, angle: float) -> Cloud:
    """Return a real cloud that was turned by an angle (°)."""
    cloud = read_cloud(path_of(name))
    returns = {dimension: cloud.get(dimension) for dimension in ("return_number", "number_of_returns")}
    return create_cloud({"xyz": turned_in_plan(cloud.get("xyz"), angle), **returns})


def _total_error(name: str, angle: float) -> float:
    """Return the total error (%) of the ground filter on a cloud that was turned."""
    cloud = _turned(name, angle)
    run_stage(STAGES["classify_ground_tin"], cloud)
    is_found, is_true = (of == PointClass.GROUND for of in (cloud.get("classification"), truth(name)))
    return 100.0 * float((is_found != is_true).mean())


def _spread(figures: np.ndarray) -> tuple[float, float, float]:
    """Return the mean, the least and the greatest of some figures."""
    return float(figures.mean()), float(figures.min()), float(figures.max())


def footprints() -> list[Table]:
    """Print how many corners outlines have, and how far Delft's are from its class 6 and from its map."""
    # QGIS reads the map, without a screen.
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    from lidar_buildings.tests.real.base_map import cell_iou, map_distances

    application = QgsApplication([], False)
    application.initQgis()
    table = Table("footprints", "cloud", "footprints", "straightened", "corners per m", "sharper than 45°")
    for name in WITH_BUILDINGS:
        made = detected(name).layers["footprints"]
        corners, n_sharp = _corners(made.geometries)
        straight = sum(made.columns["regularized"])
        table.add(name.split("/")[1], len(made), straight, corners, n_sharp, digits=2)
    delft = Table("footprints_of_delft", "Delft, classes", "IoU with class 6", "corners of houses, m", "of blocks, m")
    reached = {}
    for kind in ("truth", "chain"):
        iou, medians = cell_iou(kind), [float(np.median(map_distances(kind, level)[1])) for level in (0, 1)]
        delft.add(kind, float(iou), *medians, digits=3)
        reached[kind] = f"({iou:.3f}, {medians[0]:.2f}, {medians[1]:.2f})"
    paste("REACHED", reached)
    application.exitQgis()
    return [table, delft]


def _corners(geometries: list) -> tuple[float, int]:
    """Return the corners of polygons per meter of their rings, and how many are sharper than 45°."""
    count, length, n_sharp = 0, 0.0, 0
    for ring in (ring for rings in geometries for ring in rings):
        sides = np.diff(ring, axis=0)
        turn = np.angle(np.exp(1j * np.diff(np.arctan2(*sides[[*range(len(sides)), 0]].T[::-1]))))
        count, length = count + len(sides), length + float(np.hypot(*sides.T).sum())
        n_sharp += int((np.abs(turn) > np.deg2rad(135)).sum())
    return count / length, n_sharp


def noise() -> list[Table]:
    """Print what of the rejected points each noise filter finds."""
    table = Table("noise", "filter", *RATES)
    for stage in ("classify_noise_histogram", "classify_noise_statistical"):
        found = score("noise", OUTLIERS, classified(OUTLIERS, stage))
        table.add(stage, *(found[rate] for rate in RATES))
        if stage == "classify_noise_histogram":
            reached = found["completeness"]
    print(f"\nREACHED = {reached:.1f}")
    return [table]


# Clouds with points that their makers marked as noise, and the classes of these: low noise, high noise, artefacts.
MARKED = (OUTLIERS, "buildings/ign-forest-none", "buildings/ign-bridge-none", "buildings/ign-stbarth")
MARKS = (PointClass.LOW_NOISE, PointClass.HIGH_NOISE, 65)

# Distance (m) from every point that is not marked at which a marked one lies apart.
APART = 1.0


def noise_apart() -> list[Table]:
    """Print what is found of marked noise that lies a meter and more from everything else, before and after the ground.

    After the ground are also groups of multipath points under it. Correctness is the share of all points called noise
    that are marked, apart or not.
    """
    table = Table(
        "noise_apart", "cloud", "after", "marked", "apart", "found of these", "called noise", "correct", texts=2
    )
    for name in MARKED:
        cloud, is_marked = read_cloud(path_of(name)), np.isin(truth(name), MARKS)
        xyz = cloud.get("xyz")
        is_apart = np.zeros(len(xyz), bool)
        is_apart[is_marked] = cKDTree(xyz[~is_marked]).query(xyz[is_marked])[0] >= APART
        for after, stage in (
            ("heights", "classify_noise_histogram"),
            ("air", "classify_noise_air"),
            ("ground", "classify_ground_tin"),
            ("multipath", "classify_multipath"),
        ):
            run_stage(STAGES[stage], cloud)
            is_noise = np.isin(cloud.get("classification"), NOISE)
            counts = (is_marked, is_apart, is_apart & is_noise, is_noise, is_marked & is_noise)
            table.add(name.split("/")[1], after, *(int(count.sum()) for count in counts))
    return [table]


# Far from what the thresholds were tried on: what a town differs in from the default one.
TOWNS: tuple[dict[str, Any], ...] = (
    {},
    *({"density": density} for density in (1.0, 2.0, 30.0)),
    {"range_noise": 0.06},
    {"range_noise": 0.1, "density": 20.0},
    *({"slope": slope} for slope in (20.0, 35.0)),
    {"returns": False},
    {"forest": 0.6},
    {"pattern": "zigzag"},
    {"buildings": 0.0},
    {"trees": 0.0, "forest": 0.0},
)


def towns() -> list[Table]:
    """Print how well the default chain finds the buildings of simulated towns."""
    table = Table("towns", "town of 150 m, seed 3", "points", *RATES, "wrong, m²")
    for differs in TOWNS:
        cloud = run_stage(STAGES["simulate_town"], size=150.0, seed=3, **differs).cloud
        true = cloud.get("classification")
        cloud.set("classification", np.zeros(len(cloud), np.uint8))
        table.add(changes_cell(differs), len(cloud), *_found(cloud, true))
    return [table]


# Points per square meter and slope (°) of towns with false and true pits.
PITS = ((2.0, 3.0), (4.0, 20.0), (8.0, 3.0), (8.0, 30.0), (20.0, 3.0), (30.0, 15.0))


def pits() -> list[Table]:
    """Print which multipath points under the ground its filter takes for ground, and which it finds."""
    table = Table("pits", "density, slope", "multipath points", "called ground", "completeness", "correctness")
    for seed, (density, slope) in enumerate(PITS, start=1):
        town = with_pits(density=density, slope=slope, seed=seed)
        for stage in ("classify_ground_tin", "classify_multipath"):
            run_stage(STAGES[stage], town.cloud)
        found = town.cloud.get("classification")
        is_group, is_low = town.group > 0, found == PointClass.LOW_NOISE
        shares = (found[is_group] == PointClass.GROUND).mean(), is_low[is_group].mean(), is_group[is_low].mean()
        table.add(f"{density:g}, {slope:g}°", int(is_group.sum()), *(100 * share for share in shares))
    return [table]


def scenes() -> list[Table]:
    """Print how well the default chain does on scenes far from a usual town."""
    table = Table("scenes", "scene", "points per m²", *RATES, "wrong, m²", "ground missed, %")
    for name, make, misfit in SCENES:
        for density in (4.0, 12.0):
            made = scanned(make, misfit, density)
            returns = {name: made[name] for name in ("return_number", "number_of_returns")}
            cloud = create_cloud({"xyz": made["xyz"], **returns})
            rates = _found(cloud, made["classification"])
            missed = cloud.get("classification")[made["classification"] == PointClass.GROUND] != PointClass.GROUND
            table.add(name, int(density), *rates, 100 * float(missed.mean()))
    return [table]


def _found(cloud: Cloud, true: np.ndarray) -> tuple[float, float, float, float]:
    """Run the default chain; return completeness, correctness and F of its buildings (%), and what is wrong, m²."""
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    classes = cloud.get("classification")
    wrong = (classes == PointClass.BUILDING) & (true != PointClass.BUILDING)
    return *_rates(true, classes), area_of(cloud, wrong)


def _rates(true: np.ndarray, found: np.ndarray) -> tuple[float, float, float]:
    """Return completeness, correctness and F (%) of the points of buildings, of their true classes and those found."""
    is_building, is_found = true == PointClass.BUILDING, found == PointClass.BUILDING
    hit = int((is_building & is_found).sum())
    completeness, correctness = (100.0 * hit / max(int(of.sum()), 1) for of in (is_building, is_found))
    return completeness, correctness, 200.0 * hit / max(int(is_building.sum() + is_found.sum()), 1)


def villages() -> list[Table]:
    """Print how many buildings Map footprints finds, and how far its corners are from the true ones."""
    counts = ("points/m²", "noise, cm", "seed", "buildings", "found", "invented")
    table = Table("villages", *counts, "corners: median, cm", "mean, cm", "farthest, cm", texts=0)
    every = []
    for density, noise, seed in VILLAGES:
        arrays, true, old_map = village(density=density, noise=noise, seed=seed)
        made = mapped(arrays, old_map).layers["wall_footprints"]
        distances, used = corner_distances(made, true)
        corners = 100 * np.concatenate(distances)
        facts = (density, round(100 * noise), seed, len(true), len(distances), len(made) - len(used))
        table.add(*facts, *(float(measure(corners)) for measure in (np.median, np.mean, np.max)))
        every.append(corners)
    corners = np.concatenate(every)
    print(f"\n{len(corners)} corners: median {np.median(corners):.1f} cm, mean {corners.mean():.1f} cm,", end=" ")
    print(f"{100 * np.mean(corners < 8):.0f} % within 8 cm")
    return [table]


def places() -> list[Table]:
    """Print which houses Map footprints finds in places that are hard to map from photographs."""
    table = Table("places", "place", "houses", "found", "invented", "in others", "overlap, median, %", "of walls")
    for name, site, arrays in drone_places():
        made = mapped(arrays, None).layers["wall_footprints"]
        true, found = ([building.outline] for building in site.buildings), made.geometries
        true, found = as_polygons(list(true)), as_polygons(found)
        house, footprint, shared = overlaps(true, found, Monitor())
        area, own = np.array([b.area for b in site.buildings]), np.array(made.columns["area"])
        share = shared / (area[house] + own[footprint] - shared)
        best, used = np.zeros(len(area)), np.zeros(len(own))
        np.maximum.at(best, house, share)
        np.maximum.at(used, footprint, shared / own[footprint])
        # What lies in a hole of another footprint counts, too.
        whole = as_polygons([rings[:1] for rings in made.geometries])
        one, other, common = overlaps(whole, whole, Monitor())
        full = np.array([signed_area(rings[0]) for rings in made.geometries])
        nested = (one < other) & (common > 0.5 * np.minimum(full[one], full[other]))
        counts = int((best > 0.5).sum()), int((used < 0.3).sum()), int(nested.sum())
        table.add(name, len(area), *counts, 100 * float(np.median(best)), made.columns["source"].count("wall"))
    return [table]


def maps() -> list[Table]:
    """Print the report of Compare corners on old maps made of mapped footprints, and their known changes."""
    names = ("old_buildings", "found", "missed", "new", "corners", "matched", "mean_dx", "mean_dy", "mean", "deviation")
    table = Table("maps", "points/m², noise", "of", *names, texts=2)
    for density, noise, seed in VILLAGES:
        arrays, _, _ = village(density=density, noise=noise, seed=seed)
        mapped_ones = with_plain_corners(mapped(arrays, None).layers["wall_footprints"])
        old = aged(mapped_ones, shift=(0.4, -0.25), noise=0.15, missing=3, gone=2, annexes=3, seed=seed)
        moved = np.concatenate([moved for _, moved in old.corners.values()])
        length = np.hypot(*moved.T)
        known = {**old.counts, "mean_dx": moved[:, 0].mean(), "mean_dy": moved[:, 1].mean()}
        known.update({"mean": length.mean(), "deviation": length.std()})
        reported = run_stage(
            STAGES["compare_corners"], input_layers={"footprints": mapped_ones, "old_map": old.layer}
        ).report.values
        for called, values in (("true", known), ("reported", reported)):
            table.add(f"{density}, {100 * noise:.0f} cm", called, *(_plain(values[name]) for name in names))
    return [table]


def _plain(value: float) -> Any:
    """Return a count as it is, and a distance in centimeters."""
    return int(value) if float(value).is_integer() else 100 * float(value)


def confidence() -> list[Table]:
    """Print how many clusters of simulated towns are buildings, by how sure the default chain is of them."""
    table = Table("confidence", "confidence", "clusters", "are buildings, %")
    sure, true = (np.concatenate(parts) for parts in zip(*map(_judged, TOWNS)))
    for low in np.arange(10):
        chosen = np.minimum((sure * 10).astype(int), 9) == low
        table.add(f"{low / 10:.1f} to {low / 10 + 0.1:.1f}", int(chosen.sum()), 100 * float(true[chosen].mean()))
    return [table]


def _judged(differs: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return of each cluster of a town how sure it is a building, and whether it is."""
    cloud = run_stage(STAGES["simulate_town"], size=150.0, seed=3, **differs).cloud
    is_building = cloud.get("classification") == PointClass.BUILDING
    cloud.set("classification", np.zeros(len(cloud), np.uint8))
    for step in PIPELINES["detect_buildings"].steps:
        run_stage(step.stage, cloud, **step.tunables)
        if step.name == "buildings":
            break
    clustered = cloud.get("cluster_id") > 0
    _, first, cluster = np.unique(cloud.get("cluster_id")[clustered], return_index=True, return_inverse=True)
    true = np.bincount(cluster, is_building[clustered]) >= 0.5 * np.bincount(cluster)
    return cloud.get("confidence")[clustered][first], true


def paste(name: str, values: dict[str, str]) -> None:
    """Print a table of a test module."""
    print(f"\n{name} = {{")
    for key, value in values.items():
        print(f'    "{key}": {value},')
    print("}")


SIMULATED = {table.__name__: table for table in (towns, pits, scenes, villages, places, maps, confidence, drone)}
TABLES = {
    **{
        table.__name__: table
        for table in (
            buildings,
            classes,
            turned,
            harder,
            uneven,
            pieces,
            objects,
            footprints,
            outlines,
            ground,
            noise,
            noise_apart,
            photos,
            likeness,
            review,
        )
    },
    **SIMULATED,
}


def _without_clouds(wanted: list[str]) -> str:
    """Return that real clouds are missing, if tables need them; "" otherwise."""
    has_clouds = DATA.is_dir() or set(wanted) <= set(SIMULATED)
    return "" if has_clouds else f"no real clouds in {DATA}; LIDAR_BUILDINGS_DATA names another folder"


if __name__ == "__main__":
    print_tables(TABLES, __doc__, _without_clouds)
