# SPDX-License-Identifier: MIT
"""ahead: moves the inputs of a model in AIGER's format one step ahead, for faster proofs of modules
with several clocks.

Yosys' clk2fflogic models a flip-flop by three others: its value, its data and its clock in the
previous step. Its output is a gate of these three and of the present clock, an input. abc can
retime the three to one if the present inputs are flip-flops as well. The model here therefore has a
flip-flop for each input, and begins one step earlier. In that first step, no assertion and no
assumption counts, and the flip-flops of the model keep their initial values. All later steps are
the steps of the original model, with every sequence of inputs. A failed assertion fails one step
later than in the original model."""
from dataclasses import dataclass


@dataclass
class Model:
    """A model whose flip-flops are initially 0. The lists contain AIGER literals: the next values
    of the flip-flops, the outputs that show failed assertions, the assumptions, and the two inputs
    of each gate. The variables are the inputs, the flip-flops and the gates, in this order."""
    inputs: int
    latches: list[int]
    bads: list[int]
    assumptions: list[int]
    gates: list[tuple[int, int]]


def read(path):
    """Parses a binary AIGER file without outputs of other kinds."""
    first, _, rest = path.read_bytes().partition(b"\n")
    _, inputs, latches, outputs, gates, bads, assumptions = \
        (int(word) for word in [*first.split()[1:], *[0] * 2][:7])
    if outputs:
        raise ValueError(f"{path}: expected no outputs, got {outputs}")
    *lines, body = rest.split(b"\n", latches + bads + assumptions)
    if any(line.split()[1:] not in ([], [b"0"]) for line in lines[:latches]):
        raise ValueError(f"{path}: expected flip-flops with the initial value 0")
    literals = [int(line.split()[0]) for line in lines]
    at = 0

    def number():
        nonlocal at
        value = shift = 0
        while True:
            byte = body[at]
            at += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    pairs = []
    for gate in range(gates):
        left = 2 * (inputs + latches + 1 + gate) - number()
        pairs.append((left, left - number()))
    return Model(inputs, literals[:latches], literals[latches:latches + bads],
                 literals[latches + bads:], pairs)


def ahead(model):
    """Returns the model with a flip-flop for each input, which begins one step earlier."""
    inputs, begun = model.inputs, 2 * model.inputs + 1  # `begun`: variable, 0 in the first step
    top = begun + len(model.latches)

    def moved(literal):
        variable = literal >> 1
        return literal + 2 * (0 if not variable else
                              inputs if variable <= inputs else inputs + 1)

    gates = [(moved(a), moved(b)) for a, b in model.gates]

    def if_begun(literal):
        gates.append((max(literal, 2 * begun), min(literal, 2 * begun)))
        return 2 * (top + len(gates))

    latches = [2 * (n + 1) for n in range(inputs)] + [1]
    latches += [if_begun(moved(literal)) for literal in model.latches]
    return Model(inputs, latches, [if_begun(moved(literal)) for literal in model.bads],
                 [if_begun(moved(literal) ^ 1) ^ 1 for literal in model.assumptions], gates)


def write(model, path):
    def bytes_of(value):
        while value > 0x7F:
            yield value & 0x7F | 0x80
            value >>= 7
        yield value

    first = model.inputs + len(model.latches) + 1
    counts = (first - 1 + len(model.gates), model.inputs, len(model.latches), 0, len(model.gates),
              len(model.bads), len(model.assumptions))
    text = f"aig {' '.join(map(str, counts))}\n" + "".join(
        f"{literal}\n" for literal in [*model.latches, *model.bads, *model.assumptions])
    with open(path, "wb") as file:
        file.write(text.encode())
        for gate, (left, right) in enumerate(model.gates, first):
            file.write(bytes([*bytes_of(2 * gate - left), *bytes_of(left - right)]))
