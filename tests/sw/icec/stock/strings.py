#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""strings: checks that IceC parses and prints proxy strings in the same way as stock Ice. The cases
are written by hand, and many more are composed at random from parts.

usage: strings.py PROGRAM [SEED] [COUNT]"""
import random
import re
import subprocess
import sys

import Ice

# Intended differences (docs/icec.md): IceC does not have these transports and cannot bind a source
# address. In endpoints, quotes must surround whole words, and "-timeout" is not accepted for "-t".
NOT_HERE = ("udp", "ws", "wss", "ssl", "--sourceAddress")
STRICTER = re.compile(r"""[^\s:]["'][^\s:@]|["'][^\s:]+["']\S|\s-[tzev][^\s:]""")

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


def strings(seed, count):
    chance = random.Random(seed)
    yield from CASES
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
    lines = "".join(text.encode().hex() + "\n" for text in texts)
    ours = subprocess.run([program], input=lines.encode(), capture_output=True, check=True)
    ours = ours.stdout.decode().split("\n")
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
            if mine != stock:
                wrong += 1
                print(f"{text!r}: expected {stock!r}, got {mine!r}")
    print(f"{len(texts)} strings, {wrong} differ (seed {seed})")
    return wrong != 0


if __name__ == "__main__":
    sys.exit(main())
