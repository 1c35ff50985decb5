"""Which modules may import which: the layers of the program, read from the source without running it."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from lidar_buildings.algorithms import STAGES

ROOT = Path(__file__).resolve().parent.parent
# As they are when tests are collected: tests of the provider add toys of their own while they run.
ALL = dict(STAGES)
QGIS = {"qgis", "osgeo", "processing", "PyQt5", "PyQt6", "console"}
POINT_CLOUD_FILES = {"laspy", "lazrs", "laszip", "copclib"}
NUMERICAL = {"scipy", "sklearn", "threadpoolctl"}
# The rooms of the core in their order: a module imports from its own room and from earlier ones.
# "" holds the helpers of the core itself, "top" the modules that know stages and pipelines.
ROOMS = (
    "stage",
    "",
    "geometry",
    "neighborhoods",
    "cloud",
    "sampling",
    "planes",
    "report",
    "preparation",
    "terrain",
    "features",
    "segmentation",
    "bridges",
    "shapes",
    "buildings",
    "landcover",
    "footprints",
    "walls",
    "facades",
    "models3d",
    "export",
    "quality",
    "simulation",
    "top",
    "tiling",
    "command",
)
HELPERS = {"packages", "package_versions", "memory", "threads", "params", "rules", "criteria"}
# Share of the lines of core and provider that one room may hold: a larger one holds more than one idea.
LARGEST_ROOM = 0.12
# Statements that import.
IMPORTS = (ast.Import, ast.ImportFrom)
# Functions that import the module named by their first argument.
IMPORTERS = {"import_module", "__import__", "_Lazy"}


def imported(source: str) -> Iterator[str]:
    """Yield what a source imports, however deep inside: "scipy.spatial", or "..provider" when relative."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = "." * node.level + (node.module or "")
            yield from ([start] if node.module else (start + alias.name for alias in node.names))
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if called in IMPORTERS:
                yield str(node.args[0].value)


@cache
def names_in(path: str) -> tuple[str, ...]:
    """Return what a file imports."""
    return tuple(imported((ROOT / path).read_text(encoding="utf-8")))


def packages_of(path: str) -> set[str]:
    """Return the packages that a file imports by absolute name."""
    return {name.split(".")[0] for name in names_in(path) if not name.startswith(".")}


def importers_of(packages: set[str], paths: list[str], but: str = "") -> list[str]:
    """Return the files that import one of some packages, ``but`` one that may."""
    return [path for path in paths if path != but and packages_of(path) & packages]


def sources(*folders: str) -> list[str]:
    return sorted(str(path.relative_to(ROOT)) for folder in folders for path in (ROOT / folder).rglob("*.py"))


CORE = sources("algorithms")
PLUGIN = ["__init__.py", *CORE, *sources("provider")]
TESTS = sources("tests")
OTHER_TESTS = ("tests/provider/", "tests/qgis/", "tests/real/", "tests/benchmarks/", "tests/attacks/")
TESTS_OF_CORE = [path for path in TESTS if not path.startswith(OTHER_TESTS)]


def test_reader_of_imports_sees_every_way_to_import():
    source = """
import numpy as np, scipy.ndimage
from qgis.core import Qgis
from . import stage
from .cloud import asprs
from ..provider.crs import crs_of
def late():
    import laspy
    importlib.import_module("sklearn.cluster")
ndimage = _Lazy("scipy.ndimage")
"""
    assert sorted(imported(source)) == sorted(
        ["numpy", "scipy.ndimage", "qgis.core", ".stage", ".cloud", "..provider.crs", "laspy"]
        + ["sklearn.cluster", "scipy.ndimage"]
    )


def room_of(module: str) -> str:
    """Return the room of a module of the core, ``"geometry.grid"`` or ``"run"``."""
    first, *rest = module.split(".")
    if rest or (ROOT / "algorithms" / first).is_dir():
        return first
    return "" if first in HELPERS else "top"


