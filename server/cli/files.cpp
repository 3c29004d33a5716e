// SPDX-License-Identifier: MIT
#include "server/cli/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace penumbra {
namespace {

std::string reason() { return std::strerror(errno); }

class Descriptor {
public:
    explicit Descriptor(int fd, bool owned = true) : fd_(fd), owned_(owned) {}
    ~Descriptor() {
        if (owned_ && fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    bool close() {
        owned_ = false;
        return ::close(fd_) == 0;
    }

private:
    int fd_;
    bool owned_;
};

bool write_all(int fd, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(fd, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes = bytes.subspan(std::size_t(count));
    }
    return true;
}

mode_t file_mode() {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
}

void write_directly(const std::string& path, std::span<const unsigned char> bytes) {
    const Descriptor file(path == "-" ? STDOUT_FILENO : ::open(path.c_str(), O_WRONLY | O_CLOEXEC), path != "-");
    if (file.get() < 0 || !write_all(file.get(), bytes)) {
        throw std::runtime_error("cannot write " + (path == "-" ? "to the standard output" : path) + ": " + reason());
    }
}

}  // namespace

std::string read_text(const std::string& path, std::size_t max_bytes) {
    const Descriptor file(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC), path != "-");
    const std::string name = path == "-" ? "the standard input" : path;
    if (file.get() < 0) throw InputError("cannot read " + name + ": " + reason());
    std::string text;
    std::vector<char> block(64u << 10);
    while (true) {
        const ssize_t count = ::read(file.get(), block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw InputError("cannot read " + name + ": " + reason());
        if (count == 0) return text;
        text.append(block.data(), std::size_t(count));
        if (text.size() > max_bytes) {
            throw InputError(name + " is longer than " + std::to_string(max_bytes) + " bytes");
        }
    }
}

void write_file(const std::string& path, std::span<const unsigned char> bytes) {
    struct stat info {};
    if (path == "-" || (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode))) {
        write_directly(path, bytes);
        return;
    }
    std::string temporary = path + ".XXXXXX";
    Descriptor file(::mkstemp(temporary.data()));
    if (file.get() < 0) throw std::runtime_error("cannot write " + path + ": " + reason());
    const bool written =
        write_all(file.get(), bytes) && ::fchmod(file.get(), file_mode()) == 0 && file.close() &&
        ::rename(temporary.c_str(), path.c_str()) == 0;
    if (!written) {
        const std::string why = reason();
        ::unlink(temporary.c_str());
        throw std::runtime_error("cannot write " + path + ": " + why);
    }
}

void write_text(const std::string& path, const std::string& text) {
    write_file(path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

bool stdout_is_terminal() { return ::isatty(STDOUT_FILENO) == 1; }

}  // namespace penumbra
