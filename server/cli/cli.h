// SPDX-License-Identifier: MIT
// The command line: what every command shares. A command is one file with one function that adds it;
// main.cpp lists them, one line each.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "server/service/engine.h"

namespace CLI {
class App;
}

namespace penumbra {

// Exit codes, the same for every command.
enum ExitCode : int {
    kSuccess = 0,
    kWorldFailed = 1,  // no device, no memory, no disk, no network
    kBadInput = 2,     // the command line or the scene
};

// What a command is given. `run` is called after the whole command line has been read.
struct CommandContext {
    const Engine& engine;
    std::function<int()> run;
};

// Adds a subcommand to `app`, whose callback sets `context.run`.
using AddCommand = void (*)(CLI::App& app, CommandContext& context);

// Parses and runs; every failure ends as lines on stderr and an exit code.
int run_cli(int argc, char** argv, const Engine& engine, std::span<const AddCommand> commands);

// "penumbra: TEXT" on stderr.
void complain(std::string_view text);

}  // namespace penumbra
