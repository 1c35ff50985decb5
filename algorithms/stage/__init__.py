"""Stages and their tunables: how a numpy function declares what it is.

A stage is an ordinary function with a declaration beside it:

* positional arguments name the dimensions it reads (``dimensions.py``); one
  with the default None is read only where the cloud has it, and the prefix
  ``reference_`` means the second cloud of a comparison. ``values`` is the
  dimension that the tunable ``dimension`` names, whichever the file has;
* positional arguments after them are the vector layers that it reads, each
  declared as a :class:`Source`; a stage that reads layers only has no cloud;
* keyword-only arguments are tunables, each ``Annotated[type, Param(...)]``
  with its default; ``Optional`` types with the default None are *automatic*:
  the stage derives the value from the data and tells it to the monitor;
* ``monitor`` (a :class:`Monitor`) hears how far the stage is.

It returns values for the points it was given (``writes``), a new cloud
(``creates``), vector layers (``layers``), rasters (``rasters``), numbers with a
page (``measures``), or several of these. Two kinds make a cloud of other points:
one that ``selects`` says first which points its result has, and in which order;
one that ``merges`` reads several clouds, each argument a list with one array per
cloud, and its result has the points of all. Both may write ``xyz``, and both
leave withheld points out.

Everything a user sees of a stage (dialog, tooltip, help, bounds, composite
parameters) is derived from this declaration and written nowhere else. This
package needs the standard library and numpy only and knows nothing of QGIS.
"""

from .arguments import REFERENCE_PREFIX
from .contents import Features, Field, Layer, Made, Measure, Raster, Report, Source, Surface, given_layers
from .declaration import DIMENSION, VALUES, Stage, stage
from .monitor import Cancelled, Monitor
from .tunables import Param, Tunable

__all__ = [
    "Cancelled",
    "DIMENSION",
    "Features",
    "Field",
    "Layer",
    "Made",
    "Measure",
    "Monitor",
    "Param",
    "REFERENCE_PREFIX",
    "Raster",
    "Report",
    "Source",
    "Stage",
    "Surface",
    "Tunable",
    "VALUES",
    "given_layers",
    "stage",
]
