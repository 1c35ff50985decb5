"""What algorithms make, as the outputs that users choose."""

from dataclasses import dataclass

from qgis.core import (
    QgsProcessingDestinationParameter,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterPointCloudDestination,
    QgsProcessingParameterRasterDestination,
)

from ..algorithms.stage import CLOUD, Declared, Layer, Raster, Stage, TextFile
from .inputs import with_help
from .vectors import SOURCE_TYPES


@dataclass(frozen=True)
class Made:
    """An output: its name and title, the stage that makes it, and how that declares it."""

    name: str  #: ``OUTPUT``, ``FOOTPRINTS``
    title: str
    stage: Stage
    #: "output" for a cloud, "report" for a page; a text file has the name of the output
    declared: Declared
    optional: bool = True
    by_default: bool = True  #: Whether the dialog makes it by default
    only_with: tuple[str, ...] = ()  #: Names of layers, or of the reference, of which one must be given

    @property
    def key(self) -> str:
        """Its name among the results in memory."""
        return self.name.lower()

    def definition(self) -> QgsProcessingDestinationParameter:
        """Return the parameter that says where it goes."""
        declared = self.declared
        if isinstance(declared, Layer):
            kind = SOURCE_TYPES[declared.geometry]
            made = QgsProcessingParameterFeatureSink(self.name, self.title, kind, optional=self.optional)
            with_help(made, "A GeoPackage or any other vector format that QGIS writes.")
        elif isinstance(declared, Raster):
            made = QgsProcessingParameterRasterDestination(self.name, self.title, optional=self.optional)
            with_help(made, "A GeoTIFF, tiled and compressed.")
        elif isinstance(declared, TextFile):
            filters = ";;".join(f"{called} (*{' *'.join(endings)})" for called, endings in declared.formats.items())
            made = QgsProcessingParameterFileDestination(self.name, self.title, filters, optional=True)
            with_help(made, f"A file: {' / '.join(declared.formats)}, as its name ends.")
        elif declared == CLOUD:
            made = QgsProcessingParameterPointCloudDestination(self.name, self.title, optional=self.optional)
            with_help(made, "A .las, .laz or .copc.laz file.")
        else:
            made = QgsProcessingParameterFileDestination(self.name, self.title, "HTML files (*.html)", optional=True)
            with_help(made, "A page that shows the numbers.")
        made.setCreateByDefault(self.by_default and not (isinstance(declared, Layer) and declared.on_demand))
        return made
