#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""strings: checks that IceC parses and prints proxy strings in the same way as stock Ice. The cases
are written by hand, are combinations of options and values, or are composed at random from parts.

usage: strings.py PROGRAM [SEED] [COUNT]"""
import itertools
import random
import re
import subprocess
import sys

import Ice

# Intended differences (docs/icec.md): IceC does not have these transports and cannot bind a source
# address. In endpoints, quotes must surround whole words, and "-timeout" is not accepted for "-t".
# The name of a transport has no quotes, and a version has neither spaces nor "-0". An opaque
# endpoint has one option -t; stock Ice also accepts a second one after "-t 65535", because it
# stores 65535 as -1.
NOT_HERE = ("udp", "ws", "wss", "ssl", "--sourceAddress")
STRICTER = re.compile(r"""[^\s:]["'][^\s:@]|["'][^\s:]+["']\S|\s-[tzev][^\s:]|:["']"""
                      r"""|1\.-0|" 1\.0|-t 65535 -t""")
# IceC does not decode the bytes of opaque endpoints, and checks only the last of several "-e".
# Stock Ice decodes the types that it has, such as 1 (tcp), and refuses bytes that do not fit.
LOOSER = re.compile(r"""opaque.*(-t ['" +0]*[135]['"]*( |$)|-e .*-e )""")
# Stock Ice in Python cannot print identities that are not UTF-8.
IN_PYTHON = "UnicodeDecodeError"

CASES = r"""
a/b/c|a\/b/c|hello|hello:tcp -h host1 -p 1 -h host2 -p 2|hello:tcp -p 65535 -h h
hello:tcp -p 65536 -h h
hello:tcp -p -1 -h h|hello:tcp -p 1 -h h -t infinite|hello:tcp -p 1 -h h -t 0
hello:tcp -p 1 -h h -t -1
hello:tcp -p 1 -h h -t 2147483647|hello:tcp -p 1 -h h -t 2147483648|hello:tcp -p 1 -h
hello:tcp -h h -p
hello:tcp -p 0x10 -h h|hello:tcp -p 010 -h h|hello:tcp -p " 12" -h h|hello:tcp -p "12 " -h h
hello:tcp -p +5
hello:tcp -h "h:1" -p 1|hello:tcp -h 'h:1' -p 1|hello:tcp -h 'h h' -p 1|hello:tcp -h h -p 1 -z -z
hello:tcp -z 1
hello:tcp -h "" -p 1|hello:tcp -h * -p 1|hello:tcp -q h|hello:tcp h|hello:tcp -hh|hello:tcp --h x
hello:tcp -
hello -f f\/g:tcp -h h -p 1|hello -f "f g" -t -e 1.0 -p 1.0:tcp -h h -p 1
hello -e 1.1 -p 2.0:tcp -h h -p 1
hello -e 2.0|hello -e 1|hello -e 1.|hello -e .1|hello -e 1.1.1|hello -e 1.256|hello -e 255.255
hello -e +1.1|hello -e 1.+0|hello -e -1.1|hello -e 001.01
hello -e "1.1"|hello -e 1.2|hello -p 1.1|hello -p x|hello -t -o|hello -s -D|hello -t x|hello -f
hello -f -t
hello -f ""|hello -f "" -t|hello -x|hello -tt|hello t|hello@ad/apt|hello @ "ad apt"|hello@ "a:b"
hello@|hello@a b
hello@ "" |hello@"a"b|hello @ a:b|hello @ a@b|hello @ "a|"":tcp -h h|""|"" |'' | "" -t|cat/:tcp -h h
cat/
/name:tcp -h h -p 1|caf\303\251|café|x\ty|"a \" b"|'a " b'|'a \' b'|a\:b:tcp -h h|a@b:tcp -h h|"a@b"
"a:b"
x:opaque -t 99 -e 1.1 -v abcd|x:opaque -t 99 -v abcd|x:opaque -t 99 -v abc|x:opaque -t 99 -v ab
x:opaque -t 99 -v a
x:opaque -t 99 -v a=b=|x:opaque -t 99 -v ====|x:opaque -t 99 -v ab==cd==|x:opaque -t 99 -v a-b
x:opaque -t 99 -v ""
x:opaque -t 99 -t 99 -v abcd|x:opaque -t 99 -v abcd -v abcd|x:opaque -v abcd
x:opaque -t 65536 -v abcd|x:opaque -t -1 -v ab
x:opaque -t 0x1 -v abcd|x:opaque -t 99 -e 2.3 -v abcd|x:opaque -t 99 -e 1 -v abcd
x:opaque -t 99 -v abcd -q 1|x:opaque
x:opaque -t 1 -e 1.0 -v CTEyNy4wLjAuMeouAAAQJwAAAA==
x:opaque -t 1 -e 1.0 -v CTEyNy4wLjAuMeouAAAQJwAAAQ==
x::tcp -h h|x:|x: :tcp -h h|:tcp -h h|   x   :   tcp   -h   h   -p   1   |x:nosuch -h h
x:nosuch:tcp -h h|x:tcp:nosuch
x:default -h h -p 3|x:tcp|x -d -t:tcp -h h -p 1|x:TCP -h h|x:tcpx -h h|x:tcp -h h:|x:tcp -h h::tcp
x\\/y|x\\\/y|x\\\\/y/z|\/|\\|\|x\|x\q|x\1|x\18|x\777|x\x41|x\x|x\x4|x\xg|x\u0041|x\u041|x\U00000041
x\ud800|x\U00110000
x\0y|x\e|x\?|x\'|x\"|x\a\b\f\n\r\t\v|x\u00e9|x\u20ac|x\U0001F600|x\x01\x7f|"x\u0020y"|-t|-t -t|"-t"
/|//|a//b
"x" -f "a\"b"|x -f 'a"b'|x -f a\:b|x -f a\ b|"x"y|"x"-t|"x|'x|x"y"|x -f "a|x -f "a"b -t|x -f a"b c"
x @ a"b c"
""".replace("\n", "|").split("|") + [
    "", " ", "x\ty", "x\x01", "\tx -t\n", "x:tcp\t-h\th", "x -f \x7f", '"x\ty"',
    "x:tcp -h \"a\tb\" -p 1", "x\r-o", "a|b", "x @ \x02"]

