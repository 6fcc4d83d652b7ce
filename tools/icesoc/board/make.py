# SPDX-License-Identifier: MIT
"""make: writes the generated files of a board into a folder.

CMake: python -m icesoc.board.make BOARD.toml FOLDER writes board_pins.h, board.ucf, board.wires
and board_wires.inc. Without FOLDER, it prints how the board connects the FSMC: `multiplexed` or
`separate` address and data. `./icesoc board make NAME` writes all files."""
import sys
from pathlib import Path

from icesoc.board import check, firmware, model, picture, simulator, ucf, wiring
from icesoc.regs.model import Wrong
from icesoc.util import files
from icesoc.util.errors import Stop


def for_build(board):
    """Returns the files that the build needs, as {name: text}."""
    if found := check.problems(board):
        raise Wrong("\n  ".join([f"{board.path}: cannot be built:", *found]))
    wires, constraints = simulator.wires(board), ucf.constraints(board)
    return {"board_pins.h": firmware.header(board), "board.ucf": constraints, "board.wires": wires,
            "board_wires.inc": simulator.literals(wires, constraints)}


def for_bench(board):
    """Returns the files for assembling and debugging the board, as {name: text}."""
    return {"wiring.html": wiring.table(board), "wiring.svg": picture.draw(board),
            "bom.csv": wiring.bom(board), "openocd.cfg": firmware.openocd(board),
            "page.md": wiring.page(board)}


def write(texts, folder):
    """Writes the files with changed text, and leaves the others as they are. Returns the paths
    of all files."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        path = folder / name
        if not path.is_file() or path.read_text() != text:
            files.write(path, text)
    return [folder / name for name in texts]


def main():
    try:
        board = model.read(sys.argv[1])
        if len(sys.argv) == 2:
            print("multiplexed" if board.muxed else "separate")
            return
        write(for_build(board), sys.argv[2])
    except (Wrong, Stop) as e:
        sys.exit(str(e))


if __name__ == "__main__":
    main()
