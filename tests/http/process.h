// SPDX-License-Identifier: MIT
// Running a program and catching what it says.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace penumbra::test {

using Environment = std::vector<std::pair<std::string, std::string>>;

struct Finished {
    int exit_code = -1;  // 128 + n: ended by signal n
    std::string out, err;
};

Finished run_program(const std::string& program, const std::vector<std::string>& arguments,
                     const std::string& input = "", const Environment& environment = {});

// A program that runs on. Killed when forgotten.
class Running {
public:
    Running(const std::string& program, const std::vector<std::string>& arguments,
            const Environment& environment = {});
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    void signal(int number) const;
    pid_t pid() const { return pid_; }
    int wait();  // exit code
    std::string err() const;

private:
    pid_t pid_ = -1;
    std::string err_file_;
};

// A folder for the files of one test, removed at the end.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string path(const std::string& name) const { return path_ + "/" + name; }
    std::string write(const std::string& name, const std::string& text) const;

private:
    std::string path_;
};

// The processes whose parent this is, without those that have ended.
std::vector<pid_t> children_of(pid_t parent);

std::string read_file(const std::string& path);  // "" when there is none
// The port that `serve --port-file` wrote, waiting for it; 0 when it does not come.
int wait_for_port(const std::string& port_file);

}  // namespace penumbra::test
