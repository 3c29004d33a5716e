// SPDX-License-Identifier: MIT
#include "server/service/answer_cache.h"

#include <iterator>

namespace penumbra {
namespace {

// What a string holds outside of itself.
std::size_t beside(const std::string& text) { return text.capacity() < sizeof(std::string) / 2 ? 0 : text.capacity() + 1; }

// What one answer keeps, rounded up: the nodes of list and map, their keys, and each block's own rest.
std::size_t bytes_of(const std::string& key, const Answer& answer) {
    constexpr std::size_t kNodes = 512, kBlock = 16;
    const RenderStats& stats = answer.stats;
    std::size_t bytes = kNodes + answer.picture.capacity() + 2 * key.size() + beside(stats.device) + beside(stats.method_reason);
    bytes += stats.passes.capacity() * sizeof(PassStats) + stats.skipped.capacity() * sizeof(SkippedWork);
    for (const PassStats& pass : stats.passes) bytes += beside(pass.name);
    for (const SkippedWork& skipped : stats.skipped) bytes += beside(skipped.what) + beside(skipped.why) + 2 * kBlock;
    return bytes;
}

}  // namespace

SharedAnswer AnswerCache::find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(key);
    if (found == places_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return entries_.front().answer;
}

bool AnswerCache::put(const std::string& key, SharedAnswer answer) {
    const std::size_t bytes = bytes_of(key, *answer);
    if (bytes > most_bytes_) return false;
    std::list<Entry> dropped;  // freed without the lock
    const std::lock_guard lock(mutex_);
    if (const auto found = places_.find(key); found != places_.end()) {
        bytes_ -= found->second->bytes;
        dropped.splice(dropped.end(), entries_, found->second);
        places_.erase(found);
    }
    while (bytes_ + bytes > most_bytes_) {
        bytes_ -= entries_.back().bytes;
        places_.erase(entries_.back().key);
        dropped.splice(dropped.end(), entries_, std::prev(entries_.end()));
        ++evicted_;
    }
    entries_.push_front({key, std::move(answer), bytes});
    places_.emplace(key, entries_.begin());
    bytes_ += bytes;
    return true;
}

AnswerCache::Figures AnswerCache::figures() const {
    const std::lock_guard lock(mutex_);
    return {entries_.size(), bytes_, most_bytes_, evicted_};
}

std::string TextMemo::find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(key);
    if (found == places_.end()) return "";
    entries_.splice(entries_.begin(), entries_, found->second);
    return entries_.front().second;
}

void TextMemo::put(const std::string& key, const std::string& value) {
    const std::lock_guard lock(mutex_);
    if (const auto found = places_.find(key); found != places_.end()) {
        found->second->second = value;
        return;
    }
    if (entries_.size() == most_entries_) {
        places_.erase(entries_.back().first);
        entries_.pop_back();
    }
    entries_.emplace_front(key, value);
    places_.emplace(key, entries_.begin());
}

}  // namespace penumbra
