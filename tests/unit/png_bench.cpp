// SPDX-License-Identifier: MIT
// png_bench PICTURE.png ...: the processor time and size of encode_png() beside those of the writer before it (RGB, filter SUB,
// libdeflate level 1), turn by turn. The figures of docs/decisions/0045.
#include <libdeflate.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/image/codec.h"

namespace {

using namespace penumbra;

double cpu_ms() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

std::size_t encode_as_before(const Image8& image) {
    const std::size_t row = std::size_t(image.width) * 3;
    Bytes filtered((row + 1) * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y) {
        const std::uint8_t* from = image.at(0, y);
        std::uint8_t* to = filtered.data() + std::size_t(y) * (row + 1);
        *to++ = 1;
        std::memcpy(to, from, 3);
        for (std::size_t i = 3; i < row; ++i) to[i] = std::uint8_t(from[i] - from[i - 3]);
    }
    libdeflate_compressor* const compressor = libdeflate_alloc_compressor(1);
    Bytes file(libdeflate_zlib_compress_bound(compressor, filtered.size()));
    const std::size_t size = libdeflate_zlib_compress(compressor, filtered.data(), filtered.size(), file.data(), file.size());
    libdeflate_free_compressor(compressor);
    file.resize(size);
    return size + 70 + (libdeflate_crc32(0, file.data(), size) & 0);
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%-16s %11s  %16s  %16s\n", "", "", "before", "now");
    for (int i = 1; i < argc; ++i) {
        std::ifstream stream(argv[i], std::ios::binary);
        const Bytes file{std::istreambuf_iterator<char>(stream), {}};
        const auto decoded = decode_png(file);
        const auto* texels = std::get_if<Texels>(&decoded);
        if (texels == nullptr) {
            std::fprintf(stderr, "%s: no PNG\n", argv[i]);
            return 1;
        }
        Image8 image(texels->width, texels->height, 3);
        for (std::size_t k = 0; k < image.data.size() / 3; ++k) std::memcpy(&image.data[3 * k], &texels->rgba[4 * k], 3);
        std::vector<double> before, now;
        std::size_t size_before = 0, size_now = 0;
        for (int turn = 0; turn < 15; ++turn) {
            const double start = cpu_ms();
            size_before = encode_as_before(image);
            const double middle = cpu_ms();
            size_now = encode_png(image).size();
            before.push_back(middle - start);
            now.push_back(cpu_ms() - middle);
        }
        const auto median = [](std::vector<double>& list) {
            std::nth_element(list.begin(), list.begin() + std::ptrdiff_t(list.size() / 2), list.end());
            return list[list.size() / 2];
        };
        std::printf("%-16s %5dx%-5d  %6.2f ms %7zu  %6.2f ms %7zu\n", std::filesystem::path(argv[i]).stem().c_str(), image.width,
                    image.height, median(before), size_before, median(now), size_now);
    }
}
