// SPDX-License-Identifier: MIT
#include "core/image/png_layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace penumbra {
namespace {

constexpr std::size_t kMostColours = 256;
constexpr std::uint32_t kOpaque = 0xff000000;

std::size_t pixels_of(const Image8& image) { return std::size_t(image.width) * std::size_t(image.height); }

// Whether `test` holds for all rows; asks no further than the first that fails.
template <class Test>
bool all_rows(const Image8& image, const Test& test) {
    for (int y = 0; y < image.height; ++y) {
        if (!test(image.at(0, y))) return false;
    }
    return true;
}

bool is_opaque(const Image8& image) {
    if (image.channels != 4) return true;
    return all_rows(image, [&](const std::uint8_t* row) {
        unsigned all = 255;
        for (int x = 0; x < image.width; ++x) all &= row[4 * x + 3];
        return all == 255;
    });
}

bool is_grey(const Image8& image) {
    if (image.channels == 1) return true;
    const int step = image.channels;
    return all_rows(image, [&](const std::uint8_t* row) {
        unsigned difference = 0;
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = row + step * x;
            difference |= unsigned(p[0] ^ p[1]) | unsigned(p[1] ^ p[2]);
        }
        return difference == 0;
    });
}

// The fewest bits whose steps hold every grey value: 255, 85 or 17 apart.
int grey_depth(const Image8& image) {
    std::array<bool, 256> used{};
    const std::size_t step = std::size_t(image.channels);
    for (std::size_t i = 0; i < image.data.size(); i += step) used[image.data[i]] = true;
    for (const int depth : {1, 2, 4}) {
        const std::size_t apart = 255u / ((1u << depth) - 1);
        bool fits = true;
        for (std::size_t value = 0; value < used.size(); ++value) fits = fits && (!used[value] || value % apart == 0);
        if (fits) return depth;
    }
    return 8;
}

std::uint32_t load(const std::uint8_t* pixel, int channels) {
    if (channels == 1) return pixel[0] * 0x010101u | kOpaque;
    const std::uint32_t rgb = pixel[0] | std::uint32_t(pixel[1]) << 8 | std::uint32_t(pixel[2]) << 16;
    return rgb | (channels == 4 ? std::uint32_t(pixel[3]) << 24 : kOpaque);
}

// Fills palette and indices; false as soon as there are more than `most` colours.
bool find_palette(const Image8& image, std::size_t most, PngLayout& layout) {
    constexpr int kSlotBits = 10;
    std::array<std::uint32_t, 1u << kSlotBits> slots;
    std::array<std::int16_t, 1u << kSlotBits> slot_index;
    slot_index.fill(-1);
    std::vector<std::uint32_t>& palette = layout.palette;
    Bytes& indices = layout.indices;
    palette.clear();
    indices.clear();
    const std::size_t count = pixels_of(image);
    indices.resize(count);
    const std::uint8_t* from = image.data.data();
    std::uint32_t last = ~load(from, image.channels);
    std::uint8_t last_index = 0;
    for (std::size_t i = 0; i < count; ++i, from += image.channels) {
        const std::uint32_t colour = load(from, image.channels);
        if (colour != last) {
            last = colour;
            std::size_t slot = (colour * 0x9e3779b1u) >> (32 - kSlotBits);
            while (slot_index[slot] >= 0 && slots[slot] != colour) slot = (slot + 1) % slots.size();
            if (slot_index[slot] < 0) {
                if (palette.size() == most) return false;
                slots[slot] = colour;
                slot_index[slot] = std::int16_t(palette.size());
                palette.push_back(colour);
            }
            last_index = std::uint8_t(slot_index[slot]);
        }
        indices[i] = last_index;
    }
    return true;
}

