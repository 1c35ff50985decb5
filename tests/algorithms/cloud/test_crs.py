"""Coordinate reference systems of clouds: which text counts, one plane however it is written, meters on the ground."""

from __future__ import annotations

import json
import struct
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import authority
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import (
    NO_CRS,
    Crs,
    common_crs,
    crs_of_text,
    crs_records,
    header_with_crs,
    read_crs,
    stated_wkt,
)
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.header import WKT_BIT, Header, Vlr, read_header
from lidar_buildings.algorithms.cloud.point_formats import Layout
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.algorithms.cloud.crs_texts import (
    COMPOUND_FEET,
    ETRS_32,
    IN_SIX_WAYS,
    MERCATOR,
    THREE_AXES,
    geokeys,
)

SURVEY_FOOT = 1200 / 3937


class OneAuthority:
    """Knows EPSG:25832 by its code and its name, and EPSG:2263 in feet."""

    def define(self, text, keys=()):
        feet = text == "EPSG:2263"
        if not feet and "25832" not in text and "zone 32N" not in text:
            return None
        wkt = ETRS_32.replace("25832", "2263").replace('"metre",1', f'"US survey foot",{SURVEY_FOOT!r}')
        code = "EPSG:2263" if feet else "EPSG:25832"
        return authority.Definition(wkt if feet else ETRS_32, code, code, code)

    def to_radians(self, plane, positions):
        return np.full(np.shape(positions), np.inf), None


class Stretched(OneAuthority):
    """A map that stretches lengths to east and north by the numbers, made for an area."""

    def __init__(self, east, north, area=None):
        self.scale, self.area = np.array([east, north]), area

    def to_radians(self, plane, positions):
        return np.asarray(positions) / self.scale / 6378137.0 / [1.0, 1 - 0.00669438], self.area


def wkt_header(text, point_format=6, **more):
    return Header(vlrs=[Vlr(b"LASF_Projection", 2112, text.encode() + b"\0")], layout=Layout(point_format), **more)


@pytest.fixture(params=["pyproj", "own"])
def known(request):
    """An authority that knows the plane: pyproj where it is, and one of the test's own."""
    if request.param == "own":
        return OneAuthority()
    pytest.importorskip("pyproj")
    return authority._Pyproj(__import__("pyproj"))


@pytest.fixture
def pyproj():
    with authority._quietly():
        return authority._Pyproj(pytest.importorskip("pyproj"))


def test_pyproj_without_its_data_is_as_none(monkeypatch):
    """In a virtual environment of Debian, pyproj does not find the data of PROJ and raises with every system."""
    pyproj = pytest.importorskip("pyproj")
    monkeypatch.setattr(authority, "_of_host", [])
    monkeypatch.setattr(authority, "_pyproj", authority._pyproj.__wrapped__)
    assert authority.authority_here() is not None

    def no_data(code):
        raise pyproj.exceptions.DataDirError("Valid PROJ data directory not found.")

    monkeypatch.setattr(pyproj.CRS, "from_epsg", no_data)
    assert authority.authority_here() is None


@pytest.mark.parametrize("point_format", [1, 6])
def test_wkt_counts_before_geokeys_but_in_old_formats_that_name_these(point_format):
    header = replace(geokeys((1024, 1), (3072, 2263), (3076, 9003)), layout=Layout(point_format))
    header.vlrs.append(Vlr(b"LASF_Projection", 2112, ETRS_32.encode() + b"\0"))
    found = read_crs(header, OneAuthority())
    assert found.identity == ("EPSG:2263" if point_format == 1 else "EPSG:25832")
    assert found.horizontal == pytest.approx(SURVEY_FOOT if point_format == 1 else 1)
    header.encoding = WKT_BIT
    assert read_crs(header, OneAuthority()).identity == "EPSG:25832"


def test_one_plane_is_one_however_it_is_written(known):
    found = [crs_of_text(text, known).identity for text in IN_SIX_WAYS]
    found.append(read_crs(geokeys((1024, 1), (3072, 25832), (3076, 9001)), known).identity)
    assert set(found) == {"EPSG:25832"}


