"""Units from WKT 1, WKT 2 and GeoKeys."""

import struct

import pytest

from lidar_buildings.algorithms.cloud.header import Header, Vlr
from lidar_buildings.algorithms.cloud.units import NO_CRS, crs_identity, crs_records, units_of, units_of_wkt, wkt_of

FOOT, SURVEY_FOOT = 0.3048, 1200 / 3937
GEOGCS = (
    'GEOGCS["GRS 1980",DATUM["D",SPHEROID["S",6378137,298.25]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]'
)
PARAMETERS = 'PROJECTION["Mercator"],PARAMETER["false_easting",500000]'
BASE = (
    'BASEGEOGCRS["NAD83",DATUM["N",ELLIPSOID["GRS 1980",6378137,298.257222101,LENGTHUNIT["metre",1]]],'
    'PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]]],CONVERSION["c",METHOD["m"],'
    'PARAMETER["False easting",0,LENGTHUNIT["metre",1],ID["EPSG",8806]]]'
)
US = SURVEY_FOOT
M2 = 'LENGTHUNIT["metre",1]'
FT2 = 'LENGTHUNIT["US survey foot",0.3048006096012192]'
CS2 = f"{BASE},CS[Cartesian,2]"
BY_AXIS = f'AXIS["e",east,ORDER[1],{FT2}],AXIS["n",north,ORDER[2],{FT2}]'
UP2 = f'VERTCRS["h",VDATUM["d"],CS[vertical,1],AXIS["up",up],{FT2}]'
UP1 = 'VERT_CS["h",VERT_DATUM["d",2005],UNIT["foot",0.3048],AXIS["Up",UP]]'


@pytest.mark.parametrize(
    ("wkt", "horizontal", "vertical"),
    [
        (f'PROJCS["UTM",{GEOGCS},{PARAMETERS},UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST]]', 1, 1),
        (f'PROJCS["SP",{GEOGCS},{PARAMETERS},UNIT["US survey foot",0.3048006096012192]]', US, US),
        (f'PROJCS["SP",{GEOGCS},{PARAMETERS},UNIT["foot",0.3048]]', FOOT, FOOT),
        (f'PROJCS["says ""ft"", [really]",{GEOGCS},UNIT["foot",0.3048]]', FOOT, FOOT),
        (f'projcs[ "SP" , {GEOGCS} ,\n unit( "Foot_US" , .3048006096012192 ) ]', US, US),
        (f'COMPD_CS["b",PROJCS["SP",{GEOGCS},UNIT["metre",1]],{UP1}]', 1, FOOT),
        (f'COMPD_CS["b",PROJCS["SP",{GEOGCS},UNIT["foot",0.3048]],VERT_CS["h",UNIT["metre",1.0]]]', FOOT, 1),
        (f'PROJCS["esri",{GEOGCS},UNIT["Meter",1.0]],VERTCS["h",UNIT["Foot",0.3048]]', 1, FOOT),
        (f'PROJCRS["SP",{CS2},AXIS["easting",east],AXIS["northing",north],{FT2}]', US, US),
        (f'PROJCRS["SP",{CS2},{BY_AXIS}]', US, US),
        (f'PROJCRS["3D",{BASE},CS[Cartesian,3],{BY_AXIS},AXIS["h",up,{M2}]]', US, 1),
        (f'COMPOUNDCRS["b",PROJCRS["SP",{CS2},{M2}],{UP2}]', 1, US),
        (f'BOUNDCRS[SOURCECRS[PROJCRS["SP",{CS2},{FT2}]],TARGETCRS[GEOGCRS["WGS 84"]]]', US, US),
        ('LOCAL_CS["site",UNIT["metre",1]]', 1, 1),
        ('ENGCRS["site",EDATUM["d"],CS[Cartesian,2],LENGTHUNIT["foot",0.3048]]', FOOT, FOOT),
        (f'PROJCS["no unit",{GEOGCS},{PARAMETERS}]', 1, 1),
    ],
)
def test_wkt(wkt, horizontal, vertical):
    units = units_of_wkt(wkt)
    assert units.horizontal == pytest.approx(horizontal, rel=1e-9)
    assert units.vertical == pytest.approx(vertical, rel=1e-9)
    assert units.warning == ""


@pytest.mark.parametrize(
    ("wkt", "what"),
    [
        (GEOGCS, r"degrees \(GRS 1980\)"),
        (
            'GEOGCRS["WGS 84",DATUM["W"],CS[ellipsoidal,2],AXIS["lat",north],ANGLEUNIT["degree",0.0174]]',
            r"degrees \(WGS 84\)",
        ),
        (f'COMPD_CS["b",{GEOGCS},VERT_CS["h",UNIT["metre",1]]]', "degrees"),
        ('GEODCRS["WGS 84",DATUM["W"],CS[Cartesian,3],LENGTHUNIT["metre",1]]', "geocentric"),
        ('GEOCCS["ECEF",DATUM["W"],UNIT["metre",1]]', "geocentric"),
    ],
)
def test_what_is_no_plane_is_refused(wkt, what):
    with pytest.raises(ValueError, match=f"coordinates are {what}.*reproject"):
        units_of_wkt(wkt)


