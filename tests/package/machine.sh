#!/bin/sh
# SPDX-License-Identifier: MIT
#
# machine: installs the packages on an empty Debian by apt, and uses them as a user does: mission,
# programs with stock ZeroC Ice in Python and C++, by plugin and by gateway, a C project by CMake,
# simulation of a block; then removes and purges them. Run as root, on a machine for this test.
# Usage: machine.sh [FOLDER]    with *.deb, and the files of tests/package; default: this one
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
apt-get update -qq
apt-get install -y -qq --reinstall --no-install-recommends xplanet-images "$here"/*.deb >/dev/null
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

step "Python and C++, by the gateway, with a key, as the service runs it"
umask 077
od -An -tx1 -N16 /dev/urandom | tr -d ' ' >/etc/icesoc/uav1.key
umask 022
chown icesoc: /etc/icesoc/uav1.key
echo 'ICESOC_OPTIONS="-d /run/icesoc/modem -g 20 -l 127.0.0.1:10000"' >/etc/icesoc/uav1.conf
install -d -o icesoc /run/icesoc
apt-get install -y -qq --no-install-recommends g++ libzeroc-ice-dev cmake ninja-build pkg-config \
    iverilog verilator make systemd >/dev/null
systemd-analyze verify --man=no /lib/systemd/system/icesoc-gateway@.service
g++ -DICE_CPP11_MAPPING -o ping /usr/share/doc/icesoc-ground/examples/ping.cpp -lIce++11 -pthread
echo "Vehicle.uav1=tcp -h 127.0.0.1 -p 10000" >gateway.conf
cat >by_gateway <<'END'
#!/bin/bash
set -e
ln -sf "$1" /run/icesoc/modem
. /etc/icesoc/uav1.conf
icesoc-gateway --key /etc/icesoc/uav1.key $ICESOC_OPTIONS &
trap 'kill $!' EXIT
until true 2>/dev/null >/dev/tcp/127.0.0.1/10000; do sleep 0.1; done
ICESOC_VEHICLES=gateway.conf python3 "$2/call.py" uav1
./ping "hwengine1:tcp -h 127.0.0.1 -p 10000" 1
END
chmod +x by_gateway
runuser -u icesoc -- $simulate --key /etc/icesoc/uav1.key --out /run/icesoc/flight -- \
    ./by_gateway '{device}' "$here" >log || { cat log && fail "no answer by the gateway"; }
grep "^corners: 1" log
grep "it is a ::Autopilot" log

step "C++, by the plugin"
user $simulate --out ping.out -- ./ping 'hwengine1:xbee-at -d {device} -a 1 -g 20' 1 >log ||
    { cat log && fail "no answer by the plugin"; }
grep "it is a ::Autopilot" log

step "a project by CMake, called by stock ZeroC Ice"
user cmake -S "$here/project/server" -B build -G Ninja >/dev/null
user ninja -C build >/dev/null
user ./build/server 10001 >/dev/null &
sleep 1
user python3 -c "
import Ice
Ice.loadSlice('$here/project/server/Thing.ice')
import M
with Ice.initialize() as ic:
    thing = M.ThingPrx.checkedCast(ic.stringToProxy('thing:tcp -h 127.0.0.1 -p 10001'))
    print('sum', thing.add(3, 4))
" | grep "sum 7"
kill $!

step "the bridge, in Icarus Verilog and in Verilator"
export ICESOC_HDL=/usr/share/icesoc/hdl
iverilog -g2005 -s fsmc_bridge_tb -o bridge.vvp -f $ICESOC_HDL/fsmc_bridge.f \
    "$here/fsmc_bridge_tb.v"
vvp -n bridge.vvp | grep PASS
verilator --binary --timing -Wno-fatal -Wno-TIMESCALEMOD --Mdir verilated \
    --top-module fsmc_bridge_tb -f $ICESOC_HDL/fsmc_bridge.f "$here/fsmc_bridge_tb.v" >/dev/null
verilated/Vfsmc_bridge_tb | grep PASS

step "remove keeps keys and settings, purge keeps keys"
apt-get remove -y -qq icesoc-ground icesoc-sim icesoc-slice2c libicec-dev icesoc-hdl >/dev/null
[ -s /etc/icesoc/uav1.key ] && [ -s /etc/icesoc/uav1.conf ] || fail "remove took keys or settings"
apt-get purge -y -qq icesoc-ground >/dev/null # the others have nothing left to purge
[ "$(stat -c '%U %a' /etc/icesoc/uav1.key)" = "icesoc 600" ] || fail "purge took a key"
[ ! -e /etc/icesoc/uav1.conf ] || fail "purge left settings"
left=$(find /usr /lib -path '*icesoc*' -o -name '*xbeeat*' -o -path '*/icec/*' -o -name 'libicec*')
[ -z "$left" ] || fail "files are left: $left"
echo "machine: all steps passed"