def modules_imported(path: str) -> Iterator[str]:
    """Yield the modules of the core that one of its modules imports, ``"geometry.grid"``."""
    package = Path(path).with_suffix("").parts[1:-1]
    for name in names_in(path):
        level = len(name) - len(name.lstrip("."))
        if level:
            yield ".".join([*package[: len(package) - level + 1], name[level:]])


def test_rooms_import_only_from_earlier_rooms():
    found = [
        f"{path} imports {module}"
        for path in CORE
        if path != "algorithms/__init__.py"
        for module in modules_imported(path)
        if ROOMS.index(room_of(module)) > ROOMS.index(room_of(".".join(Path(path).with_suffix("").parts[1:])))
    ]
    assert not found


def test_the_judge_shares_nothing_with_what_it_judges():
    """Models are assessed by code that takes no part in making them."""
    imported = {module for path in CORE if "/quality/" in path for module in modules_imported(path)}
    assert imported
    assert not {module for module in imported if room_of(module) in ("models3d", "export")}


def circles(graph: dict[str, set[str]]) -> list[str]:
    """Return the modules from which imports lead back to themselves, whatever is imported late."""
    found = []
    for start, imports in graph.items():
        seen, front = set(), set(imports)
        while front:
            seen |= front
            front = set().union(*(graph.get(module, set()) for module in front)) - seen
        if start in seen:
            found.append(start)
    return found


def test_no_module_imports_itself_by_way_of_others():
    """Not even late, in a function: such a circle only hides that two modules are one, or that a third is missing."""
    names = {path: Path(path).stem for path in sources("provider")}
    imports = {
        name: {one.strip(".") for one in names_in(path) if one.startswith(".") and not one.startswith("..")}
        for path, name in names.items()
    }
    assert not circles({name: which & set(names.values()) for name, which in imports.items()})
    core = {".".join(Path(path).with_suffix("").parts[1:]): set(modules_imported(path)) for path in CORE}
    # A monitor names the type of the steps that it hears of.
    assert circles(core) == ["stage.declaration", "stage.monitor"]
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == ["a", "b", "c"]


# Modules that measure the density of some points: of parts of a cloud that are sampled otherwise than the whole.
MEASURE_PARTS = {
    "algorithms/footprints/extract_footprints.py",
    "algorithms/walls/extract_wall_footprints.py",
    "algorithms/walls/classify_walls.py",
    "algorithms/models3d/reconstruct_roofs.py",
    "algorithms/models3d/compute_building_heights.py",
}


def test_searches_take_no_more_cores_than_the_process_may_use():
    """``workers=-1`` takes all cores of the machine, also where processes share them or a batch system gives few."""
    assert not [path for path in CORE if "workers=-1" in (ROOT / path).read_text(encoding="utf-8")]


def test_how_a_cloud_was_sampled_is_asked_of_its_sampling():
    """A stage that measured the density of all its points would measure it again, and on other points than the next."""
    measuring = [name for name in CORE if not name.startswith("algorithms/sampling/")]
    own = {
        path
        for path in measuring
        for word in ("point_density(", "point_spacing(", "effective_density(", "surface_density(", "SurfaceSample(")
        if word in (ROOT / path).read_text(encoding="utf-8")
    }
    assert own == MEASURE_PARTS


