# SPDX-License-Identifier: MIT
"""drawing: the last moments of a waveform, as the page draws them."""
import collections
import json
import pathlib
import re

from tool import run

MOST_CHANGES, FEWEST_CHANGES, MOST_SIGNALS = 400, 25, 200


class Signal:
    def __init__(self, scopes, name, bits):
        self.name, self.depth = ".".join([*scopes, name]), len(scopes)
        self.bits = bits  # 0: text
        self.changes = collections.deque(maxlen=MOST_CHANGES)  # (time, value), the newest last


def shown(bits):
    """A value in hexadecimal, "x" or "z" where a bit of it is; one bit as it is."""
    strange = bits.lstrip("01")
    return bits if len(bits) <= 1 else strange[0] if strange else f"{int(bits, 2):0{-(-len(bits) // 4)}x}"


def read_vcd(text):
    """The signals of a VCD file (IEEE 1364-2005, 18.2), the first and the last moment. A signal that
    goes by several names has its outermost."""
    head, _, body = text.partition("$enddefinitions")
    signals, scopes = {}, []
    for kind, rest in re.findall(r"\$(scope|upscope|var)\s+(.*?)\s*\$end", head, re.S):
        words = rest.split()
        if kind == "scope":
            scopes.append(words[1])
        elif kind == "upscope":
            scopes.pop()
        elif not words[3].startswith("smt_"):  # the solver's own
            signal = Signal(scopes, words[3], int(words[1]) * (words[0] != "string"))
            known = signals.get(words[2])
            if not known or signal.depth < known.depth:
                signals[words[2]] = signal
    moments, now = [], 0
    words = (word for line in body.splitlines() for word in line.split())
    for word in words:
        kind, value = word[0], word[1:]
        if kind == "#":
            now = int(value)
            moments = [moments[0] if moments else now, now]
            continue
        if kind in "bs":
            signal = signals.get(next(words))
        elif kind in "01xz" and value:
            signal, value = signals.get(value), kind
        else:
            continue
        # Proofs' traces repeat at each step what has not changed.
        if signal and not (signal.changes and signal.changes[-1][1] == value):
            signal.changes.append((now, value))
    return [signal for signal in signals.values() if signal.changes], moments


def drawing_of(failure, room):
    """{from, to, signals: [[name, bits, [time, value, ...]], ...], more: signals left out}: the
    program's, those that the failure's text names, those that move below its instance, others that
    move, those that stay as they are; among each the outermost first. Of a drawing of more than
    `room` bytes the older changes are left out, then the last signals."""
    try:
        signals, moments = read_vcd(run(["fst2vcd", "-f", failure.wave])[1]
                                    if failure.wave.endswith(".fst")
                                    else pathlib.Path(failure.wave).read_text())
    except (ValueError, IndexError, StopIteration, RuntimeError) as error:
        print(f"{failure.wave} is damaged, and not drawn ({error})")
        return None
    if not moments:
        return None
    words = set(re.findall(r"[A-Za-z_]\w+", failure.about))

    def rank(signal):
        name = signal.name.rpartition(".")[2]
        within = f".{failure.scope}." in signal.name if failure.scope else signal.depth <= 3
        moves = len(signal.changes) > 1
        nameless = bool(re.fullmatch(r"n\d+(_o)?", name))  # a converter's
        return (signal.bits != 0, nameless, not (name in words and within),
                not (moves and failure.scope and within), not moves, signal.depth, signal.name)
    signals.sort(key=rank)

    def rows(count, changes):
        return [[s.name, s.bits, [each for time, value in list(s.changes)[-changes:]
                                  for each in (time, shown(value) if s.bits else value)]]
                for s in signals[:count]]
    count, changes = min(len(signals), MOST_SIGNALS), MOST_CHANGES
    drawn = rows(count, changes)
    while len(json.dumps(drawn)) > room and count > 1:
        if changes > FEWEST_CHANGES:
            changes //= 2
        else:
            count //= 2
        drawn = rows(count, changes)
    return {"from": moments[0], "to": moments[1], "signals": drawn, "more": len(signals) - count}
