"""Configuration of the documentation; `make docs` builds it, without a network."""

from __future__ import annotations

import os
import sys
from importlib.metadata import version as installed
from pathlib import Path

from rollnip.model import Model
from rollnip.rolling.claimed_errors import MODEL_SHARES, SHARE_OF_EDGE_PEAK

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))
import timings  # noqa: E402  from docs/_ext

# Small dense systems are many times slower with threaded BLAS; the kernels inherit this.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")
# Kernels start in the folder of their page; the command sits beside the interpreter.
os.environ["PATH"] = str(Path(sys.executable).parent) + os.pathsep + os.environ["PATH"]
os.environ["COLUMNS"] = "80"
os.environ["ROLLNIP_SOURCE"] = str(HERE.parent)  # where hidden cells find helpers and data
# Kernels read no settings of whoever builds, and say nothing but errors.
profile = HERE / "_build" / "ipython" / "profile_default"
profile.mkdir(parents=True, exist_ok=True)
(profile / "ipython_kernel_config.py").write_text('c.Application.log_level = "ERROR"\n')
os.environ["IPYTHONDIR"] = str(profile.parent)

project = "rollnip"
author = "The rollnip developers"
copyright = "The rollnip developers"
version = release = installed("rollnip")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "docstrings",
    "reference",
]
exclude_patterns = [
    "_build",
    "_ext",
    "_static",
    "figures",
    "scripts",
    "gallery_scripts",
    "examples/*.ipynb",
    "examples/*.py",
    "examples/*.rst.new",
    "**/README.md",
]
source_suffix = {".md": "myst-nb", ".rst": "restructuredtext"}
nitpicky = True
nitpick_ignore_regex = [
    (r"py:.*", r"(numpy|np|scipy|matplotlib|pathlib|collections|typing|os|pydantic|io)\..*"),
    (r"py:.*", r"(Path|NDArray|ArrayLike|Array|ComplexArray|Axes|Figure|Any|TypeAliasForwardRef)"),
    (r"py:.*", r"(enum\.IntEnum|abc\.ABC|concurrent\.futures\..*|tuple\[.*)"),
    # Types that modules hand to each other and no door offers.
    (r"py:class", r"Refined|MembraneIterate|PlateIterate"),
    (r"py:.*", r"rollnip\.\w+\.\w+\.\w+"),
    (r"py:.*", r"rollnip\..*\._\w+"),
]
default_role = "code"

# MyST
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath", "amsmath", "substitution"]
myst_substitutions = {
    "default_geometry": f'`"{Model().geometry}"`',
    "default_tolerance": Model().tolerance,
    "release": release,
    **{
        f"share_{name}": f"{100 * MODEL_SHARES['finite'][name]:g} %"
        for name in ("load", "creepage", "nip_width", "peak_pressure")
    },
    **{
        f"share_second_{name}": f"{100 * MODEL_SHARES['second'][name]:g} %"
        for name in ("load", "creepage", "nip_width", "peak_pressure")
    },
    "share_second_edge_peak": f"{100 * SHARE_OF_EDGE_PEAK['second']:g} %",
    "share_gripped_peak": f"{100 * SHARE_OF_EDGE_PEAK['gripped']:g} %",
    "share_edge_peak": f"{100 * SHARE_OF_EDGE_PEAK['finite']:g} %",
    **timings.substitutions(),
}
myst_heading_anchors = 3
myst_dmath_double_inline = True
nb_execution_mode = "auto"
nb_execution_raise_on_error = True
nb_execution_timeout = 600  # a cell solves some 90 nips in five geometries, beside the tests
nb_merge_streams = True
nb_render_markdown_format = "myst"  # tables that cells write
nb_execution_in_temp = True

# Mathematics: one vendored file with all its letters; no menu, which would ask for more files.
mathjax_path = "mathjax/tex-svg.js"
mathjax3_config = {"options": {"enableMenu": False}}

# Python
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_type_aliases = {"Array": "Array", "ArrayLike": "ArrayLike"}
autodoc_preserve_defaults = True
add_module_names = False
python_use_unqualified_type_names = True
toc_object_entries_show_parents = "hide"
viewcode_follow_imported_members = True

sphinx_gallery_conf = {
    "examples_dirs": "gallery_scripts",
    "gallery_dirs": "examples",
    "filename_pattern": r"/plot_",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "write_computation_times": False,
    "image_srcset": ["2x"],
    "plot_gallery": True,
    "abort_on_example_error": True,
}

# HTML
html_theme = "pydata_sphinx_theme"
html_title = "rollnip"
html_static_path = ["_static"]
html_css_files = ["rollnip.css"]
# Pages without pages below them need no column for those; wide tables need its room.
html_sidebars = {
    page: []
    for page in (
        "index",
        "getting-started",
        "tutorial",
        "theory",
        "limits",
        "conventions",
        "validation",
        "verification",
        "geometry",
        "finite-strain",
    )
}
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
html_theme_options = {
    "navbar_start": ["navbar-logo"],
    "navbar_center": ["navbar-nav"],
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "header_links_before_dropdown": 6,
    "secondary_sidebar_items": {
        "**": ["page-toc"],
        "verification": [],
        # 80 columns of output need the room.
        "how-to/drive": [],
        "how-to/interior": [],
        "how-to/layers": [],
        "how-to/results": [],
        "how-to/variations": [],
        "how-to/verify": [],
        "how-to/viscoelastic": [],
    },
    "show_prev_next": True,
    "show_toc_level": 2,
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