def test_the_codes_of_one_plane_are_one(pyproj):
    assert crs_of_text("EPSG:3067", pyproj).identity == crs_of_text("EPSG:25835", pyproj).identity
    assert crs_of_text("ESRI:102100", pyproj).identity == "EPSG:3857"
    assert crs_of_text("EPSG:25832", pyproj).identity != crs_of_text("EPSG:32632", pyproj).identity


def test_layers_get_the_horizontal_part(pyproj):
    compound, flat = crs_of_text(COMPOUND_FEET, pyproj), crs_of_text(THREE_AXES, pyproj)
    assert (compound.plane, compound.vertical) == ("EPSG:26915", pytest.approx(SURVEY_FOOT))
    assert (flat.plane, flat.vertical) == ("EPSG:32615", 1)


def test_without_an_authority_units_and_text_are_known(monkeypatch):
    monkeypatch.setattr("lidar_buildings.algorithms.cloud.crs.authority_here", lambda: None)
    found = read_crs(wkt_header(COMPOUND_FEET))
    assert (found.horizontal, found.vertical) == (1, pytest.approx(SURVEY_FOOT))
    assert found.plane == ""
    assert read_crs(wkt_header(ETRS_32)).identity == "EPSG:25832"
    named = read_crs(geokeys((1024, 1), (3072, 2263)))
    assert (named.identity, named.horizontal) == ("EPSG:2263", 1)
    assert named.warnings == ("The file gives EPSG:2263 and no unit; its coordinates are taken as meters.",)


def test_a_code_without_unit_is_looked_up():
    found = read_crs(geokeys((1024, 1), (3072, 2263)), OneAuthority())
    assert (found.horizontal, found.vertical, found.warnings) == (pytest.approx(SURVEY_FOOT),) * 2 + ((),)


def test_a_code_whose_unit_is_another_is_not_taken_for_the_system():
    """Pennsylvania's clouds have EPSG:32128, which is in meters, and US survey feet."""
    found = read_crs(geokeys((1024, 1), (3072, 25832), (3076, 9003)), OneAuthority())
    assert found.horizontal == pytest.approx(SURVEY_FOOT)
    assert (found.plane, found.wkt) == ("", "")
    assert "results name none" in found.warnings[0]


def test_a_datum_in_place_of_a_system_of_heights_leaves_the_plane_and_the_unit(known):
    """Key 4096 of many clouds of the USGS is 5103, the datum NAVD88."""
    found = read_crs(geokeys((1024, 1), (3072, 25832), (3076, 9001), (4096, 5103), (4099, 9003)), known)
    assert (found.plane, found.vertical) == ("EPSG:25832", pytest.approx(SURVEY_FOOT))
    again = crs_of_text(found.wkt, known)
    assert (again.plane, again.vertical) == ("EPSG:25832", pytest.approx(SURVEY_FOOT))


def test_what_geokeys_do_not_say_is_said():
    assert read_crs(Header()).warnings == (NO_CRS,)
    only_unit = read_crs(geokeys((1024, 1), (3076, 9003)))
    assert (only_unit.horizontal, only_unit.identity) == (SURVEY_FOOT, "")
    assert "names a unit and no coordinate reference system" in only_unit.warnings[0]
    own = read_crs(geokeys((1024, 1), (3072, 32767), (3075, 1), (3076, 9001)), OneAuthority())
    assert "has no definition that can be written" in own.warnings[0]
    assert own.identity


def test_wkt_without_a_definition_is_said_to_have_none(known):
    found = crs_of_text('PROJCS["a",UNIT["metre",1]]', known)
    assert "has no definition that can be written" in found.warnings[0]
    assert found.identity == 'PROJCS["a",UNIT["metre",1]]'


@pytest.mark.parametrize("text", ["http://127.0.0.1/x.wkt", "/etc/passwd", "+init=/etc/passwd", "C:x", "file.wkt"])
def test_addresses_and_names_of_files_are_never_looked_up(text):
    """GDAL opens them where it is asked for the system of any text."""

    class Nosy(OneAuthority):
        def define(self, text, keys=()):
            raise AssertionError(text)

    assert "can't be read" in read_crs(wkt_header(text), Nosy()).warnings[0]
    assert read_crs(Header(named=text), Nosy()).identity == ""


