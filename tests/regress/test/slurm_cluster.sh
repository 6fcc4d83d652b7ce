#!/bin/sh
# SPDX-License-Identifier: MIT
#
# slurm_cluster: a Slurm cluster of this one machine, on loopback, for as long as a command runs.
# Usage: slurm_cluster.sh folder command...     (the folder is made anew; daemons end with the command)
set -eu
folder=$1
shift
rm -rf "$folder"
mkdir -p "$folder/state" "$folder/spool"
folder=$(cd "$folder" && pwd)
chmod 755 "$folder"
user=$(id -un)
host=$(uname -n | cut -d. -f1) # hostname -s would look it up, and not every machine knows itself
# any two free ports above 20000
port=$((20000 + $$ % 20000))
dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 2>/dev/null
chmod 400 "$folder/munge.key"
cat >"$folder/slurm.conf" <<END
ClusterName=icesoc
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CryptoType=crypto/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
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
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
finish() {
    scontrol shutdown >/dev/null 2>&1 || true
    for name in slurmd slurmctld munged; do
        [ ! -f "$folder/$name.pid" ] || kill "$(cat "$folder/$name.pid")" 2>/dev/null || true
    done
}
trap finish EXIT
trap 'exit 130' INT TERM
/usr/sbin/munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/munge.seed"
/usr/sbin/slurmctld -i 2>>"$folder/slurmctld.log"
/usr/sbin/slurmd -N "$host" 2>>"$folder/slurmd.log"
tries=0
until sinfo -h -t idle -o %n 2>/dev/null | grep -q .; do
    tries=$((tries + 1))
    if [ "$tries" -ge 120 ] || grep -q 'initialization failed' "$folder"/slurmd.log "$folder"/slurmctld.log; then
        echo "slurm_cluster: the node does not come up" >&2
        tail -n 5 "$folder"/*.log >&2
        exit 1
    fi
    sleep 0.5
done
status=0
"$@" || status=$?
exit "$status"
