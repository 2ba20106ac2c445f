# SPDX-License-Identifier: MIT
# Slurm of one machine, for tests that are sourced with it: start_cluster, start_node, lose_node, stop_cluster.
# Munge, controller and node are Debian's, run by whoever runs the test, with a socket, ports and folders of their own.
# The test has sourced tidy.sh.

readonly -a cluster_programs=(munged slurmctld slurmd sbatch)

# Prints ports that nobody listens on, below those that the kernel gives to clients: free_ports HOW_MANY
free_ports() {
  python3 -c '
import random, socket, sys
found = []
while len(found) < int(sys.argv[1]):
    with socket.socket() as trial:
        port = random.randrange(10240, 32768)
        try:
            trial.bind(("", port))
        except OSError:
            continue
        found.append(port)
print(*found)' "$1"
}

write_slurm_conf() {
  local host user controller_port node_port
  host=$(hostname -s)
  user=$(id -un)
  read -r controller_port node_port < <(free_ports 2)
  # Two processors, whatever the machine has (config_overrides): so many jobs run at a time.
  cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
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
SlurmctldPort=$controller_port
SlurmdPort=$node_port
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=20
BatchStartTimeout=1
MessageTimeout=60
KillWait=2
MinJobAge=3600
SchedulerParameters=sched_interval=2,sched_min_interval=0,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=500 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
  # None is used, but a container may have none for Slurm 22.05 to look at, which then refuses to start.
  echo CgroupPlugin=cgroup/v1 >"$cluster/cgroup.conf"
}

node_is_up() { sinfo -h -o %t | grep -qE '^(idle|mix|alloc)$'; }

# Daemons keep no descriptor of the test: ctest waits for whoever holds its pipe.
start_node() {
  slurmd -f "$SLURM_CONF" </dev/null >"$cluster/slurmd.out" 2>&1
  within 120 node_is_up
}

# As when the machine is lost, without a word to anyone: its daemon, and from the top down what Slurm's keeper of the step
# runs there, of which one process is given: lose_node PID
lose_node() {
  local pid=$1
  local -a gone=("$pid")
  kill -KILL "$(<"$cluster/node.pid")"
  rm "$cluster/node.pid"
  until [[ $(<"/proc/$pid/comm") == slurmstepd ]]; do
    pid=$(parent_of "$pid")
    ((pid > 1)) || fail "process $1 does not run below slurmstepd"
    gone=("$pid" "${gone[@]}")
  done
  kill -KILL "${gone[@]}"
}

start_cluster() {
  cluster=$(mktemp -d /tmp/papilla-cluster.XXXXXX)
  tidy_also stop_cluster cluster
  chmod 755 "$cluster"
  mkdir "$cluster/state" "$cluster/spool"
  export SLURM_CONF=$cluster/slurm.conf
  write_slurm_conf
  (umask 077 && head -c 1024 /dev/urandom >"$cluster/munge.key")
  munged --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" --pid-file="$cluster/munge.pid" \
    --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed" </dev/null >"$cluster/munged.out" 2>&1
  within 60 test -S "$cluster/munge.socket"
  slurmctld -f "$SLURM_CONF" </dev/null >"$cluster/slurmctld.out" 2>&1
  within 120 scontrol ping
  start_node
}

# Whatever state it is in; done again it does nothing.
stop_cluster() {
  [[ -n ${cluster-} && -d $cluster ]] || return 0
  export SLURM_CONF=$cluster/slurm.conf
  local daemon pid
  # Jobs first: their processes would outlive the node's daemon.
  if is_alive "$cluster/controller.pid"; then
    scancel --user="$(id -un)" >/dev/null 2>&1
    within 20 sh -c 'test -z "$(squeue -h)"' 2>/dev/null
  fi
  for daemon in node controller munge; do
    is_alive "$cluster/$daemon.pid" || continue
    pid=$(<"$cluster/$daemon.pid")
    kill "$pid" 2>/dev/null
    within 20 sh -c "! kill -0 $pid" 2>/dev/null || kill -KILL "$pid" 2>/dev/null
  done
  end_those_with "SLURM_CONF=$SLURM_CONF"
  rm -rf "$cluster"
}
