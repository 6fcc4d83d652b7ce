# SPDX-License-Identifier: MIT
"""completion: completes the words of ./icesoc, and of make in this project, in bash and zsh.

The shell evaluates the text of `code`. Its functions start ./icesoc at each Tab, with the command
line in the environment: in COMP_LINE for argcomplete, or in _ICESOC_MAKE for make.
"""
import argparse
import re

from icesoc.cli.command import COMMANDS, DEFAULTS, GROUPS
from icesoc.util.console import warn

# Bash treats = and a quotation mark as the beginning of a word, so the completions of a value do
# not contain its variable.
BASH = """
_icesoc_make() {
    [ -x ./icesoc ] && grep -qs '^# Makefile: .*icesoc' Makefile || return
    local IFS=$'\n'
    COMPREPLY=($(_ICESOC_MAKE="${COMP_LINE:0:$COMP_POINT}" ./icesoc 2>/dev/null))
    [ ${#COMPREPLY[@]} != 1 ] || [ "${COMPREPLY[0]%=}" = "${COMPREPLY[0]}" ] || compopt -o nospace
}
complete -o bashdefault -o default -F _icesoc_make make
"""
# zsh passes the words of the line up to the cursor, with their quotation marks. The call of
# argcomplete is the call in argcomplete's code for bash.
ZSH = """
(( $+functions[compdef] )) || { autoload -Uz compinit; compinit; }
_icesoc() {
    local -a found
    local line="${(j: :)words[1,CURRENT]}"
    found=(${(f)"$(COMP_LINE="$line" COMP_POINT=${#line} COMP_TYPE=9 _ARGCOMPLETE=1 \\
        _ARGCOMPLETE_IFS=$'\n' _ARGCOMPLETE_SUPPRESS_SPACE=1 _ARGCOMPLETE_COMP_WORDBREAKS= \\
        "$words[1]" 8>&1 9>/dev/null 1>/dev/null 2>&1)"})
    found=(${found%% })
    (( $#found )) || { _files; return; }
    compadd -S '' -- ${(M)found:#*[=/:]}
    compadd -- ${found:#*[=/:]}
}
_icesoc_make() {
    if ! [[ -x ./icesoc ]] || ! grep -qs '^# Makefile: .*icesoc' Makefile; then
        _make "$@"
        return
    fi
    local -a found
    found=(${(f)"$(_ICESOC_MAKE="${(j: :)words[1,CURRENT]}" ./icesoc 2>/dev/null)"})
    compset -P '*[= ]'
    (( $#found )) || { _files; return; }
    found=(${found##* })
    compadd -S '' -- ${(M)found:#*=}
    compadd -- ${found:#*=}
}
compdef _icesoc ./icesoc icesoc
compdef _icesoc_make make
"""


def complete():
    """Completes the words of ./icesoc in a shell, if Debian's argcomplete is installed."""
    import argcomplete
    top = argparse.ArgumentParser()
    within = {"": top.add_subparsers()}
    for name, each in COMMANDS.items():
        first, _, last = name.rpartition(" ")
        if first not in within:
            group = within[""].add_parser(first, help=GROUPS[first])
            if first in DEFAULTS:
                COMMANDS[DEFAULTS[first]].parser(group)
            within[first] = group.add_subparsers()
        each.parser(within[first].add_parser(last, help=each.help))
    argcomplete.autocomplete(top)


def complete_make(line):
    """Returns the words that may follow in a command line of make: goals, `VARIABLE=`, or values.
    In a value of several words, such as CORES='ascon fir', the last word is completed."""
    *words, last = re.findall(r"""(?:\\.|[^ '"\\]|'[^']*(?:'|$)|"[^"]*(?:"|$))+""", line + "|")
    last = last.removesuffix("|").replace("\\ ", " ")
    goals = [word for word in words[1:] if "=" not in word and not word.startswith("-")]
    commands = [each for each in COMMANDS.values() if each.make and each.make in goals]
    options = {option.variable: option for each in commands for option in each.options
               if option.listed}
    name, has_value, value = last.partition("=")
    if has_value and name in options:
        option, value = options[name], value.lstrip("'\"")
        before = value[:value.rfind(" ") + 1] if option.many else ""
        return [before + word for word in option.completions(value.removeprefix(before))]
    if has_value:
        return []
    if commands:
        return sorted(f"{variable}=" for variable in options if variable.startswith(last))
    return sorted({each.make for each in COMMANDS.values() if (each.make or "").startswith(last)
                   and each.make})


def code():
    """Returns the code that bash or zsh evaluates to complete ./icesoc, and make in this
    project."""
    bash = BASH
    try:
        from argcomplete import shellcode
        bash = shellcode(["./icesoc"], shell="bash") + BASH
    except ImportError:
        warn("./icesoc setup --tests installs python3-argcomplete, which completes ./icesoc")
    return f"if [ -n \"${{ZSH_VERSION-}}\" ]; then{ZSH}else{bash}fi"
