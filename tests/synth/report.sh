#!/bin/sh
# SPDX-License-Identifier: MIT
#
# report: utilisation-program source-folder case kept: the command on a small project of its own, as
# a user runs it; its parts are tested by parts_test.py. What `counts` has synthesised is left in the
# folder `kept`, where the other cases begin.
set -eu
program=$1 source=$2 case=$3 kept=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
fail() {
    echo "report: $*" >&2
    exit 1
}
cd "$work" # names of files are relative, since they are part of a design's identity
project=project
cp -r "$source/tests/synth/project" "$project"
mkdir -p "$project/bus" "$project/ip"
touch "$project/bus/none" "$project/ip/none" # git keeps no empty folder
cp -r "$source/synth/yosys" "$source/synth/report" "$project/synth/"
mkdir gen out
[ "$case" = counts ] || cp -r "$kept" out/cache
run() {
    "$program" --source project --generated gen --output out "$@" >"$work/log" 2>&1
}
grow() { # twelve flip-flops more
    sed -i 's/^    wire \[5:0\] word;/&\n    reg [11:0] extra;/; s/^        data_o <= word/        extra <= {extra[5:0], word};\n        data_o <= extra[11:6] ^ word/' "$1/pair.v"
}
users_tree() {
    cd project
    mkdir -p build/main/synth build/synth
    ln -s "$program" build/main/synth/utilisation && mv ../gen build/main &&
        mv ../out/cache build/synth
}
made() { "$source/tests/regress/test/make_in.sh" "$source" . build/main "$@" >"$work/log" 2>&1;
} # in the project, as a user
has() { grep -q -- "$1" "$work/log" || { cat "$work/log" >&2; fail "no '$1' in the output"; }; }

case $case in
counts)
    # its figures are those that the blocks' sources promise, and Yosys' own `stat` counts them, too
    run || fail "$(cat "$work/log")"
    has '^wide .* [0-9]* ([0-9]*-[0-9]*)$' # the clock, and from where to where it goes in other orders
    has '^wide  *[0-9]* ([0-9]*-[0-9]*) ' # and the LUTs
    figure() { cat out/cache/"$1".xc6s.*.figures |
        /usr/bin/python3 -c 'import json, sys; f = json.load(sys.stdin); print(eval(sys.argv[1], f))' "$2"; }
    is() { [ "$(figure "$1" "$2")" = "$3" ] || fail "$1: $2 is $(figure "$1" "$2"), not $3"; }
    is wide 'cells["CARRY4"]' 4 # a counter of 16 bits: the parameter was set
    is store 'cells["RAM32M"], lutRam' '(1, 4)' # 32 x 6 bits
    is whole 'costs["u_counter"]["count_o"][2]' 5
    is whole 'costs["u_store"]["words"][:3]' '[4, 4, 0]'
    yosys -q -p "read_verilog $project/hdl/blocks/*.v; synth_xilinx -family xc6s -flatten -noiopad -noclkbuf -top pair; tee -o $work/stat stat"
    luts=$(awk '/^ +(LUT[1-6]|INV) /{n += $2} /^ +[0-9]+ +.* (LUT[1-6]|INV)$/{n += $1} END {print n + 4}' "$work/stat")
    is whole lut "$luts" # as Yosys counts
    # A core's cost in the accepted chip: a slot is the decoder of three less that of two.
    cp "$source/bus/bus_decoder.v" "$project/bus/"
    echo '{"constants": [{"name": "SLOT_LOW", "value": 2}, {"name": "SLOT_COUNT", "value": 3}]}' \
        >gen/map.regs.json
    echo '{"yosys": "", "designs": {"soc": {"lut": 9, "ff": 9, "slices": 9, "carry": 0, "dsp": 2, "ram": 1.5, "mhz": 99,
          "signals": {"u_low": {"sum": [7, 8, 1.5, 2]}}}}}' >"$project/synth/baseline.json"
    run --core low || fail "$(cat "$work/log")"
    has '^low  *[1-9][0-9]  *13  *1.5  *2  *7 / 8  *[1-9][0-9]* / 5$' # a bit each of 32, a select, four of address
    has '^The chip: 9 LUT, 9 FF, 1.5 block RAMs, 2 DSP'
    run --core high || fail "a core that is not in the accepted chip is no error"
    has 'high is not in the chip of synth/baseline.json: a line in ip/cores.list, then make ip-synth IP=high CHIP=1'
    rm -rf "$kept"
    cp -r out/cache "$kept"
    ;;
