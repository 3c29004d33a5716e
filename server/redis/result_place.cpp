// SPDX-License-Identifier: MIT
#include "server/redis/result_place.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "server/http/http_put.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 200;
constexpr int kPutTries = 3;
constexpr std::chrono::seconds kPutPatience{60};

bool write_all(int fd, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(fd, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

void sync_folder(const fs::path& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    ::fsync(fd);  // not every file system can; the file itself is safe
    ::close(fd);
}

// "" when the file is there for good.
std::string write_durably(const fs::path& path, std::span<const unsigned char> bytes) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const bool written = fd >= 0 && write_all(fd, bytes) && ::fsync(fd) == 0;
    const std::string why = written ? "" : std::strerror(errno);
    if (fd >= 0) ::close(fd);
    return why;
}

}  // namespace

std::string refuse_name(std::string_view name) {
    const std::string what = "\"" + std::string(name.substr(0, kLongestName)) + "\"";
    if (name.empty() || name.size() > kLongestName) return "a name has 1 to " + std::to_string(kLongestName) + " characters, not " + std::to_string(name.size());
    bool at_start = true;
    for (const char c : name) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        if (c == '/' ? at_start : !letter && (c != '.' || at_start)) return what + " is no name of a result: letters, digits, ._- and single slashes between";
        at_start = c == '/';
    }
    return at_start ? what + " names a folder" : "";
}

Delivery deliver_to_folder(const std::string& folder, const std::string& name, std::span<const unsigned char> bytes, const std::string& part) {
    const fs::path place = fs::path(folder) / name;
    const fs::path parent = place.parent_path();
    const std::string start = "." + place.filename().string() + ".part-";
    const fs::path unfinished = parent / (start + part);
    std::error_code error;
    fs::create_directories(parent, error);  // what is wrong with it the next line says
    std::string why = write_durably(unfinished, bytes);
    if (why.empty() && ::rename(unfinished.c_str(), place.c_str()) != 0) {
        // Another worker that had the job too has tidied up behind itself: then the picture is there.
        why = errno == ENOENT && fs::exists(place, error) ? "" : std::strerror(errno);
    }
    if (!why.empty()) {
        ::unlink(unfinished.c_str());
        return {false, false, "cannot write " + place.string() + ": " + why};
    }
    sync_folder(parent);
    // Workers that died while they wrote this picture left parts of it.
    for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().starts_with(start)) ::unlink(entry->path().c_str());
    }
    return {true, false, ""};
}

Delivery deliver_by_put(const std::string& url, std::span<const unsigned char> bytes, std::string_view media_type) {
    PutResult result;
    for (int i = 0; i < kPutTries; ++i) {
        if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(i * i * 300));
        result = http_put(url, bytes, media_type, kPutPatience);
        if (result.good || result.final) break;
    }
    return {result.good, result.final, result.why};
}

}  // namespace penumbra
