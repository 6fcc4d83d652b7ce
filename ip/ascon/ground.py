# SPDX-License-Identifier: MIT
"""Runs the part of a mission for the core ascon: the core encrypts a report and decrypts it, and
rejects a forged report."""
import os


def fly(log, proxy, report):
    import Cores  # module that loadSlice generates from Ascon.ice

    ascon = Cores.AsconPrx.uncheckedCast(proxy("ascon"))
    nonce = os.urandom(16)
    message = report.encode()[:200]
    log.call("ground -> UAV", "ascon.setKey(16 bytes)", lambda: ascon.setKey(os.urandom(16)))
    text, tag = log.call("ground -> UAV", "ascon.seal(%d bytes)" % len(message),
                         lambda: ascon.seal(nonce, b"report", message))
    valid, opened = log.call("ground -> UAV", "ascon.unseal(as it was sealed)",
                             lambda: ascon.unseal(nonce, b"report", text, tag))
    if not valid or bytes(opened) != message:
        raise RuntimeError("ascon: what was sealed does not open")
    forged = bytes([text[0] ^ 1]) + bytes(text[1:])
    valid, opened = log.call("ground -> UAV", "ascon.unseal(one bit forged)",
                             lambda: ascon.unseal(nonce, b"report", forged, tag))
    if valid or opened:
        raise RuntimeError("ascon: a forged report was opened")
    digest = log.call("ground -> UAV", "ascon.hash(nothing)", lambda: ascon.hash(b""))
    # The first known answer that the standard's authors published.
    if bytes(digest).hex() != "0b3be5850f2f6b98caf29f8fdea89b64a1fa70aa249b8f839bd53baa304d92b2":
        raise RuntimeError("ascon: the digest of nothing is %s" % bytes(digest).hex())
    log.say("ascon: sealed, opened, and a forged bit found")
