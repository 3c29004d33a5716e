// SPDX-License-Identifier: MIT
// A ZIP archive, file by file as they come; nothing is compressed, since pictures are. At most 4 GiB and 65,535 files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {

class ZipWriter {
public:
    std::string file(const std::string& name, std::string_view bytes);
    std::string end();

private:
    std::string directory_;
    std::uint32_t at_ = 0;
    std::uint16_t count_ = 0;
};

}  // namespace penumbra
