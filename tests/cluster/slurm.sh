# A Slurm cluster on this machine, of Debian's packages: munge, slurmctld and one slurmd a node, all
# below one folder. Sourced; needs root. Nothing outside the folder is touched.

slurm_packages=(slurmctld slurmd slurm-client munge)

# start_cluster FOLDER NODES: exports SLURM_CONF, so that sbatch, squeue and the rest find it.
start_cluster() {
  local folder=$1 nodes=$2 host node
  host=$(hostname -s)
  mkdir -p "$folder"/{state,spool,log,munge}
  chmod 711 "$folder" "$folder/munge"
  dd if=/dev/urandom of="$folder/munge/key" bs=32 count=32 status=none
  chmod 600 "$folder/munge/key"
  munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
    --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" --log-file="$folder/log/munged.log"
  cat >"$folder/slurm.conf" <<END
ClusterName=glint
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17000
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=2,bf_interval=5
SlurmdParameters=config_overrides
SlurmdTimeout=10
ReturnToService=2
KillWait=5
MessageTimeout=30
NodeName=node[1-$nodes] NodeHostname=$host NodeAddr=127.0.0.1 Port=[17001-$((17000 + nodes))] CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$folder/slurm.conf
  slurmctld
  for node in $(seq "$nodes"); do start_node "$folder" "node$node"; done
  for _ in $(seq 60); do
    [ "$(sinfo --noheader --Node --states=idle --format=%N | sort -u | wc -l)" -eq "$nodes" ] && return
    sleep 1
  done
  sinfo --Node >&2
  tail -n 5 "$folder"/log/*.log >&2
  return 1
}

start_node() {
  mkdir -p "$1/spool/$2"
  slurmd -N "$2"
}

# A node that loses its power: its daemon and every job on it, at once.
kill_node() {
  local pid children
  pid=$(cat "$1/$2.pid")
  children=$(pgrep -f "slurmstepd.*" | while read -r step; do
    tr '\0' '\n' <"/proc/$step/environ" 2>/dev/null | grep -qx "SLURMD_NODENAME=$2" && echo "$step"
  done || true)
  kill -9 "$pid" $children 2>/dev/null || true
  # What slurmstepd started carries the node's name in its environment.
  for process in /proc/[0-9]*; do
    grep -qz "^SLURMD_NODENAME=$2\$" "$process/environ" 2>/dev/null && kill -9 "${process#/proc/}" 2>/dev/null
  done
  true
}

stop_cluster() {
  local file
  for file in "$1"/*.pid "$1/munge/pid"; do
    [ -e "$file" ] && kill "$(cat "$file")" 2>/dev/null
  done
  true
}
