"""Stages and their tunables: how a numpy function declares its inputs, outputs and parameters.

A stage is an ordinary function with a declaration next to it:

* positional arguments name the dimensions it reads (``dimensions.py``); one
  with the default None is read only where the cloud has it, and the prefix
  ``reference_`` means the second cloud of a comparison. ``values`` is the
  dimension that the tunable ``dimension`` names, whichever the file has;
* positional arguments after them are the vector layers that it reads, each
  declared as a :class:`InputLayer`; a stage that reads layers only has no cloud;
* keyword-only arguments are tunables, each ``name: type = tunable(default, ...)``; "Other Parameters" of the docstring
  says what each does. ``Optional`` types with the default None are *automatic*:
  the stage derives the value from the data and reports it to the monitor;
* ``sampling`` with the default None is how the cloud was sampled (density, noise and the like, a
  ``CloudSampling``): no tunable. The runner measures it once for all stages of a run, or is given it; a stage that
  is called alone measures its own;
* ``monitor`` (a :class:`Monitor`) receives progress, automatic values and warnings.

It returns values for the points it was given (``writes``), a new cloud (``creates``), vector layers (``layers``),
rasters (``rasters``), text files (``files``), numbers with a page (``measures``), or several of these. Two kinds make a
cloud of other points: one that ``selects`` says first which points its result has, and in which order. One that
``merges`` reads several clouds, each argument a list with one array per cloud, and its result has the points of all.
Both may write ``xyz``, and both leave withheld points out.

Everything a user sees of a stage (dialog, tooltip, help, bounds, composite
parameters) is derived from this declaration and written nowhere else. This
package needs the standard library and numpy only, and is independent of QGIS.
"""

from .arguments import REFERENCE_PREFIX  # noqa: F401 - the names that stages import
from .declaration import CLOUD, DIMENSION, REPORT, SAMPLING, VALUES, Declared, Stage, stage  # noqa: F401
from .docstrings import description, sections, summary  # noqa: F401
from .inputs_outputs import (  # noqa: F401
    Field,
    FileContent,
    FileItem,
    InputLayer,
    Layer,
    LayerFeatures,
    MapFrame,
    Measure,
    Piece,
    Raster,
    RasterSurface,
    Report,
    StageResults,
    TextFile,
    all_fields,
    as_column,
    column_on_map,
    feature_names,
    given_layers,
    plain,
)
from .monitor import Cancelled, Monitor, Part, ProgressOnly  # noqa: F401
from .tunables import Param, Tunable, in_words, tunable, with_unit  # noqa: F401