growth)
    # a register more fails with its name; accepted it passes; a second run takes all from the cache
    run --accept || fail "$(cat "$work/log")"
    run || fail "what was accepted does not pass: $(cat "$work/log")"
    if grep -q '^\[' "$work/log"; then fail "a second run synthesised again"; fi
    grow "$project/hdl/blocks"
    if run; then fail "twelve flip-flops more pass"; fi
    has 'FAILED whole:'
    has 'extra +.*FF'
    [ "$(grep -c '^\[' "$work/log")" = 1 ] || fail "more was synthesised than what has changed"
    run --accept && run || fail "the accepted growth does not pass"
    ;;
partial)
    # one design alone: of those that have changed it says so; limits hold, whatever is accepted
    run || fail "$(cat "$work/log")"
    sed -i 's/^    wire \[5:0\] word;/&\n    wire unused = 1;/' "$project/hdl/blocks/pair.v"
    run --design store || fail "$(cat "$work/log")"
    if grep -q '^wide ' "$work/log"; then fail "a design that was not asked for is in the table"; fi
    has '^Designs: 2 measured now, 1 changed since'
    grep -q '"whole": "changed since"' out/report.json && grep -q '^| whole | changed since |' \
        out/report.md || fail "what has changed since is not told"
    grep -q '"name": "wide lut"' out/report.json || fail "what has not changed is not in the report"
    # In a fresh clone nothing has been measured, and nothing is gone.
    run --accept && rm -r out/cache && run --design store || fail "$(cat "$work/log")"
    has '^Designs: 1 measured now, 2 as accepted'
    echo '// changed' >>"$project/hdl/blocks/counter.v"
    echo 'module fresh(input wire a_i); endmodule' >"$project/hdl/blocks/fresh.v"
    run --design store || fail "$(cat "$work/log")"
    has '^Designs: 1 measured now, 2 changed since, 1 never measured here'
    sed -i 's/"lut": 40/"lut": 1/' "$project/synth/designs.json"
    if run --accept; then fail "a figure above its limit is accepted"; fi
    has 'above the limit of 1: nothing is accepted'
    ;;
broken)
    echo 'module broken(input wire a_i); assign b = ; endmodule' >"$project/hdl/blocks/broken.v"
    if run; then fail "a syntax error passes"; fi
    has 'broken.v:1: ERROR: syntax error'
    has "^wide "
    has '^broken .*failed'
    grep -q '"broken: synthesis failed"' out/report.json || fail "the failure is not in report.json"
    for file in baseline designs; do # as a merge leaves it
        printf '{\n<<<<<<< HEAD\n' >"$project/synth/$file.json"
        if run; then fail "a $file.json that is none passes"; fi
        has "^utilisation: project/synth/$file.json: .*line 2"
    done
    ;;
twice)
    # The first one's Yosys begins when the second has been seen to wait (or, if it never does,
    # after 20 s).
    cat >"$work/slow" <<'SH'
#!/bin/sh
[ "$1" = -V ] || for _ in $(seq 200); do
    ! grep -q 'waiting for another run' second || break
    sleep 0.1
