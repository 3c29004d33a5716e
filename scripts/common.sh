# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# What the scripts beside this file share. Sourced, never run.

# The project's folder, whoever owns it and wherever the caller stands.
project_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck disable=SC2034  # read by the scripts that source this file
readonly project_dir

say() { printf '%s\n' "$*"; }
die() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# usage: prints the comment block at the top of the calling script.
usage() {
    sed -n '/^# SPDX/,/^[^#]/{/^# SPDX/d;/^[^#]/d;/^$/d;s/^# \{0,1\}//;p;}' "$project_dir/scripts/${0##*/}"
}

# cpus: how many CPUs this process may really use: the affinity mask, cut by the container's quota
# (cgroup v2), which nproc and llvmpipe do not see. At least 1.
cpus() {
    local count quota period
    count=$(nproc)
    if [[ -r /sys/fs/cgroup/cpu.max ]]; then
        read -r quota period < /sys/fs/cgroup/cpu.max || true
        if [[ ${quota:-} =~ ^[0-9]+$ && ${period:-} =~ ^[0-9]+$ && $period -gt 0 ]]; then
            quota=$(((quota + period - 1) / period))
            ((quota < 1)) && quota=1
            ((quota < count)) && count=$quota
        fi
    fi
    printf '%s\n' "$count"
}
