# SPDX-License-Identifier: MIT
"""client: calls an operation through stock Ice and returns the result; receives events.

Exit statuses of a call that fails: 2 wrong arguments; 3 the operation threw an exception that its
throws clause declares; 4 no answer (no connection, time-out); 5 the vehicle has no such object,
facet or operation; 6 the operation refused the call and gave no reason.
"""
import os
import queue
import time

import Ice
from reasons import reason_of

from icesoc.call.mapping import Mapping, escaped
from icesoc.util.errors import Stop

THROWN, SILENT, ABSENT, REFUSED = 3, 4, 5, 6


class Failure(Stop):
    """A call that failed, with the name and the fields of its exception."""

    def __init__(self, text, status, name="", fields=None):
        super().__init__(text, status)
        self.name, self.fields = name, fields or {}


class Events:
    """Calls that the vehicle makes to listeners of this program, in the order of their arrival."""

    def __init__(self, client):
        self.client, self.queue, self.adapter = client, queue.Queue(), None

    def listener(self, interface):
        """Returns a proxy of a new object that accepts every operation of an interface."""
        slices, mapping = self.client.slices, self.client.mapping
        members = {}
        for name, operation in slices.operations(interface).items():
            if not name.startswith("ice_"):
                members[escaped(name)] = self.taker(interface, operation)
        kind = type("Listener", (mapping.of(interface), ), members)
        proxy = self.open().addWithUUID(kind()).ice_oneway()
        return mapping.of(interface, "Prx").uncheckedCast(proxy)

    def open(self):
        """Returns the object adapter for calls by the vehicle. These calls arrive at the endpoints
        of the target, or over the connection that this program has opened."""
        if not self.adapter:
            target, communicator = self.client.target, self.client.communicator
            if target.callbacks:
                self.adapter = communicator.createObjectAdapterWithEndpoints("", target.callbacks)
                self.adapter.activate()
            else:
                self.adapter = communicator.createObjectAdapter("")
                self.client.guarded(lambda: self.client.proxy.ice_getConnection().setAdapter(
                    self.adapter))
        return self.adapter

    def taker(self, interface, operation):
        inputs = [p for p in operation["parameters"] if not p.get("out")]
        outputs = [p["type"] for p in operation["parameters"] if p.get("out")]
        if operation["result"] != "void":
            outputs.insert(0, operation["result"])

        def take(listener, *values):
            found = {p["name"]: self.client.mapping.outof(value, p["type"])
                     for p, value in zip(inputs, values)}
            self.queue.put((f"{interface.rpartition(':')[2]}.{operation['name']}", found))
            if outputs:
                raise Ice.UnknownException("this program only listens")

        return take