done
exec yosys "$@"
SH
    chmod +x "$work/slow"
    rm -rf out
    : >second
    "$program" --source project --generated gen --output out --design wide --yosys "$work/slow" \
        >first 2>&1 &
    first=$!
    until [ -d out/cache ] || ! kill -0 $first 2>/dev/null; do sleep 0.1; done # it has the folder
    "$program" --source project --generated gen --output out --design wide --yosys "$work/slow" \
        >second 2>&1 || fail "the second: $(cat second)"
    wait $first || fail "the first: $(cat first)"
    grep -q 'waiting for another run in out' second || fail "the second did not wait: $(cat second)"
    [ "$(grep -c '^\[' first)" -gt 0 ] || fail "the first synthesised nothing: $(cat first)"
    if grep -q '^\[' second; then fail "the second synthesised again: $(cat second)"; fi
    ;;
page)
    run --family ecp5 || fail "$(cat "$work/log")"
    page=$work/out/report.html
    [ "$(wc -c <"$page")" -lt 2000000 ] || fail "the page has 2 MB or more"
    if grep -Eo '(src|href)="?https?:' "$page"; then fail "the page needs the network"; fi
    dump() { HOME=$work chromium --headless --no-sandbox --disable-gpu --virtual-time-budget=20000 \
        --dump-dom "file://$1" 2>/dev/null >"$work/dom"; }
    # Where the libraries could not be fetched, all is there, and the page says how to get them.
    sed '/^!function.*Tabulator=/d; /^.*var uPlot=/d' "$page" >"$work/plain.html"
    dump "$work/plain.html#whole/u_store"
    sed -n '/<p class="soft">/,/<script id/p' "$work/dom" | tr -d '\n' |
        sed 's/<script.*//; s/<[^>]*>/ /g; s/  */ /g' >"$work/log"
    has 'Tabulator and uPlot could not be fetched. With a network'
    has ' flip-flops 11 .* 50 (0.3 %) .* wide 1 0.0 % .* store [0-9]* .* pair 15 .* u_store .* read_addr_i 5 0 project/hdl/blocks/store.v:12 .* clk_i 11 12 [0-9]* project/hdl/blocks/pair.v:8 .* rst_i synchronous 5 project/hdl/blocks/pair.v:9 '
    has ' 8 to 8.5 ns left of 10 1 .* u_counter.count_o.4. 9 FDRE project/hdl/blocks/counter.v:13 .* now 15 11 6 [0-9]* this run '
    [ -s "${program%/synth/*}/page/libraries.js" ] ||
        { echo "skipped: Tabulator and uPlot could not be fetched"; exit 77; }
    # A second script clicks as a user does and writes what it then sees.
    cat >"$work/clicks.js" <<'JS'