// tRNS names the alpha of the first entries only.
void put_transparent_first(PngLayout& layout) {
    std::vector<std::uint8_t> order(layout.palette.size());
    std::iota(order.begin(), order.end(), std::uint8_t(0));
    std::stable_partition(order.begin(), order.end(), [&](std::uint8_t i) { return layout.palette[i] < kOpaque; });
    std::vector<std::uint32_t> palette;
    std::array<std::uint8_t, kMostColours> place{};
    for (const std::uint8_t i : order) {
        place[i] = std::uint8_t(palette.size());
        palette.push_back(layout.palette[i]);
    }
    layout.palette = std::move(palette);
    for (std::uint8_t& index : layout.indices) index = place[index];
}

int palette_depth(std::size_t colours) { return colours <= 2 ? 1 : colours <= 4 ? 2 : colours <= 16 ? 4 : 8; }

}  // namespace

std::size_t PngLayout::bits_per_pixel() const {
    switch (colour) {
        case Colour::rgb: return 24;
        case Colour::rgba: return 32;
        case Colour::grey_alpha: return 16;
        default: return std::size_t(bit_depth);
    }
}

PngLayout choose_png_layout(const Image8& image) {
    using Form = PngLayout::Colour;
    PngLayout layout;
    const bool opaque = is_opaque(image);
    const bool grey = is_grey(image);
    layout.colour = grey ? (opaque ? Form::grey : Form::grey_alpha) : (opaque ? Form::rgb : Form::rgba);
    if (layout.colour == Form::grey) layout.bit_depth = grey_depth(image);
    if (layout.colour == Form::grey && layout.bit_depth < 8) return layout;
    // A palette of more than 16 greys would take as many bits as the values themselves.
    const std::size_t most = layout.colour == Form::grey ? 16 : kMostColours;
    if (find_palette(image, most, layout)) {
        const int depth = palette_depth(layout.palette.size());
        const std::size_t entry = 3 + (opaque ? 0 : 1);
        const std::size_t saved = pixels_of(image) * (layout.bits_per_pixel() - std::size_t(depth)) / 8;
        // Twice its bytes, since what is saved would have been compressed.
        if (saved > 2 * (layout.palette.size() * entry + 24)) {
            layout.colour = Form::palette;
            layout.bit_depth = depth;
            if (!opaque) put_transparent_first(layout);
            return layout;
        }
    }
    layout.palette.clear();
    layout.indices.clear();
    return layout;
}

void pack_png_row(const Image8& image, const PngLayout& layout, int y, std::uint8_t* row) {
    const std::size_t width = std::size_t(image.width);
    const std::size_t step = std::size_t(image.channels);
    const std::uint8_t* from = image.at(0, y);
    const std::size_t bytes = layout.bits_per_pixel() / 8;  // 0: less than one
    const bool indexed = layout.colour == PngLayout::Colour::palette;
    if (indexed) from = layout.indices.data() + std::size_t(y) * width;
    if (bytes > 0 && (indexed || bytes == step)) {
        std::memcpy(row, from, width * bytes);
    } else if (layout.colour == PngLayout::Colour::rgb) {
        for (std::size_t x = 0; x < width; ++x) std::memcpy(row + 3 * x, from + 4 * x, 3);
    } else if (layout.colour == PngLayout::Colour::grey_alpha) {
        for (std::size_t x = 0; x < width; ++x) {
            row[2 * x] = from[4 * x];
            row[2 * x + 1] = from[4 * x + 3];
        }
    } else if (bytes == 1) {
        for (std::size_t x = 0; x < width; ++x) row[x] = from[step * x];
    } else {
        const std::size_t depth = std::size_t(layout.bit_depth), stride = indexed ? 1 : step;
        const std::size_t drop = indexed ? 0 : 8 - depth;  // of a grey value, whose high bits say all
        std::memset(row, 0, (width * depth + 7) / 8);
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t bit = x * depth;
            row[bit / 8] = std::uint8_t(row[bit / 8] | (from[stride * x] >> drop) << (8 - depth - bit % 8));
        }
    }
}

}  // namespace penumbra
