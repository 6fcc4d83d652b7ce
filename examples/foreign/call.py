#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calls third-party cores by radio: call.py DEVICE GUARD STATUS PLUGIN Registers.ice foreign_cobs.ice

An AES key and block of FIPS 197, appendix B; a byte through each UART and the SPI controller, whose outputs lead to
their inputs; the I2C master's registers; packets through the COBS encoder's AXI-Streams. With stock ZeroC Ice.
"""
import sys

import Ice

device, guard, status, plugin, *files = sys.argv[1:]
for file in files:
    Ice.loadSlice("", [file])
import Cores  # noqa: E402
import Hw  # noqa: E402

KEY = (0x2B7E1516, 0x28AED2A6, 0xABF71588, 0x09CF4F3C)
BLOCK = (0x3243F6A8, 0x885A308D, 0x313198A2, 0xE0370734)
CIPHER = [0x3925841D, 0x02DC09FB, 0xDC118597, 0x196A0B32]


def until(core, name, condition):
    for _ in range(100):
        if condition(value := core.get(name)):
            return value
    sys.exit("%s stays 0x%X" % (name, value))


def aes(core):
    for i, word in enumerate(KEY):
        core.set("KEY%d" % i, word)
    core.set("CONFIG", 1)  # encipher, 128 bits
    core.set("CTRL", 1)    # expand the key
    until(core, "STATUS", lambda v: v & 1)
    for i, word in enumerate(BLOCK):
        core.set("BLOCK%d" % i, word)
    core.set("CTRL", 2)
    until(core, "STATUS", lambda v: v & 2)
    return [core.get("RESULT%d" % i) for i in range(4)], CIPHER


def uart(send, receive):
    def call(core):
        core.set("SETUP", 20)  # clocks a bit
        core.wait(0)           # what was before
        core.set(send, 0xA5)
        events = core.wait(1000)
        return (events, core.get(receive) & 0x1FF), (["CORE"], 0xA5)
    return call


def spi(core):
    core.set("CTRL", 1)
    core.set("DATA", 0x5A)
    until(core, "CTRL", lambda v: not v >> 31)
    return core.get("DATA") & 0xFF, 0x5A


def i2c(core):
    core.set("PRER_LO", 0x3F)
    core.set("CTR", 0x80)
    return (core.get("PRER_LO"), core.get("CTR")), (0x3F, 0x80)


def cobs(data):
    """Consistent overhead byte stuffing (Cheshire and Baker, 1999), and the zero at its end."""
    out = bytearray()
    for part in data.split(b"\0"):
        while len(part) >= 254:
            out += b"\xff" + part[:254]
            part = part[254:]
        out += bytes([len(part) + 1]) + part
    return bytes(out) + b"\0"


CORES = {"foreign_aes": aes, "foreign_uart": uart("TXREG", "RXREG"), "axil_uart": uart("TX", "RX"), "spi_master": spi,
         "i2c_master": i2c}
data = Ice.InitializationData()
data.properties = Ice.createProperties()
data.properties.setProperty("Ice.Plugin.XBeeAT", plugin)
data.properties.setProperty("XBeeAT.Clock", status)
data.properties.setProperty("XBeeAT.Guard", guard)
with Ice.initialize(data) as ic:
    for name, call in CORES.items():
        core = Hw.RegistersPrx.checkedCast(ic.stringToProxy("%s:xbee-at -d %s -a 0x0001 -t 300000" % (name, device)))
        value, wanted = call(core)
        if value != wanted:
            sys.exit("%s: %r, expected %r" % (name, value, wanted))
        print("%s: %d registers and fields, called by radio: as expected" % (name, len(core.list())))
    encoder = Cores.ForeignCobsPrx.checkedCast(ic.stringToProxy("foreign_cobs:xbee-at -d %s -a 0x0001 -t 300000" % device))
    for packet in (b"\x11\x22\x00\x33", b"\0" * 9, bytes(range(1, 201))):
        if bytes(encoder.process(packet)) != cobs(packet):
            sys.exit("foreign_cobs: %r came of %r, expected %r" % (encoder.process(packet), packet, cobs(packet)))
    print("foreign_cobs: packets encoded, called by radio: as expected")
    master = Cores.OloSpiPrx.checkedCast(ic.stringToProxy("olo_spi:xbee-at -d %s -a 0x0001 -t 300000" % device))
    if master.transfer(0x5AC3F00D) != 0x5AC3F00D:
        sys.exit("olo_spi: what was sent did not come back")
    print("olo_spi: 32 bits sent and received, called by radio: as expected")
