"""Settings of the documentation; generated pages are written before Sphinx reads the others."""

from __future__ import annotations

import configparser
import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
sys.path[:0] = [str(ROOT), str(DOCS)]

import conftest  # noqa: F401 - registers the checkout as the package lidar_buildings

_metadata = configparser.ConfigParser()
_metadata.read(ROOT / "metadata.txt", encoding="utf-8")

project = "LiDAR Buildings"
author = copyright = _metadata["general"]["author"]
release = version = _metadata["general"]["version"]

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
    "mathml",
]
exclude_patterns = ["_build", "gallery_src", "**/GALLERY_HEADER.rst", "sg_execution_times.rst"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3

html_theme = "furo"
html_title = f"{project} {release}"
html_logo = "../resources/icons/lidar_buildings.svg"
html_static_path = ["_static"]
html_css_files = ["book.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False

bibtex_bibfiles = ["references.bib"]
bibtex_reference_style = "author_year"

numpydoc_show_class_members = False
numpydoc_xref_param_type = False
autodoc_typehints = "none"


def trimmed(gallery_conf, fname) -> None:
    """Save the pictures of examples without their margins."""
    import matplotlib as mpl

    mpl.rcParams["savefig.bbox"] = "tight"


sphinx_gallery_conf = {
    "examples_dirs": "gallery_src",
    "gallery_dirs": "gallery",
    "filename_pattern": r"plot_",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "min_reported_time": 1,
    "capture_repr": (),
    "reset_modules": ("matplotlib", trimmed),
    "remove_config_comments": True,
    "within_subsection_order": "FileNameSortKey",
    "nested_sections": False,
    "write_computation_times": False,
    "backreferences_dir": None,
}
# sphinx-gallery keeps functions in its settings, which Sphinx can't store between builds.
suppress_warnings = ["config.cache"]


def cited(app, what, name, obj, options, lines) -> None:
    """Turn keys of references.bib in docstrings into citations."""
    lines[:] = [re.sub(r"\[([a-z]+\d{4})\]", r":cite:p:`\1`", line) for line in lines]


def setup(app) -> None:
    """Write the generated pages, and resolve citations."""
    import generated_pages

    app.connect("autodoc-process-docstring", cited)

    generated_pages.write(DOCS)
