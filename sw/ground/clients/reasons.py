# SPDX-License-Identifier: MIT
"""reasons: turns errors of the system and of Ice into short texts for a user."""
import os
import termios

import Ice


def reason_of(error):
    """Returns the reason of an error, without its number or class if there is a better text."""
    if isinstance(error, OSError) and error.strerror:
        return ": ".join(str(part) for part in (error.filename, error.strerror) if part)
    if isinstance(error, termios.error):
        return str(error.args[-1])
    if not isinstance(error, Ice.Exception):
        return str(error)
    if isinstance(error, Ice.DNSException):
        return "%s: host not found" % error.host
    for field in ("unknown", "reason"):
        if getattr(error, field, ""):
            return getattr(error, field).strip().rpartition("\n")[2]
    number = getattr(error, "error", 0)
    return os.strerror(number) if number else error.ice_id().rpartition(":")[2]
