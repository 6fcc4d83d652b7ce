// SPDX-License-Identifier: MIT
// A cover as an assertion that must fail: techmap for prove.sh.
module \$cover (input A, input EN);
    \$assert _TECHMAP_REPLACE_ (.A(~A), .EN(EN));
endmodule
