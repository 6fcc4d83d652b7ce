#!/bin/sh
# SPDX-License-Identifier: MIT
#
# setup: installs the Debian packages that `make run` needs and the machine lacks; on a terminal it
# asks before it calls sudo. It is a shell script because an empty Debian has no Python.
# Usage: cmake/setup.sh [--packages] [--tests] [--check]
# --packages: also packages that `./icesoc package` needs
# --tests: also packages for tests, reports and debuggers, and the packages of --packages
# --check: only lists missing packages (exit status 1 if a package is missing)

set -eu
tests='' packaging='' check=''
for word in "$@"; do
    case $word in
    --packages) packaging=1 ;;
    --tests) tests=1 packaging=1 ;;
    --check) check=1 ;;
    *) echo "setup: '$word' is not an option: --packages, --tests, --check" >&2 && exit 2 ;;
    esac
done

# list of lines "package: its purpose"
packages='
g++ C and C++ compiler
make drives Verilator models
cmake build description
ninja-build runs the build
ccache caches compiled files, which makes later builds faster
pkg-config finds libraries
zlib1g-dev compresses waveforms (FST)
verilator turns the Verilog into a C++ model
iverilog checks the Verilog in addition to Verilator
yosys synthesis, search for latches, proofs
z3 solver for the proofs
cadical solver for the induction steps of the proofs
libgtest-dev test framework
libgmock-dev test framework
nlohmann-json3-dev reports
libfmt-dev text formatting
libcli11-dev command lines
libsodium-dev signatures of firmware (Ed25519)
liblz4-dev decompresses firmware updates that arrive by radio
python3-lz4 compresses firmware updates
python3-jinja2 templates of register blocks, headers and pages
libssl-dev AES for the model of the modem
openssl makes certificates for the gateway and its clients
git lists changed files
libstb-dev reads and writes pictures
libmcpp-dev preprocessor for the Slice compiler
libzeroc-ice-dev ZeroC Ice for C++
zeroc-ice-compilers slice2cpp, for tests and the C++ client
zeroc-ice-slice Slice files of ZeroC Ice
python3-zeroc-ice ZeroC Ice for Python: the ground station
python3-jsonschema checks the manifests of cores
python3-pil draws the corners into the picture of a flight
xplanet-images default picture of the camera
gcc-arm-none-eabi compiles the firmware for the Cortex-M3
libunicorn-dev executes Cortex-M3 instructions in the simulator
libnewlib-arm-none-eabi C library of the firmware
clang compiles models of the RTL, and fuzzers (libFuzzer)
lld links programs; builds are faster with it
libclang-rt-dev run-time libraries of fuzzers and sanitizers
'
# additional packages for `./icesoc package`, which makes and checks Debian packages
deb='
dpkg-dev finds the dependencies of the Debian packages
file finds the programs in the Debian packages
lintian checks the Debian packages
'
# additional packages for tests, reports and debuggers
rest='
clang-format-19 checks the format of the sources
mypy checks the types of the tools in Python
libxml2-utils checks the generated SVD file and pages
lcov coverage pages
chromium opens the report pages in tests
libnss3-tools installs certificates in the browser of tests
zeroc-icebridge forwarder of ZeroC Ice, which a test compares with the gateway
zeroc-glacier2 router of ZeroC Ice, which a test connects to the gateway
tshark decodes network messages in tests
strace records which files a proof reads; its result is cached until one of them changes
python3-yaml reads the CI workflows in tests
ca-certificates verifies the servers of downloads: scripts of the pages, third-party cores
gdb-multiarch debugs the firmware in the simulator
qemu-system-arm runs the examples of docs/porting.md
python3-argcomplete completes the words of ./icesoc in bash and zsh
zsh shell in which the completion is tested
gtkwave shows waveforms, and converts waveforms of failures for the page
python3-sphinx renders the documentation site
python3-myst-parser reads its Markdown pages
furo theme of the documentation site
python3-breathe adds the C reference to the documentation site
doxygen reads C headers for the documentation site
man-db shows and checks the manual pages
groff-base formats the manual pages
'
[ -z "$packaging" ] || packages="$packages$deb"
[ -z "$tests" ] || packages="$packages$rest"
# The version in Debian 12 is too old; icesoc.util.fetch downloads the version of Debian 13.
case $(sed -n 's/^VERSION_ID="*\([0-9]*\).*/\1/p' /etc/os-release 2>/dev/null) in
1[3-9]) packages="$packages
ghdl-mcode simulates and converts VHDL" ;;
esac

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "setup: this is not Debian, so nothing can be installed automatically. Needed are the" >&2
    echo "equivalents of these Debian 12 packages:" >&2
    echo "$packages" | sed -n 's/^\([^ ][^ ]*\) \(.*\)/    \1 (\2)/p' >&2
    exit 1
fi

# dpkg-query fails for unknown packages. It reports a package as not-installed if only other
# packages mention it.
# shellcheck disable=SC2046 # a list of words
there=$(dpkg-query -W -f ';${db:Status-Status} ${Package};' \
    $(echo "$packages" | sed 's/ .*//') 2>/dev/null) || true
list=$(echo "$packages" | while read -r name why; do
    case "$name;$there" in
    ";"* | *";installed $name;"*) ;;
    *) echo "$name: $why" ;;
    esac
done)
[ -n "$list" ] || exit 0
echo "Missing packages:"
echo "$list" | sed 's/^/    /'
[ -z "$check" ] || exit 1

sudo='' missing=$(echo "$list" | sed 's/:.*//')
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null 2>&1 || {
        echo "setup: installing packages needs root, and sudo is not installed. As root, run:" >&2
        echo "    apt-get update && apt-get install" $missing >&2
        exit 1
    }
    sudo=sudo
    if [ -t 0 ]; then
        printf 'Install them with sudo apt-get? [Y/n] '
        read -r answer
        case $answer in [Nn]*) echo "setup: stopped; nothing was installed" >&2 && exit 1 ;; esac
    fi
fi
echo "Installing them with apt-get (2 to 10 minutes) ..."
$sudo apt-get update -qq ||
    echo "setup: apt-get update failed: is there a network, and a mirror in /etc/apt?" >&2
# Waits while another apt, such as unattended upgrades, is running.
# shellcheck disable=SC2086 # a list of words
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    -o DPkg::Lock::Timeout=600 \
    $missing >/dev/null || {
    echo "setup: apt-get could not install the packages above (see its messages);" \
        "fix that and run setup again." >&2
    exit 1
}
echo "Installed."
