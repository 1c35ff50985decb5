"""Settings of a run in tiles besides the parameters of the composite: titles and help for dialog and pages."""

import html
from dataclasses import dataclass


@dataclass(frozen=True)
class Setting:
    """One setting: its name on the command line, its title in the dialog, and its purpose."""

    name: str
    title: str
    help: str

    def text(self) -> str:
        """Return it as HTML, as the parameters of a composite are."""
        return f"<b>{html.escape(self.title)}</b> ({self.name}): {html.escape(self.help)}"


def by_name(*settings: Setting) -> dict[str, Setting]:
    """Return settings by their names."""
    return {setting.name: setting for setting in settings}


_INPUT = Setting("INPUT", "Survey", "A folder of .las and .laz files, a .vpc file, or any number of files.")
_EXTENT = Setting(
    "EXTENT",
    "Extent (empty = the whole cloud)",
    "Only points within are read: to try parameters on a part of the cloud first. Empty: all points.",
)
_SPACING = Setting(
    "SPACING",
    "Spacing (m, empty = all points)",
    "Of each cube of this side only the lowest point is used, where no full density is needed: terrain of "
    "coarse cells, or a first look at a large cloud. Of COPC and Entwine point tiles only the coarse levels "
    "are read, which takes much less time and memory. Empty: all points.",
)
_COMPRESSED = Setting("COMPRESSED", "Write LAZ", "Tiles are compressed (.laz); otherwise they are .las files.")

# Of a cloud that is read as a whole.
READ_SETTINGS = by_name(_EXTENT, _SPACING)

# Of a composite in tiles.
SETTINGS = by_name(
    _INPUT,
    _EXTENT,
    _SPACING,
    Setting(
        "CRS",
        "Coordinate reference system",
        "For clouds whose files name none, and for their results. Clouds that name one keep it.",
    ),
    Setting(
        "BLOCK_SIDE",
        "Side of a block (m, empty = automatic)",
        "Larger blocks take more memory and less time, as less of what surrounds them is worked on twice. Empty: "
        "the largest multiple of 10 m, from 100 to 1600 m, at which a block and the margin read around it hold at "
        "most 5.3 million points. In dense clouds it is at least 1.25 times the margin, at most 100 m.",
    ),
    Setting(
        "PROCESSES",
        "Processes (empty = one for each core)",
        "How many blocks are worked on at once; each takes about 2 GB of memory. Empty: one for each core, no more "
        "than have room in three quarters of the memory.",
    ),
    Setting(
        "SCHEDULER",
        "Address of a Dask scheduler",
        "For example tcp://head-node:8786 or tls://head-node:8786; empty: processes of this machine. The workers "
        "must see the input and the output folder under the same paths.",
    ),
    Setting(
        "CERTIFICATES",
        "Certificates for tls",
        "Three files of PEM, with semicolons between: certificate authority; certificate; key.",
    ),
    _COMPRESSED,
    Setting(
        "LOAD",
        "Show the tiles on the map",
        "Each tile is written as COPC too, into a folder 'shown' among the tiles, and a virtual point cloud over "
        "these is loaded: QGIS shows the points of no other tiles. It takes as much space again. Without effect on "
        "the command line.",
    ),
)

# Of the tool that cuts.
_SIDE = Setting("SIDE", "Side of a tile (m)", "Tiles are squares of this side.")
CUT_SETTINGS = by_name(_INPUT, _SIDE, _EXTENT, _COMPRESSED)
