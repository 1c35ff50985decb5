"""Building-Regulariser on rings, in an environment of its own, as it asks for a newer numpy than QGIS brings.

As a script, which that environment's Python runs, it reads polygons from its input and writes the regularised ones:
both as JSON lists of polygons, of rings, of corners (m).
"""

from __future__ import annotations

import json
import subprocess
import sys
import venv
from pathlib import Path

# Where its environment is, and the version that the tables compare.
FOLDER = Path(__file__).resolve().parents[2] / ".pythons" / "regulariser"
PACKAGE = "buildingregulariser==0.2.5"

# Of polygons, of their rings, of the corners of these: two coordinates (m).
Polygons = list[list[list[list[float]]]]


def why_not() -> str:
    """Install Building-Regulariser where it is missing; return why it can't be, in one line, or nothing."""
    if _interpreter().exists():
        return ""
    venv.create(FOLDER, with_pip=True)
    command = [str(_interpreter()), "-m", "pip", "install", "--quiet", PACKAGE]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        _interpreter().unlink()
        return (done.stderr.strip() or f"pip ended with {done.returncode}").splitlines()[-1]
    return ""


def regularise(polygons: Polygons) -> Polygons:
    """Return what it makes of polygons with its own settings; raise CalledProcessError where it fails."""
    command = [str(_interpreter()), "-W", "ignore", __file__]
    done = subprocess.run(command, input=json.dumps(polygons), stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def _interpreter() -> Path:
    """Return the Python of its environment, which may not be there yet."""
    return FOLDER / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")


def _main() -> None:
    """Regularise the polygons of the standard input: runs in its environment."""
    import geopandas
    from buildingregulariser import regularize_geodataframe
    from shapely.geometry import Polygon
    from shapely.geometry.polygon import orient

    given = [Polygon(rings[0], rings[1:]) for rings in json.load(sys.stdin)]
    made = regularize_geodataframe(geopandas.GeoDataFrame(geometry=given, crs="EPSG:28992"), num_cores=1).geometry
    # Exteriors run counterclockwise here and in the comparison, which takes the sign of their area.
    parts = [orient(part) for one in made for part in getattr(one, "geoms", [one]) if part.area > 0]
    print(json.dumps([[list(ring.coords) for ring in (part.exterior, *part.interiors)] for part in parts]))


if __name__ == "__main__":
    _main()
