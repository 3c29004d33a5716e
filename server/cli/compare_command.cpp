// SPDX-License-Identifier: MIT
// penumbra compare: how far a picture is from another. For scripts and pixel-diff tests: exit code 1 when a bound is
// exceeded, as diff and cmp do.
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <variant>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/compare/difference_picture.h"
#include "core/compare/error_figures.h"
#include "core/compare/flip.h"
#include "core/image/codec.h"
#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/files.h"
#include "server/cli/picture_input.h"
#include "server/service/formats.h"

namespace penumbra {
namespace {

using nlohmann::ordered_json;

struct Bound {
    const char* figure;
    const char* option;
    const char* help;
    bool at_least = false;  // else at most
    std::optional<double> value;
};

struct CompareOptions {
    std::string a, b, diff;
    bool json = false;
    double pixels_per_degree = FlipOptions{}.pixels_per_degree;
    std::vector<Bound> bounds = {
        {"nrmse", "--max-nrmse", "Linear: root mean square error over the mean of B", false, {}},
        {"rel", "--max-rel", "Linear: mean of |a - b| / (b + 0.05 mean b)", false, {}},
        {"p99", "--max-p99", "Linear: 99th percentile of |a - b| over the mean of B", false, {}},
        {"max", "--max-max", "Linear: largest |a - b| over the mean of B", false, {}},
        {"bias", "--max-bias", "Linear: |mean a - mean b| over the mean of B", false, {}},
        {"leak", "--max-leak", "Linear: light where B has none, over the mean of B", false, {}},
        {"rmse", "--max-rmse", "Linear: root mean square error", false, {}},
        {"max_abs", "--max-abs", "Linear: largest |a - b|", false, {}},
        {"largest", "--max-difference", "PNG: largest difference of a channel, 0 to 255", false, {}},
        {"mean", "--max-mean-difference", "PNG: mean difference of a channel", false, {}},
        {"differing", "--max-differing", "PNG: pixels that differ", false, {}},
        {"psnr_db", "--min-psnr", "PNG: peak signal to noise ratio, dB", true, {}},
        {"flip", "--max-flip", "PNG: mean of the FLIP difference, 0 to 1", false, {}},
    };
};

template <class T>
T& expect(std::variant<T, Problem>& result) {
    if (const auto* problem = std::get_if<Problem>(&result)) throw InputError(problem->message);
    return std::get<T>(result);
}

ordered_json number(const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json compare_linear(const ImageF& a, const ImageF& b, const std::string& diff) {
    auto result = error_figures(a, b);
    const ErrorFigures& e = expect(result);
    if (!diff.empty()) {
        auto picture = signed_picture(a, b);
        write_file(diff, encode_png(expect(picture)));
    }
    return {{"kind", "linear"}, {"nrmse", number(e.nrmse)}, {"rel", number(e.rel)}, {"p99", number(e.p99)},
            {"max", number(e.max)}, {"bias", number(e.bias)}, {"leak", number(e.leak)}, {"rmse", number(e.rmse)},
            {"max_abs", number(e.max_abs)}, {"mean_truth", number(e.mean_truth)}, {"count", e.count},
            {"nan_only_a", e.nan_only_a}};
}

// Codes of 16 bits where either picture has them; FLIP, which is about what an eye sees, takes 8.
ordered_json compare_display(const Picture& first, const Picture& second, const CompareOptions& options) {
    const auto codes = [](const Picture& picture) {
        const auto* narrow = std::get_if<Image8>(&picture);
        return narrow != nullptr ? *narrow : narrowed(std::get<Image16>(picture));
    };
    const auto wide = [](const Picture& picture) {
        const auto* codes_of_16 = std::get_if<Image16>(&picture);
        return codes_of_16 != nullptr ? *codes_of_16 : widened(std::get<Image8>(picture));
    };
    const Image8 a = codes(first), b = codes(second);
    const bool narrow = std::holds_alternative<Image8>(first) && std::holds_alternative<Image8>(second);
    auto pixels = narrow ? pixel_figures(a, b) : pixel_figures(wide(first), wide(second));
    const PixelFigures& p = expect(pixels);
    const ordered_json largest = narrow ? ordered_json(int(p.largest)) : ordered_json(p.largest);
    auto seen = flip(a, b, {.pixels_per_degree = options.pixels_per_degree});
    const Flip& f = expect(seen);
    if (!options.diff.empty()) write_file(options.diff, encode_png(heat_picture(f.map)));
    return {{"kind", "display"}, {"largest", largest}, {"mean", p.mean}, {"differing", p.differing},
            {"pixels", p.pixels}, {"psnr_db", number(p.psnr_db)}, {"flip", f.mean}};
}

// Every bound that does not hold, as a sentence.
std::vector<std::string> exceeded(const ordered_json& figures, const std::vector<Bound>& bounds) {
    std::vector<std::string> result;
    for (const Bound& bound : bounds) {
        if (!bound.value) continue;
        if (!figures.contains(bound.figure))
            throw InputError(std::string(bound.option) + " is for the other kind of picture");
        const ordered_json& figure = figures[bound.figure];
        // Without a value: two equal pictures have no PSNR, a black truth no relative error.
        if (figure.is_null()) {
            if (bound.at_least) continue;
            const double absolute = figures.value("max_abs", 0.0);
            if (absolute > 0) result.push_back(std::string(bound.figure) + " has no value (B is black, and A is not)");
            continue;
        }
        const double value = std::abs(figure.get<double>());
        if (bound.at_least ? value >= *bound.value : value <= *bound.value) continue;
        char text[160];
        std::snprintf(text, sizeof text, "%s is %.6g, %s %.6g", bound.figure, value, bound.at_least ? "less than" : "more than",
                      *bound.value);
        result.push_back(text);
    }
    const bool bounded = std::any_of(bounds.begin(), bounds.end(), [](const Bound& b) { return b.value.has_value(); });
    if (bounded && figures.value("nan_only_a", 0) > 0)
        result.push_back("A lacks " + figures["nan_only_a"].dump() + " samples that B has");
    return result;
}

void print_figures(const ordered_json& figures) {
    for (const auto& [name, value] : figures.items()) {
        if (value.is_null())
            std::printf("%-12s -\n", name.c_str());
        else if (value.is_number_float())
            std::printf("%-12s %.6g\n", name.c_str(), value.get<double>());
        else
            std::printf("%-12s %s\n", name.c_str(), value.is_string() ? value.get<std::string>().c_str() : value.dump().c_str());
    }
}

int compare_files(const CompareOptions& options) {
    const PictureFormat* format = find_format_of_file(options.diff);
    if (!options.diff.empty() && (format == nullptr || format->name != "png"))
        throw InputError("--diff takes a name that ends in .png, not " + options.diff);
    const Picture a = read_picture(options.a);
    const Picture b = read_picture(options.b);
    const bool linear = std::holds_alternative<ImageF>(a);
    if (linear != std::holds_alternative<ImageF>(b)) throw InputError("one picture is linear and the other is not");
    ordered_json figures = linear ? compare_linear(std::get<ImageF>(a), std::get<ImageF>(b), options.diff)
                                  : compare_display(a, b, options);
    const std::vector<std::string> complaints = exceeded(figures, options.bounds);
    if (options.json) {
        figures["exceeded"] = complaints;
        std::printf("%s\n", figures.dump(2).c_str());
    } else {
        print_figures(figures);
    }
    for (const std::string& complaint : complaints) complain(complaint);
    return complaints.empty() ? kSuccess : kWorldFailed;
}

}  // namespace

void add_compare_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("compare", "Compare a picture with another: error figures, FLIP, a difference picture");
    auto options = std::make_shared<CompareOptions>();
    command->add_option("a", options->a, "Picture: PNG (8 or 16 bits), or linear: PFM, EXR, HDR, NPY")->required();
    command->add_option("b", options->b, "The truth, of the same kind and size; NaN samples are left out")->required();
    command->add_flag("--json", options->json, "Say it as JSON");
    command->add_option("--diff", options->diff, "Write a difference picture (.png): red too bright and blue too dark, or FLIP's map");
    command->add_option("--pixels-per-degree", options->pixels_per_degree, "Of FLIP's viewer")->check(number_of_more_than(0));
    for (Bound& bound : options->bounds) command->add_option(bound.option, bound.value, bound.help)->check(number_of_at_least(0));
    command->footer("Exit codes: 0 within all bounds, 1 a bound is exceeded, 2 bad input.");
    command->callback([&context, options] {
        context.run = [options]() -> int {
            try {
                return compare_files(*options);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
