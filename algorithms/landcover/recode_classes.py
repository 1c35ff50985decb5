"""Class codes of an agency, or of one's own, instead of ASPRS'."""

import numpy as np

from ..cloud.asprs import NOISE, VEGETATION, PointClass, parse_classes
from ..stage import stage, tunable

_ASPRS = "ASPRS"
_WIRES = (PointClass.WIRE_CONDUCTOR, PointClass.TRANSMISSION_TOWER)
_OTHER = int(PointClass.UNCLASSIFIED)

# Codes that agencies write for classes of ASPRS; other classes keep their code.
CODES: dict[str, dict[int, int]] = {
    _ASPRS: {},
    # Civil works are 26; plants, noise and masts are "other", and wires keep 14.
    "AHN (Netherlands)": {
        **{int(one): _OTHER for one in (0, *VEGETATION, *NOISE, PointClass.TRANSMISSION_TOWER)},
        int(PointClass.BRIDGE_DECK): 26,
    },
    # Lasting objects above the ground are 64, artefacts 65.
    "IGN LiDAR HD (France)": {0: _OTHER, **{int(one): 64 for one in _WIRES}, **{int(one): 65 for one in NOISE}},
    # The base specification has no class for plants and wires; buildings are an optional one.
    "USGS 3DEP (United States)": {int(one): _OTHER for one in (0, *VEGETATION, *_WIRES)},
}


@stage(
    "Land cover",
    tags="class,code,mapping,remap,translate,AHN,IGN,USGS,LiDAR HD,3DEP,ASPRS,convert",
    writes=("classification",),
    cost=0.1,
    packages=(),
)
def recode_classes(
    xyz,
    classification,
    *,
    codes: str = tunable(_ASPRS, label="Codes to write", choices=tuple(CODES)),
    mapping: str = tunable("", label="Own codes"),
    monitor=None,
):
    """Replace class codes by an agency's, or by one's own.

    The last step of a chain: every other step reads the codes of ASPRS.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The codes.

    Other Parameters
    ----------------
    codes
        Class codes that are written: the codes of ASPRS, which all other steps read, or of the Dutch, the French or the
        American survey.
    mapping
        Classes and the code that each gets instead, over those chosen above: 3-5=5; 17=26. Numbers and ranges before
        the equals sign, entries separated by semicolons; empty for none.

    Raises
    ------
    ValueError
        If the mapping is no list of classes with a code from 0 to 255 each.

    Notes
    -----
    AHN: plants, noise and masts become 1 (other), bridge decks 26 (civil works). IGN: wires and masts become 64
    (lasting objects above the ground), noise 65 (artefacts). USGS: plants, wires and masts become 1. LAS formats 0 to 5
    hold codes up to 31 only.

    References
    ----------
    ASPRS, 2019. LAS specification 1.4, R15, table 17. [asprs2019]
    IGN, 2023. LiDAR HD: descriptif de contenu des nuages de points classés. [ign2023]
    USGS, 2024. Lidar base specification, table 5. [usgs2024]

    Examples
    --------
    >>> recode_classes([[0, 0, 0], [1, 0, 0]], np.array([6, 17]), codes="AHN (Netherlands)")
    array([ 6, 26], dtype=uint8)
    """
    table = np.arange(256, dtype=np.uint8)
    for number, code in {**CODES[codes], **parse_mapping(mapping)}.items():
        table[number] = code
    return table[classification.astype(np.uint8)]


def parse_mapping(text: str) -> dict[int, int]:
    """Return the code of each class of a text such as ``"3-5=5; 17=26"``.

    Raises
    ------
    ValueError
        If an entry has no sign of equality, or anything else than numbers from 0 to 255.
    """
    found: dict[int, int] = {}
    for entry in filter(None, (part.strip() for part in text.split(";"))):
        classes, _, code = (part.strip() for part in entry.partition("="))
        if not code.isdecimal() or int(code) > 255 or not classes:  # noqa: PLR2004 - a byte holds the code
            raise ValueError(
                f"Own codes (mapping) must be classes, a sign of equality and a code from 0 to 255, got {entry!r}; "
                "write, say, 17=26."
            )
        found.update(dict.fromkeys(parse_classes(classes, "Own codes").tolist(), int(code)))
    return found
