// SPDX-License-Identifier: MIT
// What a render will take by the clock: its price by the plan (core/plan/price.h), times what such prices turned out to be here.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>

#include "core/plan/price.h"
#include "core/renderer.h"

namespace penumbra {

class Pricing {
public:
    // `threads` of a renderer: what to expect before anything has been measured.
    explicit Pricing(int threads) : threads_(threads) {}

    struct Quote {
        Price price;
        // Milliseconds from the scene to the pixels: as expected, and what it seldom is less or more than (some 2 % each).
        double ms = 0, low_ms = 0, high_ms = 0;
        bool measured = false;  // this very scene was rendered before
    };
    // Throws DeviceError when the device cannot hold the picture.
    Quote quote(const std::string& key, const Scene& scene, const DeviceInfo& device) const;

    void learn(const std::string& key, const Quote& quote, double measured_ms);

private:
    // What was measured over what the plan said, as logarithms: their mean and their spread.
    struct Experience {
        double mean = 0, spread = 0;
        int count = 0;
    };
    static std::string kind_of(const Price& price);

    const int threads_;
    mutable std::mutex mutex_;
    std::map<std::string, Experience> experience_;  // by method
    // Scenes that were rendered, the longest unused last.
    struct Known {
        std::string key;
        Price price;
        double ms = 0;
    };
    mutable std::list<Known> scenes_;
    mutable std::unordered_map<std::string, std::list<Known>::iterator> places_;
};

}  // namespace penumbra
