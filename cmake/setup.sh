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
ccache makes a second build quick
pkg-config finds libraries
zlib1g-dev waveforms (FST)
verilator turns the Verilog into a C++ model
iverilog second opinion in lint
yosys synthesis, latch check, proofs
z3 solver of the proofs
cadical solver of their induction steps
libgtest-dev test framework
libgmock-dev test framework
nlohmann-json3-dev reports
libfmt-dev text formatting
libcli11-dev command lines
libsodium-dev signatures of firmware (Ed25519)
liblz4-dev unpacks firmware that comes by radio
python3-lz4 packs it
python3-jinja2 templates of register blocks, headers and pages
libssl-dev AES of the modem model
openssl certificates of the gateway and its clients
git finds what changed
libstb-dev reads and writes pictures
libmcpp-dev preprocessor of the Slice compiler
libzeroc-ice-dev ZeroC Ice for C++
zeroc-ice-compilers slice2cpp, for tests and the C++ client
zeroc-ice-slice Slice files of ZeroC Ice
python3-zeroc-ice ZeroC Ice for Python: the ground station
python3-jsonschema checks the manifests of cores
python3-pil draws the features over the picture
xplanet-images the default picture
gcc-arm-none-eabi the firmware for the Cortex-M3
libunicorn-dev executes its instructions in the simulator
libnewlib-arm-none-eabi C library for it
clang fuzzers of the link layer (libFuzzer)
libclang-rt-dev their run time, which clang only recommends
'
# additional packages for `./icesoc package`, which makes and checks Debian packages
deb='
dpkg-dev finds the dependencies of the Debian packages
file finds the programs in them
lintian checks them
'
# additional packages for tests, reports and debuggers
rest='
clang-format-19 holds the source to .clang-format
mypy checks the types of the tools in Python
libxml2-utils checks the generated SVD file and pages
lcov coverage pages
chromium opens the report pages in tests
libnss3-tools gives it certificates
zeroc-icebridge a forwarder; a test compares the gateway with it
zeroc-glacier2 a router, in front of the gateway in a test
tshark reads the messages on the wire in tests
strace sees which files a proof reads, so that its verdict holds until one changes
python3-yaml reads the workflows in tests
ca-certificates checks whom what pages sort and draw with, and foreign cores, are fetched from
gdb-multiarch debugs it there
qemu-system-arm runs the examples of porting
gtkwave shows waveforms, and converts waveforms of failures for the page
python3-sphinx renders the documentation site
python3-myst-parser reads its Markdown pages
furo style of the documentation site
python3-breathe C reference of the documentation site
doxygen reads the C headers for it
man-db shows and checks the manual pages
groff-base formats them
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
        echo "setup: not root, and sudo is not there. As root, run:" >&2
        echo "    apt-get update && apt-get install" $missing >&2
        exit 1
    }
    sudo=sudo
    if [ -t 0 ]; then
        printf 'Install them with sudo apt-get? [Y/n] '
        read -r answer
        case $answer in [Nn]*) echo "setup: nothing is installed" >&2 && exit 1 ;; esac
    fi
fi
echo "Installing them with apt-get (a minute or two) ..."
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
