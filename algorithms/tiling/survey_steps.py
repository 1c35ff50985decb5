"""Run the steps of a composite that work on the layers of the whole survey and make its pages."""

from typing import Optional

import numpy as np

from ..cloud.cloud import Cloud, create_cloud
from ..pipeline import REPORT, Step
from ..report.hillshade import CELLS
from ..run import run_stage
from ..stage import LayerFeatures
from .tiled_run import JOINED, RunSettings, TilesOutcome
from .tiled_steps import afterwards, made_by
from .views import View


class SurveySteps:
    """The steps of a composite that come after its blocks."""

    def __init__(self, settings: RunSettings, outcome: TilesOutcome) -> None:
        self.settings, self.outcome = settings, outcome
        steps = afterwards(settings.working)
        self._others = [step for step in steps if not step.stage.shows]
        self._paged = [step for step in steps if step.stage.shows]
        self._names = {(output.step.name, output.of): output.name for output in settings.pipeline.outputs}

    def run_others(self) -> None:
        """Run the steps that need no points."""
        self._run(self._others, None)

    def view(self) -> Optional[View]:
        """Return what the tiles keep of their points for pages, None where no page needs any."""
        if not self._paged or not self.outcome.layers:
            return None
        boxes = [step.stage.shows(**self._layers_of(step, {})) for step in self._paged]  # type: ignore[misc]
        survey = self.outcome.survey
        # Of a survey without extent any cell will do.
        cell = float(np.ptp(survey.box, axis=0).max()) / CELLS or 1.0
        return View(self.settings.work, survey.origin, cell, np.concatenate(boxes))

    def run_paged(self, view: Optional[View]) -> None:
        """Run the steps that make pages, with what the tiles have kept of their points."""
        self._run(self._paged, view)

    def _run(self, steps: list[Step], view: Optional[View]) -> None:
        settings, outcome = self.settings, self.outcome
        if not steps or not outcome.layers:
            return
        find = settings.options.find_layers
        given = find(outcome.survey) if find else {}
        chosen = {step.name: of_step for step, of_step in settings.pipeline.by_step(settings.tunables)}
        for step in steps:
            if step.only_with and all(given.get(name) is None for name in step.only_with):
                continue
            monitor = settings.monitor.part(JOINED, JOINED, f"{step.name}_")
            cloud = self._shown(view) if step.stage.shows else None
            layers = self._layers_of(step, given)
            # The points that are shown are no sample of the survey.
            sampling = outcome.sampling if step.stage.samples else None
            made = run_stage(step.stage, cloud, None, monitor, layers, sampling, **chosen[step.name])
            outcome.layers.update({self._names[step.name, of]: features for of, features in made.layers.items()})
            if made.report is not None:
                outcome.reports[self._names[step.name, REPORT]] = made.report

    def _layers_of(self, step: Step, given: dict[str, Optional[LayerFeatures]]) -> dict[str, Optional[LayerFeatures]]:
        """Return the layers that a step reads, by the names that it gives them."""
        made = {name: self.outcome.layers[self._names[made_by(earlier)]] for name, earlier in step.layers.items()}
        return {one.name: made.get(one.name, given.get(one.name)) for one in step.stage.input_layers}

    def _shown(self, view: Optional[View]) -> Optional[Cloud]:
        """Return the points that the tiles have kept, None without any."""
        if view is None:
            return None
        xyz, classification = view.points(self.outcome.tiles)
        return create_cloud({"xyz": xyz, "classification": classification}) if len(xyz) else None
