// SPDX-License-Identifier: MIT
// penumbra sign-url: a scene as an address that the service answers with its picture.
#include <cstdio>
#include <ctime>
#include <memory>

#include <CLI/CLI.hpp>

#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/files.h"
#include "server/http/access.h"

namespace penumbra {
namespace {

struct SignUrl {
    std::string scene, key_file, base = "http://127.0.0.1:8080";
    long expires_in_s = 86400;
};

// What the service and most of what lies before it take.
constexpr std::size_t kLongestTarget = 8000;

int sign_url(const SignUrl& options) {
    if (options.key_file.empty()) {
        complain("--url-key-file is missing");
        return kBadInput;
    }
    try {
        const std::string key = read_key(options.key_file);
        const std::string scene = read_text(options.scene, std::size_t(1) << 20);
        const std::string target = signed_target(key, scene, options.expires_in_s > 0 ? std::time(nullptr) + options.expires_in_s : 0);
        if (target.size() > kLongestTarget) {
            complain("the address would have " + std::to_string(target.size()) + " characters, " + std::to_string(kLongestTarget) +
                     " are possible: send such a scene by POST");
            return kBadInput;
        }
        std::printf("%s%s\n", options.base.c_str(), target.c_str());
        return kSuccess;
    } catch (const InputError& error) {
        complain(error.what());
        return kBadInput;
    }
}

}  // namespace

void add_sign_url_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("sign-url", "Sign an address that shows a scene's picture");
    auto options = std::make_shared<SignUrl>();
    command->add_option("scene", options->scene, "Scene, or - for the standard input")->required();
    command->add_option("--url-key-file", options->key_file, "File of the key, as given to penumbra serve")->envname("PENUMBRA_URL_KEY_FILE");
    command->add_option("--expires", options->expires_in_s, "Seconds until it works no longer; 0 is never")
        ->check(whole_number(0, 10L * 366 * 86400))
        ->capture_default_str();
    command->add_option("--base", options->base, "What stands before the path")->capture_default_str();
    command->callback([&context, options] { context.run = [options] { return sign_url(*options); }; });
}

}  // namespace penumbra
