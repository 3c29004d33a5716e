// SPDX-License-Identifier: MIT
#include "server/service/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/scene/wording.h"
#include "server/json/json_tree.h"
#include "server/json/tree_parser.h"

namespace penumbra {
namespace {

constexpr std::string_view kBlock = "/animate";
constexpr std::size_t kMostTracks = 64, kMostKeys = 1000, kMostNumbers = 16;

enum class Ease { linear, smooth, step };

struct Key {
    double time = 0;
    std::vector<double> values;
};

struct Track {
    std::string pointer;
    std::vector<Key> keys;
    bool list = false;
    Ease ease = Ease::linear;
};

std::string number(double value) { return number_text(value); }

// What of the text stands for a value: from its first byte to its last.
std::string_view text_of(std::string_view text, const JsonTree& tree, NodeId id) {
    // Its end is not kept: the shortest piece that is a value.
    const std::string_view rest = text.substr(tree[id].offset);
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const char c = rest[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
            if (c == '"' && depth == 0) return rest.substr(0, i + 1);
            continue;
        }
        if (c == '"') quoted = true;
        if (c == '[' || c == '{') ++depth;
        if (c == ']' || c == '}') --depth;
        const bool ends = depth == 0 && (c == ']' || c == '}');
        if (ends) return rest.substr(0, i + 1);
        if (depth < 0 || (depth == 0 && (c == ',' || c == ' ' || c == '\n' || c == '\r' || c == '\t'))) return rest.substr(0, i);
    }
    return rest;
}

class Reader {
public:
    Reader(std::string_view text, const JsonTree& tree, const AnimationLimits& limits) : text_(text), tree_(tree), limits_(limits) {}

    std::optional<Animation> read() {
        NodeId block = kNoNode, before = kNoNode;
        for (NodeId id = tree_.root().first_child; id != kNoNode; id = tree_[id].next_sibling) {
            if (tree_[id].key == "animate") {
                block = id;
                break;
            }
            before = id;
        }
        if (block == kNoNode || tree_[block].kind != NodeKind::object) {
            complain(std::string(kBlock), block == kNoNode ? tree_.root().offset : tree_[block].offset, block == kNoNode ? "missing" : "wrong_type",
                     block == kNoNode ? "is missing: it says what changes from frame to frame" : "must be an object");
            return std::nullopt;
        }
        Animation animation;
        animation.scene = without(block, before);
        std::vector<Track> tracks;
        std::vector<std::pair<std::string, std::vector<std::string>>> lists;
        std::optional<double> frames;
        for (NodeId id = tree_[block].first_child; id != kNoNode; id = tree_[id].next_sibling) {
            const std::string pointer = std::string(kBlock) + "/" + std::string(tree_[id].key);
            if (tree_[id].key == "frames") frames = whole(id, pointer, 1, double(limits_.max_frames));
            else if (tree_[id].key == "fps") animation.fps = ranged(id, pointer, 0.1, limits_.max_fps).value_or(animation.fps);
            else if (tree_[id].key == "plays") animation.plays = int(whole(id, pointer, 0, 65535).value_or(0));
            else if (tree_[id].key == "tracks") read_tracks(id, pointer, tracks);
            else if (tree_[id].key == "vary") read_lists(id, pointer, lists);
            else complain_key(id, pointer);
        }
        if (problems_.empty() && tracks.empty() == lists.empty()) {
            complain(std::string(kBlock), tree_[block].offset, "conflict", "has either \"tracks\", which move values, or \"vary\", which lists them");
        }
        if (problems_.empty() && !tracks.empty() && !frames) complain(std::string(kBlock) + "/frames", tree_[block].offset, "missing", "is missing");
        if (problems_.empty() && !lists.empty() && frames) {
            complain(std::string(kBlock) + "/frames", tree_[tree_.child(block, "frames")].offset, "conflict",
                     "is not for \"vary\": there is a frame for each combination of its values");
        }
        if (!problems_.empty()) return std::nullopt;
        if (!tracks.empty()) move(tracks, std::size_t(*frames), animation);
        if (!lists.empty() && !combine(lists, tree_[block].offset, animation)) return std::nullopt;
        return animation;
    }

