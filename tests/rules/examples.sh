#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The examples, for real: every client that this machine can run against a running service, and every scene.
#
#   examples.sh PROGRAM EXAMPLES_FOLDER
set -euo pipefail
program=$1
examples=$2
work=$(mktemp -d)
service=''
# shellcheck disable=SC2317  # called by the trap
stop() {
    if [[ -n $service ]]; then
        kill -TERM "$service" 2>/dev/null || true
        wait "$service" 2>/dev/null || true
    fi
    rm -rf "$work"
}
trap stop EXIT
failures=0
wrong() {
    printf 'examples: %s\n' "$*"
    failures=$((failures + 1))
}

# Every scene is valid, or all that is wrong with it is that this version does not render it yet.
for scene in "$examples"/scenes/*.json; do
    name=$(basename "$scene" .json)
    status=0
    "$program" validate "$scene" >"$work/text" 2>&1 || status=$?
    [[ $status -ne 0 ]] || continue
    if [[ $status -ne 2 || $name == hello || $name == window_light ]] || grep -v 'not supported yet$' "$work/text" >/dev/null; then
        wrong "validate $name ended with $status: $(cat "$work/text")"
    fi
done

"$program" serve --host 127.0.0.1 --port 0 --port-file "$work/port" >"$work/log" 2>&1 </dev/null &
service=$!
url=''
for ((i = 0; i < 600; ++i)); do
    kill -0 "$service" 2>/dev/null || {
        cat "$work/log"
        wrong "the service ended at its start"
        exit 1
    }
    [[ -s $work/port ]] && url=http://127.0.0.1:$(<"$work/port")
    if [[ -n $url ]] && "$program" health --url "$url" >/dev/null 2>&1; then break; fi
    sleep 0.1
done

clients=()
if command -v curl >/dev/null; then clients+=("bash $examples/clients/render.sh"); fi
if command -v python3 >/dev/null; then clients+=("python3 $examples/clients/render.py"); fi
if command -v node >/dev/null; then clients+=("node $examples/clients/render.mjs"); fi
[[ ${#clients[@]} -gt 0 ]] || wrong "no client can run here"
export no_proxy=127.0.0.1 NO_PROXY=127.0.0.1 PYTHONDONTWRITEBYTECODE=1

"$program" render "$examples/scenes/hello.json" -o "$work/cli.png"
sed 's/"radius": 44/"radius": -44/' "$examples/scenes/hello.json" >"$work/bad.json"
for client in "${clients[@]}"; do
    read -r -a command <<<"$client"
    name=$(basename "${command[1]}")
    "${command[@]}" --help | grep 'SCENE\|scene' >/dev/null || wrong "$name --help says nothing"

    "${command[@]}" "$examples/scenes/hello.json" -o "$work/a.png" --url "$url" >/dev/null || wrong "$name failed"
    cmp "$work/a.png" "$work/cli.png" || wrong "$name: other bytes than penumbra render"
    "${command[@]}" - -o - --url "$url" <"$examples/scenes/hello.json" >"$work/b.png" || wrong "$name failed on its pipes"
    cmp "$work/b.png" "$work/cli.png" || wrong "$name: other bytes through pipes"
    "${command[@]}" "$examples/scenes/hello.json" -o "$work/a.pfm" --url "$url" >/dev/null || wrong "$name failed for pfm"
    [[ $(head -c 2 "$work/a.pfm") == PF ]] || wrong "$name: no PFM"

    status=0
    "${command[@]}" "$work/bad.json" -o "$work/bad.png" --url "$url" 2>"$work/errors" || status=$?
    [[ $status -eq 2 ]] || wrong "$name ended with $status on a bad scene, not 2"
    grep '/shapes/0/radius' "$work/errors" >/dev/null || wrong "$name names no problem: $(cat "$work/errors")"
    [[ ! -e $work/bad.png ]] || wrong "$name wrote a picture of a bad scene"

    status=0
    "${command[@]}" "$examples/scenes/hello.json" -o "$work/none.png" --url http://127.0.0.1:9 2>/dev/null || status=$?
    [[ $status -eq 1 ]] || wrong "$name ended with $status without a service, not 1"
done

if [[ $failures -gt 0 ]]; then
    printf 'examples: %s failures\n' "$failures"
    exit 1
fi
printf 'examples: %s clients and all scenes pass\n' "${#clients[@]}"
