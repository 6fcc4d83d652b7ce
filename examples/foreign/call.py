#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calls third-party cores and two of one's own by radio: call.py DEVICE GUARD STATUS PLUGIN
"NAME ..." Registers.ice File.ice ...
 An AES key and block of FIPS 197, appendix B; a byte through each UART and the SPI controller,
whose outputs lead to their inputs, and of the I2C master on lines that nobody else pulls low;
packets through the COBS encoder's AXI-Streams; a CRC-32 of buffers in DDR3; a servo's pulses, which
orders.sh measures at the pins. With stock ZeroC Ice. """
import sys
import zlib

import Ice

device, guard, status, plugin, names, *files = sys.argv[1:]
for file in files:
    Ice.loadSlice("", [file])
import Cores  # noqa: E402
import Demo  # noqa: E402
import Hw  # noqa: E402

# Keys, blocks and ciphers of FIPS 197: appendices B, C.1 and C.3.
AES = [
    ("2b7e151628aed2a6abf7158809cf4f3c", "3243f6a8885a308d313198a2e0370734",
     "3925841d02dc09fbdc118597196a0b32"),
    (bytes(range(16)).hex(), "00112233445566778899aabbccddeeff",
     "69c4e0d86a7b0430d8cdb78070b4c55a"),
    (bytes(range(32)).hex(), "00112233445566778899aabbccddeeff",
     "8ea2b7ca516745bfeafc49904b496089")]


def until(core, name, condition):
    for _ in range(100):
        if condition(value := core.get(name)):
            return value
    sys.exit("%s stays 0x%X" % (name, value))


def words(text):
    return [int(text[i:i + 8], 16) for i in range(0, len(text), 8)]


def aes(core):
    answers = []
    for key, block, _ in AES:
        for i, word in enumerate(words(key)):
            core.set("KEY%d" % i, word)
        core.set("CONFIG", 3 if len(key) > 32 else 1)  # encipher, 256 or 128 bits
        core.set("CTRL", 1)  # expand the key
        until(core, "STATUS", lambda v: v & 1)
        for i, word in enumerate(words(block)):
            core.set("BLOCK%d" % i, word)
        core.set("CTRL", 2)
        until(core, "STATUS", lambda v: v & 2)
        answers.append([core.get("RESULT%d" % i) for i in range(4)])
    return answers, [words(cipher) for _, _, cipher in AES]


def uart(core):
    core.set("SETUP", 20)  # clocks a bit
    core.wait(0)  # takes earlier events
    core.set("TXREG", 0xA5)
    events = core.wait(1000)
    return (events, core.get("RXREG") & 0x1FF), (["CORE"], 0xA5)


def spi(core):
    core.set("REG0", 1)  # enabled
    core.set("REG1", 0x5A)
    until(core, "REG0", lambda v: not v >> 31)
    return core.get("REG1") & 0xFF, 0x5A


def i2c(core):
    core.set("REG0", 9)  # prescaler
    core.set("REG2", 0x80)  # enabled
    core.set("REG3", 0xA6)
    core.set("REG4", 0x90)  # start, write
    status, line = until(core, "REG4", lambda v: not v & 2), core.get("REG3")
    core.set("REG4", 0x40)  # stop
    until(core, "REG4", lambda v: not v & 0x40)
    # Nobody acknowledges; behind the byte's last bit stand the others, as they were on the line.
    return (status, line), (0xC1, 0x53)


def cobs(data):
    """Consistent overhead byte stuffing (Cheshire and Baker, 1999), and the zero at its end."""
    out = bytearray()
    for part in data.split(b"\0"):
        while len(part) >= 254:
            out += b"\xff" + part[:254]
            part = part[254:]
        out += bytes([len(part) + 1]) + part
    return bytes(out) + b"\0"


CORES = {
    "foreign_aes": aes, "foreign_uart": uart, "foreign_axil": uart, "foreign_spi": spi,
    "foreign_i2c": i2c}
data = Ice.InitializationData()
data.properties = Ice.createProperties()
data.properties.setProperty("Ice.Plugin.XBeeAT", plugin)
data.properties.setProperty("XBeeAT.Clock", status)
data.properties.setProperty("XBeeAT.Guard", guard)
with Ice.initialize(data) as ic:

    def proxy(kind, name):
        return kind.checkedCast(
            ic.stringToProxy("%s:xbee-at -d %s -a 0x0001 -t 300000" % (name, device)))

    servo = proxy(Demo.ServoPrx, "servo")
    servo.setPulse(2, 1500)
    for name in sorted(CORES.keys() & names.split()):
        core = proxy(Hw.RegistersPrx, name)
        value, wanted = CORES[name](core)
        if value != wanted:
            sys.exit("%s: %r, expected %r" % (name, value, wanted))
        print("%s: %d registers and fields, called by radio: as expected" %
              (name, len(core.list())))
    if "foreign_cobs" in names:
        encoder = proxy(Cores.ForeignCobsPrx, "foreign_cobs")
        for packet in (b"\x11\x22\x00\x33", b"\0" * 9, bytes(range(1, 201))):
            if bytes(encoder.process(packet)) != cobs(packet):
                sys.exit("foreign_cobs: %r came of %r, expected %r" %
                         (encoder.process(packet), packet, cobs(packet)))
        print("foreign_cobs: packets encoded, called by radio: as expected")
    crc = proxy(Cores.Crc32Prx, "crc32")
    for packet in (b"", b"123456789", bytes(range(256)) * 16):
        if crc.crc(packet) & 0xFFFFFFFF != zlib.crc32(packet):
            sys.exit("crc32: 0x%08X, expected 0x%08X" %
                     (crc.crc(packet) & 0xFFFFFFFF, zlib.crc32(packet)))
    print("crc32: of up to 4096 bytes in DDR3, called by radio: as zlib's")
    if "olo_spi" in names:
        if proxy(Cores.OloSpiPrx, "olo_spi").transfer(0x5AC3F00D) != 0x5AC3F00D:
            sys.exit("olo_spi: what was sent did not come back")
        print("olo_spi: 32 bits sent and received, called by radio: as expected")
    if servo.fault():
        sys.exit("servo: a fault, of a pin that is low")