    std::vector<LocatedProblem> take_problems() { return std::move(problems_); }

private:
    void complain(const std::string& pointer, TextOffset offset, const char* code, const std::string& message, const std::string& suggestion = "") {
        LocatedProblem problem;
        problem.problem = {pointer, code, message};
        const auto before = text_.substr(0, offset);
        problem.line = 1 + int(std::count(before.begin(), before.end(), '\n'));
        const std::size_t line_start = before.rfind('\n');
        problem.column = int(before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1)) + 1;
        problem.suggestion = suggestion;
        problems_.push_back(std::move(problem));
    }
    void complain_key(NodeId id, const std::string& pointer) {
        static constexpr std::array<std::string_view, 5> kKeys{"frames", "fps", "plays", "tracks", "vary"};
        const std::string near(nearest_word(tree_[id].key, std::vector<std::string_view>(kKeys.begin(), kKeys.end())));
        complain(pointer, tree_[id].key_offset, "unknown_key", in_quotes(tree_[id].key) + " is not a key of an animation" + did_you_mean(near), near);
    }

    // Everything else stays in its line and column, so that problems of the scene are told at their place.
    std::string without(NodeId block, NodeId before) const {
        std::string scene(text_);
        const auto blank = [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) {
                if (scene[i] != '\n' && scene[i] != '\r') scene[i] = ' ';
            }
        };
        const NodeId next = tree_[block].next_sibling;
        if (next != kNoNode) {
            blank(tree_[block].key_offset, tree_[next].key_offset);
            return scene;
        }
        const std::size_t end = tree_[block].offset + text_of(text_, tree_, block).size();
        std::size_t from = tree_[block].key_offset;
        if (before != kNoNode) from = scene.rfind(',', from);
        blank(from, end);
        return scene;
    }

    std::optional<double> ranged(NodeId id, const std::string& pointer, double low, double high) {
        if (tree_[id].kind != NodeKind::number) {
            complain(pointer, tree_[id].offset, "wrong_type", "must be a number");
        } else if (tree_[id].number < low || tree_[id].number > high) {
            complain(pointer, tree_[id].offset, "out_of_range", "must be from " + number(low) + " to " + number(high) + ", is " + number(tree_[id].number));
        } else {
            return tree_[id].number;
        }
        return std::nullopt;
    }
    std::optional<double> whole(NodeId id, const std::string& pointer, double low, double high) {
        const std::optional<double> value = ranged(id, pointer, low, high);
        if (value && *value != std::floor(*value)) {
            complain(pointer, tree_[id].offset, "wrong_type", "must be a whole number");
            return std::nullopt;
        }
        return value;
    }
    bool is_list(NodeId id, const std::string& pointer, std::size_t most) {
        if (tree_[id].kind != NodeKind::array || tree_[id].child_count == 0) {
            complain(pointer, tree_[id].offset, "wrong_type", "must be a list with something in it");
        } else if (tree_[id].child_count > most) {
            complain(pointer, tree_[id].offset, "too_many", "has " + std::to_string(tree_[id].child_count) + " entries, " + std::to_string(most) + " are possible");
        } else {
            return true;
        }
        return false;
    }
    // The pointer that a track or a list is for; "" with a complaint.
    std::string target(NodeId id, const std::string& pointer) {
        const NodeId member = tree_[id].kind == NodeKind::object ? tree_.child(id, "pointer") : kNoNode;
        if (member == kNoNode || tree_[member].kind != NodeKind::string || !tree_[member].string.starts_with('/')) {
            complain(pointer + "/pointer", tree_[member == kNoNode ? id : member].offset, member == kNoNode ? "missing" : "wrong_type",
                     "must be the JSON pointer of what changes, such as \"/shapes/0/radius\"");
            return "";
        }
        return std::string(tree_[member].string);
    }
    void only_keys(NodeId id, const std::string& pointer, std::vector<std::string_view> known) {
        for (NodeId member = tree_[id].first_child; member != kNoNode; member = tree_[member].next_sibling) {
            if (std::find(known.begin(), known.end(), tree_[member].key) != known.end()) continue;
            const std::string near(nearest_word(tree_[member].key, known));
            complain(pointer + "/" + std::string(tree_[member].key), tree_[member].key_offset, "unknown_key",
                     in_quotes(tree_[member].key) + " is not a key here" + did_you_mean(near), near);
        }
    }

    void read_tracks(NodeId id, const std::string& pointer, std::vector<Track>& tracks) {
        if (!is_list(id, pointer, kMostTracks)) return;
        std::size_t index = 0;
        for (NodeId entry = tree_[id].first_child; entry != kNoNode; entry = tree_[entry].next_sibling, ++index) {
            const std::string here = pointer + "/" + std::to_string(index);
            Track track;
            track.pointer = target(entry, here);
            if (track.pointer.empty()) continue;
            only_keys(entry, here, {"pointer", "keys", "ease"});
            if (const NodeId ease = tree_.child(entry, "ease"); ease != kNoNode) {
                const std::string_view word = tree_[ease].kind == NodeKind::string ? tree_[ease].string : std::string_view();
                if (word == "smooth") track.ease = Ease::smooth;
                else if (word == "step") track.ease = Ease::step;
                else if (word != "linear") complain(here + "/ease", tree_[ease].offset, "unknown_value", "must be \"linear\", \"smooth\" or \"step\"");
            }
            const NodeId keys = tree_.child(entry, "keys");
            if (keys == kNoNode) {
                complain(here + "/keys", tree_[entry].offset, "missing", "is missing");
                continue;
            }
            if (is_list(keys, here + "/keys", kMostKeys)) read_keys(keys, here + "/keys", track);
            tracks.push_back(std::move(track));
        }
    }

    // [time, value]: a number, or a list of numbers; times grow from 0 to 1.
    void read_keys(NodeId id, const std::string& pointer, Track& track) {
        std::size_t index = 0;
        for (NodeId pair = tree_[id].first_child; pair != kNoNode; pair = tree_[pair].next_sibling, ++index) {
            const std::string here = pointer + "/" + std::to_string(index);
            const bool two = tree_[pair].kind == NodeKind::array && tree_[pair].child_count == 2;
            const NodeId time = two ? tree_[pair].first_child : kNoNode;
            const NodeId value = two ? tree_[time].next_sibling : kNoNode;
            if (!two || tree_[time].kind != NodeKind::number) {
                complain(here, tree_[pair].offset, "wrong_type", "must be [time, value]");
                return;
            }
            Key key;
            key.time = tree_[time].number;
            const double least = track.keys.empty() ? 0 : track.keys.back().time;
            if (key.time < least || key.time > 1) {
                complain(here + "/0", tree_[time].offset, "out_of_range", "must be from " + number(least) + " to 1, is " + number(key.time));
                return;
            }
            const bool list = tree_[value].kind == NodeKind::array;
            bool numbers = list ? tree_[value].child_count > 0 && tree_[value].child_count <= kMostNumbers : tree_[value].kind == NodeKind::number;
            if (!list) key.values.push_back(tree_[value].number);
            for (NodeId one = list ? tree_[value].first_child : kNoNode; one != kNoNode && numbers; one = tree_[one].next_sibling) {
                numbers = tree_[one].kind == NodeKind::number;
                key.values.push_back(tree_[one].number);
            }
            const bool alike = track.keys.empty() || (list == track.list && key.values.size() == track.keys.front().values.size());
            if (!numbers || !alike) {
                complain(here + "/1", tree_[value].offset, "wrong_type", "must be a number, or a list of numbers, as in the other keys; \"vary\" takes other values");
                return;
            }
            track.list = list;
            track.keys.push_back(std::move(key));
        }
    }

    void read_lists(NodeId id, const std::string& pointer, std::vector<std::pair<std::string, std::vector<std::string>>>& lists) {
        if (!is_list(id, pointer, kMostTracks)) return;
        std::size_t index = 0;
        for (NodeId entry = tree_[id].first_child; entry != kNoNode; entry = tree_[entry].next_sibling, ++index) {
            const std::string here = pointer + "/" + std::to_string(index);
            const std::string to = target(entry, here);
            if (to.empty()) continue;
            only_keys(entry, here, {"pointer", "values"});
            const NodeId values = tree_.child(entry, "values");
            if (values == kNoNode) {
                complain(here + "/values", tree_[entry].offset, "missing", "is missing");
                continue;
            }
            if (!is_list(values, here + "/values", limits_.max_frames)) continue;
            std::vector<std::string> texts;
            for (NodeId value = tree_[values].first_child; value != kNoNode; value = tree_[value].next_sibling) {
                texts.emplace_back(text_of(text_, tree_, value));
            }
            lists.emplace_back(to, std::move(texts));
        }
    }

    static std::string value_at(const Track& track, double time) {
        const auto after = std::upper_bound(track.keys.begin(), track.keys.end(), time, [](double t, const Key& key) { return t < key.time; });
        const Key& to = after == track.keys.end() ? track.keys.back() : *after;
        const Key& from = after == track.keys.begin() ? to : *(after - 1);
        double share = to.time > from.time ? std::clamp((time - from.time) / (to.time - from.time), 0.0, 1.0) : 0;
        if (track.ease == Ease::smooth) share = share * share * (3 - 2 * share);
        if (track.ease == Ease::step) share = 0;
        std::string text;
        for (std::size_t i = 0; i < from.values.size(); ++i) {
            text += (text.empty() ? "" : ", ") + number(from.values[i] + share * (to.values[i] - from.values[i]));
        }
        return track.list ? "[" + text + "]" : text;
    }

    static void add_frame(std::vector<Override> overrides, Animation& animation) {
        std::string values;
        for (const Override& one : overrides) {
            values += (values.empty() ? "{" : ", ") + nlohmann::json(one.pointer).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + ": " + one.value;
        }
        std::erase_if(values, [](char c) { return c == '\n' || c == '\r'; });
        animation.values.push_back(values + "}");
        animation.frames.push_back(std::move(overrides));
    }

    static void move(const std::vector<Track>& tracks, std::size_t frames, Animation& animation) {
        for (std::size_t i = 0; i < frames; ++i) {
            const double time = frames > 1 ? double(i) / double(frames - 1) : 0;
            std::vector<Override> overrides;
            for (const Track& track : tracks) overrides.push_back({track.pointer, value_at(track, time)});
            add_frame(std::move(overrides), animation);
        }
    }

    // The last list changes fastest.
    bool combine(const std::vector<std::pair<std::string, std::vector<std::string>>>& lists, TextOffset offset, Animation& animation) {
        double count = 1;
        for (const auto& list : lists) count *= double(list.second.size());
        if (count > double(limits_.max_frames)) {
            complain(std::string(kBlock) + "/vary", offset, "too_many", "makes " + number(count) + " frames, " + std::to_string(limits_.max_frames) + " are possible");
            return false;
        }
        for (std::size_t i = 0; i < std::size_t(count); ++i) {
            std::vector<Override> overrides(lists.size());
            std::size_t rest = i;
            for (std::size_t j = lists.size(); j-- > 0;) {
                const auto& [pointer, values] = lists[j];
                overrides[j] = {pointer, values[rest % values.size()]};
                rest /= values.size();
            }
            add_frame(std::move(overrides), animation);
        }
        return true;
    }

    std::string_view text_;
    const JsonTree& tree_;
    const AnimationLimits& limits_;
    std::vector<LocatedProblem> problems_;
};

}  // namespace

ParsedAnimation parse_animation(std::string_view text, const TextLimits& limits, const AnimationLimits& animation_limits) {
    ParsedAnimation parsed;
    JsonTree tree;
    const ParsedText read = parse_text(text, limits, tree);
    if (read.error || tree.empty() || tree.root().kind != NodeKind::object) {
        // Told by the parser of scenes, which says it best.
        ParsedScene scene = parse_scene(text, {}, limits);
        parsed.problems = std::move(scene.problems);
        parsed.is_json = scene.is_json;
        return parsed;
    }
    Reader reader(text, tree, animation_limits);
    parsed.animation = reader.read();
    parsed.problems = reader.take_problems();
    return parsed;
}

}  // namespace penumbra
