"""The one Processing algorithm that turns any stage into a dialog, a model child and a command."""

from dataclasses import replace
from typing import Any

from qgis.core import QgsProcessingFeedback

from ..algorithms.cloud.crs import common_crs
from ..algorithms.cloud.dimensions import DIMENSIONS
from ..algorithms.help import stage_help
from ..algorithms.run import Results, run_stage
from ..algorithms.stage import CLOUD, REPORT, Monitor, Raster, Stage
from ..algorithms.tiling.features_in_blocks import LARGEST, measure_features, run_in_windows
from ..algorithms.tiling.survey import Survey, crs_of_survey, open_survey
from .cloud_algorithm import CloudAlgorithm, Read
from .crs_authority import crs_reader
from .destinations import Made
from .feedback import FeedbackMonitor, announce
from .given import Given
from .input_layers import find_input_layers, read_input_layers
from .inputs import cloud_title, result_title
from .parameters import automatic_numbers, number_outputs, parameter, tunable_values, used_name
from .run_log import RunLog
from .surveys import place_of_survey
from .vectors import number
from .web import log_size


class StageAlgorithm(CloudAlgorithm):
    """A stage as a Processing algorithm; everything it shows comes from the stage's declaration."""

    def __init__(self, stage: Stage) -> None:
        super().__init__()
        self.stage = self.declared = stage
        self.compared = stage if stage.reads_reference else None
        self.needs_cloud = stage.needs_cloud
        self.layers = stage.input_layers
        self.creates = bool(stage.creates)
        self.made = _made(stage)

    def help(self) -> str:
        """Return the help as HTML."""
        return stage_help(self.stage)

    def add_tunables(self) -> None:
        """Declare the parameters that are tunables."""
        for tunable in self.stage.tunables.values():
            self.addParameter(parameter(tunable))

    def tunables(self, given: Given) -> dict[str, Any]:
        """Return the checked values of the tunables by their names."""
        return tunable_values(given, self.stage)

    def number_titles(self) -> dict[str, str]:
        """Return the titles of the measures, and of what automatic tunables took, by name."""
        return number_outputs(self.stage)

    def monitor(self, feedback: QgsProcessingFeedback, log: RunLog) -> FeedbackMonitor:
        """Return the monitor of a run: it shows the progress and keeps the messages."""
        announce(self.stage.title, feedback)
        log.begin(self.stage, self.job.tunables)
        return FeedbackMonitor(feedback, log)

    def _read(self, given: Given, monitor: Monitor) -> Read:
        """Read clouds and layers; of a large cloud that is worked on part by part the layers alone."""
        job, stage = self.job, self.stage
        found = find_input_layers(given, stage.input_layers)
        in_parts = stage.each or (stage.windowed and len(found) == len(stage.input_layers))
        if not in_parts or job.points <= LARGEST:
            return super()._read(given, monitor)
        log_size(job.paths, job.box, job.spacing, monitor)
        surveys = self._surveys(monitor)
        place = place_of_survey(surveys[0])
        return Read([], None, read_input_layers(found, place, monitor), place, surveys)

    def _surveys(self, monitor: Monitor) -> list[Survey]:
        """Return the cloud as a survey, and the reference, with the meters of the cloud, where one is given."""
        job, read = self.job, crs_reader(self.job.crs)
        surveys = [open_survey(job.clouds, read, monitor, job.box, job.spacing)]
        if job.reference:
            first, own = surveys[0].crs, crs_of_survey([job.reference], read)
            leader = common_crs([first, own], [path.name for path in job.paths], monitor, whole=False)
            shared = replace(own if own.identity else leader, horizontal=first.horizontal)
            surveys.append(open_survey([job.reference], lambda _: shared, monitor, job.box, job.spacing))
        return surveys

    def compute(self, read: Read, monitor: Monitor) -> Results:
        """Run the stage on what was read."""
        if read.surveys and self.stage.each:
            layer = measure_features(self.stage, read.surveys[0], read.layers[self.stage.each], monitor)
            return Results(None, {self.stage.layers[0].name: layer})
        if read.surveys:
            found = run_in_windows(self.stage, read.surveys, {**read.layers}, monitor, **self.job.tunables)
            return Results(None, found.layers, found.report, reports={REPORT: found.report})
        self._log_earlier_dimensions(read, monitor)
        made = run_stage(self.stage, read.clouds, read.reference, monitor, read.layers, **self.job.tunables)
        self._warn_if_nothing_was_selected(read, made.cloud, monitor)
        reports = {REPORT: made.report} if made.report is not None else {}
        return Results(made.cloud, made.layers, made.report, made.rasters, made.files, reports=reports)

    def numbers(self, results: Results, values: dict[str, Any]) -> dict[str, Any]:
        """Return the measures, and the values of automatic tunables, by the names of their outputs."""
        numbers = {}
        for tunable in automatic_numbers(self.stage):
            given = self.job.tunables[tunable.name]
            numbers[used_name(tunable)] = number(values.get(tunable.name) if given is None else given)
        for measure in self.stage.measures if results.report is not None else ():
            numbers[measure.name.upper()] = number(results.report.values[measure.name])
        return numbers

    def _warn_if_nothing_was_selected(self, read: Read, selected: Any, monitor: Monitor) -> None:
        """Warn where a selection by the user is the whole cloud: an area or a limit was forgotten."""
        selects_alone = self.stage.selects and self.alone and self.job.box is None
        if selects_alone and len(selected) == len(read.clouds[0]):
            monitor.warn(f"All {len(selected):,} points stay: nothing that is set leaves any out.")

    def _log_earlier_dimensions(self, read: Read, monitor: Monitor) -> None:
        """Log which dimensions of earlier runs are read; in a user's chain, where its own steps made them, none."""
        names = [name for name in self.stage.optional if name in DIMENSIONS and not DIMENSIONS[name].standard]
        earlier = [DIMENSIONS[name].disk[0] for name in names if all(cloud.has(name) for cloud in read.clouds)]
        if self.alone and earlier:
            monitor.inform(f"The cloud has {', '.join(earlier)} of an earlier run; they are taken as they are.")


def _made(stage: Stage) -> list[Made]:
    """Return the outputs of a stage. The first layer or the only raster is required where it makes nothing else."""
    made: list[Made] = []
    has_other = bool(stage.makes_cloud or stage.measures or stage.files)
    for name, declared in stage.outputs.items():
        is_one_of_several = isinstance(declared, Raster) and len(stage.rasters) > 1
        optional = declared != CLOUD and (has_other or bool(made) or is_one_of_several)
        title = cloud_title([stage]) if name == CLOUD else result_title(stage, declared)
        made.append(Made(name.upper(), title, stage, declared, optional))
    return made
