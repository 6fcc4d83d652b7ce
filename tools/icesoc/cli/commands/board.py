# SPDX-License-Identifier: MIT
"""board: list, show and check the boards of boards/, and generate their files."""
from pathlib import Path

from icesoc import TREE
from icesoc.board import check, make, model, picture, wiring
from icesoc.cli import choices
from icesoc.cli.command import GROUPS, command
from icesoc.cli.options import BOARD, FOLDER, SWITCH, Option
from icesoc.regs.model import Wrong
from icesoc.util.console import say
from icesoc.util.errors import Stop

GROUPS["board"] = "boards: wiring, constraints, pins, self-test"
PAGES = TREE / "docs/boards"


NAME = Option("name", BOARD, "name of the board, such as nucleo-qmtech", "", positional=True,
              choices=choices.boards, is_checked=False)


def read(values):
    """Returns the board given by NAME: the name of a board, or a file board.toml."""
    name = values.name
    if not name:
        raise Stop(f"NAME: expected one of the boards {', '.join(model.names())}, or a file "
                   "board.toml, got none", 2)
    try:
        if name.endswith(".toml"):
            return model.read(name)
        return model.find(name)
    except Wrong as error:
        raise Stop(str(error), 2) from None


@command("board list", [], examples=["board list"], brief="board list")
def board_list(_):
    """list the boards that are described in the folder boards/

    Prints name, number of wires, title and state of each board. A board with facts missing
    from its description cannot be built."""
    for name in model.names():
        board = model.find(name)
        state = ("facts are missing; cannot be built" if board.facts.get("unknown")
                 else board.facts["status"])
        say(f"{name:22} {len(wiring.wires(board)):3} wires  {board.facts['title']} ({state})")


@command("board show", [NAME], examples=[
    "board show nucleo-qmtech", "board show nucleo-qmtech-muxed", "board show my/board.toml"],
         brief="board show nucleo-qmtech")
def board_show(values):
    """print a board: chips, wiring table, parts to order, notes

    NAME is the name of a board in boards/, or a file board.toml. The output is the same text as the
    board's page in the documentation."""
    say(wiring.page(read(values)).rstrip())


@command("board check", [NAME], examples=[
    "board check nucleo-qmtech", "board check nucleo-qmtech-muxed", "board check my/board.toml"],
         brief="board check nucleo-qmtech")
def board_check(values):
    """report the errors of a board description

    NAME is the name of a board in boards/, or a file board.toml. The command checks the functions
    of pins, voltages of banks and signals, and clock inputs. It reports pins that are used twice,
    pins that the FPGA module or the microcontroller board already uses internally, inputs without a
    driver, and missing facts. Exit status 1: an error was found."""
    board = read(values)
    if found := check.problems(board):
        raise Stop("\n".join([f"board check: {len(found)} problem{'s' * (len(found) > 1)} in "
                              f"{board.path}",
                              *(f"  {text}" for text in found)]))
    say(f"{board.name}: {len(board.nets)} nets, no problem found")


@command("board make", [
    NAME, Option("out", FOLDER, "folder of the files (default: build/board/NAME)", ""),
    Option("docs", SWITCH, "only write the page and the picture of the board into docs/boards")],
         examples=["board make nucleo-qmtech", "board make nucleo-qmtech --out my/folder",
                   "board make nucleo-qmtech --docs"],
         brief="board make nucleo-qmtech --out build/brief/board")
def board_make(values):
    """generate the files of a board: constraints, pins, wiring, parts

    Also writes a configuration file for OpenOCD, and a page that describes the board. Nothing is
    written for a board with errors or missing facts; ./icesoc board check lists these errors and
    facts."""
    board = read(values)
    if values.docs:
        made = make.write(documents(board), PAGES)
    else:
        folder = Path(values.out or f"build/board/{board.name}")
        try:
            made = make.write({**make.for_build(board), **make.for_bench(board)}, folder)
        except Wrong as error:
            raise Stop(f"board make: refused\n{error}") from None
    for path in made:
        say(str(path))


def documents(board):
    """Returns the files of docs/boards, name to text."""
    found = {f"{board.name}.md": wiring.page(board)}
    if board.modules:
        found[f"{board.name}.svg"] = picture.draw(board)
    return found
