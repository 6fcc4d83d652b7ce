#!/bin/sh
# SPDX-License-Identifier: MIT
#
# service: uses the gateway's service on a machine that machine.sh has prepared. Python, C++,
# icesoc-call and the gateway's page call a simulated vehicle through the service, with a key. Then
# the modem disappears and returns while the service runs. Then the script tries to install single
# packages of another version, which apt must refuse, and upgrades all packages, which must keep
# keys, permissions and settings and restart the service. Finally it removes and purges the
# packages. Run as root, with systemd running (boot.sh). Usage:
# service.sh [FOLDER]    FOLDER as for machine.sh
set -eu
here=$(cd "${1:-.}" && pwd)
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
step() { echo "== $*"; }
fail() {
    touch ended
    echo "service: $*" >&2
    exit 1
}
[ -d /run/systemd/system ] || fail "systemd is not running: use boot.sh"
cd /home/tester

step "the name of the modem"
rule=/lib/udev/rules.d/70-icesoc-modem.rules
if udevadm verify --help >/dev/null 2>&1; then
    udevadm verify $rule
fi
mkdir -p /run/udev/rules.d
echo 'SUBSYSTEM=="tty", KERNEL=="tty", ENV{ID_BUS}="usb", ENV{ID_VENDOR_ID}="0403", \
ENV{ID_MODEL_ID}="6001", ENV{ID_SERIAL_SHORT}="A1B2"' >/run/udev/rules.d/69-adapter.rules
udevadm test /sys/class/tty/tty 2>&1 | tee udev.log | grep -q "icesoc-modem-A1B2" ||
    { cat udev.log && fail "the rule makes no name"; }

step "the service does not start without a key"
options="-d /run/icesoc-modem -g 20 -l 127.0.0.1:11093 --page 127.0.0.1:11094"
echo "ICESOC_OPTIONS=\"$options\"" >/etc/icesoc/uav1.conf
chmod 640 /etc/icesoc/uav1.conf
systemd-analyze verify --man=no icesoc-gateway@uav1.service
! systemctl enable --now icesoc-gateway@uav1 >log 2>&1 || fail "no error without a key"
grep "Assertion failed" log
! systemctl is-active -q icesoc-gateway@uav1 || fail "the service runs without a key"

step "Python, C++, icesoc-call and a page, by the service"
umask 077
od -An -tx1 -N16 /dev/urandom | tr -d ' ' >/etc/icesoc/uav1.key
umask 022
chown icesoc: /etc/icesoc/uav1.key
echo "Vehicle.uav1=tcp -h 127.0.0.1 -p 11093" >/etc/icesoc/vehicles.conf
cat >by_service <<'END'
#!/bin/bash
set -e
systemctl start icesoc-gateway@uav1
until true 2>/dev/null >/dev/tcp/127.0.0.1/11093; do
    systemctl is-active -q icesoc-gateway@uav1
    sleep 0.1
done
python3 "$1/call.py" uav1
./ping "hwengine1:tcp -h 127.0.0.1 -p 11093" 1
echo "icesoc-call: $(icesoc-call uav.isAlive 7)"
python3 "$1/page.py" 127.0.0.1:11094
systemctl show -P User -P DynamicUser -P NoNewPrivileges -P ProtectSystem icesoc-gateway@uav1
END
rm -rf ended service
simulate="icesoc-sim --image /usr/share/xplanet/images/earth.jpg --size 96x64 --guard 20"
simulate="$simulate --speed real"
chmod a+x /home/tester # in Debian 13, only the user can enter the user's home folder
# Starts a simulated vehicle and plugs its modem in. The simulator runs as the gateway's user,
# because the simulated modem belongs to the user who runs the simulator.
plug_in() {
    rm -rf ended service
    install -d -o icesoc service
    runuser -u icesoc -- $simulate --key /etc/icesoc/uav1.key --out service -- \
        sh -c 'echo "$0" >service/device; until [ -e ended ]; do sleep 0.1; done' '{device}' \
        >simulator.log 2>&1 &
    simulator=$!
    until [ -e service/device ]; do
        kill -0 $simulator
        sleep 0.1
    done
    ln -sf "$(cat service/device)" /run/icesoc-modem
}
# Fails with the logs of all programs.
no_answer() {
    cat log simulator.log
    journalctl --no-pager -u icesoc-gateway@uav1 | tail -20
    fail "$*"
}
plug_in
bash by_service "$here" >log 2>&1 || no_answer "no answer by the service"
grep "^corners: 1" log
grep "type: ::Autopilot" log
grep "^icesoc-call: true" log
grep "^isAlive: True" log
grep "^strict" log