(async () => {
const seen = [], all = selector => [...document.querySelectorAll(selector)], rest = () => new Promise(done => setTimeout(done, 200));
const rowsOf = id => all(`#${id} .tabulator-row`), first = id => rowsOf(id).map(r => r.querySelector(".tabulator-cell").textContent);
const cells = (id, row) => [...rowsOf(id)[row].querySelectorAll(".tabulator-cell")].map(c => c.textContent);
const row = (id, name) => rowsOf(id)[first(id).findIndex(text => text.startsWith(name))];
const key = (row, key) => row.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
await rest();
const verdict = document.getElementById("verdict"), chip = document.getElementById("chip");
seen.push("at first " + document.getElementById("here").textContent + ", " + first("tree").filter((name, i) => rowsOf("tree")[i].matches(".picked")));
seen.push("first " + (verdict.compareDocumentPosition(chip) & Node.DOCUMENT_POSITION_FOLLOWING ? verdict.firstChild.textContent : "not the verdict"));
seen.push("chip " + chip.querySelectorAll(".meter").length + " " + chip.firstChild.textContent);
seen.push("folders " + first("designs"));
row("designs", "hdl/blocks").focus();
key(row("designs", "hdl/blocks"), "Enter");
seen.push("opened " + first("designs") + " at " + document.activeElement.textContent.slice(0, 10));
for (const time of [1, 2]) {
  all("#designs .tabulator-col")[1].click();
  await rest();
  seen.push("sorted " + first("designs"));
}
row("designs", "whole").click();
await rest();
seen.push("picked " + all("#designs .picked").length + " " + document.getElementById("inside").textContent);
row("tree", "u_store").click();
await rest();
seen.push("tree " + rowsOf("tree").map((r, i) => cells("tree", i)[0] + cells("tree", i)[5]).join(" "));
seen.push("here " + document.getElementById("here").textContent);
seen.push("paths " + all("#paths details").length);
all("#paths details")[0].open = true;
await rest();
seen.push("step " + all("#paths a").pop().textContent);
seen.push("on the way to " + stepsOf({ steps: [["a", "x"], ["b", ""], ["c", "y"]], pin: "D",
  to: "z" }).map(row => row.at));
const read = id => all(`#${id} .u-value`).map(value => value.textContent).join(" ");
let slack = read("slack");
for (let left = 20; left && / 0 *$/.test(slack); left--) { // to the last bar
  key(document.getElementById("slack"), "ArrowLeft");
  await rest();
  slack = read("slack");
}
seen.push("slack " + slack);
seen.push("history " + read("history"));
document.getElementById("seen").textContent = seen.join("; ") + ";";
})().catch(error => { document.getElementById("seen").textContent = error.stack; });
JS
    awk -v clicks="$work/clicks.js" \
        '/^<\/body>/ { print "<p id=\"seen\"></p><script>"; while ((getline line < clicks) > 0) print line; print "</script>" } { print }' \
        "$page" >"$work/clicked.html"
    dump "$work/clicked.html#whole/u_store"
    sed -n 's/<p id="seen">/; /p' "$work/dom" >"$work/log"
    has '; at first Signals of u_store, u_store; first Within all budgets; chip 5 15 LUT0.2 % of 9112'
    has '; folders whole,hdl/blocks, 2 modules; opened whole,hdl/blocks, 2 modules,wide,store at hdl/blocks; sorted whole,hdl/blocks, 2 modules,store,wide;'
    has '; sorted hdl/blocks, 2 modules,wide,store,whole; picked 1 Inside whole: '
    has '; tree pair u_storestore u_countercounter; here Signals of u_store;'
    has '; paths 1; step project/hdl/blocks/[a-z]*.v:1[23]; on the way to x,y,y,z; slack [0-9.]* to [0-9.]* ns left of 10 [1-9][0-9]* ; history now  this run 15 11 6;'
    "$source/tests/look.py" "$page" || fail "the page"
    grep -q '"peer": 100' "$work/out/report.json" || fail "report.json has no figure of the paper"
    grep -q '^| whole |' "$work/out/report.md" || fail "report.md has no table of designs"
    ;;
