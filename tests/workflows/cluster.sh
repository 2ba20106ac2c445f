# SPDX-License-Identifier: MIT
# Slurm of one machine, for tests that are sourced with it: start_cluster, start_node, kill_node, stop_cluster.
# Munge, controller and node are those of Debian, with sockets, ports and folders of their own.

# Ends the test as skipped when this machine can't run the given programs as root.
need() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
  done
}

need_root() { ((EUID == 0)) || { echo 'skipped: Slurm can be started by root only'; exit 77; }; }

# Waits until a command succeeds: within SECONDS COMMAND ...
within() {
  local left=$(($1 * 10))
  shift
  until "$@" >/dev/null 2>&1; do
    ((left-- > 0)) || { echo "gave up waiting for: $*" >&2; return 1; }
    sleep 0.1
  done
}

write_slurm_conf() {
  local host cpus
  host=$(hostname)
  cpus=$(($(nproc) < 2 ? 1 : 2))
  local -a port
  mapfile -t port < <(python3 -c '
import socket
sockets = [socket.socket() for _ in range(2)]
for s in sockets:
    s.bind(("", 0))
print(*(s.getsockname()[1] for s in sockets), sep="\n")')
  cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=5
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/controller.pid
SlurmdPidFile=$cluster/node.pid
SlurmctldLogFile=$cluster/controller.log
SlurmdLogFile=$cluster/node.log
SlurmctldPort=${port[0]}
SlurmdPort=${port[1]}
ReturnToService=2
SlurmdTimeout=20
KillWait=2
MinJobAge=600
SchedulerParameters=sched_interval=2,sched_min_interval=0,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=500 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
}

# The pid that a daemon wrote, when that process is there.
pid_of() { [[ -s $1 ]] && kill -0 "$(<"$1")" 2>/dev/null && cat "$1"; }

# Daemons keep no descriptor of the test: ctest waits for whoever holds its pipe.
start_node() {
  slurmd -f "$SLURM_CONF" </dev/null >"$cluster/slurmd.out" 2>&1
  within 60 sh -c 'sinfo -h -o %t | grep -qE "^(idle|mix|alloc)$"'
}

# As when the machine is lost: without a word to anyone.
kill_node() {
  kill -KILL "$(<"$cluster/node.pid")"
  rm "$cluster/node.pid"
}

start_cluster() {
  trap 'exit 143' TERM INT HUP  # so that a test that is ended stops its daemons, too
  cluster=$(mktemp -d /tmp/papilla-cluster.XXXXXX)
  chmod 755 "$cluster"
  mkdir "$cluster/state" "$cluster/spool"
  export SLURM_CONF=$cluster/slurm.conf
  write_slurm_conf
  (umask 077 && head -c 1024 /dev/urandom >"$cluster/munge.key")
  munged --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" --pid-file="$cluster/munge.pid" \
    --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed" </dev/null >"$cluster/munged.out" 2>&1
  within 20 test -S "$cluster/munge.socket"
  slurmctld -f "$SLURM_CONF" </dev/null >"$cluster/slurmctld.out" 2>&1
  within 30 scontrol ping
  start_node
}

stop_cluster() {
  [[ -n ${cluster-} ]] || return 0
  local daemon pid
  # Jobs first: their processes would outlive the node's daemon.
  if pid_of "$cluster/controller.pid" >/dev/null; then
    scancel --user="$(id -un)" >/dev/null 2>&1 || true
    within 20 sh -c 'test -z "$(squeue -h)"' || true
  fi
  for daemon in node controller munge; do
    pid=$(pid_of "$cluster/$daemon.pid") || continue
    kill "$pid"
    within 20 sh -c "! kill -0 $pid" || kill -KILL "$pid"
  done
  rm -rf "$cluster"
}