def test_wkt_that_can_not_be_read_gives_way_to_what_else_is_there():
    header = geokeys((1024, 1), (3072, 25832), (3076, 9001))
    header.vlrs.append(Vlr(b"LASF_Projection", 2112, b'PROJCS["a",UNIT["metre",1]]]\0'))
    header.encoding = WKT_BIT
    found = read_crs(header, OneAuthority())
    assert found.identity == "EPSG:25832"
    assert found.warnings == (
        'The WKT of the file can\'t be read (PROJCS["a",UNIT["metre",1]]]); assign its CRS again.',
    )


@pytest.mark.parametrize(
    "codes",
    [
        {"proj:epsg": 25832},
        {"proj:code": "EPSG:25832"},
        {"proj:wkt2": ETRS_32},
        # What no record of a file can hold gives way to the code: longer than 65,535 bytes, half of a character.
        {"proj:wkt2": ETRS_32 + " " * 65536, "proj:epsg": 25832},
        {"proj:wkt2": ETRS_32 + "\ud800", "proj:epsg": 25832},
    ],
    ids=["epsg", "code", "wkt2", "long", "half"],
)
def test_a_catalog_counts_where_its_tiles_say_nothing(make_las, tmp_path, codes):
    make_las("a.las")
    feature = {"properties": codes, "assets": {"data": {"href": "./a.las", "roles": ["data"]}}}
    (tmp_path / "all.vpc").write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))

    def read(header):
        return read_crs(header, OneAuthority(), given="EPSG:2263")

    cloud = read_cloud(tmp_path / "all.vpc", read=read)
    assert cloud.crs.identity == "EPSG:25832"
    write_cloud(cloud, tmp_path / "b.las")
    assert read_cloud(tmp_path / "b.las", read=read).crs.identity == "EPSG:25832"
    assert read_cloud(tmp_path / "a.las", read=read).crs.identity == "EPSG:2263"


@pytest.mark.parametrize(("scale", "ground"), [(1.0004, 1.0), (1.002, 1.0), (1.6, 1.6), (0.8, 0.8)])
def test_lengths_are_those_on_the_ground_where_the_map_has_others(scale, ground):
    header = wkt_header(ETRS_32, low=np.array([500, -900, 0.0]), high=np.array([700, 900, 9.0]))
    found = read_crs(header, Stretched(scale, scale))
    assert found.horizontal == pytest.approx(1 / ground, abs=1e-9)
    assert found.vertical == 1
    assert len(found.warnings) == (abs(scale - 1) > 0.001)
    assert all(f"{scale:.4f} m on the map of EPSG:25832" in one for one in found.warnings)


def test_maps_that_stretch_lengths_by_direction_are_refused_or_named():
    header = wkt_header(ETRS_32, low=np.array([500, -900, 0.0]), high=np.array([700, 900, 9.0]))
    with pytest.raises(ValueError, match="stretches lengths by direction"):
        read_crs(header, Stretched(1.5, 1.0))
    (warned,) = read_crs(header, Stretched(1.02, 1 / 1.02)).warnings
    assert "0.9804 to 1.0200 by direction" in warned


def test_outside_of_the_area_that_a_map_is_made_for_its_own_lengths_count():
    """More clouds name a wrong system than lie far outside of the right one."""
    header = wkt_header(ETRS_32, low=np.array([500, -900, 0.0]), high=np.array([700, 900, 9.0]))
    found = read_crs(header, Stretched(1.6, 1.2, authority.Area(6, 38, 12, 84)))
    assert found.horizontal == 1
    assert "which is not made for this place" in found.warnings[0]
    inside = read_crs(header, Stretched(1.6, 1.6, authority.Area(170, -1, 12, 84)))
    assert inside.horizontal == pytest.approx(1 / 1.6)


def test_web_mercator_measures_the_ground(pyproj):
    """A square of 10 m at 52 degrees north is one of 16.2 m on the map."""
    header = wkt_header(MERCATOR, low=np.array([5e5, 6.8e6, 0]), high=np.array([5.01e5, 6.801e6, 9]))
    found = read_crs(header, pyproj)
    latitude = 2 * np.arctan(np.exp(6.8005e6 / 6378137)) - np.pi / 2
    assert 1 / found.horizontal == pytest.approx(1 / np.cos(latitude), rel=0.003)
    assert read_crs(replace(header, low=header.low * [1, 0, 1], high=header.high * [1, 0, 1]), pyproj).horizontal == 1


