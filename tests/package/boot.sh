#!/bin/sh
# SPDX-License-Identifier: MIT
#
# boot: boots systemd in a folder that contains a Debian system, in separate namespaces, and runs a
# shell command there as root. Prints the output of the command and returns its exit status. The
# booted system uses this machine's network. It cannot change settings of the kernel. Needs root and
# cgroup2. Usage: boot.sh ROOT FOLDER COMMAND
set -eu
if [ "$1" != --inside ]; then
    exec unshare --mount sh "$0" --inside "$@"
fi
root=$(cd "$2" && pwd) folder=$3 command=$4
mount --make-rprivate /
# systemd needs a separate group below the root of cgroup2.
groups=$(mktemp -d)
mount -t cgroup2 cgroup2 "$groups"
group=$groups/icesoc-machine-$$
mkdir "$group"
echo "$command" >"$root/run.sh"
rm -f "$root/run.status" "$root/run.log"

cat >"$root/etc/systemd/system/icesoc-run.service" <<END
[Unit]
After=multi-user.target
SuccessAction=exit-force
FailureAction=exit-force
[Service]
Type=oneshot
WorkingDirectory=$folder
ExecStart=/bin/sh -c 'sh /run.sh >/run.log 2>&1; echo \$\$? >/run.status'
END
mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
ln -sf ../icesoc-run.service "$root/etc/systemd/system/multi-user.target.wants/"

cat >"$root/boot.sh" <<'END'
set -e
root=$1
mount --bind "$root" "$root"
cd "$root"
mount -t proc proc proc
mount --bind proc/sys proc/sys
mount -o remount,bind,ro proc/sys
mount -t sysfs -o ro sysfs sys
mount -t cgroup2 cgroup2 sys/fs/cgroup
for folder in run tmp dev; do mount -t tmpfs -o mode=755 tmpfs $folder; done
chmod 1777 tmp
mkdir dev/pts dev/shm
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts dev/pts
ln -s pts/ptmx dev/ptmx
ln -s /proc/self/fd dev/fd
for name in null zero full random urandom tty; do
    touch dev/$name
    mount --bind /dev/$name dev/$name
done
pivot_root . mnt
umount -l mnt
exec env -i container=icesoc PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd --system \
    --log-target=console
END
status=0
sh -c 'echo $$ >"$0/cgroup.procs"
exec unshare --cgroup --pid --mount --uts --ipc --fork --kill-child sh "$1/boot.sh" "$1"' \
    "$group" "$root" </dev/null >"$root/boot.log" 2>&1 || status=$?
find "$group" -depth -type d -exec rmdir {} +
umount "$groups"
rmdir "$groups"
cat "$root/run.log" || {
    cat "$root/boot.log"
    echo "boot: systemd ended with exit status $status before the command" >&2
    exit 1
}
exit "$(cat "$root/run.status")"
