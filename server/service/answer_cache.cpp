// SPDX-License-Identifier: MIT
#include "server/service/answer_cache.h"

#include <iterator>

namespace penumbra {
namespace {

std::size_t bytes_of(const std::string& key, const Answer& answer) {
    // Two keys, the nodes of list and map, and about what the statistics hold: counted generously.
    return answer.picture.capacity() + 2 * key.size() + answer.stats.passes.size() * sizeof(PassStats) +
           answer.stats.skipped.size() * sizeof(SkippedWork) + 512;
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
