"""What stages and composites have in common as algorithms: read, compute in memory, write all results or none."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
)

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.files import NOWHERE, check_readable, count_points, read_extent
from ..algorithms.memory import installed_memory
from ..algorithms.report.page import with_coordinates
from ..algorithms.run import Results
from ..algorithms.stage import CLOUD, REPORT, InputLayer, Layer, LayerFeatures, Monitor, Raster, Stage, TextFile
from ..algorithms.stages import less_memory
from ..algorithms.tiling.survey import Survey
from . import inputs
from .algorithm import CheckedAlgorithm
from .caller import is_step
from .clouds import cloud_path, files_read
from .crs_authority import crs_reader, text_of
from .destinations import Made
from .errors import as_processing_errors
from .feedback import FeedbackMonitor, warn_unknown_names
from .given import Given
from .input_layers import find_input_layers, input_layer_parameter, layer_files, read_input_layers, refuse_elsewhere
from .inputs import CRS, INPUT, REFERENCE
from .layer_outputs import write_layer, write_text
from .named_clouds import SIMULATED_CRS, named, names_of_crs, read_clouds
from .places import Place, place_of_cloud, place_of_layer
from .qgis_crs import WGS84
from .rasters import write_raster
from .run_log import RunLog, about_run, write_page
from .run_outputs import all_in_place, check_targets, write_for_qgis
from .styles import Styler, cloud_style, layer_style, show_on_load
from .web import check_sizes, log_size

# Bytes that stages take per point at most, the points themselves included.
_PER_POINT = 400

# Bytes of the unit of the message.
_GB = 1e9


def warn_if_memory_is_short(n_points: int, monitor: Monitor) -> None:
    """Warn of clouds that hardly fit into memory: where it ends, most systems end QGIS without a word."""
    installed, needed = installed_memory(), _PER_POINT * n_points
    if needed > installed:
        monitor.warn(
            f"{n_points:,} points may need {needed / _GB:.1f} GB of memory, this computer has {installed / _GB:.1f}; "
            f"if that is not enough, {less_memory()}."
        )


@dataclass
class Job:
    """What a run needs of its parameters, found out before it starts."""

    tunables: dict[str, Any]
    wanted: list[Made]
    clouds: list[Path] = field(default_factory=list)
    unmade: list[Made] = field(default_factory=list)  #: Outputs that need a layer which is not given
    layer: str = ""  #: Name of the layer that gives the cloud, "" for a file
    systems: list[str] = field(default_factory=list)  #: Coordinate reference systems of files in place of layers
    reference: Optional[Path] = None
    box: Optional[np.ndarray] = None
    spacing: Optional[np.ndarray] = None  #: Sides (3,) of cubes that one point each is read of, in units of the clouds
    crs: QgsCoordinateReferenceSystem = field(default_factory=QgsCoordinateReferenceSystem)

    @property
    def paths(self) -> list[Path]:
        """All clouds that are read, the reference last."""
        return [*self.clouds, *([self.reference] if self.reference else [])]

    @property
    def points(self) -> int:
        """How many points are read."""
        return sum(count_points(path, self.box, self.spacing) for path in self.paths)


@dataclass
class Read:
    """What was read for a run, and where on Earth that lies."""

    clouds: list[Cloud]
    reference: Optional[Cloud]
    layers: dict[str, LayerFeatures]
    place: Optional[Place]
    surveys: list[Survey] = field(default_factory=list)  #: In place of clouds that are worked on part by part


class CloudAlgorithm(CheckedAlgorithm, QgsProcessingAlgorithm):
    """An algorithm that reads clouds and layers, computes in memory, and writes all its results or none.

    Subclasses say what they read and make, and compute it.
    """

    compared: Optional[Stage]  #: The stage that reads the second cloud
    needs_cloud = True
    layers: Collection[InputLayer]
    made: list[Made]
    creates = False  #: Whether it makes a cloud of nothing
    #: Progress when all is read, and when all is computed; writing takes the rest
    shares = (0.15, 0.8)

    def add_tunables(self) -> None:
        """Declare the parameters that are tunables."""
        raise NotImplementedError

    def tunables(self, given: Given) -> dict[str, Any]:
        """Return the checked values of the tunables by their names."""
        raise NotImplementedError

    def number_titles(self) -> dict[str, str]:
        """Return the titles of the numbers that a run returns, by name."""
        raise NotImplementedError

    def monitor(self, feedback: QgsProcessingFeedback, log: RunLog) -> FeedbackMonitor:
        """Return the monitor of a run: it shows the progress and keeps the messages of steps."""
        raise NotImplementedError

    def compute(self, read: Read, monitor: Monitor) -> Results:
        """Return the results of what was read."""
        raise NotImplementedError

    def numbers(self, results: Results, values: dict[str, Any]) -> dict[str, Any]:
        """Return the numbers of a run by their names; ``values`` are those that its monitor received."""
        raise NotImplementedError

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802 - QGIS asks for these names
        """Declare inputs, tunables and outputs."""
        declared = self.declared
        if declared.reads_cloud:
            self.addParameter(inputs.input_parameter(declared.merges, declared.input_title, self.needs_cloud))
        if self.compared is not None:
            self.addParameter(inputs.reference_parameter(self.compared))
        for input_layer in self.layers:
            self.addParameter(input_layer_parameter(input_layer))
        self.add_tunables()
        if declared.reads_cloud:
            self.addParameter(inputs.extent_parameter())
            self.addParameter(inputs.spacing_parameter())
        if declared.reads_cloud or self.creates:
            self.addParameter(inputs.crs_parameter(SIMULATED_CRS if self.creates else None))
        for made in self.made:
            self.addParameter(made.definition())
        for name, title in self.number_titles().items():
            self.addOutput(QgsProcessingOutputNumber(name, title))
        self.name_pages()

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Check the parameters; raise a ValueError where a run can't succeed."""
        self.job = self._job(Given(self, parameters, context))

    def systems(self) -> list[str]:
        """Return the coordinate reference systems of the clouds, and the one that is given."""
        read = crs_reader(self.job.crs)
        systems = [read_extent(path, read, self.job.box)[2].plane for path in self.job.paths]
        has_file = any(isinstance(made.declared, TextFile) for made in self.job.wanted)
        return [*systems, *self.job.systems, *names_of_crs(self.job.crs), *[WGS84] * has_file]

    def _job(self, given: Given) -> Job:
        """Return the checked parameters of a run; raise a ValueError where it can't succeed."""
        declared = self.declared
        tunables = self.tunables(given)
        wanted = [made for made in self.made if given.has(made.name)]
        layers = find_input_layers(given, self.layers)
        compared = {one.wanted.name for one in layers} | ({REFERENCE.lower()} if given.has(REFERENCE) else set())
        job = Job(tunables, [made for made in wanted if not made.only_with or compared & set(made.only_with)])
        job.unmade = [made for made in wanted if made not in job.wanted]
        # Others last as long as their layers.
        job.systems = [one.source.sourceCrs().authid() for one in layers if one.wanted.read]
        if declared.reads_cloud and (self.needs_cloud or given.has(INPUT)):
            job.clouds = inputs.input_paths(given, declared.merges)
            job.layer = inputs.name_of_layer(given.parameters.get(INPUT))
        if self.compared is not None and (declared.needs_reference or given.has(REFERENCE)):
            job.reference = cloud_path(given, REFERENCE)
        job.crs = inputs.given_crs(given) if self.parameterDefinition(CRS) else job.crs
        if job.clouds:
            crs = read_extent(job.clouds[0], crs_reader(job.crs), NOWHERE)[2]
            job.box, job.spacing = inputs.extent_box(given, crs.plane), inputs.given_spacing(given, crs.factors)
        read = [*files_read(job.paths), *layer_files(given, layers)]
        check_targets(self.destinationParameterDefinitions(), given.parameters, read, job.clouds)
        # A cloud that is classified anew may well be assessed by the classes that it had.
        if job.reference and (declared.needs_reference or all(made.declared != CLOUD for made in self.made)):
            inputs.refuse_same(job.clouds, job.reference)
        for path in job.paths:
            check_readable(path, box=job.box)
        check_sizes(job.paths, job.box, job.spacing)
        if job.clouds:
            refuse_elsewhere(layers, job.clouds, job.box)
        return job

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Read, compute, write; all or nothing. What was cancelled has no results."""
        self.alone = not is_step(feedback)
        warn_unknown_names(self, parameters, feedback)
        definitions = self.destinationParameterDefinitions()
        subject = inputs.subject_of(self.job.paths, self.job.layer, feedback)
        title = self.displayName() if self.alone else ""
        log = RunLog()
        with as_processing_errors(feedback), all_in_place(definitions, parameters, context, subject, title) as run:
            monitor = self.monitor(feedback, log)
            if self.job.unmade:
                titles = ", ".join(made.title for made in self.job.unmade)
                monitor.inform(f"Not made, as what they compare with is not given: {titles}.")
            read = self._read(Given(self, parameters, context), monitor.part(0.0, self.shares[0]))
            results = self.compute(read, monitor.part(*self.shares))
            monitor.end_steps()
            if self.creates and results.cloud is not None:
                results.cloud = named(results.cloud, self.job.crs)
            place = place_of_cloud(results.cloud) if results.cloud is not None else read.place
            if place is None:
                raise ValueError(f"{self.displayName()} has neither a point cloud nor a layer; choose one.")
            writer = _Writer(Given(self, run.parameters, context), monitor.part(self.shares[1], 1.0), place)
            written = writer.write(self.job.wanted, results)
            written.update(writer.write_pages(self.job, results, log))
            monitor.end()
            numbers = self.numbers(results, monitor.values)
            return {**run.final(written), **{name: one for name, one in numbers.items() if one is not None}}
        return {}

    def _read(self, given: Given, monitor: Monitor) -> Read:
        """Read clouds and layers."""
        job = self.job
        # Before reading: a process that runs out of memory is ended without a message.
        warn_if_memory_is_short(job.points, monitor)
        log_size(job.paths, job.box, job.spacing, monitor)
        clouds = read_clouds(job.paths, monitor.parts(len(job.paths)), job.crs, job.box, job.spacing)
        reference = clouds.pop() if job.reference else None
        found = find_input_layers(given, self.layers)
        place = place_of_cloud(clouds[0]) if clouds else None
        if not clouds and found:
            place = place_of_layer(found[0].wanted.title, found[0].source, monitor)
        layers = read_input_layers(found, place, monitor.part(1.0, 1.0)) if place is not None else {}
        return Read(clouds, reference, layers, place)


@dataclass
class _Writer:
    """Writes results in memory to where the user wants them."""

    given: Given
    monitor: Monitor
    place: Place

    def write(self, wanted: Sequence[Made], results: Results) -> dict[str, str]:
        """Write everything but pages; return where each is, by the names of the outputs."""
        files = [made for made in wanted if made.declared != REPORT]
        written: dict[str, str] = {}
        for made, part in zip(files, self.monitor.parts(len(files))):
            written.update(self._write(made, results, part))
            part.progress(1.0)
        return written

    def _write(self, made: Made, results: Results, monitor: Monitor) -> dict[str, str]:
        """Write one result; return where it is."""
        declared = made.declared
        if isinstance(declared, Layer):
            return write_layer(self.given, made.name, declared, results.layers[made.key], self.place, monitor)
        if isinstance(declared, Raster):
            target = self.given.read("OutputLayer", made.name)
            write_raster(declared, results.rasters[made.key], self.place, Path(target), monitor)
            show_on_load(self.given.context, target, "Raster", Styler(layer_style(declared)))
            return {made.name: target}
        if isinstance(declared, TextFile):
            return write_text(self.given, made.name, declared, results.files[made.key], self.place, monitor)
        cloud = results.cloud if made.key == CLOUD else results.clouds[made.key]
        return self._write_cloud(made, cloud, monitor) if cloud is not None else {}

    def _write_cloud(self, made: Made, cloud: Cloud, monitor: Monitor) -> dict[str, str]:
        target = self.given.read("OutputLayer", made.name)
        shown = write_for_qgis(cloud, target, self.given.context, monitor)
        styler = Styler(cloud_style(made.stage, cloud), crs=cloud.crs.plane)
        show_on_load(self.given.context, shown, "Cloud", styler)
        return {made.name: target}

    def write_pages(self, job: Job, results: Results, log: RunLog) -> dict[str, str]:
        """Write the pages that are wanted, with what was run on which clouds and with which parameters."""
        written = {}
        for made in job.wanted:
            report = results.reports.get(made.key)
            if report is not None:
                written[made.name] = target = self.given.read("FileOutput", made.name)
                rows = about_run(self.given.algorithm.displayName(), job.paths, job.points, text_of(self.place.crs))
                write_page(target, with_coordinates(report.html, self.place.to_map), rows, log.steps)
        return written