class Client:
    """A communicator and the proxy of one object."""

    def __init__(self, target, catalogue, each, options):
        self.target, self.catalogue, self.each = target, catalogue, each
        self.slices, self.options = catalogue.slices, options
        self.communicator = self.connect()
        self.mapping = Mapping(self.slices, self.communicator)
        self.events = Events(self)
        self.mapping.listeners = self.events.listener
        try:
            self.proxy = self.made()
        except BaseException:
            self.communicator.destroy()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.communicator.destroy()

    def connect(self):
        import plugged
        milliseconds = str(int(1000 * self.options.timeout))
        # The time-out of a call includes connecting. A time-out of the connection would expire at
        # nearly the same time; if the communicator is then destroyed, Ice 3.7 may use freed memory.
        settings = {"Ice.Default.InvocationTimeout": milliseconds,
                    "Ice.Override.ConnectTimeout": "-1", "Ice.RetryIntervals": "-1",
                    "Ice.Warn.Connections": "0", "Ice.Warn.Dispatch": "0", "Ice.ACM.Close": "0",
                    "Ice.Default.EncodingVersion": self.options.encoding,
                    **self.target.properties}
        if self.options.config:
            settings |= self.guarded(lambda: properties_in(self.options.config))
        if self.target.plugin and not os.path.exists(
                os.path.join(self.target.plugin, "libxbeeat.so.37")):
            raise Stop(f"'{self.target.plugin}': expected libxbeeat.so.37 in this folder; "
                       "./icesoc run builds it", 2)
        return self.guarded(lambda: plugged.initialize(
            settings, self.target.plugin, self.target.guard, self.target.key))

    def made(self):
        """Returns the proxy of the object; if the object's interface is unknown, asks the object
        for it."""
        mode = " -o" if self.options.oneway else ""
        text = self.target.proxy(self.each.identity, mode, self.options.facet or "")
        try:
            plain = self.communicator.stringToProxy(text)
        except Ice.Exception as error:
            raise Stop(f"expected an object's identity, got '{self.each.identity}': "
                       f"{getattr(error, 'str', error)}", 2) from None
        if not self.each.interface:
            ids = self.guarded(plain.ice_twoway().ice_ids)
            self.each.interface = self.catalogue.interface_of(ids)
            if not self.each.interface:
                own = next((name for name in ids if name != "::Ice::Object"), ids[0])
                raise Stop(f"'{self.each.identity}' has the interface {own}, which no Slice file "
                           "declares; add --slice FILE", 2)
        return self.mapping.of(self.each.interface, "Prx").uncheckedCast(plain)

    def arguments(self, operation, values):
        """Converts checked values to values of stock Ice, in the order of the operation's
        parameters."""
        made = []
        for p in operation["parameters"]:
            if not p.get("out"):
                value = self.mapping.into(values[p["name"]], p["type"], p["name"])
                made.append(Ice.Unset if value is None and "tag" in p else value)
        return made

    def call(self, operation, arguments):
        """Calls the operation; returns ({name: value} of the results, duration in ms)."""
        name = operation["name"]
        method = getattr(self.proxy, name if name.startswith("ice_") else escaped(name))
        begin = time.perf_counter()
        context = self.options.context
        answer = self.guarded(lambda: method(*arguments, context) if name.startswith("ice_")
                              else method(*arguments, context=context), operation)
        milliseconds = 1000 * (time.perf_counter() - begin)
        outputs = [(p["name"], p["type"]) for p in operation["parameters"] if p.get("out")]
        if operation["result"] != "void":
            outputs.insert(0, ("result", operation["result"]))
        if self.options.oneway:
            return {}, milliseconds
        answers = answer if len(outputs) > 1 else (answer, )
        return {called: self.mapping.outof(value, kind)
                for (called, kind), value in zip(outputs, answers)}, milliseconds

    def guarded(self, function, operation=None):
        """Calls a function. Raises a Failure with a plain text instead of any exception of Ice."""
        try:
            return function()
        except Ice.UserException as error:
            raise self.thrown(error) from None
        except Ice.ObjectNotExistException:
            raise Failure(f"{self.target.place} has no object '{self.each.identity}'", ABSENT,
                          "Ice.ObjectNotExistException") from None
        except Ice.FacetNotExistException:
            raise Failure(f"'{self.each.identity}' has no facet '{self.options.facet}'", ABSENT,
                          "Ice.FacetNotExistException") from None
        except Ice.OperationNotExistException:
            raise Failure(f"'{self.each.identity}' has no operation '{operation['name']}' in the "
                          "vehicle; check that its firmware was built from the same Slice "
                          "files", ABSENT,
                          "Ice.OperationNotExistException") from None
        except Ice.UnknownLocalException as error:
            # A gateway that cannot reach the vehicle answers "icesoc-gateway: " and the reason.
            gateway, _, reason = reason_of(error).partition("icesoc-gateway: ")
            if gateway or not reason:
                raise self.refused(error, operation) from None
            raise Failure(reason, SILENT, "Ice.UnknownLocalException") from None
        except Ice.UnknownException as error:
            raise self.refused(error, operation) from None
        except Ice.NotRegisteredException as error:
            raise Failure(f"IceGrid has no vehicle '{error.id}'; check that its gateway is running "
                          "and the vehicle is in reach", SILENT,
                          "Ice.NotRegisteredException") from None
        except (Ice.InvocationTimeoutException, Ice.TimeoutException):
            raise Failure(f"no answer from {self.target.place} within {self.options.timeout:g} s; "
                          "check that it is switched on, in reach, and has the same key", SILENT,
                          "Ice.TimeoutException") from None
        except Ice.LocalException as error:
            raise Failure(f"cannot reach {self.target.place}: "
                          f"{reason_of(error, connecting='')}", SILENT,
                          error.ice_id().lstrip(":").replace("::", ".")) from None

    def refused(self, error, operation):
        """Returns the Failure for an exception that Slice does not declare."""
        text = f"the call was refused: {reason_of(error)}"
        if reason_of(error).endswith(": the servant failed"):  # IceC's reply without a reason
            text = "the vehicle refused the call and gave no reason"
            if operation and any(not p.get("out") for p in operation["parameters"]):
                text += f"; check the arguments: {self.slices.signature(operation)}"
        return Failure(text, REFUSED,
                       error.ice_id().lstrip(":").replace("::", "."))

    def thrown(self, error):
        """Returns the Failure for an exception that Slice declares."""
        name = error.ice_id()
        fields = self.mapping.object(error, name)
        text = ", ".join(f"{field} = {value}" for field, value in fields.items())
        named = name.lstrip(":").replace("::", ".")
        return Failure(f"{named}{': ' + text if text else ''}", THROWN, named, fields)


def properties_in(file):
    """Returns the Ice properties that a file sets."""
    found = Ice.createProperties()
    found.load(file)
    return found.getPropertiesForPrefix("")
