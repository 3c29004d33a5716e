// SPDX-License-Identifier: MIT
#include "process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace penumbra::test {
namespace {

std::string temporary_name() {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-http-XXXXXX").string();
    const int fd = ::mkstemp(name.data());
    if (fd >= 0) ::close(fd);
    return name;
}

pid_t start(const std::string& program, const std::vector<std::string>& arguments, const std::string& in,
            const std::string& out, const std::string& err, const Environment& environment) {
    // All that allocates is done before the fork: other threads may hold the allocator's lock.
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    std::vector<std::string> variables;
    for (char** entry = environ; *entry; ++entry) variables.emplace_back(*entry);
    for (const auto& [name, value] : environment) {
        std::erase_if(variables, [start = name + "="](const std::string& old) { return old.starts_with(start); });
        variables.push_back(name + "=" + value);
    }
    std::vector<char*> envp;
    for (std::string& variable : variables) envp.push_back(variable.data());
    envp.push_back(nullptr);

    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    const int in_fd = ::open(in.c_str(), O_RDONLY);
    const int out_fd = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_fd = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(in_fd, 0);
    ::dup2(out_fd, 1);
    ::dup2(err_fd, 2);
    ::execve(program.c_str(), argv.data(), envp.data());
    ::_exit(127);
}

int wait_for(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::string read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

Finished run_program(const std::string& program, const std::vector<std::string>& arguments,
                     const std::string& input, const Environment& environment) {
    const std::string in = temporary_name(), out = temporary_name(), err = temporary_name();
    std::ofstream(in, std::ios::binary) << input;
    Finished finished;
    finished.exit_code = wait_for(start(program, arguments, in, out, err, environment));
    finished.out = read_file(out);
    finished.err = read_file(err);
    for (const std::string& name : {in, out, err}) std::filesystem::remove(name);
    return finished;
}

Running::Running(const std::string& program, const std::vector<std::string>& arguments,
                 const Environment& environment)
    : err_file_(temporary_name()) {
    pid_ = start(program, arguments, "/dev/null", "/dev/null", err_file_, environment);
}

Running::~Running() {
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        wait();
    }
    std::filesystem::remove(err_file_);
}

void Running::signal(int number) const { ::kill(pid_, number); }

int Running::wait() {
    const int code = wait_for(pid_);
    pid_ = -1;
    return code;
}

std::string Running::err() const { return read_file(err_file_); }

TemporaryFolder::TemporaryFolder() {
    path_ = (std::filesystem::temp_directory_path() / "penumbra-http-XXXXXX").string();
    if (!::mkdtemp(path_.data())) std::abort();
}

TemporaryFolder::~TemporaryFolder() { std::filesystem::remove_all(path_); }

std::string TemporaryFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
}

std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string stat = read_file(entry.path() / "stat");
        const std::size_t end = stat.rfind(')');
        if (end == std::string::npos) continue;
        char state = 0;
        int of = 0;
        std::istringstream(stat.substr(end + 1)) >> state >> of;
        if (of == parent && state != 'Z' && state != 'X') children.push_back(std::stoi(name));
    }
    return children;
}

int wait_for_port(const std::string& port_file) {
    // A first start compiles, on a slow machine or under sanitizers for more than 20 s.
    for (int i = 0; i < 4000; ++i) {
        const std::string text = read_file(port_file);
        if (text.ends_with('\n')) return std::atoi(text.c_str());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return 0;
}

}  // namespace penumbra::test
