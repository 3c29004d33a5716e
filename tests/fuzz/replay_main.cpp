// SPDX-License-Identifier: MIT
// Puts files through a fuzz target without a fuzzer: any compiler, in the ordinary suite.
//
//   fuzz_TARGET FILE-OR-FOLDER ...     exits with 0 when every promise held for every file
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "check.h"

namespace {

namespace fs = std::filesystem;

char g_current[512] = "";  // for the signal handler

// Which file it was, where the program ends without a word.
void tell_and_end(int signal_number) {
    const auto say = [](const char* text) { [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, text, std::strlen(text)); };
    say("ended while replaying ");
    say(g_current);
    say("\n");
    ::signal(signal_number, SIG_DFL);
    ::raise(signal_number);
}

std::vector<fs::path> files_of(int argc, char** argv) {
    std::vector<fs::path> files;
    for (int i = 1; i < argc; ++i) {
        if (!fs::is_directory(argv[i])) {
            files.emplace_back(argv[i]);
            continue;
        }
        for (const auto& entry : fs::recursive_directory_iterator(argv[i])) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

int main(int argc, char** argv) {
    for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) ::signal(number, tell_and_end);
    const std::vector<fs::path> files = files_of(argc, argv);
    double slowest_ms = 0;
    std::string slowest;
    for (const fs::path& path : files) {
        std::snprintf(g_current, sizeof g_current, "%s", path.c_str());
        std::ifstream file(path, std::ios::binary);
        if (!file) {
            std::fprintf(stderr, "cannot read %s\n", path.c_str());
            return 1;
        }
        const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        const auto start = std::chrono::steady_clock::now();
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        if (ms > slowest_ms) {
            slowest_ms = ms;
            slowest = path.filename();
        }
    }
    std::printf("%zu files, the slowest %s: %.1f ms\n", files.size(), slowest.c_str(), slowest_ms);
    return files.empty() ? 1 : 0;  // a corpus that is not found tests nothing
}
