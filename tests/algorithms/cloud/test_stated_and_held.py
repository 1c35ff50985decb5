"""What a header states is held against what the file holds: bounds, lists of extra bytes, indexes of points."""

import struct

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import count_points, read_cloud, read_extent, write_cloud
from lidar_buildings.algorithms.cloud.merging import merge_records
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.tests.las_files import descriptor, evlr, made_las, random_records, vlr

# xmax, xmin, ymax, ymin, zmax, zmin in a header.
BOUNDS_AT, BOUNDS = 179, struct.Struct("<6d")
TRUE = (600_099.0, 600_001.0, 5_000_099.0, 5_000_001.0, 9.0, 1.0)


def grid(n=100):
    """A cloud of n x n points, 1 m apart, that begins at 600 000, 5 000 000."""
    at = np.arange(n, dtype=float)
    x, y = (axis.ravel() for axis in np.meshgrid(at, at))
    return create_cloud({"xyz": np.column_stack([x + 600_000, y + 5_000_000, x % 10])})


def with_bounds(path, bounds):
    raw = bytearray(path.read_bytes())
    BOUNDS.pack_into(raw, BOUNDS_AT, *bounds)
    path.write_bytes(raw)
    return path


@pytest.mark.parametrize("suffix", [".las", ".laz", ".copc.laz"])
@pytest.mark.parametrize(
    "bounds",
    [
        (0.0,) * 6,
        (np.nan,) * 6,
        (-np.inf, np.inf) * 3,
        (-1e300, 1e300) * 3,
        (1e300, -1e300) * 3,
        (600_000.0, 600_099.0, 5_000_000.0, 5_000_099.0, 0.0, 9.0),
        (600_099.0, 0.0, 5_000_099.0, 0.0, 9.0, 0.0),
        (599_000.0, 598_000.0, 5_000_099.0, 5_000_000.0, 9.0, 0.0),
    ],
    ids=["zeros", "nan", "infinite", "never set", "wide", "exchanged", "from zero", "elsewhere"],
)
def test_bounds_that_can_not_be_are_measured_wherever_they_are_used(tmp_path, suffix, bounds):
    """The survey had no points, and a clip kept none."""
    path = tmp_path / f"a{suffix}"
    write_cloud(grid(), path)
    with_bounds(path, bounds)
    low, high, _ = read_extent(path)
    np.testing.assert_allclose([low, high], [[600_000, 5_000_000, 0], [600_099, 5_000_099, 9]], atol=1e-6)
    box = np.array([[600_010, 5_000_010], [600_019.5, 5_000_029.5]])
    assert len(read_cloud(path, box=box)) == 10 * 20
    assert 150 < count_points(path, box) < 250
    monitor = Monitor()
    survey = open_survey([path], monitor=monitor)
    assert len(survey.window(box).cloud) == 10 * 20
    assert f"The bounds in the header of a{suffix} don't fit the points" in " ".join(monitor.warnings)


def test_bounds_that_can_be_stay_as_they_are(tmp_path):
    """Bounds may be rounded, and wider than the points: of a tile, for example."""
    path = tmp_path / "a.las"
    write_cloud(grid(), path)
    stated = (600_200.0, 599_999.999, 5_000_200.0, 4_999_900.0, 9.0, 0.001)
    with_bounds(path, stated)
    low, high, _ = read_extent(path)
    np.testing.assert_array_equal(np.column_stack([high, low]).ravel(), stated)
    monitor = Monitor()
    open_survey([path], monitor=monitor)
    assert not [one for one in monitor.warnings if "bounds" in one]


def test_a_file_that_was_mended_is_measured_again(tmp_path):
    path = tmp_path / "a.las"
    write_cloud(grid(), path)
    with_bounds(path, (0.0,) * 6)
    assert read_extent(path)[0][0] == 600_000
    write_cloud(grid(50), path)
    assert read_extent(path)[1][0] == 600_049


TWO_LISTS = (
    vlr("LASF_Spec", 4, descriptor("Deviation", 3, text="of the pulse")),
    vlr("someone", 5, b"between"),
    vlr("LASF_Spec", 4, descriptor("confidence", 1, text="of another program") + b"rest"),
)


