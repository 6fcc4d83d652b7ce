#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""update: sends new firmware, a bitstream, or keys to a vehicle, waits until the new version runs,
and confirms it. It uses unmodified ZeroC Ice.

The package is a file made by pack_update, or several such files joined. It contains lists of keys,
firmware or bitstreams, which are sent in their order in the package. After a loss of the link, or
of the vehicle's power, the update continues where it was interrupted. It also continues if this
program is started again. A refused package leaves the vehicle unchanged.
"""

import argparse
import sys
import threading
import time

import Ice
import lz4.block

import places
import plugged
from mission_log import Air
from reasons import reason_of

HEADER = places.record_of("sw/update/slots_header.toml")
MAGIC, KEYS = HEADER.constants["SLOTS_MAGIC"], HEADER.constants["SLOTS_KEYS"]
# name of the object that receives an image, by product number
OBJECTS = {HEADER.constants["LOADER_PRODUCT"]: "update",
           HEADER.constants["FPGA_PRODUCT"]: "fpga", KEYS: "update"}
PIECE, PIECES_ON_THE_WAY, DICTIONARY = 4096, 3, 65535
TEXT = {
    "foreignImage": "the package is for another kind of vehicle or another board",
    "oldVersion": "the version must be greater than the confirmed version on the vehicle",
    "wrongSignature": "the package is not signed with one of the vehicle's keys",
    "damagedImage": "the received bytes do not match the signature; try again",
    "busyNow": "another update is in progress",
    "onTrial": "the running image is not confirmed yet; the vehicle reverts within a minute",
    "needsOther": "the package needs a newer bitstream (or firmware) that is confirmed: send that "
                  "first; a list of keys needs the previous list, and a running image that is "
                  "signed with a key of the new list",
    "flashFault": "the vehicle could not write its flash",
    "wentBack": "the new version was started, then replaced by the old one: it was not "
                "confirmed in time, or crashed",
    "refused": "the FPGA has not accepted the bitstream: its CRC is wrong, or it is for another "
               "device; the golden bitstream runs",
}
IN_FLIGHT = "the vehicle is flying, and accepts an update only after it has landed"


class Failed(Exception):
    """Raised when the update has ended; the text is the reason."""


def read_package(path):
    """Returns the parts of a package, in order. Each part is a pair: either ("keys", lists of
    keys), or (name of the object that receives the image, dictionary). The dictionary maps each
    flash offset to (header, image)."""
    with open(path, "rb") as f:
        data = f.read()
    parts, at, last = [], 0, None
    while at < len(data):
        head = data[at:at + HEADER.size]
        if len(head) < HEADER.size:
            raise Failed("'%s': expected a complete package from pack_update" % path)
        fields = HEADER.unpack(head)
        product, version, base = fields["product"], fields["version"], fields["base"]
        image = data[at + HEADER.size:at + HEADER.size + fields["bytes"]]
        if fields["magic"] != MAGIC or product not in OBJECTS or len(image) < fields["bytes"]:
            raise Failed("'%s': expected a complete package from pack_update" % path)
        if product == KEYS:
            if last != KEYS:
                parts.append(("keys", []))
            parts[-1][1].append(head)
            last = KEYS
        else:
            if last != (product, version) or base in parts[-1][1]:
                parts.append((OBJECTS[product], {}))
            parts[-1][1][base] = head, image
            last = product, version
        at += HEADER.size + len(image)
    if not data:
        raise Failed("'%s': expected a package from pack_update, got an empty file" % path)
    return parts


def read_clock(air):
    """Returns the time in s, and the number of bytes sent over the air to the vehicle, both counted
    by the simulator. Without a simulator, returns a clock of this machine and 0 bytes."""
    counters = air.read()
    return (counters["ns"] / 1e9, counters["bytesUp"]) if counters else (time.monotonic(), 0)


class Watch(threading.Thread):
    """Calls the vehicle repeatedly during an update, and records the longest time until a reply."""

    def __init__(self, proxy, air):
        super().__init__(daemon=True)
        self.proxy, self.air, self.over = proxy, air, threading.Event()
        self.answers, self.longest = 0, 0.0
        self.start()

    def run(self):
        while not self.over.wait(0.05):
            try:
                begun = read_clock(self.air)[0]
                self.proxy.getStatus()
                self.longest = max(self.longest, read_clock(self.air)[0] - begun)
                self.answers += 1
            except Ice.Exception:
                pass  # the thread that sends the update reports the error

    def stop(self):
        self.over.set()
        self.join()
        return "%d calls were answered meanwhile, each within %.2f s" % (self.answers, self.longest)


class Vehicle:
    def __init__(self, proxy, patience):
        self.proxy, self.patience = proxy, patience

    def persist(self, function):
        """Calls the function and returns its result. Tries again while the vehicle does not
        reply."""
        end = time.monotonic() + self.patience
        while True:
            try:
                return function()
            except Ice.ObjectNotExistException:
                raise Failed("the vehicle has no object '%s': it was not started by a boot "
                             "loader, or its processor has no access to the FPGA's flash" %
                             self.proxy.ice_getIdentity().name)
            except Ice.LocalException as e:
                if time.monotonic() > end:
                    raise Failed("no reply from the vehicle for %d s (%s): check that it is on "
                                 "and in range" % (self.patience, reason_of(e)))
                time.sleep(0.2)

    def status(self):
        return self.persist(self.proxy.getStatus)

    def expect(self, reason):
        if str(reason) != "none":
            raise Failed(TEXT.get(str(reason), str(reason)))

    def wait_while(self, *phases):
        """Waits until the vehicle is in none of these phases. Returns the status. Raises Failed,
        with the reason, if the vehicle has refused the update."""
        while True:
            status = self.status()
            if str(status.phase) not in phases:
                break
            time.sleep(0.1)
        if str(status.phase) == "idle":
            self.expect(status.last)
        return status

    def send(self, image, dictionary, say):
        """Sends the missing pieces, several at a time."""
        received = self.status().received
        on_the_way, at, shown = [], received, 0
        while at < len(image) or on_the_way:
            while at < len(image) and len(on_the_way) < PIECES_ON_THE_WAY:
                piece = image[at:at + PIECE]
                packed = lz4.block.compress(piece, mode="high_compression", compression=12,
                                            store_size=False,
                                            dict=image[max(0, at - dictionary):at])
                on_the_way.append((at + len(piece),
                                   self.proxy.writeAsync(at, len(piece),
                                                         min(piece, packed, key=len))))
                at += len(piece)
            received, future = on_the_way.pop(0)
            self.expect(future.result())
            if received == len(image) or received - shown >= len(image) // 10:
                shown = received
                say("%d of %d bytes" % (received, len(image)))


def send_keys(vehicle, lists, say):
    for header in lists:
        number = HEADER.unpack(header)["version"]
        reason = vehicle.persist(lambda: vehicle.proxy.begin(header))
        if str(reason) == "oldVersion":
            say("the vehicle already has list %d of keys, or a later one" % number)
            continue
        vehicle.expect(reason)
        vehicle.wait_while("preparing")
        say("the vehicle now accepts packages signed with the keys of list %d" % number)


def transfer(vehicle, header, image, say, air):
    """Sends an image and starts its check by the vehicle. Continues after a loss of the link."""
    # The vehicle's processor cannot read the FPGA's flash as memory.
    dictionary = DICTIONARY if vehicle.proxy.ice_getIdentity().name == "update" else 0

    def begin():
        vehicle.expect(vehicle.persist(lambda: vehicle.proxy.begin(header)))

    begin()
    begun = None
    while True:
        try:
            received = vehicle.wait_while("preparing", "erasing").received
            begun = begun or (received, *read_clock(air))
            vehicle.send(image, dictionary, say)
            first, start, sent = begun
            end, sent_end = read_clock(air)
            say("sent %d bytes in %.2f s%s; the vehicle is checking them" % (
                len(image) - first, end - start,
                ", %d bytes on the air" % (sent_end - sent) if sent_end else ""))
            vehicle.expect(vehicle.proxy.finish())
            return
        except Ice.LocalException as e:
            say("the link was lost (%s): continuing" % reason_of(e))
            if str(vehicle.status().phase) == "idle":
                begin()


def await_start(vehicle, version):
    while (status := vehicle.status()).running != version:
        if str(status.last) != "none":
            vehicle.expect(status.last)
        time.sleep(0.2)


def update(vehicle, images, say, air, rehearses):
    """Updates the vehicle to the version in the package and confirms this version. A rehearsal does
    not confirm: it waits until the new version runs, and then until the vehicle has returned to the
    old version."""
    version = HEADER.unpack(next(iter(images.values()))[0])["version"]
    status = vehicle.status()
    say("the vehicle runs version %d%s" % (status.running, ", on trial" if status.trial else ""))
    if status.running == version and not status.trial:
        say("version %d is already confirmed" % version)
        return
    if status.running != version:
        if status.slot not in images:
            raise Failed("the package has no image for the vehicle's free slot: pack it again "
                         "with pack_update")
        watch = Watch(vehicle.proxy, air)
        transfer(vehicle, *images[status.slot], say, air)
        vehicle.wait_while("checking")
        say(watch.stop())
        say("version %d was received and verified; the vehicle starts it" % version)
        await_start(vehicle, version)
    if rehearses:
        say("version %d runs and is not confirmed: the vehicle returns to the old version within "
            "a minute" % version)
        while vehicle.status().running == version:
            time.sleep(1)
        say("the vehicle runs version %d" % vehicle.status().running)
        return
    vehicle.expect(vehicle.persist(vehicle.proxy.confirm))
    say("version %d runs and is confirmed" % version)


def main():
    plugged.interrupt_once()
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n\n")[0],
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n"
               "  %(prog)s new.update --device /dev/ttyUSB0 --key uav1.key\n"
               "  %(prog)s new.update --proxy 'update:tcp -h 127.0.0.1 -p 10001'\n"
               "  %(prog)s new.update --device /dev/ttyUSB0 --key uav1.key --rehearse")
    parser.add_argument("package", help="package made by pack_update")
    parser.add_argument("--device", help="serial port of the modem")
    parser.add_argument("--proxy",
                        help="proxy of the object, such as 'update:tcp -h host -p 4061'; replaces "
                             "--device")
    parser.add_argument("--plugin", help="folder of libxbeeat.so.37 (default: as built or "
                        "installed; the plugin is not loaded with --proxy)")
    parser.add_argument("--slice", default=places.slice_file("Update.ice"),
                        help="path of Update.ice (default: as installed)")
    parser.add_argument("--status", help="file with the counters of a simulator")
    parser.add_argument("--key", default="", help="file with the key of the link (default: no key)")
    parser.add_argument("--guard", type=int, default=1000,
                        help="guard time of the modem, ms (default 1000)")
    parser.add_argument("--rehearse", action="store_true",
                        help="do not confirm the new version: let it start, and let the vehicle "
                        "return to the old one")
    parser.add_argument("--patience", type=int, default=120,
                        help="time-out for a reply, s (default 120)")
    args = parser.parse_args()
    start = time.monotonic()

    def say(text):
        print("%7.3f s  %s" % (time.monotonic() - start, text), flush=True)

    communicator = None
    try:
        parts = read_package(args.package)
        images = [name for name, _ in parts if name != "keys"]
        Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), args.slice])
        import Update  # generated by loadSlice
        settings = {"Ice.Default.InvocationTimeout": "60000", "Ice.ACM.Close": "0",
                    "Ice.RetryIntervals": "-1"}
        plugin = args.plugin or ("" if args.proxy else places.plugin())
        communicator = plugged.initialize(settings, plugin, args.guard, args.key)
        first = images[0] if images else "update"
        where = args.proxy or "%s:xbee-at -d %s -a 0x0001 -s 0x0000 -t 60000" % (
            first, plugged.quoted(args.device))
        proxy = Update.FirmwarePrx.uncheckedCast(communicator.stringToProxy(where))
        for name, part in parts:
            # --proxy names the object of the first part; for other objects, the identity in this
            # proxy is replaced
            own = proxy if name == first else proxy.ice_identity(
                Ice.stringToIdentity("update" if name == "keys" else name))
            vehicle = Vehicle(Update.FirmwarePrx.uncheckedCast(own), args.patience)
            if name != "keys":
                update(vehicle, part, say, Air(args.status), args.rehearse)
            elif not args.rehearse or part is parts[0][1]:
                # A rehearsal does not send keys that follow an image in the package, because the
                # vehicle returns to its old image.
                send_keys(vehicle, part, say)
        return 0
    except KeyboardInterrupt:
        return 130
    except Ice.UserException as e:
        sys.exit("update: %s" % (IN_FLIGHT if e.ice_id() == "::Update::InFlight" else
                                reason_of(e)))
    except (Failed, Ice.Exception, OSError) as e:
        sys.exit("update: %s" % reason_of(e))
    finally:
        if communicator:
            communicator.destroy()


if __name__ == "__main__":
    sys.exit(main())
