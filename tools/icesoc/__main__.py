# SPDX-License-Identifier: MIT
"""Runs a command of `./icesoc`."""
import sys

try:
    from icesoc.cli.main import main
    sys.exit(main(sys.argv[1:]))
except (ImportError, MemoryError, SystemError) as error:
    sys.exit("icesoc: Python cannot start, because memory or a file is missing: "
             + (str(error) or "out of memory"))