def test_clouds_are_in_one_system():
    named, other, none = Crs(identity="a", code="A:1"), Crs(identity="b", code="B:2"), Crs()
    monitor = Monitor()
    assert common_crs([none, named, named], "xyz", monitor) is named
    assert monitor.warnings == ["x names no coordinate reference system; it is taken to be in the system of y."]
    assert common_crs([none, none], "xy", monitor) is none
    with pytest.raises(ValueError, match=r"^x and y have different coordinate reference systems \(A:1, B:2\)"):
        common_crs([named, other], "xy", monitor)
    feet = replace(named, vertical=0.3048)
    with pytest.raises(ValueError, match=r"A:1 with heights in units of 1 m, A:1 with heights in units of 0.3048 m"):
        common_crs([named, feet], "xy", monitor)
    assert common_crs([named, feet], "xy", monitor, whole=False) is named


@pytest.mark.parametrize("name", ["a.copc.laz", "a.las"])
def test_geokeys_become_wkt_where_formats_ask_for_it(make_las, tmp_path, name):
    keys = geokeys((1024, 1), (3072, 25832), (3076, 9001), (4099, 9003)).vlrs[0]
    vlr = struct.pack("<2s16sHH32s", b"", keys.user_id, keys.record_id, len(keys), b"") + keys.data
    path = make_las(point_format=1, minor=2, vlrs=(vlr,))
    cloud = read_cloud(path, read=lambda header: read_crs(header, OneAuthority()))
    if name == "a.las":
        cloud.set("classification", np.full(len(cloud), 40, np.uint8))
    write_cloud(cloud, tmp_path / name)
    header = read_header(tmp_path / name)
    assert not header.layout.is_old
    assert header.encoding & WKT_BIT
    found = crs_of_text(header.find((b"LASF_Projection", 2112)).data.rstrip(b"\0").decode(), OneAuthority())
    assert (found.identity, found.vertical) == ("EPSG:25832", pytest.approx(SURVEY_FOOT))


def test_files_keep_the_text_that_they_have():
    header = wkt_header(COMPOUND_FEET, encoding=0)
    assert header_with_crs(header, read_crs(header)) == header
    both = wkt_header(ETRS_32, encoding=0)
    both.vlrs += geokeys((1024, 1), (3072, 2263)).vlrs
    made = header_with_crs(both, read_crs(both, OneAuthority()))
    # As dictionaries: from Python 3.13 on, data classes with arrays can't be compared.
    assert vars(made) == vars(replace(both, encoding=WKT_BIT))


def test_a_cloud_that_gets_a_system_has_its_units_and_keeps_what_was_set():
    cloud = create_cloud({"xyz": np.array([[0, 0, 0], [10.0, 20, 30]])})
    cloud.set("height_above_ground", np.array([1, 2], "f4"))
    feet = cloud.in_crs(crs_of_text("EPSG:2263", OneAuthority()))
    assert np.ptp(feet.get("xyz"), axis=0) == pytest.approx(np.array([10, 20, 30]) * SURVEY_FOOT)
    assert feet.get("height_above_ground").tolist() == [1, 2]
    assert cloud.in_crs(cloud.crs) is cloud


def test_a_crs_that_can_not_be_stored_is_refused():
    for text in ("EPSG:28992+5709", "here", "EPSG:0", "ESRI:102100"):
        with pytest.raises(ValueError, match="can't be stored"):
            crs_records(text)


@pytest.mark.parametrize(("length", "is_read"), [(60_000, True), (70_000, False)])
def test_wkt_that_no_vlr_holds_is_damage(length, is_read):
    wkt = f'LOCAL_CS["{"a" * length}"]'
    header = Header(evlrs=[Vlr(b"LASF_Projection", 2112, wkt.encode())])
    assert stated_wkt(header) == (wkt if is_read else "")


def test_geokeys_with_the_code_of_heights_in_place_of_a_plane_are_read():
    class OfHeights(OneAuthority):
        def define(self, text, keys=()):
            return authority.Definition('VERT_CS["heights",UNIT["metre",1]]', "", "EPSG:5703", "")

    header = Header(vlrs=crs_records("EPSG:5703")[0], layout=Layout(3))
    crs = read_crs(header, OfHeights())
    assert (crs.wkt, crs.factors.tolist()) == ("", [1, 1, 1])
