// SPDX-License-Identifier: MIT
// Every setting of the service, its default and the reason for it. Filled in one place:
// server/cli/config_options.cpp (command line first, then environment, then these).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/limits.h"
#include "server/json/scene_json.h"
#include "server/service/tokens.h"
#include "server/service/warm_up.h"

namespace penumbra {

enum class LogFormat { text, json };

struct SceneBounds {
    int max_json_depth = TextLimits().max_depth;
    std::size_t max_json_values = TextLimits().max_nodes;
    std::size_t max_shapes = Limits().max_shapes;
    std::size_t max_points = Limits().max_points;
    std::size_t max_lights = Limits().max_lights;
    double max_bitmap_texels = Limits().max_bitmap_texels;
    int max_bounces = Limits().max_converging_bounces;
};

struct Config {
    // Only this machine: a service without authentication is opened to others by a decision.
    std::string host = "127.0.0.1";
    int port = 8080;  // 0: the system picks a free one, told in the log and in port_file
    std::string port_file;

    std::string device = "auto";
    std::string font;      // file; empty: Debian's DejaVu Sans
    std::string tone_lut;  // file; empty: scenes with the tone map "tony" are refused

    // Renders waiting behind the one that runs. Each waiting one holds a parsed scene (a few MB) and a
    // client; 16 standard renders of 512 x 512 are some seconds on two cores, which clients sit out.
    std::size_t queue_capacity = 16;
    // Threads beyond the ones that wait for renders: they parse scenes, encode pictures and answer
    // what needs no render while every place of the queue is taken.
    std::size_t spare_http_threads = 32;
    // Connections beyond the threads: silent, slow, idle, or waiting for a thread. They take a kilobyte and no thread. More are
    // refused at once with 503.
    std::size_t max_waiting_connections = 1024;
    // Bytes of requests and of answers not yet taken, of all connections: four of the longest bodies.
    std::size_t held_bytes = 256u << 20;
    // Scenes parsed at the same time: parsing takes up to 26 bytes of memory per byte of JSON.
    std::size_t parse_slots = 4;

    // The format's own bounds (core/scene/limits.h, server/json/scene_json.h), which operators may lower.
    SceneBounds bounds;
    // Room for bitmaps as data URLs; the scene without them is seldom over 1 MiB.
    std::size_t max_body_bytes = 64u << 20;
    // The format's own limit (core/scene/limits.h). Operators lower it to bound a render's time.
    double max_pixels = 8192.0 * 8192.0;

    // Names, cookies of others and tracing headers fit in half of this.
    std::size_t max_header_bytes = 16u << 10;
    std::size_t max_header_lines = 100;
    // From a request's first byte to the last of its body: 64 MiB in 30 s is 18 Mbit/s.
    int request_timeout_s = 30;
    // For the whole response: a slow reader must not hold a thread for ever.
    int response_timeout_s = 60;
    // Longer than the idle time of common load balancers (60 s), so that they close first.
    int keep_alive_s = 75;

    // Processes that render. -1: one for four processors; 0: none, this process renders itself.
    int workers = -1;
    // A worker is replaced when it uses more; 0: no bound.
    std::size_t worker_memory_mb = 0;
    // And after so many renders, 0 never: what leaks slowly in a driver never becomes much.
    std::size_t worker_renders = 10'000;
    // A worker that says nothing for so long hangs. One dispatch of a dense scene takes seconds, a compiler too.
    int worker_silence_s = 30;
    // The most that a request may take from its first byte on; clients may ask for less.
    int max_deadline_s = 120;
    // Threads of a renderer, for the first guess at what renders take: filled from the number of workers.
    int render_threads = 2;
    // Seconds of rendering that a client may have in a minute; 0: no bound.
    double client_budget_s = 0;
    // Renders that outlive their request: kept at most, 0: none are taken; after their end, in seconds and in bytes of pictures.
    std::size_t max_jobs = 64;
    int job_ttl_s = 600;
    std::size_t job_bytes = 256u << 20;
    // Of a job, and of all frames of an animation together.
    int max_job_s = 3600;
    std::size_t max_frames = 600;
    // What still renders so long after the first signal is ended.
    int shutdown_timeout_s = 60;

    // Pictures kept to be given again; 0 keeps none. A 512 x 512 PNG has 0.1 to 0.5 MB: some thousand of them.
    std::size_t cache_bytes = 256u << 20;

    // Before the first request. `common` takes about a second with Mesa's shader cache, several without.
    WarmUp warm_up = WarmUp::common;

    // Metrics and probes for operators: -1 is no such port, 0 a free one.
    int admin_port = -1;
    std::string admin_host;  // empty: as host
    // Browsers' scripts from there may use the service; "*": from everywhere.
    std::vector<std::string> cors_origins;
    std::string token_file, url_key_file;
    Tokens tokens;        // of token_file: who may render; none: everybody
    std::string url_key;  // of url_key_file: signs addresses of pictures; empty: none are taken
    // A client is told apart by the last address in X-Forwarded-For, which our own proxy has put there.
    bool trust_forwarded_for = false;

    LogFormat log_format = LogFormat::text;
};

}  // namespace penumbra
