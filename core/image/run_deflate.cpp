// SPDX-License-Identifier: MIT
#include "core/image/run_deflate.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace penumbra {
namespace {

// Four codes fit in 64 bits with what is left from before; a longer bound gains nothing that shows.
constexpr int kMostBits = 12;
constexpr int kMostLengthBits = 7;  // RFC 1951, 3.2.7: of the code of code lengths
constexpr std::size_t kSymbols = 286;
constexpr std::size_t kEndOfBlock = 256;
constexpr std::size_t kLongestMatch = 258;
constexpr std::size_t kShortestMatch = 3;
constexpr std::size_t kWord = 8;  // bytes compared at once; shorter runs cost more than they save

static_assert(std::endian::native == std::endian::little, "bits are gathered in the order in which memory holds them");

struct Code {
    std::uint16_t bits = 0;  // in the order of the stream
    std::uint8_t length = 0;
};

// RFC 1951, 3.2.2: codes of one length count upwards. Huffman codes go out with their highest bit first.
void make_codes(std::span<const std::uint8_t> lengths, std::span<Code> codes) {
    std::array<std::uint32_t, 16> count{}, next{};
    for (const std::uint8_t length : lengths) ++count[length];
    count[0] = 0;
    for (std::size_t l = 1; l < 16; ++l) next[l] = (next[l - 1] + count[l - 1]) << 1;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        codes[i].length = lengths[i];
        const std::uint32_t code = lengths[i] ? next[lengths[i]]++ : 0;
        codes[i].bits = 0;
        for (int b = 0; b < lengths[i]; ++b) {
            codes[i].bits = std::uint16_t(codes[i].bits | ((code >> b) & 1) << (lengths[i] - 1 - b));
        }
    }
}

struct MatchLength {
    std::uint16_t symbol = 0;
    std::uint8_t extra_bits = 0;
    std::uint16_t extra = 0;
};

// RFC 1951, 3.2.5.
const std::array<MatchLength, kLongestMatch + 1>& match_lengths() {
    static const auto table = [] {
        std::array<MatchLength, kLongestMatch + 1> lengths{};
        std::size_t length = kShortestMatch;
        for (std::uint16_t symbol = 257; symbol < 285; ++symbol) {
            const int extra_bits = std::max(0, (symbol - 261) / 4);
            for (std::uint16_t extra = 0; extra < 1 << extra_bits; ++extra) {
                if (length < kLongestMatch) lengths[length++] = {symbol, std::uint8_t(extra_bits), extra};
            }
        }
        lengths[kLongestMatch] = {285, 0, 0};
        return lengths;
    }();
    return table;
}

// Cuts a run into lengths that a match can have.
template <class Match>
void cut(std::size_t run, const Match& match) {
    for (; run >= kLongestMatch + kShortestMatch; run -= kLongestMatch) match(kLongestMatch);
    if (run > kLongestMatch) {
        match(run - kShortestMatch);
        run = kShortestMatch;
    }
    match(run);
}

// Writes bits into memory that is known to be large enough.
struct BitWriter {
    std::uint8_t* to;
    std::uint64_t bits;
    int count;

    void put(std::uint64_t value, int length) {
        bits |= value << count;
        count += length;
    }
    void put(const Code& code) { put(code.bits, code.length); }
    // Afterwards fewer than 8 bits are left. Touches 8 bytes.
    void flush() {
        std::memcpy(to, &bits, 8);
        to += count >> 3;
        bits >>= count & ~7;
        count &= 7;
    }
};

