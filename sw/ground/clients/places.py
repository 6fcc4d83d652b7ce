# SPDX-License-Identifier: MIT
"""places: finds the files that the ground programs need, in the source tree or where they are
installed.

When installed, this module is part of the package `icesoc` in PREFIX/lib/python3/dist-packages.
"""
import importlib.util
import os
import sysconfig

HERE = os.path.dirname(os.path.realpath(__file__))
IS_INSTALLED = os.path.isfile(os.path.join(HERE, "__init__.py"))
TOP = os.path.normpath(os.path.join(HERE, "../../../.." if IS_INSTALLED else "../../.."))
SHARE = os.path.join(TOP, "share/icesoc")
SLICE_FILES = {"Autopilot.ice": "sw/vehicle", "Registers.ice": "sw/hw/registers",
               "Update.ice": "sw/update"}  # Slice files, each with its folder in the source tree
# objects of the firmware (sw/vehicle): identity -> interface, declared in one of these Slice files
OBJECTS = {"uav": "::Autopilot::Vehicle", "keys": "::Autopilot::KeyRing", "chip": "::Hw::Chip",
           "update": "::Update::Firmware", "fpga": "::Update::Firmware"}


def slice_file(name):
    """Returns the path of a Slice file in SLICE_FILES."""
    folder = os.path.join(SHARE, "slice") if IS_INSTALLED else os.path.join(TOP, SLICE_FILES[name])
    return os.path.join(folder, name)


def plugin():
    """Returns the folder that contains libxbeeat.so.37."""
    if not IS_INSTALLED:
        return os.path.join(TOP, "build/main/ground")
    multiarch = os.path.join(TOP, "lib", sysconfig.get_config_var("MULTIARCH") or "")
    return multiarch if os.path.isdir(multiarch) else os.path.join(TOP, "lib")


def core(name):
    """Returns the folder that contains a core's Slice file and its ground.py, the core's part of a
    mission."""
    return os.path.join(SHARE if IS_INSTALLED else TOP, "ip", name)


def record_of(description):
    """Returns the record type that a TOML file of the source tree describes
    (icesoc.util.record)."""
    module = os.path.join(HERE if IS_INSTALLED else os.path.join(TOP, "tools/icesoc/util"),
                          "record.py")
    spec = importlib.util.spec_from_file_location("record", module)
    record = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(record)
    return record.load(os.path.join(SHARE, os.path.basename(description)) if IS_INSTALLED else
                       os.path.join(TOP, description))
