// SPDX-License-Identifier: MIT
// APPNOTE.TXT of PKWARE, 4.3.
#include "server/service/zip.h"

#include "core/image/gzip.h"

namespace penumbra {
namespace {

void put16(std::string& out, std::uint32_t value) {
    out += char(value & 0xff);
    out += char(value >> 8 & 0xff);
}
void put32(std::string& out, std::uint32_t value) {
    put16(out, value & 0xffff);
    put16(out, value >> 16);
}

// 1980-01-01: the same pictures make the same archive.
constexpr std::uint32_t kTime = 0, kDate = 0x21;
constexpr std::uint32_t kVersion = 20, kUtf8 = 0x800;

// What a file's head and its entry in the directory have in common.
std::string common(const std::string& name, std::string_view bytes) {
    std::string out;
    put16(out, kVersion);
    put16(out, kUtf8);
    put16(out, 0);  // stored
    put16(out, kTime);
    put16(out, kDate);
    put32(out, crc32(bytes));
    put32(out, std::uint32_t(bytes.size()));
    put32(out, std::uint32_t(bytes.size()));
    put16(out, std::uint32_t(name.size()));
    put16(out, 0);
    return out;
}

}  // namespace

std::string ZipWriter::file(const std::string& name, std::string_view bytes) {
    const std::string shared = common(name, bytes);
    std::string out = "PK\x03\x04" + shared + name;
    out += bytes;
    directory_ += "PK\x01\x02";
    put16(directory_, kVersion);
    directory_ += shared;
    put16(directory_, 0);  // comment
    put16(directory_, 0);  // disk
    put16(directory_, 0);  // internal attributes
    put32(directory_, 0);  // external attributes
    put32(directory_, at_);
    directory_ += name;
    at_ += std::uint32_t(out.size());
    ++count_;
    return out;
}

std::string ZipWriter::end() {
    std::string out = directory_ + "PK\x05\x06";
    put16(out, 0);
    put16(out, 0);
    put16(out, count_);
    put16(out, count_);
    put32(out, std::uint32_t(directory_.size()));
    put32(out, at_);
    put16(out, 0);
    return out;
}

}  // namespace penumbra
