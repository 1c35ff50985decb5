"""A small town to try everything with: made in seconds, and opened as a project."""

from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsPointCloudAttributeByRampRenderer,
    QgsPointCloudLayer,
    QgsProcessingException,
    QgsProject,
    QgsStyle,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QApplication

from ..algorithms.cloud.asprs import PointClass
from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.files import read_cloud, write_cloud
from ..algorithms.run import run_stage
from ..algorithms.stages import STAGES
from .errors import as_processing_errors
from .named_clouds import SIMULATED_CRS, named
from .named_styles import CUTS
from .styles import Styler, show_in_3d

# Side (m) of the town: with houses, a hall, a river with bridges, and plants.
_SIZE = 110.0

# Its density (points/m²): files of about 2 MB.
_DENSITY = 12.0

# Files in the folder of the sample: the town as a scanner sees it, the truth, and the project.
TOWN, TRUTH, PROJECT = "town.copc.laz", "town_truth.copc.laz", "town.qgz"


def sample_folder() -> Path:
    """Return the folder of the profile in which the sample is kept."""
    return Path(QgsApplication.qgisSettingsDirPath()) / "lidar_buildings_sample"


def open_sample(iface: Any) -> None:
    """Make the town, if it is not there, and open it in a new project; a changed project is saved first, or kept."""
    QApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
    try:
        with as_processing_errors():
            make_sample(sample_folder())
    except QgsProcessingException as error:
        iface.messageBar().pushWarning("Sample data", str(error))
        return
    finally:
        QApplication.restoreOverrideCursor()
    if not iface.newProject(True):
        return
    fill_project(QgsProject.instance(), sample_folder())
    iface.mapCanvas().zoomToFullExtent()
    what_next = "Choose Plugins ▸ LiDAR Buildings ▸ Find buildings in this view…."
    iface.messageBar().pushInfo("Sample data", f"A simulated town without classes. {what_next}")


def make_sample(folder: Path) -> None:
    """Write the town and its truth into a folder, where they are missing."""
    if (folder / TOWN).is_file() and (folder / TRUTH).is_file():
        return
    folder.mkdir(parents=True, exist_ok=True)
    made = run_stage(STAGES["simulate_town"], size=_SIZE, density=_DENSITY).cloud
    truth = named(made, QgsCoordinateReferenceSystem(SIMULATED_CRS))
    write_cloud(truth, folder / TRUTH)
    write_cloud(_as_scanned(truth), folder / TOWN)


def _as_scanned(truth: Cloud) -> Cloud:
    """Return a cloud in which no point is classified, and none has the number of its object."""
    cloud = truth.copy()
    cloud.set("classification", np.full(len(cloud), PointClass.UNCLASSIFIED, np.uint8))
    for name in ("segment_id", "cluster_id"):
        if cloud.has(name):
            cloud.set(name, np.zeros(len(cloud), np.int32))
    return cloud


def fill_project(project: QgsProject, folder: Path) -> None:
    """Add the town, colored by its elevation, and the truth, switched off, to an empty project, and save that."""
    crs = QgsCoordinateReferenceSystem(SIMULATED_CRS)
    project.setCrs(crs)
    town = QgsPointCloudLayer(str(folder / TOWN), "Town", "copc")
    truth = QgsPointCloudLayer(str(folder / TRUTH), "Town, true classes", "copc")
    for layer in (truth, town):
        if not layer.crs().isValid():
            layer.setCrs(crs)
        project.addMapLayer(layer)
    truth.loadNamedStyle(str(Styler.file("classification")))
    _color_by_elevation(town, np.quantile(read_cloud(folder / TOWN).get("xyz")[:, 2], CUTS))
    for layer in (truth, town):
        show_in_3d(layer)
    project.layerTreeRoot().findLayer(truth.id()).setItemVisibilityChecked(False)
    project.write(str(folder / PROJECT))


def _color_by_elevation(layer: QgsPointCloudLayer, limits: np.ndarray) -> None:
    """Color a cloud between two elevations."""
    low, high = limits.tolist()
    renderer = QgsPointCloudAttributeByRampRenderer()
    renderer.setAttribute("Z")
    renderer.setMinimum(low)
    renderer.setMaximum(high)
    shader = renderer.colorRampShader()
    shader.setSourceColorRamp(QgsStyle.defaultStyle().colorRamp("Viridis"))
    shader.setMinimumValue(low)
    shader.setMaximumValue(high)
    shader.classifyColorRamp(5)
    renderer.setColorRampShader(shader)
    renderer.setPointSize(0.8)
    layer.setRenderer(renderer)
