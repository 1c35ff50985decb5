"""Files of other programs, each of which a reader here once took wrong, with the values that are right."""

import time

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.authority import authority_here
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.tests.real.clouds import DATA

CASES = DATA / "cases"
FOOT = 1200 / 3937
EXTENT = np.array([[500_005, 5_000_005], [500_020, 5_000_040]])


@pytest.fixture
def case():
    """Return the path of a case, or skip where there is none."""

    def found(name):
        if not (CASES / name).exists():
            pytest.skip(f"no {name} in {CASES}")
        return CASES / name

    return found


@pytest.mark.parametrize(
    ("name", "count"),
    [("copc_chunk_size_0.copc.laz", 30), ("copc_own.copc.laz", 2603), ("pointwise_version_1.laz", 11_781)],
)
def test_laz_of_other_programs_is_read(case, name, count):
    cloud = read_cloud(case(name))
    low, high = (bound * cloud.crs.factors - cloud.origin for bound in (cloud.header.low, cloud.header.high))
    assert len(cloud) == count
    np.testing.assert_allclose(cloud.get("xyz").min(axis=0), low, atol=1e-6)
    np.testing.assert_allclose(cloud.get("xyz").max(axis=0), high, atol=1e-6)


def test_a_part_of_a_copc_whose_chunks_state_no_size(case):
    assert len(read_cloud(case("copc_own.copc.laz"), box=EXTENT)) == 1011


def test_bounds_of_zero_are_measured(case):
    assert len(read_cloud(case("E_bbox0.las"), box=EXTENT)) == 1011


def test_two_lists_of_extra_bytes_become_one(case, tmp_path, laspy):
    cloud = read_cloud(case("two_extra_bytes_records.laz"))
    cloud.set("cluster_id", np.arange(len(cloud)))
    write_cloud(cloud, tmp_path / "a.las")
    again = laspy.read(tmp_path / "a.las")
    assert list(again.point_format.extra_dimension_names) == ["Deviation", "confidence", "ClusterID"]
    for number, name in enumerate(("Deviation", "confidence")):
        np.testing.assert_array_equal(again[name], cloud.points[f"extra{number}"])


@pytest.mark.parametrize(
    "name", ["forest_megaplot_e.laz", pytest.param("forest_megaplot_e_hills.laz", marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("keep", [pytest.param(1.0, marks=pytest.mark.slow), 0.5])
def test_a_forest_has_no_buildings(case, name, keep):
    """About 6,000 m² of crowns were called buildings in both."""
    cloud = read_cloud(case(name))
    cloud = cloud.take(np.flatnonzero(np.random.default_rng(0).random(len(cloud)) < keep))
    run_pipeline(PIPELINES["detect_buildings"], cloud, wanted=("output",))
    building = cloud.get("xyz")[cloud.get("classification") == 6, :2]
    assert len(np.unique(np.floor(building), axis=0)) <= 20


def test_withheld_points_are_counted(case):
    monitor = Monitor()
    run_stage(STAGES["filter_points"], read_cloud(case("D1_flags.las")), monitor=monitor)
    assert "109 withheld points are left out." in monitor.infos


@pytest.mark.parametrize(
    ("name", "plane", "horizontal", "vertical"),
    [
        ("A1_utm15_vftus.las", "EPSG:26915", 1, FOOT),
        ("K_wkt_ellips_ft.las", "EPSG:26915", 1, FOOT),
        ("K_wkt2_3d.las", "EPSG:32615", 1, 1),
        ("pointwise_version_1.laz", "EPSG:2271", FOOT, FOOT),
        ("K_wm3857.las", "EPSG:3857", 1 / 1.5838, 1),
    ],
)
def test_coordinate_systems_have_a_plane_and_units(case, name, plane, horizontal, vertical):
    if authority_here() is None:
        pytest.skip("nothing looks up systems")
    crs = read_cloud(case(name)).crs
    found = crs.horizontal, crs.vertical
    assert found == pytest.approx((horizontal, vertical), rel=1e-6)
    # Without QGIS, GeoKeys that contradict their code are no system.
    assert crs.plane == plane or (name.startswith("pointwise") and crs.warnings)


def test_one_plane_written_in_six_ways_is_one(case, tmp_path):
    names = ["C_w_geokeys", "C_e_plain", "C_e_comp", "C_e_noauth", "C_e_prec", "C_e_none"]
    monitor = Monitor()
    survey = open_survey([case(f"{name}.las") for name in names], monitor=monitor)
    assert survey.crs.identity == "EPSG:25832"
    said = [one for one in monitor.warnings if "coordinate reference system" in one]
    assert said == [
        "C_e_none.las names no coordinate reference system; it is taken to be in the system of C_w_geokeys.las."
    ]


def test_lengths_in_web_mercator_are_those_on_the_ground(case):
    sides = [np.ptp(read_cloud(case(name)).get("xyz"), axis=0) for name in ("town.laz", "town_3857.laz")]
    # The two axes are not quite parallel.
    assert sides[1] == pytest.approx(sides[0], rel=0.02)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("R_tiny20.laz", "it covers less than 900 m²"),
        ("R_roofsonly.laz", "its points lie in islands with nothing around"),
        ("terrestrial_wide.las", "points per m² where it is thin"),
    ],
)
def test_what_a_cloud_can_hardly_show_is_said(case, name, why):
    """Of roofs alone, half was found without a word; the wide scan took 40 s of processor time."""
    monitor, cloud = Monitor(), read_cloud(case(name))
    began = time.process_time()
    results = run_pipeline(PIPELINES["detect_buildings"], cloud, monitor=monitor)
    assert time.process_time() - began < 8.0
    (said,) = (one for one in monitor.warnings if "can hardly show buildings" in one)
    assert why in said
    assert said in results.reports["report"].html
    assert results.reports["report"].values["doubtful"] == results.reports["report"].values["buildings"]
