// SPDX-License-Identifier: MIT
// Numbers for operators, as Prometheus reads them (text format 0.0.4). Kept under names and labels of a known, small set: nothing that
// a client chooses becomes a label.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra {

class Metrics {
public:
    using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

    // `name` is one of the table in metrics.cpp.
    void count(std::string_view name, const Labels& labels = {}, double by = 1);
    void observe(std::string_view name, const Labels& labels, double seconds);  // of a histogram

    // What is read when asked, not counted.
    struct Gauge {
        std::string_view name;
        double value = 0;
        std::string labels{};  // "device=\"cpu\"", or none
    };
    std::string text(const std::vector<Gauge>& gauges) const;

    double total(std::string_view name) const;  // of a counter, all labels together

private:
    struct Series {
        double value = 0;                    // of a counter; of a histogram the sum
        std::uint64_t count = 0;
        std::vector<std::uint64_t> buckets;  // of a histogram, not yet summed up
    };
    mutable std::mutex mutex_;
    std::map<std::string, std::map<std::string, Series>, std::less<>> families_;
};

}  // namespace penumbra
