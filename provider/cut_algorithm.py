"""Point clouds of any size cut into square tiles, as a Processing algorithm."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from qgis.core import (
    Qgis,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputFile,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterNumber,
)

from ..algorithms.tiling.cutting import cut_into_tiles
from ..algorithms.tiling.settings import CUT_SETTINGS
from ..algorithms.tiling.survey import crs_of_survey, files_of_survey, open_survey
from ..algorithms.tiling.tiled_pipelines import CUT_INTO_TILES, survey_tool_help
from .algorithm import CheckedAlgorithm
from .clouds import CloudsParameter, survey_paths
from .errors import as_processing_errors
from .feedback import FeedbackMonitor, warn_unknown_names
from .given import Given
from .inputs import INPUT, OUTPUT, extent_box, extent_parameter, with_help, with_setting
from .qgis_crs import WGS84
from .run_outputs import target_path
from .surveys import VPC, check_vpc, write_survey
from .web import check_sizes

SIDE, COMPRESSED, TILES = "SIDE", "COMPRESSED", "TILES"


class CutAlgorithm(CheckedAlgorithm, QgsProcessingAlgorithm):
    """Files in, a folder of tiles out."""

    declared = CUT_INTO_TILES

    def createInstance(self) -> CutAlgorithm:  # noqa: N802 - QGIS asks for these names
        """Return a new algorithm of the same kind."""
        return CutAlgorithm()

    def help(self) -> str:
        """Return the help as HTML."""
        return survey_tool_help(CUT_INTO_TILES)

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802
        """Declare the survey, the size of tiles, and the folder."""
        self.addParameter(with_setting(CloudsParameter(INPUT, ""), CUT_SETTINGS))
        number = Qgis.ProcessingNumberParameterType.Double
        side = QgsProcessingParameterNumber(SIDE, "", number, 500.0, False, 1.0, 100_000.0)
        side.setMetadata({"widget_wrapper": {"decimals": 1}})
        self.addParameter(with_setting(side, CUT_SETTINGS))
        self.addParameter(extent_parameter())
        self.addParameter(with_setting(QgsProcessingParameterBoolean(COMPRESSED, "", True), CUT_SETTINGS))
        folder = QgsProcessingParameterFolderDestination(OUTPUT, "Folder of the tiles")
        self.addParameter(with_help(folder, "It is made where it is missing."))
        self.addOutput(QgsProcessingOutputFile(VPC, "Virtual point cloud over the tiles"))
        self.addOutput(QgsProcessingOutputNumber(TILES, "Tiles written"))

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find the files of the survey, and refuse invalid input before the run."""
        given = Given(self, parameters, context)
        self.paths = survey_paths(given, INPUT)
        check_vpc(target_path(parameters.get(OUTPUT)), self.paths)
        self.files, self.plane = files_of_survey(self.paths), crs_of_survey(self.paths).plane
        self.extent = extent_box(given, self.plane)
        check_sizes(self.paths, self.extent)

    def systems(self) -> list[str]:
        """Return the coordinate reference systems of the survey and of its virtual point cloud."""
        return [self.plane, WGS84]

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Cut; then write the virtual point cloud."""
        warn_unknown_names(self, parameters, feedback)
        folder = Path(self.parameterAsString(parameters, OUTPUT, context))
        side = self.parameterAsDouble(parameters, SIDE, context)
        compressed = self.parameterAsBool(parameters, COMPRESSED, context)
        monitor = FeedbackMonitor(feedback)
        with as_processing_errors(feedback, f"Cancelled; tiles that were complete are in {folder}."):
            survey = open_survey(self.paths, monitor=monitor, extent=self.extent)
            stem = self.files[0].name.split(".")[0] if len(self.files) == 1 else "tile"
            tiles = cut_into_tiles(survey, side, folder, stem, compressed, monitor)
            vpc = write_survey(survey, tiles, folder, context, monitor)
            return {OUTPUT: str(folder), VPC: str(vpc), TILES: len(tiles)}
        return {}
