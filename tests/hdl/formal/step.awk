# SPDX-License-Identifier: MIT
#
# step: gives an unrolled model in BLIF (abc: frames, comb) one output, `step`: only the last clock failed.
# Its first `bads` outputs say whether an assertion fails in each clock; the rest, the next state, goes.

/\\$/ { # a line goes on in the next
    sub(/\\$/, "")
    line = line $0
    next
}
{
    $0 = line $0
    line = ""
}
$1 == ".outputs" {
    for (i = 2; i < 2 + bads; i++) inputs = inputs " " $i
    print ".outputs step"
    next
}
$1 == ".end" {
    for (i = 1; i < bads; i++) zeros = zeros "0"
    print ".names" inputs " step"
    print zeros "1 1"
}
{ print }