@pytest.mark.parametrize(
    "text", ["", '"', "PROJCS", "PROJCS[", "]", "[[", "1,2,3", '"a"]', "A[" * 100, 'VERT_CS["h",UNIT["foot",0.3048]]']
)
def test_what_is_no_wkt_is_unknown(text):
    assert units_of_wkt(text).warning == NO_CRS


def geokeys(*pairs, doubles=()):
    numbers = [1, 1, 0, len(pairs)]
    for key, value in pairs:
        numbers += [key, 34736, 1, 0] if value == "double" else [key, 0, 1, value]
    records = [Vlr(b"LASF_Projection", 34735, struct.pack(f"<{len(numbers)}H", *numbers))]
    if doubles:
        records.append(Vlr(b"LASF_Projection", 34736, struct.pack(f"<{len(doubles)}d", *doubles)))
    return Header(vlrs=records, encoding=0)


@pytest.mark.parametrize(
    ("header", "horizontal", "vertical"),
    [
        (geokeys((1024, 1), (3072, 28992), (3076, 9001)), 1, 1),
        (geokeys((1024, 1), (3072, 2992), (3076, 9002)), FOOT, FOOT),
        (geokeys((1024, 1), (3072, 2264), (3076, 9003)), SURVEY_FOOT, SURVEY_FOOT),
        (geokeys((1024, 1), (3072, 26910), (3076, 9001), (4096, 5703), (4099, 9003)), 1, SURVEY_FOOT),
        (geokeys((1024, 1), (3076, 9003), (4099, 9001)), SURVEY_FOOT, 1),
        # Clarke's foot and yard, as the EPSG registry has them; the yard of Sears (9040) is 7 ppm longer.
        (geokeys((1024, 1), (3076, 9037), (4099, 9005)), 0.9143917962, 0.3047972654),
        (geokeys((1024, 1), (3072, 32767), (3076, 32767), (3077, "double"), doubles=(0.9144,)), 0.9144, 0.9144),
        (geokeys((1024, 1), (2048, 4269), (3072, 32767), (3076, 9001)), 1, 1),
    ],
)
def test_geokeys(header, horizontal, vertical):
    units = units_of(header)
    assert (units.horizontal, units.vertical, units.warning) == (pytest.approx(horizontal), pytest.approx(vertical), "")


def test_code_without_unit_is_looked_up_if_that_is_possible():
    header = geokeys((1024, 1), (3072, 2264))
    assert "EPSG:2264" in units_of(header).warning
    assert units_of(header).horizontal == 1
    asked = []

    def crs_units(code):
        asked.append(code)
        return (SURVEY_FOOT, SURVEY_FOOT, False)

    units = units_of(header, crs_units)
    assert (units.horizontal, units.vertical, units.warning, asked) == (SURVEY_FOOT, SURVEY_FOOT, "", [2264])
    assert "EPSG:2264" in units_of(header, lambda code: None).warning


def test_code_of_the_heights_is_looked_up_too():
    units = units_of(
        geokeys((1024, 1), (3072, 26910), (3076, 9001), (4096, 6360)),
        {26910: (1, 1, False), 6360: (1, FOOT, False)}.get,
    )
    assert (units.horizontal, units.vertical) == (1, FOOT)


@pytest.mark.parametrize("keys", [((1024, 2), (2048, 4326)), ((2048, 4326),), ((1024, 3), (2048, 4978))])
def test_geographic_geokeys_are_refused(keys):
    with pytest.raises(ValueError, match=r"degrees|geocentric"):
        units_of(geokeys(*keys))


def test_projected_code_that_turns_out_geographic_is_refused():
    with pytest.raises(ValueError, match="degrees"):
        units_of(geokeys((3072, 4326)), lambda code: (1.0, 1.0, True))


def test_nothing_is_meters_with_a_warning():
    assert units_of(Header()).warning == NO_CRS
    assert units_of(geokeys()).warning == NO_CRS


def test_bit_of_the_header_decides_between_wkt_and_geokeys():
    header = geokeys((1024, 1), (3072, 2264), (3076, 9003))
    header.vlrs.append(Vlr(b"LASF_Projection", 2112, b'PROJCS["m",UNIT["metre",1]]\0'))
    assert wkt_of(header) == "EPSG:2264"
    assert units_of(header).horizontal == SURVEY_FOOT
    header.encoding = 16
    assert wkt_of(header).startswith("PROJCS")
    assert units_of(header).horizontal == 1


def test_identity_is_the_code_where_there_is_one():
    assert crs_identity("EPSG:28992") == "EPSG:28992"
    assert crs_identity(f'PROJCS["RD",{GEOGCS},AUTHORITY["EPSG","28992"]]') == "EPSG:28992"
    assert crs_identity(f'PROJCRS["RD",{BASE},ID["EPSG",28992]]') == "EPSG:28992"
    assert crs_identity('PROJCS["a", UNIT["metre", 1]]') == crs_identity('PROJCS["a",UNIT["metre",1]]\n')


def test_a_crs_that_can_not_be_stored_is_refused():
    for text in ("EPSG:28992+5709", "here", "EPSG:0", "ESRI:102100"):
        with pytest.raises(ValueError, match="can't be stored"):
            crs_records(text)
