"""Units from WKT 1, WKT 2 and GeoKeys."""

import pytest

from lidar_buildings.algorithms.cloud.header import Header
from lidar_buildings.algorithms.cloud.units import GeoKeys, Units, units_of_wkt, with_named_units
from lidar_buildings.tests.algorithms.cloud.crs_texts import geokeys

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
    assert units_of_wkt(text) is None


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
    units, warnings = GeoKeys(header).units(None)
    assert (units, warnings) == (pytest.approx((horizontal, vertical)), ())


def test_units_that_keys_do_not_name_are_those_of_their_codes():
    known = Units(SURVEY_FOOT, FOOT)
    assert GeoKeys(geokeys((1024, 1), (3072, 2264))).units(known) == (known, ())
    keys = GeoKeys(geokeys((1024, 1), (3072, 26910), (3076, 9001), (4096, 6360)))
    assert keys.units(Units(1, FOOT)) == ((1, FOOT), ())
    assert GeoKeys(geokeys((1024, 1), (3072, 2264))).units(None) == (None, ())
    assert GeoKeys(Header()).units(None) == (None, ())


@pytest.mark.parametrize("keys", [((1024, 2), (2048, 4326)), ((2048, 4326),), ((1024, 3), (2048, 4978))])
def test_geographic_geokeys_are_refused(keys):
    with pytest.raises(ValueError, match=r"degrees|geocentric"):
        GeoKeys(geokeys(*keys)).units(None)


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("US survey foot", US),
        ("Foot_US", US),
        ("ftUS", US),
        ("foot", FOOT),
        ("FEET", FOOT),
        ("International Foot", FOOT),
    ],
)
@pytest.mark.parametrize("one", ["1", "1.0", "1.000000000000"])
def test_a_unit_called_foot_and_given_as_a_meter_is_a_foot(name, size, one):
    """VERT_CS of clouds of US states have UNIT["US survey foot",1]."""
    text = f'COMPD_CS["b",PROJCS["SP",UNIT["metre",1]],VERT_CS["h",VERT_DATUM["d",2005],UNIT["{name}",{one}]]]'
    mended, (warned,) = with_named_units(text)
    assert units_of_wkt(mended) == pytest.approx((1, size), rel=1e-9)
    assert name in warned
    two = f'PROJCRS["SP",{CS2},LENGTHUNIT["{name}",{one}]]'
    assert units_of_wkt(with_named_units(two)[0]).horizontal == pytest.approx(size, rel=1e-9)


@pytest.mark.parametrize(
    "unit", ['"metre",1', '"foot",0.3048', '"foot",10', '"Shift",1', '"US survey foot",0.304800609601']
)
def test_other_units_stay_as_they_are(unit):
    text = f'PROJCS["SP",UNIT[{unit}]]'
    assert with_named_units(text) == (text, ())


def test_geokeys_that_give_a_foot_as_a_meter_mean_a_foot():
    keys = GeoKeys(geokeys((1024, 1), (3072, 2264), (3076, 9003), (3077, "double"), doubles=(1.0,)))
    units, (warned,) = keys.units(None)
    assert units.horizontal == pytest.approx(SURVEY_FOOT)
    assert "US survey foot" in warned
