#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sends a scene to a running Penumbra with curl and saves the picture.
#
#   render.sh SCENE.json|- [-o PICTURE] [--url http://127.0.0.1:8080]
#
# PICTURE is scene.png unless given; "-" is standard output; a name ending in .pfm asks for the linear
# picture. Exit codes: 0 the picture is there, 1 no answer, the service failed or the picture cannot be
# written, 2 the request is wrong.
set -euo pipefail

usage() { sed -n '3,9s/^# \{0,1\}//p' "$0"; }
wrong() {
    printf 'render.sh: %s\n' "$*" >&2
    exit 2
}

scene='' picture=scene.png url=${PENUMBRA_URL:-http://127.0.0.1:8080}
while [[ $# -gt 0 ]]; do
    case $1 in
    -h | --help)
        usage
        exit 0
        ;;
    -o | --output | --url)
        [[ $# -ge 2 ]] || wrong "$1 needs a value"
        if [[ $1 == --url ]]; then url=$2; else picture=$2; fi
        shift 2
        ;;
    -?*) wrong "unknown option $1 (see render.sh --help)" ;;
    *)
        [[ -z $scene ]] || wrong "one scene only"
        scene=$1
        shift
        ;;
    esac
done
[[ -n $scene ]] || { usage >&2; exit 2; }
[[ $scene == - || -r $scene ]] || wrong "cannot read $scene"

accept=image/png
[[ $picture != *.pfm ]] || accept=image/x-pfm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

status=$(curl --silent --show-error --data-binary "@$scene" \
    -H 'Content-Type: application/json' -H "Accept: $accept, application/problem+json" \
    --output "$work/answer" --write-out '%{http_code}' "${url%/}/v1/render") || {
    printf 'render.sh: no answer from %s\n' "$url" >&2
    exit 1
}
if [[ $status != 200 ]]; then
    printf 'render.sh: the service answered %s\n' "$status" >&2
    # One problem a line. jq makes it neat; without it the JSON is shown as it came.
    if command -v jq >/dev/null && jq -e . "$work/answer" >/dev/null 2>&1; then
        jq -r '[.title, .detail] | map(select(.)) | join(": ")' "$work/answer" >&2
        jq -r '(.errors // [])[] | (if (.line // 0) > 0 then "line \(.line), column \(.column)" else "" end) as $spot | (.pointer // "") as $pointer | "  " + (if $pointer != "" and $spot != "" then "\($pointer) (\($spot))" else $pointer + $spot end) + ": \(.detail // .message // "")"' "$work/answer" >&2
    else
        cat "$work/answer" >&2
        printf '\n' >&2
    fi
    [[ $status == 4* ]] && exit 2
    exit 1
fi
if [[ $picture == - ]]; then cat "$work/answer"; else
    reason=$(cp "$work/answer" "$picture" 2>&1) || {
        printf 'render.sh: cannot write %s: %s\n' "$picture" "${reason##*: }" >&2
        exit 1
    }
    printf '%s: %s bytes\n' "$picture" "$(wc -c <"$picture")"
fi