PARTS = ["x", "cat/name", '"a b"', "'c d'", "a\\/b/c", "\\u00e9", "\\x41", "/", "\\", '"', "'", ":",
         " ", " ", " -t", " -o", " -s", " -f f", ' -f "g h"', " -e 1.1", " -e 1.0", " -e 3.7",
         " -p 1.0", " -p 1.2", "@ad", " @ \"b c\"", ":tcp", ":tcp -h h", ":tcp -h h -p 10",
         ":default -p 2", ":opaque -t 99 -v abcd", ":opaque -t 55 -e 1.0 -v QQ==", " -h k", " -p 7",
         " -p 99999", " -t 5", " -t infinite", " -z", " -h \"::1\"", " -q", " -t 0", ":nosuch",
         "\t", "é"]


# Values of options: of an endpoint, of an opaque endpoint, and of a proxy.
NUMBERS = ["", "0", "1", "-0", "-1", "+1", "++1", "1.0", "1e3", "0x1", "01", "'1'", '" 1"', '"1 "',
           "1a", "a1", "\u0661", "'", "-", '"-1"', '"- 1"', "65535", "65536", "2147483647",
           "2147483648", "4294967297", "18446744073709551617", "infinite", "Infinite", "' 5'",
           "5ms"]
HOSTS = ['"h"', "'h'", '""', "''", '"h h"', "'h:h'", "'h", '"h', "\\h", "h\\:", "é", "-h", "h@h",
         '"::1"', "*", "%", "h.", "h#h", "h=h", "h|h", '"h\th"']
VERSIONS = ["", '""', "1.0", "'1.1'", "2.0", "0.0", "0.1", "255.255", "256.0", "1.256", "-1.0",
            "1.-0", "1.0.0", "1", "1.", ".", "a.b", "1.0:tcp -h h", "1.0@a", "01.00", "1. 0",
            '"1.0', '1.0"', "+1.0", '" 1.0"', '"1.0 "', "1.0 1.1", "-x", "f\\:g", '"f@g"', "f/g",
            "f\\", "a\\x41", "a\\u0041"]
VALUES = {"tcp": {"h": HOSTS, "p": NUMBERS, "t": NUMBERS, "z": ["", "1", "-z", '""'],
                  "q": ["", "1"], "H": ["h"], "-h": ["h"], "": ["", "1"]},
          "opaque": {"t": NUMBERS, "e": VERSIONS,
                     "v": ["", "abcd", "QQ==", "a", "ab", "abcde", "====", "a===", "=abc", "ab=c",
                           "a b", '"abcd"', "'abcd'", "-", "+/+/", "ab*d", "é"]}}
