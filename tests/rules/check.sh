#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The rules of dependency as searches that must find nothing.
#
#   check.sh [--root DIR] [RULE ...]   all rules, or these; prints FILE:LINE: and the breach
#   check.sh --list                    the rules' names, one a line
#   check.sh --self-test [--cxx CXX]   plants breaches in a scratch tree and expects each to be found
#
# Exit codes: 0 nothing found, 1 breaches, 2 wrong use.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export LC_ALL=C

# ---- tools -------------------------------------------------------------------------------------

# files EXT_REGEX FOLDER...: the files below these folders, relative to the root; missing folders are empty.
files() {
    local pattern=$1 folder
    shift
    for folder in "$@"; do
        [[ -e $root/$folder ]] || continue
        (cd "$root" && find "$folder" -type f -regextype posix-extended -regex "$pattern" | sort)
    done
}
readonly cpp='.*\.(h|cpp)' shaders='.*\.(comp|glsl|h)' sources='.*\.(h|cpp|comp|glsl|cmake|txt)'

# code: from files named on stdin, every line as FILE:LINE:TEXT with comments gone (strings stay).
code() {
    local list=()
    mapfile -t list
    [[ ${#list[@]} -gt 0 ]] || return 0
    (cd "$root" && awk '
        FNR == 1 { block = 0 }
        {
            line = $0; text = ""; quoted = 0
            if (!block && line !~ /\//) { text = line; line = "" }
            while (length(line) > 0) {
                if (block) {
                    end = index(line, "*/")
                    if (end == 0) break
                    line = substr(line, end + 2); block = 0; text = text " "
                    continue
                }
                two = substr(line, 1, 2); one = substr(line, 1, 1)
                if (quoted && one == "\\") { text = text two; line = substr(line, 3); continue }
                if (!quoted && two == "//") break
                if (!quoted && two == "/*") { block = 1; line = substr(line, 3); continue }
                if (one == "\"") quoted = !quoted
                text = text one; line = substr(line, 2)
            }
            print FILENAME ":" FNR ":" text
        }' "${list[@]}")
}

# includes: from files named on stdin, every include as FILE:LINE:NAME (quotes and brackets gone).
includes() {
    code | sed -nE 's/^([^:]*:[0-9]+:)[ \t]*#[ \t]*include[ \t]*[<"]([^>"]*)[>"].*/\1\2/p'
}

# search REGEX: the lines FILE:LINE:TEXT of stdin whose TEXT matches (extended, GNU).
search() { grep -E "^[^:]*:[0-9]+:.*($1)" || true; }
# search_include REGEX: the same where the whole included name must begin with a match.
search_include() { grep -E "^[^:]*:[0-9]+:($1)" || true; }

# ---- rules: each prints its breaches -------------------------------------------------------------

readonly gl_headers='glad/|EGL/|GL/|GLES[0-9]*/|KHR/|GL/osmesa'
readonly gl_free=(core/scene core/plan core/image core/outline core/film core/floor core/views core/reference core/compare)

# core knows no server, JSON, HTTP, log or command line, and reads no environment.
rule_core_knows_no_server() {
    files "$cpp" core | includes | search_include 'server/|nlohmann/|json\.hpp|httplib\.h|spdlog/|CLI/|CLI11'
    files "$cpp" core | code | search '\<(secure_)?getenv *\(|\<(set|put|unset)env *\(|\<environ\>'
}

# What needs no device is compiled without any GL header.
rule_no_gl_below_the_device() {
    files "$cpp" "${gl_free[@]}" | includes | search_include "$gl_headers|core/gl/|core/passes/"
}

public_headers() {
    (cd "$root" && find core -maxdepth 1 -name '*.h' 2>/dev/null | sort) || true
    files '.*\.h' "${gl_free[@]}"
}
# Public headers bring in no glad, EGL or stb, however deep.
rule_public_headers_are_clean() {
    local queue=() seen=' ' file hit name
    mapfile -t queue < <(public_headers)
    while [[ ${#queue[@]} -gt 0 ]]; do
        file=${queue[0]}
        queue=("${queue[@]:1}")
        [[ $seen != *" $file "* && -f $root/$file ]] || continue
        seen+="$file "
        while IFS= read -r hit; do
            name=${hit#*:*:}
            if [[ $name =~ ^(glad|EGL|GL|KHR)/|^stb|spng\.h|libdeflate\.h|ft2build\.h ]]; then printf '%s\n' "$hit"; fi
            if [[ $name =~ ^(core|glsl|server)/ ]]; then queue+=("$name"); fi
            if [[ $file == glsl/* && -f $root/glsl/$name ]]; then queue+=("glsl/$name"); fi
        done < <(printf '%s\n' "$file" | includes)
    done
}

# A folder includes only what lies below it.
rule_layers() {
    files "$cpp" core/scene | includes | search_include 'core/[a-rt-z_]|core/s[a-bd-z]|glsl/'
    files "$cpp" core/image | includes | search_include 'core/(plan|gl|passes|reference|renderer|film|outline)'
    files "$cpp" core/film core/floor core/outline core/views | includes | search_include 'core/(plan|gl|passes|reference|compare|renderer)'
    # Of the exact solver the plan knows the scene's outline, what a point sees of it, and the sky: not the light.
    files "$cpp" core/plan | includes | search_include 'core/(gl|passes|renderer)|core/reference/(solver|radiosity|delta)'
    files "$cpp" core/reference core/compare | includes | search_include 'core/(gl|passes|plan|renderer)'
    files "$cpp" core/gl | includes | search_include 'core/(passes|reference|renderer)'
    files "$cpp" core/passes | includes | search_include 'core/(reference|renderer)'
    files "$cpp" server/json | includes | search_include 'server/(http|cli)/'
    files "$cpp" server/http | includes | search_include 'server/cli/'
}

# Each third-party library enters by one door.
rule_one_door_each() {
    files "$cpp" core server | grep -v '^server/http/' | includes | search_include 'httplib\.h'
    files "$cpp" core server | grep -v '^server/cli/' | includes | search_include 'CLI/|CLI11'
    files "$cpp" core server | grep -v '^core/gl/' | includes | search_include "$gl_headers"
    files "$cpp" core server | grep -v '^core/outline/' | includes | search_include 'ft2build\.h|freetype/'
    files "$cpp" core server | grep -v '^server/redis/' | includes | search_include 'hiredis/'
    files "$cpp" core server | grep -v '^core/image/' | includes | search_include 'spng\.h|libdeflate\.h|stb'
}

# A failure's HTTP status is chosen in one file. Prose in strings may name one; a status line may not.
rule_statuses_in_problem_cpp() {
    local status='40[0-9]|41[0-8]|42[1-689]|431|451|499|50[1-8]|511' lines
    lines=$(files "$cpp" server | grep -v '^server/http/problem\.cpp$' | code)
    printf '%s\n' "$lines" | search 'HTTP/[0-9.]+ [45][0-9][0-9]'
    printf '%s\n' "$lines" | sed -E 's/"([^"\\]|\\.)*"/""/g' |
        search "(^|[^0-9A-Za-z_.'])($status)([^0-9A-Za-z_.']|\$)|\\<status[^;]*[^0-9A-Za-z_.'](400|500)([^0-9]|\$)|StatusCode::[A-Za-z]+_[45][0-9][0-9]"
}

# GLSL is written in glsl/, nowhere else.
rule_glsl_text_in_glsl() {
    files "$cpp" core server | code |
        search '#version|\<gl_(GlobalInvocationID|LocalInvocationID|WorkGroupID)\>|\<layout *\( *(std140|std430|binding|location|local_size|shared|packed|row_major|r8|r16|r32|rg|rgba)'
}

# reads_in_loops: from files named on stdin, the lines where a loop (its head or its body) touches a member of a storage block
# that is not for writing only. Atomic operations pass: they are how invocations claim room.
reads_in_loops() {
    code | awk '
        {
            at = index($0, ":"); file = substr($0, 1, at - 1); rest = substr($0, at + 1); at = index(rest, ":")
            if (file != last) { if (last != "") scan(); text = ""; count = 0; last = file }
            line[++count] = substr(rest, 1, at - 1); start[count] = length(text) + 1; text = text substr(rest, at + 1) "\n"
        }
        END { if (last != "") scan() }
        function line_of(place,   i) { for (i = count; i > 1 && start[i] > place; --i); return line[i] }
        # Where the loop that begins at `place` ends.
        function end_of(place,   depth, c) {
            for (depth = 0; place <= length(text); ++place) {
                c = substr(text, place, 1)
                if (c == "{" || c == "(") ++depth
                if (c == "}" || c == ")") --depth
                if (depth < 0 || (depth == 0 && (c == ";" || c == "}"))) break
            }
            return place
        }
        function scan(   names, rest, block, part, n, i, place, head) {
            split("", names)
            rest = text
            while (match(rest, /(^|[^A-Za-z0-9_])buffer[ \t\n]+[A-Za-z_0-9]*[ \t\n]*\{[^}]*\}/)) {
                block = substr(rest, 1, RSTART + RLENGTH - 1); rest = substr(rest, RSTART + RLENGTH)
                n = split(block, part, ";")  # the last statement before the brace says of what kind the block is
                block = substr(block, RSTART)
                for (i = 1; i <= n && part[i] !~ /(^|[^A-Za-z0-9_])buffer[ \t\n]/; ++i);
                if (part[i] ~ /[^A-Za-z0-9_]writeonly[^A-Za-z0-9_]/) continue
                sub(/^[^{]*\{/, "", block)
                n = split(block, part, ";")
                for (i = 1; i < n; ++i) {
                    sub(/[ \t\n]*(\[.*)?[ \t\n]*$/, "", part[i]); sub(/^.*[^A-Za-z_0-9]/, "", part[i])
                    if (part[i] != "") names[part[i]] = 1
                }
            }
            for (place = 1; match(substr(text, place), /(^|[^A-Za-z0-9_])(for|while|do)[^A-Za-z0-9_]/); place = head + 2) {
                head = place + RSTART - 1
                for (n in names) look(n, head, substr(text, head, end_of(head + 1) - head + 1))
            }
        }
        function look(name, base, body,   from, at) {
            for (from = 1; match(substr(body, from), "[^A-Za-z0-9_]" name "[^A-Za-z0-9_]"); from = at + 1) {
                at = from + RSTART
                if (substr(body, 1, at - 1) !~ /atomic[A-Za-z]+[ \t\n]*\([ \t\n]*$/)
                    print last ":" line_of(base + at - 1) ": " name " is read in a loop"
            }
        }'
}

# Scene data and intermediate results are read through textures. Storage blocks are for writing only, but for counters: plain
# numbers by which invocations claim room, and which no loop reads.
rule_no_storage_buffer_reads() {
    files "$shaders" glsl | code | search '\<buffer +[A-Za-z_]+|\<buffer *\{|\<buffer *$' | grep -vE '\<writeonly\>' |
        grep -vE '\<buffer +[A-Za-z_]*(Counters|Bits) *\{ *uint [a-z_]+\[\]; *\};' || true
    files "$shaders" glsl | code | search '\<readonly\>[^;{]*\<buffer\>|\<buffer\>[^;{]*\<readonly\>'
    files "$shaders" glsl | reads_in_loops
}

# A file that one can read in one go.
rule_at_most_500_lines() {
    files "$sources" core server glsl | while read -r file; do
        lines=$(awk 'END { print NR }' "$root/$file")
        if ((lines > 500)); then printf '%s:%s: has %s lines, 500 are enough\n' "$file" "$lines" "$lines"; fi
    done
}

all_rules() { declare -F | sed -n 's/^declare -f rule_//p'; }

# check RULE: prints breaches; fails when there are any.
check() {
    local found
    declare -F "rule_$1" >/dev/null || {
        printf 'check.sh: there is no rule %s (see check.sh --list)\n' "$1" >&2
        exit 2
    }
    found=$("rule_$1" | sort -u)
    [[ -z $found ]] && return 0
    printf '%s\n' "$found" | sed "s/^/[$1] /"
    return 1
}

# ---- main ----------------------------------------------------------------------------------------

cxx=''
mode=check
rules=()
while [[ $# -gt 0 ]]; do
    case $1 in
    --root) root=$(cd "$2" && pwd) && shift ;;
    --cxx) cxx=$2 && shift ;;
    --list) mode=list ;;
    --self-test) mode=self_test ;;
    -h | --help)
        sed -n '3,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
        exit 0
        ;;
    -*)
        printf 'check.sh: unknown option %s\n' "$1" >&2
        exit 2
        ;;
    *) rules+=("$1") ;;
    esac
    shift
done

case $mode in
list) all_rules ;;
self_test)
    # shellcheck source=tests/rules/self_test.sh
    source "$here/self_test.sh"
    ;;
check)
    [[ ${#rules[@]} -gt 0 ]] || mapfile -t rules < <(all_rules)
    [[ -n $(files "$cpp" core) ]] || {
        printf 'check.sh: no sources below %s\n' "$root" >&2
        exit 2
    }
    failed=0
    for rule in "${rules[@]}"; do
        check "$rule" || failed=1
    done
    exit "$failed"
    ;;
esac
