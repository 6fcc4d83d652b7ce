# SPDX-License-Identifier: MIT
"""templates: files that are generated from the Jinja templates of a folder."""


def environment(folder, **names):
    """Returns Jinja's environment for a folder of templates; `names` are known in all of them.
    Imports Jinja here, because commands of an empty machine import this module before it is
    installed."""
    import jinja2  # pylint: disable=import-outside-toplevel
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder), trim_blocks=True, lstrip_blocks=True,
        keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
    made.globals.update(names)
    return made
