#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calls third-party cores and two cores of this project by radio. Usage:
call.py DEVICE GUARD STATUS PLUGIN "NAME ..." Registers.ice File.ice ...

It makes the calls of each core in tools/icesoc/cores/examples.py. It also encrypts blocks of FIPS
197 with the AES cores, sends packets through the COBS encoder's AXI-Streams, computes the CRC-32 of
buffers in DDR3, and sets a servo's pulses, which orders.sh measures at the pins. It uses stock
ZeroC Ice."""
import ast
import re
import sys
import zlib

import Ice

from icesoc.cores import examples

device, guard, status, plugin, names, *files = sys.argv[1:]
names = names.split()
for file in files:
    Ice.loadSlice("", [file])
import Hw  # noqa: E402

Cores, Demo = sys.modules.get("Cores"), sys.modules.get("Demo")  # of the chip's cores

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


def cobs(data):
    """Returns the data after consistent overhead byte stuffing (Cheshire and Baker, 1999), with the
    zero that ends a packet."""
    out = bytearray()
    for part in data.split(b"\0"):
        while len(part) >= 254:
            out += b"\xff" + part[:254]
            part = part[254:]
        out += bytes([len(part) + 1]) + part
    return bytes(out) + b"\0"


def call(core, word):
    """Executes one word of a core's "calls". REGISTER=value sets the register. REGISTER==value
    waits until the register has this value, and REGISTER&mask==value compares only the bits of the
    mask. operation(arguments) calls the operation, and ==result after it compares the result."""
    name, ending, arguments, value = re.fullmatch(r"(\w+)(&\w+==|==?|\((.*?)\)(?:==)?)(.*)",
                                                  word).groups()
    if ending == "=":
        core.set(name, int(value, 0))
    elif arguments is None:
        mask, wanted = int(ending[1:-2] or "-1", 0), int(value, 0)
        until(core, name, lambda v: v & mask == wanted)
    else:
        answer = getattr(core, name)(*ast.literal_eval(f"({arguments},)" if arguments else "()"))
        if value and answer != ast.literal_eval(value):
            sys.exit(f"{word}: the answer is {answer!r}")


def camel(name):
    return "".join(word.capitalize() for word in name.split("_"))


data = Ice.InitializationData()
data.properties = Ice.createProperties()
data.properties.setProperty("Ice.Plugin.XBeeAT", plugin)
data.properties.setProperty("XBeeAT.Clock", status)
data.properties.setProperty("XBeeAT.Guard", guard)
with Ice.initialize(data) as ic:

    def proxy(kind, name):
        return kind.checkedCast(
            ic.stringToProxy("%s:xbee-at -d %s -a 0x0001 -t 300000" % (name, device)))

    servo = proxy(Demo.ServoPrx, "servo") if "servo" in names else None
    if servo:
        servo.setPulse(2, 1500)
    for name in names:
        calls = examples.cores()[name].calls
        kind = getattr(Cores, camel(name) + "Prx", Hw.RegistersPrx)
        if name == "servo" or not calls and kind is not Hw.RegistersPrx:
            continue
        core = proxy(kind, name)
        for word in calls.split():
            call(core, word)
        print(f"{name}: " + (f"{len(core.list())} registers and fields, "
                             if kind is Hw.RegistersPrx else "") + "called by radio: as expected")
    if "foreign_aes" in names:
        value, wanted = aes(proxy(Hw.RegistersPrx, "foreign_aes"))
        if value != wanted:
            sys.exit("foreign_aes: %r, expected %r" % (value, wanted))
        print("foreign_aes: three keys of FIPS 197: as expected")
    if "foreign_cobs" in names:
        encoder = proxy(Cores.ForeignCobsPrx, "foreign_cobs")
        for packet in (b"\x11\x22\x00\x33", b"\0" * 9, bytes(range(1, 201))):
            if bytes(encoder.process(packet)) != cobs(packet):
                sys.exit("foreign_cobs: %r came of %r, expected %r" %
                         (encoder.process(packet), packet, cobs(packet)))
        print("foreign_cobs: packets encoded, called by radio: as expected")
    if "crc32" in names:
        crc = proxy(Cores.Crc32Prx, "crc32")
        for packet in (b"", b"123456789", bytes(range(256)) * 16):
            if crc.crc(packet) & 0xFFFFFFFF != zlib.crc32(packet):
                sys.exit("crc32: 0x%08X, expected 0x%08X" %
                         (crc.crc(packet) & 0xFFFFFFFF, zlib.crc32(packet)))
        print("crc32: of up to 4096 bytes in DDR3, called by radio: as zlib's")
    if servo and servo.fault():
        sys.exit("servo: a fault, of a pin that is low")