def test_names_are_unique():
    """A module, or a class that other modules import, is the only one of its name: a search finds it at once."""
    modules = Counter(Path(path).name for path in PLUGIN if not path.endswith("__init__.py"))
    classes = Counter(
        node.name
        for path in PLUGIN
        for node in ast.parse((ROOT / path).read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    )
    repeated = {name for found in (modules, classes) for name, count in found.items() if count > 1}
    # The rules of a module have one name in all modules.
    assert repeated <= {"RULES"}


def test_every_folder_is_a_room():
    folders = {path.name for path in (ROOT / "algorithms").iterdir() if (path / "__init__.py").exists()}
    assert folders == set(ROOMS) - {"", "top"}


def test_no_room_is_too_large():
    lines = {path: (ROOT / path).read_text(encoding="utf-8").count("\n") for path in CORE}
    rooms = {room: sum(n for path, n in lines.items() if f"/{room}/" in path) for room in ROOMS if room}
    whole = sum(lines.values()) + sum(
        (ROOT / path).read_text(encoding="utf-8").count("\n") for path in sources("provider")
    )
    assert max(rooms.values()) <= LARGEST_ROOM * whole, max(rooms, key=lambda room: rooms[room])


def test_module_of_a_stage_has_its_name():
    assert {stage.function.__module__.rsplit(".", 1)[1]: stage for stage in ALL.values()} == dict(ALL)


def test_tests_of_a_stage_have_its_name_and_its_folder():
    room = {stage.name: stage.function.__module__.split(".")[-2] for stage in ALL.values()}
    tests = {name: ROOT / "tests" / "algorithms" / room[name] / f"test_{name}.py" for name in room}
    assert not [name for name, path in tests.items() if not path.is_file()]


def test_folders_of_tests_are_rooms_of_the_core():
    """A room that moves takes its tests with it."""
    rooms = {Path("tests", path).parent for path in CORE}
    assert {Path(path).parent for path in sources("tests/algorithms")} <= rooms


def test_there_are_sources_to_read():
    assert "algorithms/stages.py" in CORE
    assert "provider/plugin.py" in PLUGIN


def test_only_the_provider_knows_qgis():
    assert not importers_of(QGIS, ["__init__.py", *CORE])


def test_tests_of_the_core_need_no_qgis():
    """The core is tested where there is no QGIS; a second opinion of QGIS's libraries has its place in tests/qgis."""
    assert not importers_of(QGIS, TESTS_OF_CORE)
    assert not [path for path in TESTS_OF_CORE if any("provider" in name.split(".") for name in names_in(path))]


def test_no_module_of_tests_is_a_library():
    """What two modules share is in one that has no tests, where it can be found."""
    assert not [path for path in TESTS if any(".test_" in name for name in aliases_in(path))]


def aliases_in(path: str) -> list[str]:
    """Return every name that a file imports, ``"module.name"``."""
    nodes = [node for node in ast.walk(ast.parse((ROOT / path).read_text("utf-8"))) if isinstance(node, IMPORTS)]
    return [f"{getattr(node, 'module', '')}.{alias.name}" for node in nodes for alias in node.names]


def test_only_one_module_imports_the_libraries_of_point_clouds():
    assert not importers_of(POINT_CLOUD_FILES, PLUGIN, but="algorithms/cloud/laspy_library.py")


def test_scipy_and_scikit_learn_come_through_packages_only():
    assert not importers_of(NUMERICAL, PLUGIN, but="algorithms/packages.py")


def test_core_does_not_import_the_provider():
    assert not [path for path in CORE if any("provider" in name.lstrip(".").split(".") for name in names_in(path))]


def test_core_imports_nothing_but_what_the_readme_names():
    found = {path: packages_of(path) - allowed_in(path) - set(sys.stdlib_module_names) for path in CORE}
    assert not {path: packages for path, packages in found.items() if packages}


def allowed_in(path: str) -> set[str]:
    """Return the packages that a module of the core may import besides those of Python."""
    allowed = {"numpy"} | (POINT_CLOUD_FILES if path == "algorithms/cloud/laspy_library.py" else set())
    # Needed by nobody who names no vector format but GeoJSON.
    allowed |= NUMERICAL | {"pyogrio"} if path == "algorithms/packages.py" else set()
    # Where it is installed, it knows codes of coordinate reference systems; QGIS has its own.
    allowed |= {"pyproj"} if path == "algorithms/cloud/authority.py" else set()
    # Needed by nobody who doesn't name a scheduler.
    return allowed | ({"distributed"} if path == "algorithms/tiling/workers.py" else set())


@pytest.mark.parametrize("absent", [POINT_CLOUD_FILES | NUMERICAL, QGIS])
def test_stages_load_where_packages_are_missing(absent):
    # A None in sys.modules makes Python say "not installed".
    script = f"""
import sys
sys.modules.update(dict.fromkeys({sorted(absent)}))
import conftest
from lidar_buildings.algorithms import STAGES, pipelines
assert all(STAGES.values())
"""
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# Lazy modules of ``packages.py`` by the names to install them; threadpoolctl is optional.
OF_PACKAGE = {
    **dict.fromkeys(("spatial", "special", "ndimage", "sparse", "csgraph"), "scipy"),
    "cluster": "scikit-learn",
}


@cache
def uses(module: str) -> tuple[set[str], list[str]]:
    """Return the packages that a module of the core uses itself, and the modules that it imports."""
    path = Path("algorithms", *module.split(".")).with_suffix(".py")
    path = path if (ROOT / path).is_file() else path.with_suffix("") / "__init__.py"
    if not (ROOT / path).is_file():
        return set(), []
    aliases = [name.removeprefix("packages.") for name in aliases_in(str(path)) if name.startswith("packages.")]
    return {OF_PACKAGE[name] for name in aliases if name in OF_PACKAGE}, list(modules_imported(str(path)))


def packages_used(module: str) -> set[str]:
    """Return the packages that a module of the core and all that it imports use."""
    found, open_ones, seen = set(), [module], set()
    while open_ones:
        one = open_ones.pop()
        if one not in seen:
            seen.add(one)
            packages, imports = uses(one)
            found |= packages
            open_ones += imports
    return found


def test_a_stage_names_the_packages_that_it_uses():
    module = {name: stage.function.__module__.split(".algorithms.")[1] for name, stage in ALL.items()}
    assert {name: set(ALL[name].packages) for name in module} == {name: packages_used(module[name]) for name in module}


def test_composites_run_without_scikit_learn():
    """It stopped all 91 algorithms, and one option of one of them used it."""
    script = """
import sys
sys.modules["sklearn"] = None
import conftest
import numpy as np
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
rng = np.random.default_rng(5)
x, y = rng.uniform(0, 30, (2, 12000))
z = np.where((abs(x - 15) < 5) & (abs(y - 15) < 4), 8.0 - 0.4 * abs(y - 15), 0.0) + rng.normal(0, 0.02, 12000)
for name in ("detect_buildings", "model_buildings", "map_footprints"):
    results = run_pipeline(PIPELINES[name], create_cloud({"xyz": np.column_stack([x, y, z])}))
    print(len(next(layer for title, layer in results.layers.items() if "footprints" in title)))
"""
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["1", "1", "1"]


def test_a_run_imports_no_stages_but_those_of_its_steps():
    """All stages together take half a second to import, before the first point is read."""
    script = """
import sys, conftest
import numpy as np
from lidar_buildings.algorithms import STAGES
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.pipelines import PIPELINES
print(*(stage for stage in STAGES if any(name.endswith(stage) for name in sys.modules)))
plane = np.stack(np.meshgrid(np.arange(0, 3, 0.05), np.arange(0, 3, 0.05), [0.0]), axis=-1).reshape(-1, 3)
run_pipeline(PIPELINES["model_industry"], create_cloud({"xyz": plane}))
print(*{name.split(".")[2] for name in sys.modules if name.startswith("lidar_buildings.algorithms.")})
"""
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    stages, rooms = done.stdout.split("\n")[:2]
    assert not stages
    assert {"shapes", "segmentation"} <= set(rooms.split())
    assert not {"buildings", "footprints", "walls", "facades", "models3d", "quality", "simulation"} & set(rooms.split())


def test_names_of_the_stage_package_are_imported_from_the_package_itself():
    """``algorithms.stage`` exports what a stage and its tests need, whichever of its modules defines it."""
    parts = [path.stem for path in (ROOT / "algorithms" / "stage").glob("*.py") if path.stem != "__init__"]
    deep = [
        path
        for path in sources("algorithms", "provider", "tests")
        if not path.startswith("algorithms/stage/")
        for name in names_in(path)
        if any(name.endswith(f"stage.{part}") for part in parts)
    ]
    assert not deep
