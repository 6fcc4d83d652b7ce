# SPDX-License-Identifier: MIT
"""reasons: turns errors of the system and of Ice into short texts for a user."""
import errno
import os
import re
import termios

import Ice

LOST = "the modem is lost or does not answer: check its cable and its power"


def reason_of(error, connecting="cannot connect: "):
    """Returns the reason of an error. The number or class of the error is left out if there is a
    better text. connecting: prefix of the reason if a connection could not be made."""
    if isinstance(error, OSError) and error.strerror:
        return ": ".join(str(part) for part in (error.filename, error.strerror) if part)
    if isinstance(error, termios.error):
        return str(error.args[-1])
    if not isinstance(error, Ice.Exception):
        return str(error)
    if isinstance(error, Ice.DNSException):
        return "%s: host not found" % error.host
    for field in ("unknown", "reason", "str"):
        if getattr(error, field, ""):
            text = getattr(error, field).strip().rpartition("\n")[2]
            # IceC sends the name of its status, such as "::Ice::TimeoutException".
            return "the servant reported " + text if text.startswith("::Ice::") else text
    if getattr(error, "error", 0):
        prefix = connecting if isinstance(error, Ice.ConnectFailedException) else ""
        # the plugin uses ENOLINK, "Link has been severed", for a modem that it cannot use
        is_lost = error.error == errno.ENOLINK
        return prefix + (LOST if is_lost else os.strerror(error.error))
    # Other exceptions have no text. Their reason is the name of the exception, split into words,
    # such as "Connection lost".
    name = error.ice_id().rpartition(":")[2].replace("Exception", "")
    return re.sub("(?<=[a-z])(?=[A-Z])", " ", name).capitalize()
