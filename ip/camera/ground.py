# SPDX-License-Identifier: MIT
"""Runs the part of a mission for the core camera: starts and stops the core; if the flight has a
sensor, the vision core processes the frames."""

import Ice


def camera_of(proxy):
    import Cores  # module that loadSlice generates from Camera.ice

    return Cores.CameraPrx.uncheckedCast(proxy("camera"))


def capture(log, camera, width, height):
    log.call("ground -> UAV", "camera.capture(%d, %d)" % (width, height),
             lambda: camera.capture(width, height))


def prepare(log, proxy, width, height):
    """Prepares the mission before the vision core starts. `width` and `height` are the size of the
    sensor's frames in pixels."""
    capture(log, camera_of(proxy), width, height)


def refuses(log, camera, width, height):
    def call():
        try:
            camera.capture(width, height)
        except Ice.UnknownException:
            return True
        return False

    if not log.call("ground -> UAV", "camera.capture(%d, %d), refused" % (width, height), call):
        raise RuntimeError("camera: a frame of %d x %d was not refused" % (width, height))


def fly(log, proxy, report):
    camera = camera_of(proxy)
    active, frames, dropped = log.call("ground -> UAV", "camera.isActive()", camera.isActive)
    if active and (frames == 0 or dropped != 0):
        raise RuntimeError("camera: %d frames, %d dropped" % (frames, dropped))
    log.say("camera: %d frames from the sensor" % frames if active else "camera: no sensor is used")
    refuses(log, camera, 12, 8)
    refuses(log, camera, 2048, 2047)
    for wanted, call in ((True, lambda: capture(log, camera, 64, 48)),
                         (False, lambda: log.call("ground -> UAV", "camera.stop()", camera.stop))):
        call()
        active, frames, dropped = log.call("ground -> UAV", "camera.isActive()", camera.isActive)
        if active != wanted:
            raise RuntimeError("camera: it is %s" % ("active" if active else "not active"))
