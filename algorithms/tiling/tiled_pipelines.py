"""The composites that run in tiles, as users meet them."""

from dataclasses import dataclass
from typing import Optional

from ..help import listed, output_text, paragraphs, pipeline_help, written_by
from ..packages import ESSENTIAL
from ..pipeline import REPORT, Output, Pipeline
from ..pipelines import PIPELINES
from ..stage import Layer, Raster, TextFile
from .settings import CUT_SETTINGS, SETTINGS, Setting
from .tiled_run import TilesOptions
from .tiled_steps import afterwards, of_survey, why_whole

# What the help says of every composite in tiles.
_DESCRIPTION = f"""
For surveys of any size: the input is a folder of tiles, a virtual point cloud, any number of files, or one file of any
size. Each file becomes a classified tile of the same name in the output folder, with a virtual point cloud over all of
them. A file of more than {TilesOptions.largest_file / 1e6:g} million points becomes tiles of the size of a block. The
layers are as of the whole survey, without seams and duplicates.

The work is done in blocks of a lattice that starts at the origin of the coordinates, each with the points around it as
far as the steps reach. So the result does not depend on how the points are spread over files. Density, spacing and
noise of the cloud are measured once for all blocks. So are the roughness of the ground and the mean entropies that
clusters are compared with, where steps use them. A block that cuts off a building or a facade is worked on again with
more around it; long pipes and large planes are put together from the pieces that blocks found. Rasters have the same
cells in all blocks, and no seams. Reviewed buildings get new numbers. Steps that read layers alone are run once, on
the layers of the whole survey.

A run that was stopped goes on where it was when it is started again with the same input, parameters and version. Until
it is complete, the results of blocks are kept in a hidden folder among the tiles. Blocks that fail are named at the
end; the tiles that they touch are missing then, all others are written.

The blocks are worked on by one process for each core, or by the workers of a Dask cluster that runs already. These must
see the same folders under the same paths; they receive the program from QGIS, and need numpy, scipy, laspy and lazrs.
"""


@dataclass(frozen=True)
class TiledPipeline:
    """A composite that is run in tiles."""

    pipeline: Pipeline
    group = "Models in tiles"  #: of the toolbox

    @property
    def name(self) -> str:
        """Name, ``detect_buildings_in_tiles``."""
        return f"{self.pipeline.name}_in_tiles"

    @property
    def id(self) -> str:
        """Processing id, ``detectbuildingsintiles``: frozen, saved models depend on it."""
        return self.name.replace("_", "")

    @property
    def title(self) -> str:
        """Its name for users."""
        return f"{self.pipeline.title}, in tiles"

    @property
    def tags(self) -> str:
        """Words that the toolbox finds it by."""
        return f"{self.pipeline.tags},tile,tiles,folder,survey,large,batch,parallel,Dask,cluster"

    @property
    def summary(self) -> str:
        """Its purpose, in a sentence."""
        return f"{self.pipeline.title} on a survey of any size, tile by tile, in several processes."

    @property
    def needed_packages(self) -> tuple[str, ...]:
        """Packages that a step can't run without."""
        return self.pipeline.needed_packages

    @property
    def outputs(self) -> list[Output]:
        """The outputs besides the tiles: layers, rasters, text files, and the report."""
        kinds, made = (Layer, Raster, TextFile), self.pipeline.outputs
        shown = [one for kind in kinds for one in made if isinstance(one.declared, kind)]
        return [*shown, *([self.report] if self.report else [])]

    @property
    def report(self) -> Optional[Output]:
        """The report of the steps that read the layers of the whole survey, None without such steps."""
        steps = afterwards(self.pipeline)
        return next((one for one in self.pipeline.outputs if one.step in steps and one.of == REPORT), None)


@dataclass(frozen=True)
class SurveyTool:
    """Work on the files of a survey that runs no stage."""

    name: str
    title: str
    tags: str
    summary: str
    description: str
    group: str = "Preparation"
    needed_packages: tuple[str, ...] = ESSENTIAL

    @property
    def id(self) -> str:
        """Processing id, ``cutintotiles``: frozen, saved models depend on it."""
        return self.name.replace("_", "")


CUT_INTO_TILES = SurveyTool(
    name="cut_into_tiles",
    title="Cut into tiles",
    tags="las,laz,copc,pdal,tile,tiles,split,grid,folder,survey,large,retile,lastile",
    summary="Cut point clouds of any size into square tiles.",
    description=(
        "The tiles are the cells of a lattice that starts at the origin of the coordinates; each is named by its lower "
        "left corner in meters. Every point of every file is in exactly one tile, with all its dimensions; points at a "
        "lower edge belong to the tile, those at an upper edge to the next one. Files are read in portions, so that "
        "memory does not grow with them; on the disk the points lie once uncompressed next to the tiles while they are "
        "made. A virtual point cloud over all tiles is written with them."
    ),
)


def settings_help(settings: dict[str, Setting]) -> str:
    """Return a list of settings, as HTML."""
    return f"<h3>Parameters: Survey</h3>\n{listed(setting.text() for setting in settings.values())}"


def survey_tool_help(tool: SurveyTool) -> str:
    """Return the help of a tool, as HTML that QGIS's help pane shows."""
    return "\n".join([paragraphs(tool.summary), paragraphs(tool.description), settings_help(CUT_SETTINGS)])


TILED_PIPELINES = {
    tiled.name: tiled for tiled in (TiledPipeline(of_survey(one)) for one in PIPELINES.values() if not why_whole(one))
}


def tiled_pipeline_help(tiled: TiledPipeline) -> str:
    """Return the help of a composite in tiles, and of its steps, as HTML that QGIS's help pane shows."""
    made = [output_text(tiled.pipeline, output) for output in tiled.outputs]
    tiles = (
        f"<b>OUTPUT</b>: a folder with a tile for each file, with {written_by(tiled.pipeline)}, and a virtual point "
        "cloud over all of them."
    )
    numbers = (
        "<b>TILES, BLOCKS, POINTS, FAILURES</b>: how many tiles were written, how many blocks and points were worked "
        "on, and how many blocks and tiles failed."
    )
    of_composite = pipeline_help(tiled.pipeline, [tiles, *made, numbers])
    parts = [paragraphs(tiled.summary), paragraphs(_DESCRIPTION), settings_help(SETTINGS), of_composite]
    return "\n".join(parts)
