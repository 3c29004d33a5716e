# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Sourced by check.sh --self-test: a rule that cannot fail guards nothing. Each breach is planted alone in
# a clean tree; its rule must name the file. What only looks like a breach must pass.

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failures=0
planted=0
proven=' '

clean_tree() {
    rm -rf "$scratch/tree"
    mkdir -p "$scratch/tree/core/scene" "$scratch/tree/core/plan" "$scratch/tree/core/gl" \
        "$scratch/tree/core/image" "$scratch/tree/server/http" "$scratch/tree/server/cli" "$scratch/tree/glsl/lib"
    root=$scratch/tree
    # Near misses: words in comments, success statuses, times, names that contain a forbidden word.
    cat >"$root/core/scene/scene.h" <<'END'
#pragma once
#include <string>
// getenv( and #version 430 are only mentioned here; so is layout(std140).
/* readonly buffer,
   #include <nlohmann/json.hpp> in prose */
struct Scene { std::string name; };
END
    printf '#pragma once\n#include "core/scene/scene.h"\nint cascade_layout(int binding);\n' >"$root/core/renderer.h"
    printf '#include <glad/gl.h>\n#include "core/gl/program.h"\n' >"$root/core/gl/program.cpp"
    printf '#pragma once\n' >"$root/core/gl/program.h"
    printf '#include <spng.h>\n#include "core/scene/scene.h"\n' >"$root/core/image/png.cpp"
    printf '#include <httplib.h>\nvoid f() { respond(200); wait_ms(500); sleep(404ms); }  // not 404\n' >"$root/server/http/server.cpp"
    printf 'int status = 503;\nint bad = 422;\n' >"$root/server/http/problem.cpp"
    printf '#include <CLI/CLI.hpp>\nconst char* url = "http://a//b"; int k = 4040;\nauto help = "more get 503";\n' >"$root/server/cli/main.cpp"
    cat >"$root/glsl/fill.comp" <<'END'
#version 430 core
// not a readonly buffer
layout(std430, binding = 0) writeonly buffer Out { float out_values[]; };
layout(binding = 1) uniform samplerBuffer records;
void main() {}
END
    # Counters: read outside of loops, counted in them by atomic operations.
    cat >"$root/glsl/count.comp" <<'END'
#version 430 core
layout(std430, binding = 0) writeonly buffer Jobs { uint out_jobs[]; };
layout(std430, binding = 1) buffer Counters { uint counters[]; };
void main() {
    uint count = counters[3];  // for (;;) counters[0] is only mentioned here
    for (uint i = 0u; i < count; ++i) out_jobs[i] = i;
    for (uint i = 0u; i < count; ++i) {
        if (i > 2u) { atomicAdd(counters[1], 1u); }
    }
    counters[2] = count;
}
END
}

# plant RULE FILE TEXT: FILE gains TEXT, in an otherwise clean tree; RULE must name FILE.
plant() {
    local rule=$1 file=$2 text=$3 output
    planted=$((planted + 1))
    proven+="$rule "
    clean_tree
    mkdir -p "$(dirname "$root/$file")"
    printf '%b\n' "$text" >>"$root/$file"
    if output=$(check "$rule"); then
        printf 'self-test: %s did not notice in %s: %s\n' "$rule" "$file" "${text:0:60}"
        failures=$((failures + 1))
    elif [[ $output != *"] $file:"* ]]; then
        printf 'self-test: %s failed without naming %s: %s\n' "$rule" "$file" "$output"
        failures=$((failures + 1))
    fi
}

clean_tree
mapfile -t rules < <(all_rules)
for rule in "${rules[@]}"; do
    check "$rule" || {
        printf 'self-test: %s finds a breach in the clean tree\n' "$rule"
        failures=$((failures + 1))
    }
done

for header in '"server/json/scene_json.h"' '<nlohmann/json.hpp>' '<httplib.h>' '<spdlog/spdlog.h>' '<CLI/CLI.hpp>'; do
    plant core_knows_no_server core/plan/plan.cpp "#include $header"
done
plant core_knows_no_server core/gl/context.cpp 'auto v = std::getenv("HOME");'
plant core_knows_no_server core/gl/context.cpp 'auto v = "//"; auto w = getenv ("HOME");'
plant core_knows_no_server core/gl/context.cpp 'setenv("LP_NUM_THREADS", "2", 1);'

for folder in scene plan image reference compare; do
    plant no_gl_below_the_device core/$folder/x.cpp '#include <glad/gl.h>'
    plant no_gl_below_the_device core/$folder/x.cpp '  #  include <EGL/egl.h>'
    plant no_gl_below_the_device core/$folder/x.cpp '#include "core/gl/program.h"'
done

plant public_headers_are_clean core/renderer.h '#include <glad/gl.h>'
plant public_headers_are_clean core/render_stats.h '#include <EGL/egl.h>'
plant public_headers_are_clean core/image/codec.h '#include <stb_image.h>'
plant public_headers_are_clean core/scene/scene.h '#include <spng.h>'
# Deep: renderer.h -> core/gl/program.h -> glad.
clean_tree
printf '#include "core/gl/program.h"\n' >>"$root/core/renderer.h"
printf '#include <glad/gl.h>\n' >>"$root/core/gl/program.h"
planted=$((planted + 1))
if check public_headers_are_clean >/dev/null; then
    printf 'self-test: public_headers_are_clean missed glad behind another header\n'
    failures=$((failures + 1))
fi

