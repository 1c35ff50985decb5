"""Coordinate reference systems as files of other programs have them."""

from __future__ import annotations

import re
import struct

from lidar_buildings.algorithms.cloud.header import Header, Vlr

_ETRS = (
    'GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_1989",SPHEROID["GRS 1980",6378137,298.257222101]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4258"]]'
)


def utm(name, geographic, meridian, end):
    """Return WKT 1 of a zone of UTM."""
    numbers = (("latitude_of_origin", 0), ("central_meridian", meridian), ("scale_factor", 0.9996))
    numbers = (*numbers, ("false_easting", 500000), ("false_northing", 0))
    parameters = ",".join(f'PARAMETER["{key}",{value}]' for key, value in numbers)
    return f'PROJCS["{name}",{geographic},PROJECTION["Transverse_Mercator"],{parameters},UNIT["metre",1]{end}]'


ETRS_32 = utm("ETRS89 / UTM zone 32N", _ETRS, 9, ',AUTHORITY["EPSG","25832"]')
_ESRI = utm(
    "ETRS_1989_UTM_Zone_32N",
    'GEOGCS["GCS_ETRS_1989",DATUM["D_ETRS_1989",SPHEROID["GRS_1980",6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],'
    'UNIT["Degree",0.0174532925199433]]',
    9,
    "",
)
# EPSG:25832 by its code and as WKT: with it, without it, with other decimals, with heights, of ESRI, with another name.
IN_SIX_WAYS = (
    "EPSG:25832",
    ETRS_32,
    ETRS_32.replace(',AUTHORITY["EPSG","25832"]', ""),
    ETRS_32.replace(',AUTHORITY["EPSG","25832"]', "").replace("0.0174532925199433", "0.01745329251994328"),
    f'COMPD_CS["with heights",{ETRS_32},VERT_CS["DHHN2016 height",VERT_DATUM["DHHN2016",2005],UNIT["metre",1]]]',
    re.sub("Zone_32N|GCS_", lambda found: {"Zone_32N": "zone 32N"}.get(found[0], found[0]), _ESRI),
)
_NAD83 = (
    'GEOGCS["NAD83",DATUM["North_American_Datum_1983",SPHEROID["GRS 1980",6378137,298.257222101]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]'
)
COMPOUND_FEET = (
    f'COMPD_CS["feet",{utm("NAD83 / UTM zone 15N", _NAD83, -93, "")},VERT_CS["Ellipsoid (US Feet)",'
    'VERT_DATUM["Ellipsoid",2002],UNIT["US survey foot",0.304800609601219],AXIS["Up",UP]]]'
)
THREE_AXES = (
    'PROJCRS["WGS 84 / UTM zone 15N",BASEGEOGCRS["WGS 84",DATUM["World Geodetic System 1984",'
    'ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],PRIMEM["Greenwich",0,'
    'ANGLEUNIT["degree",0.0174532925199433]]],CONVERSION["UTM zone 15N",METHOD["Transverse Mercator",ID["EPSG",9807]],'
    'PARAMETER["Latitude of natural origin",0,ANGLEUNIT["degree",0.0174532925199433]],'
    'PARAMETER["Longitude of natural origin",-93,ANGLEUNIT["degree",0.0174532925199433]],'
    'PARAMETER["Scale factor at natural origin",0.9996,SCALEUNIT["unity",1]],'
    'PARAMETER["False easting",500000,LENGTHUNIT["metre",1]],PARAMETER["False northing",0,LENGTHUNIT["metre",1]]],'
    'CS[Cartesian,3],AXIS["(E)",east,ORDER[1],LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]],'
    'AXIS["ellipsoidal height (h)",up,ORDER[3],LENGTHUNIT["metre",1]]]'
)
MERCATOR = (
    'PROJCS["WGS 84 / Pseudo-Mercator",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Mercator_1SP"],PARAMETER["central_meridian",0],'
    'PARAMETER["scale_factor",1],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1],'
    'AUTHORITY["EPSG","3857"]]'
)


def geokeys(*pairs, doubles=()):
    """Return the header of a file of format 1 with GeoKeys, "double" for the next of the doubles."""
    numbers, at = [1, 1, 0, len(pairs)], 0
    for key, value in pairs:
        numbers += [key, 34736, 1, at] if value == "double" else [key, 0, 1, value]
        at += value == "double"
    records = [Vlr(b"LASF_Projection", 34735, struct.pack(f"<{len(numbers)}H", *numbers))]
    if doubles:
        records.append(Vlr(b"LASF_Projection", 34736, struct.pack(f"<{len(doubles)}d", *doubles)))
    return Header(vlrs=records, encoding=0)
