// SPDX-License-Identifier: MIT
// Pictures that were asked for before, by the key of their scene, up to a number of bytes: the longest unused go first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "core/image/codec.h"
#include "core/render_stats.h"

namespace penumbra {

// A rendered scene as a client gets it. Never changed once made: requests share it.
struct Answer {
    Bytes picture;
    std::string format;  // of `picture`, as output.format
    RenderStats stats;
    double encode_ms = 0;
};
using SharedAnswer = std::shared_ptr<const Answer>;

class AnswerCache {
public:
    // 0: keeps nothing.
    explicit AnswerCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

    SharedAnswer find(const std::string& key);  // null when it is not there
    // False when it is larger than all the room there is.
    bool put(const std::string& key, SharedAnswer answer);

    struct Figures {
        std::size_t entries = 0, bytes = 0, capacity_bytes = 0;
        std::uint64_t evicted = 0;
    };
    Figures figures() const;

private:
    struct Entry {
        std::string key;
        SharedAnswer answer;
        std::size_t bytes = 0;
    };

    const std::size_t most_bytes_;
    mutable std::mutex mutex_;
    std::size_t bytes_ = 0;
    std::uint64_t evicted_ = 0;
    std::list<Entry> entries_;  // the longest unused last
    std::unordered_map<std::string, std::list<Entry>::iterator> places_;
};

// The same for short texts, by their number: what was once worked out need not be worked out again.
class TextMemo {
public:
    explicit TextMemo(std::size_t most_entries) : most_entries_(most_entries) {}

    std::string find(const std::string& key);  // "" when it is not there
    void put(const std::string& key, const std::string& value);

private:
    using Entry = std::pair<std::string, std::string>;

    const std::size_t most_entries_;
    std::mutex mutex_;
    std::list<Entry> entries_;
    std::unordered_map<std::string, std::list<Entry>::iterator> places_;
};

}  // namespace penumbra