IDENTITIES = r"""a/b|/b|a/|//|a//b|a\/b|a\\/b|\a|\\|\|\0|\0000|\12|\377|\400|\8|\x|\x1|\x123|\xg
\u123|\u1234|\ud7ff|\udfff|\uffff|\U|\U0001F600|\U0010FFFF|\UFFFFFFFF|\c|\ |\:|\@|\-|é|€|😀|\xc3\xa9
~|!|#|$|%|&|(|,|-|-a|--|.|;|<|?|[|^|`|{|a b|\x7f""".replace("\n", "|").split("|")


def combinations():
    """Yields strings with all combinations of a few options, values, spaces and places."""
    for count in range(1, 5):
        for words in itertools.permutations(["-h h", "-p 10", "-t 5", "-z"], count):
            yield "x:tcp " + " ".join(words)
    for count in range(1, 4):
        for words in itertools.permutations("-t -o -O -d -s".split() + ["-f f", "-e 1.0"], count):
            yield "x " + " ".join(words)
    twice = ["-h a", "-h b", "-p 1", "-p 2", "-t 1", "-t 2"]
    for first, second in itertools.permutations(twice, 2):
        yield f"x:tcp {first} {second} {first}"
    rests = {"tcp": ["", " -h k", " -p 3 -z"], "opaque": ["", " -t 99 -v abcd", " -v abcd -e 1.1"]}
    for name, options in VALUES.items():
        for letter, values in options.items():
            for value, rest in itertools.product(values, rests[name]):
                option = f" -{letter} {value}".rstrip()
                yield from (f"x:{name}{option}{rest}", f"x -o:{name}{rest}{option}")
    for option, value in itertools.product("-f -e -p -t -o -s -x --t".split(), VERSIONS):
        yield from (f"x {option} {value}", f"x {option} {value} -o:tcp -h h")
    for identity in IDENTITIES:
        for form in ("%s", '"%s"', "'%s' -t", "%s:tcp -h h", "c/%s", "%s/n", "x -f %s", 'x -f "%s"',
                     "x @ %s", 'x@"%s"'):
            yield form.replace("%s", identity)
    for space in "\t", "\n", "\r", "\v", "\f", "\u00a0", "\u2028", "  ":
        for form in ("x_", "_x", "x_-t", "x_:tcp", "x:_tcp", "x:tcp_-h_h", "x:tcp -h h_", "x_@_a",
                     "x -f_f", "x_y", '"x_y"', "x -e_1.0", "x:tcp -h h:_tcp -h k",
                     "x:tcp -h h_:tcp -h k", "x:opaque_-t_99_-v_abcd"):
            yield form.replace("_", space)


def strings(seed, count):
    chance = random.Random(seed)
    yield from CASES
    yield from combinations()
    for _ in range(count):
        text = "".join(chance.choice(PARTS) for _ in range(chance.randint(1, 7)))
        if chance.random() < 0.2:
            at = chance.randrange(len(text))
            text = text[:at] + chance.choice("\\\"'/:@- \t0z%") + text[at + chance.randint(0, 1):]
        yield text


def main():
    program = sys.argv[1]
    seed, count = (int(word) for word in (sys.argv[2:] + ["1", "4000"][len(sys.argv) - 2:]))
    texts = [text for text in strings(seed, count)
             if not any(word in text for word in NOT_HERE)]
    # printed strings may contain newlines, so another proxy marks the end of each
    lines = "".join(text.encode().hex() + "\n" + b"end".hex() + "\n" for text in texts)
    ours = subprocess.run([program], input=lines.encode(), capture_output=True, check=True)
    ours = ours.stdout.decode(errors="replace").split("\n=end -t -e 1.1\n")
    wrong = 0
    with Ice.initialize(["--Ice.Default.Host=127.0.0.1", "--Ice.Warn.Endpoints=0"]) as ic:
        for text, mine in zip(texts, ours):
            try:
                proxy = ic.stringToProxy(text)
                stock = "=" + (str(proxy) if proxy else "")
            except Exception as e:  # stock Ice raises exceptions of several kinds
                stock = "error " + type(e).__name__
            if mine.startswith("error") and (stock.startswith("error") or STRICTER.search(text)):
                continue
            if stock.startswith("error") and (LOOSER.search(text) or IN_PYTHON in stock):
                continue
            if mine != stock:
                wrong += 1
                print(f"{text!r}: expected {stock!r}, got {mine!r}")
    print(f"{len(texts)} strings, {wrong} differ (seed {seed})")
    return wrong != 0


if __name__ == "__main__":
    sys.exit(main())
