"""The Processing provider: an algorithm for every stage and every pipeline, and those for surveys in tiles."""

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from ..algorithms.pipelines import PIPELINES
from ..algorithms.stages import STAGES
from ..algorithms.tiling.tiled_pipelines import TILED_PIPELINES
from . import PROVIDER_ID
from .cut_algorithm import CutAlgorithm
from .dependencies import lacking_sentence
from .paths import ICON
from .pipeline_algorithm import PipelineAlgorithm
from .rasters import EXTENSIONS as RASTER_EXTENSIONS
from .stage_algorithm import StageAlgorithm
from .tiles_algorithm import TilesAlgorithm

CLOUD_EXTENSIONS = ("las", "laz", "copc.laz")


class Provider(QgsProcessingProvider):
    """LiDAR Buildings in the Processing toolbox."""

    def loadAlgorithms(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Add an algorithm per stage, per pipeline and per pipeline that runs in tiles, and that which cuts tiles."""
        for stage in STAGES.values():
            self.addAlgorithm(StageAlgorithm(stage))
        for pipeline in PIPELINES.values():
            self.addAlgorithm(PipelineAlgorithm(pipeline))
        self.addAlgorithm(CutAlgorithm())
        for tiled in TILED_PIPELINES.values():
            self.addAlgorithm(TilesAlgorithm(tiled))

    def id(self) -> str:
        """Return the prefix of all algorithm ids; frozen, saved models depend on it."""
        return PROVIDER_ID

    def name(self) -> str:
        """Return what the toolbox calls the provider."""
        return "LiDAR Buildings"

    def longName(self) -> str:  # noqa: N802 - QGIS asks for this name
        """Return the name with the purpose."""
        return "LiDAR Buildings (buildings from point clouds)"

    def icon(self) -> QIcon:
        """Return the plugin's icon."""
        return QIcon(str(ICON))

    def svgIconPath(self) -> str:  # noqa: N802 - QGIS asks for this name
        """Return the icon's file."""
        return str(ICON)

    def warningMessage(self) -> str:  # noqa: N802 - QGIS asks for this name
        """Return the banner above the toolbox: which packages are missing, "" when none is."""
        return lacking_sentence()

    def defaultPointCloudFileExtension(self) -> str:  # noqa: N802 - QGIS asks for this name
        """Return the extension of temporary clouds: not compressed, since the next step reads them at once."""
        return "las"

    def supportedOutputPointCloudLayerExtensions(self) -> list:  # noqa: N802 - QGIS asks for this name
        """Return the extensions that stages write."""
        return list(CLOUD_EXTENSIONS)

    def defaultRasterFileExtension(self) -> str:  # noqa: N802 - QGIS asks for this name
        """Return the extension of temporary rasters."""
        return RASTER_EXTENSIONS[0]

    def supportedOutputRasterLayerExtensions(self) -> list:  # noqa: N802 - QGIS asks for this name
        """Return the extensions of rasters that stages write."""
        return list(RASTER_EXTENSIONS)
