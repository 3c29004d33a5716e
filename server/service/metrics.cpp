// SPDX-License-Identifier: MIT
#include "server/service/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace penumbra {
namespace {

enum class Kind { counter, gauge, histogram };

struct Row {
    std::string_view name;
    Kind kind;
    std::string_view help;
};

constexpr std::array kRows{
    Row{"penumbra_http_requests_total", Kind::counter, "Requests answered, by endpoint and status."},
    Row{"penumbra_http_request_seconds", Kind::histogram, "From a request's first byte to its answer, by endpoint."},
    Row{"penumbra_queue_wait_seconds", Kind::histogram, "Time of renders in the queue."},
    Row{"penumbra_render_seconds", Kind::histogram, "Time of renders, by method."},
    Row{"penumbra_renders_total", Kind::counter, "Renders ended, by method and outcome."},
    Row{"penumbra_pass_seconds_total", Kind::counter, "Time by the clock in each pass, by method."},
    Row{"penumbra_encode_seconds_total", Kind::counter, "Time in writing pictures, by format."},
    Row{"penumbra_cache_requests_total", Kind::counter, "Requests for pictures, by where they came from."},
    Row{"penumbra_admission_total", Kind::counter, "Requests refused before their render, by reason."},
    Row{"penumbra_price_ratio", Kind::histogram, "Measured time of renders over the time that was expected."},
    Row{"penumbra_jobs_total", Kind::counter, "Jobs taken, by how they ended."},
    Row{"penumbra_queue_waiting", Kind::gauge, "Renders that wait."},
    Row{"penumbra_queue_capacity", Kind::gauge, "Renders that may wait."},
    Row{"penumbra_renders_running", Kind::gauge, "Renders under way."},
    Row{"penumbra_backlog_seconds", Kind::gauge, "Expected time until all that waits is rendered."},
    Row{"penumbra_workers", Kind::gauge, "Renderers there should be."},
    Row{"penumbra_workers_ready", Kind::gauge, "Renderers that take work now."},
    Row{"penumbra_workers_lost_total", Kind::counter, "Renderers that crashed, hung or were ended at work."},
    Row{"penumbra_workers_replaced_total", Kind::counter, "Renderers that took the place of others."},
    Row{"penumbra_cache_bytes", Kind::gauge, "Bytes of pictures kept."},
    Row{"penumbra_cache_pictures", Kind::gauge, "Pictures kept."},
    Row{"penumbra_cache_evicted_total", Kind::counter, "Pictures given up for others."},
    Row{"penumbra_streams", Kind::gauge, "Answers that are being sent in parts."},
    Row{"penumbra_jobs", Kind::gauge, "Jobs kept."},
    Row{"penumbra_up_seconds", Kind::gauge, "Since the start."},
    Row{"penumbra_resident_bytes", Kind::gauge, "Memory in use by the service's own process."},
    Row{"penumbra_info", Kind::gauge, "1, with what runs as labels."},
};

// Seconds; for ratios their unit is 1.
constexpr std::array kBuckets{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0};


std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\' || c == '"') out += '\\';
        if (c == '\n') {
            out += "\\n";
        } else {
            out += c;
        }
    }
    return out;
}

std::string text_of(const Metrics::Labels& labels) {
    std::string text;
    for (const auto& [name, value] : labels) {
        text += (text.empty() ? "" : ",") + std::string(name) + "=\"" + escaped(value) + '"';
    }
    return text;
}

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, value == std::floor(value) && std::abs(value) < 1e15 ? "%.0f" : "%.9g", value);
    return text;
}

std::string in_braces(const std::string& labels) { return labels.empty() ? "" : "{" + labels + "}"; }

}  // namespace

void Metrics::count(std::string_view name, const Labels& labels, double by) {
    const std::string key = text_of(labels);
    const std::lock_guard lock(mutex_);
    families_[std::string(name)][key].value += by;
}

void Metrics::observe(std::string_view name, const Labels& labels, double seconds) {
    const std::string key = text_of(labels);
    const auto bucket = std::size_t(std::lower_bound(kBuckets.begin(), kBuckets.end(), seconds) - kBuckets.begin());
    const std::lock_guard lock(mutex_);
    Series& series = families_[std::string(name)][key];
    series.buckets.resize(kBuckets.size() + 1);
    ++series.buckets[bucket];
    ++series.count;
    series.value += seconds;
}

double Metrics::total(std::string_view name) const {
    const std::lock_guard lock(mutex_);
    const auto family = families_.find(name);
    double sum = 0;
    if (family == families_.end()) return 0;
    for (const auto& [labels, series] : family->second) sum += series.value;
    return sum;
}

std::string Metrics::text(const std::vector<Gauge>& gauges) const {
    std::string out;
    const std::lock_guard lock(mutex_);
    for (const Row& row : kRows) {
        const auto family = families_.find(row.name);
        const bool read = std::any_of(gauges.begin(), gauges.end(), [&](const Gauge& gauge) { return gauge.name == row.name; });
        if (family == families_.end() && !read) continue;
        const std::string name(row.name);
        out += "# HELP " + name + " " + std::string(row.help) + "\n# TYPE " + name + " ";
        out += row.kind == Kind::counter ? "counter\n" : row.kind == Kind::gauge ? "gauge\n" : "histogram\n";
        for (const Gauge& gauge : gauges) {
            if (gauge.name == row.name) out += name + in_braces(gauge.labels) + " " + number(gauge.value) + "\n";
        }
        if (family == families_.end()) continue;
        for (const auto& [labels, series] : family->second) {
            if (row.kind != Kind::histogram) {
                out += name + in_braces(labels) + " " + number(series.value) + "\n";
                continue;
            }
            std::uint64_t below = 0;
            const std::string before = labels.empty() ? "" : labels + ",";
            for (std::size_t i = 0; i < series.buckets.size(); ++i) {
                below += series.buckets[i];
                const std::string bound = i < kBuckets.size() ? number(kBuckets[i]) : "+Inf";
                out += name + "_bucket{" + before + "le=\"" + bound + "\"} " + std::to_string(below) + "\n";
            }
            out += name + "_sum" + in_braces(labels) + " " + number(series.value) + "\n";
            out += name + "_count" + in_braces(labels) + " " + std::to_string(series.count) + "\n";
        }
    }
    return out;
}

}  // namespace penumbra
