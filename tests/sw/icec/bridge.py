#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""bridge: bridge.py HEADER... >bridged.c writes servants with operations that call the proxy
Bridge_far.

The headers are those that slice2c generates. A servant passes the parameters of each operation to
the proxy of the same interface, and returns the results, the status and the exception of this call.
"""
import re
import sys

SERVANT = re.compile(r"^typedef struct (\w+) \{\n    Ice_Object base;", re.M)
OPERATION = re.compile(r"^Ice_Status (\w+)\((\w+ self)((?:, [^;]*)?), const Ice_Current "
                       r"\*current\);")
RESPONSE = re.compile(r"^Ice_Status (\w+)_response\(Ice_Reply \*reply((?:, [^;]*)?)\);")
CALL = re.compile(r"^Ice_Status (\w+Prx_\w+)\(\w+ self((?:, [^;]*)?)\);")


def name_of(parameter):
    return re.search(r"\w+$", parameter)[0]


def operation(name, self, parameters, calls, servants, responses):
    """Writes one operation. If the call has results, the servant sends its reply asynchronously."""
    owner = max((s for s in servants if name.startswith(s + "_")), key=len)
    call = re.sub("(Disp)?$", "Prx", owner, count=1) + name[len(owner):]
    own = parameters.split(", ")[1:]
    later = calls.get(call, parameters).split(", ")[len(own) + 1:]
    # the servant has const parameters, the proxy does not
    given = ["(void*)" * ("**" in p) + name_of(p) for p in own]
    print(f"\nIce_Status {name}({self}{parameters}, const Ice_Current* current) {{")
    for result in later:
        print(f"    {result.replace('*', '', 1)};")
    print("    Ice_ObjectPrx far = Bridge_far;\n    Ice_Status status;")
    print("    (void)self, (void)current;")
    if own and name_of(own[-1]) == "ex":
        print("    memset(ex, 0x55, sizeof *ex); /* the proxy must set all of it */")
    arguments = ["&far", *given, *("&" + name_of(p) for p in later)]
    print(f"    status = {call}({', '.join(arguments)});")
    if later:
        names = [name_of(p) for p in later]
        # values that are passed by pointer; classes (two asterisks) are pointers already
        own = {name_of(p) for p in later if p.count("*") == 1}
        own &= {name_of(p) for p in responses[name].split(", ") if "*" in p}
        results = ", ".join(["&reply"] + [
            f"has_{n} ? &{n} : 0" if "has_" + n in names else "&" * (n in own) + n
            for n in names if n != "ex" and n[:4] != "has_"])
        answer = [f"status == ICE_OK ? {name}_response({results})"]
        answer += [f"{name}_exception(&reply, &ex)" for p in later if name_of(p) == "ex"]
        print("    if (status <= ICE_USER_EXCEPTION) {\n        Ice_Reply reply;\n"
              "        Ice_Current_later(current, &reply);\n"
              f"        (void)({' : '.join((answer + ['ICE_OK'])[:2])});\n"
              "        return ICE_LATER;\n    }")
    print("    return status;\n}")


def main():
    servants, operations, calls, responses = [], {}, {}, {}
    for header in sys.argv[1:]:
        print(f'#include "{header}"')
        text = open(header).read()
        servants += SERVANT.findall(text)
        for statement in re.findall(r"^Ice_Status [^;]*;", text, re.M):
            flat = " ".join(statement.split())
            if match := OPERATION.match(flat):
                operations[match[1]] = match.groups()
            elif match := CALL.match(flat):
                calls[match[1]] = match[2]
            elif match := RESPONSE.match(flat):
                responses[match[1]] = match[2]
    print('#include "serve.h"\n\n#include <string.h>')
    for each in operations.values():
        operation(*each, calls, servants, responses)
    print("\nIce_ObjectPtr Bridge_servant(int number) {\n    switch (number) {")
    for number, servant in enumerate(servants):
        print(f"    case {number}: {{\n        static {servant} v;\n        {servant}_init(&v);\n"
              "        return (Ice_ObjectPtr)&v;\n    }")
    print("    default:\n        return 0;\n    }\n}")


main()
