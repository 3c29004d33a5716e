// SPDX-License-Identifier: MIT
// penumbra submit: scenes into a Redis stream, for `penumbra worker`.
#include <signal.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/files.h"
#include "server/cli/redis_options.h"
#include "server/cli/scene_input.h"
#include "server/cli/scene_report.h"
#include "server/redis/result_place.h"

namespace penumbra {
namespace {

struct SubmitOptions {
    RedisOptions redis;
    std::vector<std::string> scenes, sets, fields;
    std::string name, folder, format, put;
    bool wait = false;
};

// Last entry of a stream: what is behind it is news.
std::string last_of(Redis& redis, const std::string& stream) {
    const RedisReply entries = redis.command({"XREVRANGE", stream, "+", "-", "COUNT", "1"});
    return entries.list.empty() ? "0-0" : entries.at(0).at(0).text;
}

std::vector<StreamFields> jobs_of(const SubmitOptions& options, const Engine& engine) {
    const SceneLimits limits = limits_of(Config{});
    const std::vector<Override> overrides = parse_sets(options.sets);
    if (!options.format.empty() && find_format(options.format) == nullptr) {
        throw InputError("--format takes one of " + format_names() + ", not " + options.format);
    }
    if (options.scenes.size() > 1 && (!options.name.empty() || !options.put.empty())) {
        throw InputError("--name and --put are of one scene; several have names by their files (--folder goes before)");
    }
    std::vector<StreamFields> jobs;
    bool good = true;
    for (const std::string& path : options.scenes) {
        const std::string text = read_text(path, limits.text.max_bytes);
        RenderRequest request;
        request.text = text;
        request.overrides = overrides;
        if (!options.format.empty()) request.formats = only_format(options.format);
        // The tone map's table and the font are the worker's matter: it may have what is not here.
        const CheckedScene checked = check_scene(request, limits, engine.unsupported_with({.tone_lut = true}));
        if (checked.failure != RenderFailure::none) {
            complain_about_scene(path, checked.problems, checked.problems_left_out);
            good = false;
            continue;
        }
        std::string name = options.name;
        if (name.empty() && path != "-") {
            const PictureFormat* format = find_format(checked.scene->output.format);
            name = options.folder + (options.folder.empty() || options.folder.ends_with('/') ? "" : "/") +
                   std::filesystem::path(path).stem().string() + std::string(format->extension);
        }
        if (!name.empty()) {
            if (const std::string why = refuse_name(name); !why.empty()) throw InputError(why);
        }
        StreamFields fields = {{"scene", text}};
        if (!name.empty()) fields.emplace_back("name", name);
        if (!options.format.empty()) fields.emplace_back("format", options.format);
        if (!options.put.empty()) fields.emplace_back("put", options.put);
        for (const std::string& set : options.sets) fields.emplace_back("set", set);
        for (const std::string& field : options.fields) {
            const std::size_t equals = field.find('=');
            if (equals == 0 || equals == std::string::npos) throw InputError("--field takes NAME=VALUE, not " + field);
            fields.emplace_back(field.substr(0, equals), field.substr(equals + 1));
        }
        jobs.push_back(std::move(fields));
    }
    if (!good) jobs.clear();  // all or none
    return jobs;
}

// Until each has come to its end; how many of them died.
std::size_t wait_for(Redis& redis, const StreamNames& names, std::map<std::string, std::string> waiting, std::string last_done, std::string last_dead) {
    constexpr std::chrono::milliseconds kPatience{1000};
    std::size_t dead = 0;
    while (!waiting.empty()) {
        const RedisReply news = redis.command({"XREAD", "COUNT", "100", "BLOCK", std::to_string(kPatience.count()), "STREAMS", names.done(),
                                               names.dead(), last_done, last_dead}, kPatience);
        for (const RedisReply& stream : news.list) {
            const bool is_dead = stream.at(0).text == names.dead();
            for (const RedisReply& entry : stream.at(1).list) {
                (is_dead ? last_dead : last_done) = entry.at(0).text;
                StreamFields fields;
                const std::vector<RedisReply>& list = entry.at(1).list;
                for (std::size_t i = 0; i + 1 < list.size(); i += 2) fields.emplace_back(list[i].text, list[i + 1].text);
                const auto found = waiting.find(std::string(field_of(fields, "job")));
                if (found == waiting.end()) continue;
                if (is_dead) {
                    ++dead;
                    complain(found->second + ": " + std::string(field_of(fields, "reason")));
                } else {
                    std::printf("%s done %s\n", found->first.c_str(), std::string(field_of(fields, "name")).c_str());
                    std::fflush(stdout);
                }
                waiting.erase(found);
            }
        }
    }
    return dead;
}

int submit(const SubmitOptions& options, const Engine& engine) {
    const RedisAddress address = address_of(options.redis);
    const std::vector<StreamFields> jobs = jobs_of(options, engine);
    if (jobs.empty()) return kBadInput;
    ::signal(SIGPIPE, SIG_IGN);
    Redis redis(address);
    const StreamNames& names = options.redis.names;
    const std::string last_done = last_of(redis, names.done()), last_dead = last_of(redis, names.dead());
    std::map<std::string, std::string> waiting;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::string id = submit_job(redis, names, jobs[i]);
        waiting.emplace(id, options.scenes[i]);
        std::printf("%s %s\n", id.c_str(), std::string(field_of(jobs[i], "name")).c_str());
    }
    std::fflush(stdout);
    if (!options.wait) return kSuccess;
    return wait_for(redis, names, std::move(waiting), last_done, last_dead) == 0 ? kSuccess : kWorldFailed;
}

}  // namespace

void add_submit_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("submit", "Put scenes into a Redis stream, for penumbra worker");
    auto options = std::make_shared<SubmitOptions>();
    add_redis_options(*command, options->redis);
    command->add_option("scenes", options->scenes, "Scene files, - for the standard input")->required();
    command->add_option("--name", options->name, "Name of the picture; else the scene's file with the format's extension");
    command->add_option("--folder", options->folder, "What goes before the names of the pictures");
    command->add_option("--format", options->format, "Picture format (" + format_names() + "); else the scene's");
    command->add_option("--put", options->put, "URL that takes the picture, signed perhaps; the workers' --put must be its beginning");
    command->add_option("--set", options->sets, "Replace a value of the scene: /json/pointer=value")->expected(1)->take_all();
    command->add_option("--field", options->fields, "NAME=VALUE, handed on to the note of what is done")->expected(1)->take_all();
    command->add_flag("--wait", options->wait, "Wait until all are rendered; ends with 1 when one is not");
    command->callback([&context, options] {
        context.run = [&context, options]() -> int {
            try {
                return submit(*options, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