step "the modem is unplugged, and plugged in again"
pid=$(systemctl show -P MainPID icesoc-gateway@uav1)
rm /run/icesoc-modem
touch ended
wait $simulator || true
! icesoc-call uav.isAlive 7 >log 2>&1 || fail "a call without a modem succeeds"
grep "cannot reach the vehicle: " log || no_answer "a call without a modem fails without a reason"
plug_in
icesoc-call uav.isAlive 7 >log 2>&1 || no_answer "no answer after the modem has returned"
[ "$pid" = "$(systemctl show -P MainPID icesoc-gateway@uav1)" ] || fail "the service was restarted"
journalctl --no-pager -o cat -u icesoc-gateway@uav1 >log
grep "has disappeared" log && grep "is in use again" log || no_answer "the log does not name it"

step "packages of two versions are refused"
version() { dpkg-query -W -f '${Version}' "$1"; }
old=$(version icesoc-ground)
new=$(echo "$old" | sed 's/-/.99-/')
rm -rf newer && mkdir newer
for deb in "$here"/*.deb; do
    dpkg-deb -R "$deb" tree
    sed -i "s/$old/$new/g" tree/DEBIAN/control
    dpkg-deb -b tree newer >/dev/null
    rm -r tree
done
for package in icesoc-ground icesoc-sim icesoc-slice2c libicec-dev; do
    ! apt-get install -y -qq --no-remove ./newer/${package}_*.deb >log 2>&1 ||
        fail "apt installs another version of $package alone"
    [ "$(version $package)" = "$old" ] || fail "$package has another version: $(version $package)"
done

step "upgrade keeps keys, rights and settings, and restarts the service"
state() { stat -c '%n %U:%G %a %Y' /etc/icesoc /etc/icesoc/*; sha256sum /etc/icesoc/*; }
chmod 710 /etc/icesoc # a change by the administrator, which an upgrade must keep
before=$(state) user=$(id icesoc)
pid=$(systemctl show -P MainPID icesoc-gateway@uav1)
apt-get install -y -qq --no-install-recommends ./newer/*.deb >/dev/null
[ "$(version icesoc-ground)" = "$new" ] || fail "$new was not installed"
[ "$before" = "$(state)" ] || fail "the upgrade changed /etc/icesoc: $(state)"
[ "$user" = "$(id icesoc)" ] || fail "the upgrade changed the user icesoc"
after=$(systemctl show -P MainPID icesoc-gateway@uav1)
[ "$after" != 0 ] && [ "$after" != "$pid" ] || fail "the service was not restarted: $pid, $after"
echo "$old to $new; $(id icesoc)"
touch ended

step "remove stops the service and keeps keys and settings, purge keeps keys"
apt-get remove -y -qq icesoc-ground icesoc-sim icesoc-slice2c libicec-dev icesoc-hdl >/dev/null
! systemctl is-active -q icesoc-gateway@uav1 || fail "the service still runs"
[ -s /etc/icesoc/uav1.key ] && [ -s /etc/icesoc/uav1.conf ] || fail "remove took keys or settings"
[ -L /etc/systemd/system/multi-user.target.wants/icesoc-gateway@uav1.service ] ||
    fail "remove disabled the service"
apt-get purge -y -qq icesoc-ground >/dev/null # the other packages have no files left to purge
[ "$(stat -c '%U %a' /etc/icesoc/uav1.key)" = "icesoc 600" ] || fail "purge took a key"
[ "$(ls /etc/icesoc)" = uav1.key ] || fail "purge left settings: $(ls /etc/icesoc)"
left=$(find /usr /lib /etc/systemd -path '*icesoc-g*' -o -path '*/icesoc/*' -o -name '*xbeeat*' \
    -o -path '*/icec/*' -o -name 'libicec*')
[ -z "$left" ] || fail "files are left: $left"
[ -z "$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' 'icesoc-*' libicec-dev 2>/dev/null |
    grep -v '^un')" ] || fail "dpkg still knows a package"
echo "service: all steps passed"