plant layers core/scene/x.cpp '#include "core/plan/plan.h"'
plant layers core/scene/x.cpp '#include "core/renderer.h"'
plant layers core/image/x.cpp '#include "core/passes/pass.h"'
plant layers core/film/x.cpp '#include "core/passes/compose_pass.h"'
plant layers core/outline/x.cpp '#include "core/plan/pack.h"'
plant layers core/plan/x.cpp '#include "core/reference/solver.h"'
plant layers core/plan/x.cpp '#include "core/reference/radiosity.h"'
plant layers core/reference/x.cpp '#include "core/renderer.h"'
plant layers core/reference/x.cpp '#include "core/plan/plan.h"'
plant layers core/gl/x.cpp '#include "core/passes/pass.h"'
plant layers core/passes/x.cpp '#include "core/renderer.h"'
plant layers server/json/x.cpp '#include "server/http/problem.h"'
plant layers server/http/x.cpp '#include "server/cli/serve.h"'

plant one_door_each server/cli/x.cpp '#include <httplib.h>'
plant one_door_each server/json/x.h '#include "httplib.h"'
plant one_door_each server/http/x.cpp '#include <CLI/CLI.hpp>'
plant one_door_each core/passes/x.cpp '#include <glad/gl.h>'
plant one_door_each server/http/x.cpp '#include <EGL/egl.h>'
plant one_door_each core/plan/x.cpp '#include <libdeflate.h>'
plant one_door_each server/json/x.cpp '#include <ft2build.h>'
plant one_door_each server/cli/x.cpp '#include <hiredis/hiredis.h>'

plant statuses_in_problem_cpp server/http/x.cpp 'response.status = 404;'
plant statuses_in_problem_cpp server/http/x.cpp 'response.status = 500;'
plant statuses_in_problem_cpp server/http/x.cpp 'const char* full = "HTTP/1.1 503 Service Unavailable";'
plant statuses_in_problem_cpp server/cli/x.cpp 'return refuse(422, text);'
plant statuses_in_problem_cpp server/http/problem.h 'constexpr int kTooLarge = 413;'
plant statuses_in_problem_cpp server/http/x.cpp 'r.status = httplib::StatusCode::BadRequest_400;'

plant glsl_text_in_glsl core/gl/x.cpp 'const char* s = "#version 430 core";'
plant glsl_text_in_glsl core/passes/x.cpp 'auto s = R"(layout(local_size_x = 8) in;)";'
plant glsl_text_in_glsl core/passes/x.h 'auto s = "layout( std430, binding = 1) buffer B";'
plant glsl_text_in_glsl server/cli/x.cpp 'auto s = "uvec3 g = gl_GlobalInvocationID;";'

plant no_storage_buffer_reads glsl/x.comp 'layout(std430, binding = 0) readonly buffer In { float v[]; };'
plant no_storage_buffer_reads glsl/x.comp 'layout(std430, binding = 0) buffer InOut { float v[]; };'
plant no_storage_buffer_reads glsl/lib/x.glsl 'layout(std430) restrict readonly buffer In\n{ float v[]; };'
plant no_storage_buffer_reads glsl/x.h 'buffer In { float v[]; };'
plant no_storage_buffer_reads glsl/x.comp 'buffer Counters { vec4 counters[]; };'
plant no_storage_buffer_reads glsl/x.comp 'buffer Counters { uint counters[]; float more[]; };'
counters='layout(std430) buffer Counters { uint counters[]; };\nvoid main() {\n'
plant no_storage_buffer_reads glsl/x.comp "$counters for (int i = 0; i < 9; ++i) x += counters[i];\n}"
plant no_storage_buffer_reads glsl/x.comp "$counters for (int i = 0; i < 9; ++i) {\n  if (i > 3) {\n x += counters[i];\n }\n }\n}"
plant no_storage_buffer_reads glsl/x.comp "$counters for (uint i = 0u; i < counters[0]; ++i) { ++x; }\n}"
plant no_storage_buffer_reads glsl/x.comp "$counters while (x < 3) { while (true) { ++y; }\n x = int(counters[x]); }\n}"
plant no_storage_buffer_reads glsl/x.comp "$counters do { x = int(counters[x]); } while (x < 3);\n}"
plant no_storage_buffer_reads glsl/x.comp "$counters do { ++x; } while (x < counters[0]);\n}"

long=$(for ((i = 0; i < 501; ++i)); do printf '// %d\\n' "$i"; done)
plant at_most_500_lines core/scene/x.cpp "$long"
plant at_most_500_lines server/http/x.h "$long"
plant at_most_500_lines glsl/x.comp "$long"

for rule in "${rules[@]}"; do
    [[ $proven == *" $rule "* ]] || {
        printf 'self-test: nothing proves that %s can fail\n' "$rule"
        failures=$((failures + 1))
    }
done

# The compiled rule, "a public header compiles alone", is a build target: prove its means can fail.
if [[ -n $cxx ]]; then
    try() { printf '#include "%s"\n#include "%s"\n' "$1" "$1" | "$cxx" -std=c++20 -fsyntax-only -I "$scratch" -x c++ - 2>/dev/null; }
    printf '#pragma once\n#include <string>\nstd::string alone();\n' >"$scratch/good.h"
    printf '#pragma once\nstd::string needs_an_include();\n' >"$scratch/needy.h"
    printf '#include <string>\nstruct Twice {};\n' >"$scratch/unguarded.h"
    planted=$((planted + 2))
    try good.h || { printf 'self-test: a good header does not compile with %s\n' "$cxx" && failures=$((failures + 1)); }
    for header in needy.h unguarded.h; do
        if try "$header"; then
            printf 'self-test: %s compiles alone, and should not\n' "$header"
            failures=$((failures + 1))
        fi
    done
fi

if [[ $failures -gt 0 ]]; then
    printf 'self-test: %s failures\n' "$failures"
    exit 1
fi
printf 'self-test: %s planted breaches, each found; the clean tree passes\n' "$planted"
