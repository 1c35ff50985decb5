"""A QGIS without windows, with the provider and a few toy stages."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.toys import TOY_CHAIN, TOY_MAPPING, TOYS

RD = "EPSG:28992"


@pytest.fixture(scope="session")
def qgis_application():
    """The running QGIS; one that another plugin of pytest started is used as it is."""
    from qgis.core import QgsApplication

    application = QgsApplication.instance()
    if application is None:
        application = QgsApplication([], False)
        QgsApplication.initQgis()
    plugins = str(Path(QgsApplication.pkgDataPath()) / "python" / "plugins")
    if plugins not in sys.path:
        sys.path.append(plugins)
    from processing.core.Processing import Processing

    Processing.initialize()
    return application


@pytest.fixture(scope="session")
def provider(qgis_application):
    """The provider in Processing's registry, with the toy stages and the toy chain in addition to the real ones."""
    from qgis.core import QgsApplication

    from lidar_buildings.provider.provider import Provider

    registry = QgsApplication.processingRegistry()
    patch = pytest.MonkeyPatch()
    for name, stage in TOYS.items():
        patch.setitem(STAGES, name, stage)
    for pipeline in (TOY_CHAIN, TOY_MAPPING):
        patch.setitem(PIPELINES, pipeline.name, pipeline)
    provider = Provider()
    registry.addProvider(provider)
    yield provider
    registry.removeProvider(provider)
    patch.undo()
    # Collect garbage now: some objects can't be deleted after QGIS has ended.
    gc.collect()


@pytest.fixture
def context(provider):
    """A context with the project, which is empty again afterwards."""
    from qgis.core import QgsProcessingContext, QgsProject

    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    yield context
    # Its layers can't be closed any more when QGIS is gone, which outlives this fixture but not the objects of a test.
    context.temporaryLayerStore().removeAllMapLayers()
    QgsProject.instance().clear()


@pytest.fixture
def log():
    """A feedback that keeps its messages."""
    from qgis.core import QgsProcessingFeedback

    class Log(QgsProcessingFeedback):
        def __init__(self):
            super().__init__(False)
            self.infos, self.warnings, self.errors = [], [], []

        def pushInfo(self, info):
            self.infos.append(info)

        def pushWarning(self, warning):
            self.warnings.append(warning)

        def reportError(self, error, fatalError=False):
            self.errors.append(error)

    return Log()


@pytest.fixture(scope="session")
def town():
    """Arrays of a 20 m square: ground at 10 m, a building's roof at 16 m, in the Dutch grid."""
    x, y = np.meshgrid(np.arange(20.0), np.arange(20.0))
    roof = (np.abs(x - 10) < 4) & (np.abs(y - 10) < 4)
    xyz = np.column_stack([85_000 + x.ravel(), 446_000 + y.ravel(), np.where(roof, 16.0, 10.0).ravel()])
    return {"xyz": xyz, "classification": np.where(roof, 6, 2).ravel().astype(np.uint8)}


@pytest.fixture
def town_file(town, tmp_path):
    """The square as a LAZ file in a folder of its own."""
    folder = tmp_path / "input"
    folder.mkdir()
    path = folder / "town.laz"
    write_cloud(create_cloud(town, wkt=RD), path)
    return path


@pytest.fixture
def reference_file(town_file):
    """A copy of the square, to compare it with."""
    path = town_file.with_name("reference.laz")
    path.write_bytes(town_file.read_bytes())
    return path


@pytest.fixture
def out(tmp_path):
    """An empty folder for results."""
    folder = tmp_path / "out"
    folder.mkdir()
    return folder