// RFC 1951, 3.2.7: the lengths of both codes, with runs, by a third code.
void put_code_lengths(BitWriter& writer, std::span<const std::uint8_t> lengths, std::size_t pixel) {
    std::size_t used = kSymbols;
    while (lengths[used - 1] == 0) --used;  // ends at the end of block at the latest
    // The only distance is a pixel: its symbol is one less, and has one bit.
    std::array<std::uint8_t, kSymbols + 4> all{};
    std::copy_n(lengths.begin(), used, all.begin());
    all[used + pixel - 1] = 1;
    const std::size_t total = used + pixel;

    struct Item {
        std::uint8_t symbol, extra, extra_bits;
    };
    std::vector<Item> items;
    for (std::size_t i = 0; i < total;) {
        std::size_t end = i;
        while (end < total && all[end] == all[i]) ++end;
        std::size_t count = end - i;
        if (all[i] != 0) {
            items.push_back({all[i], 0, 0});
            --count;
        }
        while (count >= 3) {
            const std::size_t most = all[i] != 0 ? 6 : count >= 11 ? 138 : 10;
            const std::size_t n = std::min(count, most);
            if (all[i] != 0) items.push_back({16, std::uint8_t(n - 3), 2});
            else if (n >= 11) items.push_back({18, std::uint8_t(n - 11), 7});
            else items.push_back({17, std::uint8_t(n - 3), 3});
            count -= n;
        }
        for (; count > 0; --count) items.push_back({all[i], 0, 0});
        i = end;
    }
    std::array<std::uint32_t, 19> counts{};
    for (const Item& item : items) ++counts[item.symbol];
    std::array<std::uint8_t, 19> length_lengths{};
    code_lengths(counts, kMostLengthBits, length_lengths);
    std::array<Code, 19> codes;
    make_codes(length_lengths, codes);

    constexpr std::array<std::uint8_t, 19> kOrder{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    std::size_t sent = kOrder.size();
    while (sent > 4 && length_lengths[kOrder[sent - 1]] == 0) --sent;
    writer.put(used - 257, 5);
    writer.put(pixel - 1, 5);
    writer.put(sent - 4, 4);
    writer.flush();
    for (std::size_t i = 0; i < sent; ++i) {
        writer.put(length_lengths[kOrder[i]], 3);
        writer.flush();
    }
    for (const Item& item : items) {
        writer.put(codes[item.symbol]);
        writer.put(item.extra, item.extra_bits);
        writer.flush();
    }
}

constexpr std::size_t kMostHeadBytes = 640;  // of a block, before its data, and what the last flush touches

}  // namespace

void code_lengths(std::span<const std::uint32_t> counts, int most, std::span<std::uint8_t> lengths) {
    std::fill(lengths.begin(), lengths.end(), std::uint8_t(0));
    std::vector<std::size_t> leaves;  // symbols, the rarest first
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > 0) leaves.push_back(i);
    }
    const std::size_t n = leaves.size();
    if (n == 0) return;
    if (n == 1) {
        lengths[leaves[0]] = 1;
        return;
    }
    assert(n <= std::size_t(1) << most);
    std::stable_sort(leaves.begin(), leaves.end(), [&](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });
    // Huffman's tree: leaves and inner nodes both come in the order of their weights.
    std::vector<std::uint64_t> weight(2 * n - 1);
    std::vector<std::size_t> parent(2 * n - 1);
    for (std::size_t i = 0; i < n; ++i) weight[i] = counts[leaves[i]];
    std::size_t leaf = 0, inner = n;
    for (std::size_t made = n; made < 2 * n - 1; ++made) {
        for (int child = 0; child < 2; ++child) {
            const bool from_leaves = leaf < n && (inner >= made || weight[leaf] <= weight[inner]);
            const std::size_t taken = from_leaves ? leaf++ : inner++;
            weight[made] += weight[taken];
            parent[taken] = made;
        }
    }
    std::vector<int> depth(2 * n - 1);
    for (std::size_t i = 2 * n - 2; i-- > 0;) depth[i] = depth[parent[i]] + 1;
    // Kraft's sum in units of the longest code: cutting the depth overspends it, which the rarest symbols pay for.
    const auto share = [&](int d) { return std::uint64_t(1) << (most - d); };
    std::uint64_t spent = 0;
    for (std::size_t i = 0; i < n; ++i) {
        depth[i] = std::min(depth[i], most);
        spent += share(depth[i]);
    }
    for (std::size_t i = 0; spent > share(0);) {
        if (depth[i] == most) {
            ++i;
        } else {
            spent -= share(++depth[i]);
        }
    }
    // What was paid too much goes to the most frequent. A sum below one would be no complete code.
    for (std::size_t i = n; i-- > 0;) {
        while (depth[i] > 1 && spent + share(depth[i]) <= share(0)) spent += share(depth[i]--);
    }
    for (std::size_t i = 0; i < n; ++i) lengths[leaves[i]] = std::uint8_t(depth[i]);
}

RunDeflate::RunDeflate(Bytes& out, std::size_t pixel_bytes) : out_(out), pixel_(pixel_bytes) {
    assert(pixel_bytes >= 1 && pixel_bytes <= 4);
    out_.insert(out_.end(), {0x78, 0x01});
}

