#!/bin/sh
# SPDX-License-Identifier: MIT
#
# slurm_cluster: a Slurm cluster of two nodes with a processor each, on loopback, for as long as a command runs.
# Usage: slurm_cluster.sh folder command...     (the folder is made anew; daemons end with the command)
set -eu
folder=$1
shift
rm -rf "$folder"
mkdir -p "$folder/state" "$folder/spool.one" "$folder/spool.two"
folder=$(cd "$folder" && pwd)
chmod 755 "$folder"
user=$(id -un)
host=$(uname -n | cut -d. -f1) # hostname -s would look it up, and not every machine knows itself
# any three free ports above 20000
port=$((20000 + $$ % 20000))
dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 2>/dev/null
chmod 400 "$folder/munge.key"
cat >"$folder/slurm.conf" <<END
ClusterName=icesoc
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CryptoType=crypto/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
SlurmdTimeout=10
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
MaxArraySize=10001
SchedulerParameters=sched_interval=1,sched_min_interval=1,batch_sched_delay=0
NodeName=one NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1 State=UNKNOWN
NodeName=two NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1 State=UNKNOWN
PartitionName=test Nodes=one,two Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
finish() {
    scontrol shutdown >/dev/null 2>&1 || true
    for name in slurmd.one slurmd.two slurmctld munged; do
        [ ! -f "$folder/$name.pid" ] || kill "$(cat "$folder/$name.pid")" 2>/dev/null || true
    done
}
trap finish EXIT
trap 'exit 130' INT TERM
/usr/sbin/munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"
/usr/sbin/slurmctld -i 2>>"$folder/slurmctld.log"
for node in one two; do /usr/sbin/slurmd -N $node 2>>"$folder/slurmd.$node.log"; done
tries=0
until [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" = 2 ]; do
    tries=$((tries + 1))
    if [ "$tries" -ge 120 ] || grep -q 'initialization failed' "$folder"/*.log; then
        echo "slurm_cluster: the nodes do not come up" >&2
        tail -n 5 "$folder"/*.log >&2
        exit 1
    fi
    sleep 0.5
done
status=0
"$@" || status=$?
exit "$status"
