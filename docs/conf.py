# SPDX-License-Identifier: MIT
"""Configuration of the documentation site, which `./icesoc docs` builds with Sphinx."""
project = "IceSoC"
author = "the IceSoC authors"
extensions = ["myst_parser", "breathe"]
exclude_patterns = ["man", "waves"]
suppress_warnings = ["myst.xref_missing_download"]

myst_heading_anchors = 4
myst_enable_extensions = ["deflist"]

breathe_default_project = "icesoc"
breathe_domain_by_extension = {"h": "c"}

html_theme = "furo"
html_title = "IceSoC"
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
pygments_style = "friendly"
pygments_dark_style = "monokai"
