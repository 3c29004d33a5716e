// SPDX-License-Identifier: MIT
// A zlib stream (RFC 1950, 1951) made for filtered rows of pixels, where speed counts more than the last tenth of size: the only
// matches are runs of one pixel, the codes are fitted to each call's data. Measured against libdeflate level 1 in
// docs/decisions/0045.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/image/codec.h"

namespace penumbra {

class RunDeflate {
public:
    // Appends the stream to `out`. `pixel_bytes` is from 1 to 4: how far apart bytes of a run repeat.
    RunDeflate(Bytes& out, std::size_t pixel_bytes);

    // At most 2^24 bytes a call, best some ten thousand. No run crosses from one call to the next.
    void add(std::span<const std::uint8_t> data, bool last);

private:
    struct Run {
        std::uint32_t literals = 0;  // bytes before it
        std::uint32_t length = 0;
    };
    void find_runs(std::span<const std::uint8_t> data);

    Bytes& out_;
    std::size_t pixel_;
    std::vector<Run> runs_;
    std::uint64_t bits_ = 0;  // not yet written, the lowest first
    int bit_count_ = 0;       // below 8 between calls
    std::uint32_t adler_ = 1;
};

// Lengths of a prefix code for symbols that occur so often, none longer than `most` bits; 0 for those that do not. Optimal
// where the bound does not bind. A single symbol gets one bit.
void code_lengths(std::span<const std::uint32_t> counts, int most, std::span<std::uint8_t> lengths);

}  // namespace penumbra