def test_all_lists_of_extra_bytes_are_one(make_las, take_apart, tmp_path, laspy):
    """The second list was forgotten, and a third one written that described more than the points hold."""
    records = random_records(6, 33, 100)
    path = make_las(records=records, extra=3, vlrs=TWO_LISTS)
    cloud = read_cloud(path)
    np.testing.assert_array_equal(cloud.named("Deviation"), records[:, 30:32].copy().view("<u2")[:, 0])
    np.testing.assert_array_equal(cloud.named("confidence"), records[:, 32])
    cloud.set("confidence", np.full(100, 0.5))
    write_cloud(cloud, tmp_path / "b.las")
    assert [record[2:18].rstrip(b"\0") for record in take_apart(tmp_path / "b.las")["vlrs"]] == [
        b"LASF_Spec",
        b"someone",
    ]
    again = laspy.read(tmp_path / "b.las")
    assert list(again.point_format.extra_dimension_names) == ["Deviation", "confidence", "Confidence"]
    np.testing.assert_array_equal(again["confidence"], records[:, 32])
    np.testing.assert_array_equal(again["Confidence"], 0.5)


@pytest.mark.parametrize("first", ["vlr", "evlr"])
def test_lists_may_lie_behind_the_points(make_las, first):
    one, two = descriptor("a", 3), descriptor("b", 1)
    lists = ((vlr("LASF_Spec", 4, one),), (evlr("LASF_Spec", 4, two),))
    if first == "evlr":
        lists = ((), (evlr("LASF_Spec", 4, one), evlr("LASF_Spec", 4, two)))
    cloud = read_cloud(make_las(extra=3, vlrs=lists[0], evlrs=lists[1]))
    assert [field.name for field in cloud.header.layout.extras] == ["a", "b"]
    assert [len(record) for record in cloud.header.find_all((b"LASF_Spec", 4))] == [384]


LAX = evlr("LAStools", 30, b"LASX index")


def keys(cloud):
    return [record.key for record in (*cloud.header.vlrs, *cloud.header.evlrs)]


def test_an_index_of_points_goes_where_points_do_not_stay(make_las, tmp_path):
    """LAStools would look for the points of a clipped cloud at their old positions."""
    path = make_las(evlrs=(LAX, evlr("someone", 7, b"kept")), vlrs=(vlr("LAStools", 30, b"LASX index"),))
    cloud = read_cloud(path)
    lax, kept = (b"LAStools", 30), (b"someone", 7)
    assert keys(cloud) == [lax, lax, kept]
    moved = cloud.copy()
    moved.set("xyz", cloud.get("xyz") + 1.0)
    low, high, _ = read_extent(path)
    clipped = read_cloud(path, box=np.array([low[:2], high[:2]]))
    for one in (cloud.take(np.arange(50)), moved, merge_records([cloud, cloud], None), clipped):
        assert keys(one) == [kept]
    assert keys(open_survey([path]).window(np.array([low[:2], high[:2] + 1])).cloud) == [kept]
    write_cloud(cloud, tmp_path / "a.copc.laz")
    assert lax not in keys(read_cloud(tmp_path / "a.copc.laz"))
    assert keys(cloud) == [lax, lax, kept]


@pytest.mark.parametrize(
    ("field", "is_foreign"),
    [
        (descriptor("ClusterID", 6, text="cluster; 0 if unassigned"), False),
        (descriptor("ClusterID", 6, text="cluster, 0 is none"), False),
        (descriptor("ClusterID", 6, text="group of a crew"), True),
        (descriptor("ClusterID", 6), True),
        (descriptor("ClusterID", 5, text="cluster; 0 if unassigned"), True),
        (descriptor("Confidence", 9, text="percent"), True),
        (descriptor("Mine", 6), False),
    ],
)
def test_what_is_replaced_of_other_programs_is_said(tmp_path, field, is_foreign):
    """Extra bytes that another program named as this one does were replaced without a word."""
    path = tmp_path / "a.las"
    records = random_records(6, 34, 400)
    records[:, 30:] = np.full((400, 1), 7, "<i4").view(np.uint8)
    records[:, 15], records[:, 16] = 0, 6
    path.write_bytes(made_las(records=records, extra=4, vlrs=(vlr("LASF_Spec", 4, field),)))
    monitor = Monitor()
    run_stage(STAGES["segment_clusters"], read_cloud(path), monitor=monitor)
    assert len([one for one in monitor.warnings if "of another program" in one]) == is_foreign


def test_withheld_points_that_are_left_out_are_counted():
    """*Filter points* dropped them without a word."""
    cloud = grid(20)
    flags = np.zeros(400, bool)
    flags[:7] = True
    cloud.header.layout.put(cloud.points, "withheld", flags)
    monitor = Monitor()
    assert len(run_stage(STAGES["filter_points"], cloud, monitor=monitor).cloud) == 393
    assert "7 withheld points are left out." in monitor.infos
    merging = Monitor()
    run_stage(STAGES["merge_clouds"], [cloud, grid(20)], monitor=merging)
    assert "7 withheld points are left out." in merging.infos
    monitor = Monitor()
    run_stage(STAGES["compute_features"], cloud, monitor=monitor)
    assert not [one for one in monitor.infos if "withheld" in one]