void RunDeflate::find_runs(std::span<const std::uint8_t> data) {
    runs_.clear();
    const std::uint8_t* const begin = data.data();
    const std::uint8_t* const end = begin + data.size();
    const auto differing = [&](const std::uint8_t* at) {
        std::uint64_t a = 0, b = 0;
        std::memcpy(&a, at, kWord);
        std::memcpy(&b, at - pixel_, kWord);
        return a ^ b;
    };
    const std::uint8_t* literals = begin;  // of the next run
    const std::uint8_t* at = begin + pixel_;
    while (at + kWord <= end) {
        if (differing(at) != 0) {
            at += kWord;
            continue;
        }
        const std::uint8_t* first = at;
        while (first > literals && first > begin + pixel_ && first[-1] == *(first - 1 - pixel_)) --first;
        at += kWord;
        std::uint64_t difference = 0;
        while (at + kWord <= end && (difference = differing(at)) == 0) at += kWord;
        if (difference != 0) {
            at += std::countr_zero(difference) / 8;
        } else {
            while (at < end && *at == *(at - pixel_)) ++at;
        }
        runs_.push_back({std::uint32_t(first - literals), std::uint32_t(at - first)});
        literals = at;
    }
}

void RunDeflate::add(std::span<const std::uint8_t> data, bool last) {
    assert(data.size() <= std::size_t(1) << 24);
    adler_ = libdeflate_adler32(adler_, data.data(), data.size());
    find_runs(data);

    // Four tables: counting one byte does not wait for the byte before it.
    std::array<std::array<std::uint32_t, kSymbols>, 4> counts{};
    const auto count_literals = [&](const std::uint8_t* from, const std::uint8_t* to) {
        for (; from + 4 <= to; from += 4) {
            for (std::size_t i = 0; i < 4; ++i) ++counts[i][from[i]];
        }
        for (; from < to; ++from) ++counts[0][*from];
    };
    const auto& matches = match_lengths();
    const std::uint8_t* at = data.data();
    const std::uint8_t* const end = at + data.size();
    for (const Run& run : runs_) {
        count_literals(at, at + run.literals);
        at += run.literals + run.length;
        cut(run.length, [&](std::size_t length) { ++counts[0][matches[length].symbol]; });
    }
    count_literals(at, end);
    counts[0][kEndOfBlock] = 1;
    for (std::size_t i = 0; i < kSymbols; ++i) counts[0][i] += counts[1][i] + counts[2][i] + counts[3][i];

    std::array<std::uint8_t, kSymbols> lengths{};
    code_lengths(counts[0], kMostBits, lengths);
    std::array<Code, kSymbols> codes;
    make_codes(lengths, codes);

    // No symbol stands for less than a byte, and none but a match has extra bits: 5 and 1 for at least 3 bytes.
    const std::size_t start = out_.size();
    out_.resize(start + data.size() * kMostBits / 8 + kMostHeadBytes);
    BitWriter writer{out_.data() + start, bits_, bit_count_};
    writer.put(last ? 1 : 0, 1);
    writer.put(2, 2);
    put_code_lengths(writer, lengths, pixel_);
    const auto put_literals = [&](const std::uint8_t* from, const std::uint8_t* to) {
        BitWriter local = writer;  // in registers
        for (; from + 4 <= to; from += 4) {
            for (std::size_t i = 0; i < 4; ++i) local.put(codes[from[i]]);
            local.flush();
        }
        for (; from < to; ++from) {
            local.put(codes[*from]);
            local.flush();
        }
        writer = local;
    };
    at = data.data();
    for (const Run& run : runs_) {
        put_literals(at, at + run.literals);
        at += run.literals + run.length;
        cut(run.length, [&](std::size_t length) {
            const MatchLength& match = matches[length];
            writer.put(codes[match.symbol]);
            writer.put(match.extra, match.extra_bits);
            writer.put(0, 1);  // the distance
            writer.flush();
        });
    }
    put_literals(at, end);
    writer.put(codes[kEndOfBlock]);
    writer.flush();
    out_.resize(std::size_t(writer.to - out_.data()));
    bits_ = writer.bits;
    bit_count_ = writer.count;
    if (!last) return;
    if (bit_count_ > 0) out_.push_back(std::uint8_t(bits_));
    for (const int shift : {24, 16, 8, 0}) out_.push_back(std::uint8_t(adler_ >> shift));
}

}  // namespace penumbra
