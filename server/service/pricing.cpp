// SPDX-License-Identifier: MIT
#include "server/service/pricing.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr std::size_t kKnownScenes = 4096;
// Before anything is measured: the machine may be four times faster or slower than the one of the table.
constexpr double kFirstSpread = 0.7;
// The same scene takes more or less the same time; a shared machine sees to it that it is not the same.
constexpr double kLeastSpread = 0.2;
// What was not planned may be anything.
constexpr double kGuessSpread = 1.2;
// A new figure's weight: some ten renders forget a busy neighbour.
constexpr double kWeight = 0.1;
constexpr double kLeastMs = 0.05;

}  // namespace

std::string Pricing::kind_of(const Price& price) {
    if (!price.planned) return "unplanned " + price.method;
    return price.work[std::size_t(Work::grid_pixels)] == 0 && price.work[std::size_t(Work::rays)] == 0 ? "constant" : price.method;
}

Pricing::Quote Pricing::quote(const std::string& key, const Scene& scene, const DeviceInfo& device) const {
    Quote quote;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = places_.find(key); found != places_.end()) {
            scenes_.splice(scenes_.begin(), scenes_, found->second);
            quote.price = found->second->price;
            quote.ms = found->second->ms;
            quote.measured = true;
            quote.low_ms = quote.ms * std::exp(-2 * kLeastSpread);
            quote.high_ms = quote.ms * std::exp(2 * kLeastSpread);
            return quote;
        }
    }
    quote.price = price_of(scene, device_limits(device.max_texture_side, device.max_texture_buffer_texels,
                                                device.max_loop_iterations, device.kind != "gpu"));
    const std::lock_guard lock(mutex_);
    Experience known;
    // llvmpipe's threads share a picture, but not all of its work.
    known.mean = -0.7 * std::log(double(std::max(threads_, 1)));
    known.spread = kFirstSpread;
    if (const auto found = experience_.find(kind_of(quote.price)); found != experience_.end()) known = found->second;
    quote.ms = std::max(quote.price.cpu_ms, kLeastMs) * std::exp(known.mean);
    const double spread = std::max(known.spread, quote.price.planned ? kLeastSpread : kGuessSpread);
    quote.low_ms = quote.ms * std::exp(-2 * spread);
    quote.high_ms = quote.ms * std::exp(2 * spread);
    return quote;
}

void Pricing::learn(const std::string& key, const Quote& quote, double measured_ms) {
    const double ms = std::max(measured_ms, kLeastMs);
    const double ratio = std::log(ms / std::max(quote.price.cpu_ms, kLeastMs));
    const std::lock_guard lock(mutex_);
    Experience& known = experience_[kind_of(quote.price)];
    if (known.count == 0) {
        known.mean = ratio;
        known.spread = kFirstSpread;
    } else {
        // The first few count as much as each other.
        const double weight = std::max(kWeight, 1.0 / (known.count + 1));
        const double off = ratio - known.mean;
        known.mean += weight * off;
        known.spread = std::sqrt((1 - weight) * known.spread * known.spread + weight * off * off);
    }
    ++known.count;
    if (const auto found = places_.find(key); found != places_.end()) {
        scenes_.splice(scenes_.begin(), scenes_, found->second);
        found->second->ms = std::exp(0.5 * (std::log(found->second->ms) + std::log(ms)));
        return;
    }
    scenes_.push_front({key, quote.price, ms});
    places_.emplace(key, scenes_.begin());
    if (scenes_.size() > kKnownScenes) {
        places_.erase(scenes_.back().key);
        scenes_.pop_back();
    }
}

}  // namespace penumbra
