# SPDX-License-Identifier: MIT
"""templates: generates files from the Jinja templates of a folder."""


def environment(folder, **names):
    """Returns Jinja's environment for a folder of templates; all of them can use `names`. Jinja is
    imported here because on an empty machine, commands import this module before Jinja is
    installed."""
    import jinja2  # pylint: disable=import-outside-toplevel
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder), trim_blocks=True, lstrip_blocks=True,
        keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
    made.globals.update(names)
    return made
