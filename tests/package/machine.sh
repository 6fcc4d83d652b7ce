#!/bin/sh
# SPDX-License-Identifier: MIT
#
# machine: installs the packages on an empty Debian with apt, and uses them like a user: a mission,
# programs with stock ZeroC Ice in Python and C++ that use the plugin, icesoc-call, a C project with
# CMake, IceC as single files, and the simulation of a block. Run service.sh after this script. Run
# as root, on a machine that is used only for this test.
# Usage: machine.sh [FOLDER]    FOLDER contains *.deb, icec-*.tar.gz and the files of tests/package;
# default: the folder of this script
set -eu
here=$(cd "${1:-.}" && pwd)
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
step() { echo "== $*"; }
fail() {
    echo "machine: $*" >&2
    exit 1
}
user() { runuser -u tester -- env HOME=/home/tester "$@"; }

step "install"
# Removes packages, keys and permissions that an earlier, stopped run may have left.
apt-get purge -y -qq 'icesoc-*' libicec-dev >/dev/null 2>&1 || true
rm -rf /etc/icesoc
apt-get update -qq
apt-get install -y -qq --no-install-recommends systemd-sysv udev dbus xplanet-images >/dev/null
apt-get install -y -qq --reinstall --no-install-recommends "$here"/*.deb >/dev/null
dpkg-query -W -f '${Package} ${Version} ${Installed-Size} KiB\n' 'icesoc-*' libicec-dev
[ "$(stat -c '%U:%G %a' /etc/icesoc)" = "root:icesoc 750" ] ||
    fail "/etc/icesoc: wrong owner or mode"
id -u tester >/dev/null 2>&1 || useradd --create-home tester
cd /home/tester

step "mission, by the host build and by the ARM binary"
for cpu in host m3; do
    user icesoc-fly --size 96x64 --guard 20 --cpu $cpu --out $cpu >log 2>&1 ||
        { cat log && fail "the mission failed"; }
    grep "the result equals the C++ reference" log
done

step "Python, by the plugin"
echo "Vehicle.uav1=xbee-at -d /home/tester/modem -a 0x0001
XBeeAT.Guard=20" >vehicles.conf
cat >by_plugin <<'END'
#!/bin/sh
ln -sf "$1" modem
ICESOC_VEHICLES=vehicles.conf python3 "$2/call.py" uav1
END
chmod +x by_plugin
simulate="icesoc-sim --image /usr/share/xplanet/images/earth.jpg --size 96x64 --guard 20"
user $simulate --out plugin -- ./by_plugin '{device}' "$here" | grep "^corners: 1"

step "icesoc-call, by the plugin"
echo 'ln -sf "$1" modem; ICESOC_VEHICLES=vehicles.conf icesoc-call uav.isAlive 7' >call
user $simulate --out call.out -- sh call '{device}' | grep "^true"

step "C++, by the plugin"
apt-get install -y -qq --no-install-recommends g++ libzeroc-ice-dev cmake ninja-build pkg-config \
    iverilog verilator make gcc clang gcc-arm-none-eabi libnewlib-arm-none-eabi >/dev/null
g++ -DICE_CPP11_MAPPING -o ping /usr/share/doc/icesoc-ground/examples/ping.cpp -lIce++11 -pthread
user $simulate --out ping.out -- ./ping 'hwengine1:xbee-at -d {device} -a 1 -g 20' 1 >log ||
    { cat log && fail "no answer by the plugin"; }
grep "type: ::Autopilot" log

step "a project by CMake, called by stock ZeroC Ice"
user cmake -S "$here/project/server" -B build -G Ninja >/dev/null
user ninja -C build >/dev/null
# answers PROGRAM PORT: starts a server, and calls it by stock ZeroC Ice.
answers() {
    rm -f server.log
    user "$1" "$2" >server.log &
    server=$!
    until grep -q ready server.log; do
        kill -0 $server || fail "$1 does not start"
        sleep 0.1
    done
    user python3 -c "
import Ice
Ice.loadSlice('$here/project/server/Thing.ice')
import M
with Ice.initialize() as ic:
    thing = M.ThingPrx.checkedCast(ic.stringToProxy('thing:tcp -h 127.0.0.1 -p $2'))
    print('sum', thing.add(3, 4))
" | grep "sum 7"
    kill $server
}
answers ./build/server 10001

step "IceC as single files, compiled by three compilers, called by stock ZeroC Ice"
rm -rf icec-* made
user tar -xzf "$here"/icec-*.tar.gz
source=$(echo icec-*/src)
strict="-std=c90 -pedantic -Wall -Wextra -Wconversion -Werror"
for compiler in gcc clang "arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb"; do
    for file in "$source"/*.c; do
        case $compiler,$file in arm*,*/icec_tcp.c) continue ;; esac # for POSIX systems
        for level in -O0 -Os -O2; do
            user $compiler $strict $level -c "$file" -o object.o
        done
    done
    $compiler --version | head -n 1
done
user slice2c "$here/project/server/Thing.ice" --output-dir made
sed 's/tcp_endpoint.h/icec_tcp.h/' "$here/project/server/server.c" >single.c
user gcc $strict -ffunction-sections -fdata-sections -I"$source" -Imade single.c \
    made/Thing_types.c made/Thing_server.c "$source/icec.c" "$source/icec_tcp.c" \
    -Wl,--gc-sections -pthread -o single
answers ./single 10002

step "the bridge, in Icarus Verilog and in Verilator"
export ICESOC_HDL=/usr/share/icesoc/hdl
iverilog -g2005 -s fsmc_bridge_tb -o bridge.vvp -f $ICESOC_HDL/fsmc_bridge.f \
    "$here/fsmc_bridge_tb.v"
vvp -n bridge.vvp | grep PASS
verilator --binary --timing -Wno-fatal -Wno-TIMESCALEMOD --Mdir verilated \
    --top-module fsmc_bridge_tb -f $ICESOC_HDL/fsmc_bridge.f "$here/fsmc_bridge_tb.v" >/dev/null
verilated/Vfsmc_bridge_tb | grep PASS

echo "machine: all steps passed"