compare) # what has changed since another commit, or between two, as Markdown
    users_tree
    compare() { made synth BASE="$1"; }
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(small NONE)\nadd_custom_target(synth_inputs COMMAND ${CMAKE_COMMAND} -E make_directory gen)\n' >CMakeLists.txt
    echo build >.gitignore
    git init -q . && git add . && git -c user.name=a -c user.email=a@b commit -qm "The first one"
    "$program" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
    compare HEAD.. || fail "$(cat "$work/log")"
    has '^No figure of any design differs'
    sed -i 's/"WIDTH": 16/"WIDTH": 17/; s/"name": "wide"/"name": "wider"/' synth/designs.json
    grow hdl/blocks
    "$program" >"$work/log" 2>&1 || [ $? -eq 1 ] || fail "$(cat "$work/log")" # it has grown
    compare HEAD.. || fail "$(cat "$work/log")"
    has '^Utilisation since .* (The first one):'
    has '^| whole | .* | [0-9]* -> [0-9]* (+12) |'
    has '^| wide | gone | gone |'
    has '^| wider | [0-9]* (new) |'
    cmp -s build/synth/compare.md "$work/log" || grep -q '^| wider ' build/synth/compare.md ||
        fail "compare.md is not there"
    has '^| [0-9a-f]*+ | not measured | not measured |' # nobody knows what was measured of files without a commit
    # Over budget the difference matters most: it is told, and the status is that of the budget.
    cp synth/designs.json designs.kept && sed -i 's/"ff": 30/"ff": 20/' synth/designs.json
    if made synth BASE=HEAD; then fail "a design over its limit passes"; fi
    has '^FAILED whole'
    has '^| whole | .* | [0-9]* -> [0-9]* (+12) |'
    mv designs.kept synth/designs.json
    # The same between two commits, whatever is here now; tests and coverage are those of each.
    git add . && git -c user.name=a -c user.email=a@b commit -qm "The second one"
    mkdir -p build/regress build/coverage
    for tests in 9 7; do printf '{"commit":"%s","passed":%s,"failed":1}\n' \
        "$(git describe --always --abbrev=10)" $tests; done >build/regress/history.jsonl
    echo "$(git describe --always --abbrev=10 HEAD~1) 97.1 % of lines" >build/coverage/history
    echo 'module pair' >hdl/blocks/pair.v
    rm build/synth/report.json
    compare HEAD~1..HEAD || fail "$(cat "$work/log")"
    has '^Utilisation since .* (The first one), at .* (The second one):'
    has '^| whole | .* | [0-9]* -> [0-9]* (+12) |'
    has '^| [0-9a-f]* | not measured | 97.1 % of lines |'
    has '^| [0-9a-f]* | 9 passed, 1 failed | not measured |'
    for wrong in nonsense HEAD..nonsense; do
        if compare $wrong; then fail "a commit that is none"; fi
        has 'there is no commit BASE=nonsense'
    done
    ;;
made)
    users_tree
    made synth-accept DESIGN=store && made synth DESIGN=store || fail "$(cat "$work/log")"
    if grep -q '^wide ' "$work/log"; then fail "a design that was not asked for is in the table"; fi
    if made synth FAMILY=none; then fail "no such family"; fi
    has "'none'.*choose from"
    echo store >build/main/cores.known
    if made ip-synth IP=nobody; then fail "a core that is none"; fi
    has "there is no core 'nobody': store"
    ;;
edif)
    # The netlist that ISE reads has every cell that Yosys counts, once, and well-formed
    # parentheses.
    users_tree
    made synth-edif DESIGN=whole || fail "$(cat "$work/log")"
    edif=build/synth/ise/whole.edf
    [ "$(tr -cd '(' <"$edif" | wc -c)" = "$(tr -cd ')' <"$edif" | wc -c)" ] ||
        fail "parentheses do not match"
    for cell in RAM32M CARRY4 FDRE; do
        inside=$(grep -o "(cellRef $cell " "$edif" | wc -l)
        counted=$(grep -c "\"type\": \"$cell\"" build/synth/ise/whole.json)
        { [ "$inside" = "$counted" ] && [ "$inside" -gt 0 ]; } ||
            fail "$inside $cell in EDIF, $counted counted"
    done
    grep -q '(design pair' "$edif" || grep -q '(design whole' "$edif" || fail "the top is not named"
    [ -f "build/synth/ise/verilog/store.v" ] || fail "the Verilog for XST is not there"
    # Of a primitive's port only bits that it has are connected.
    cat >hdl/blocks/deep.v <<EOF
module deep (input clk_i, write_i, input [7:0] at_i, from_i, input [31:0] i, output reg [31:0] o);
    reg [31:0] words [0:255];
    always @(posedge clk_i) begin
        if (write_i) words[at_i] <= i;
        o <= words[from_i];
    end
endmodule
EOF
    made synth-edif DESIGN=deep || fail "$(cat "$work/log")"
    edif=build/synth/ise/deep.edf
    grep -q 'cellRef RAMB8BWER' "$edif" && ! grep -q '(member [A-Za-z0-9_]* -' "$edif" ||
        fail "an 8-Kbit block RAM has another width: $(grep -m 1 '(member [A-Za-z]* -' "$edif")"
    ;;
*) fail "unknown case $case" ;;
esac
