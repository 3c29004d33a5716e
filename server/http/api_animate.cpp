// SPDX-License-Identifier: MIT
// POST /v1/animate: one scene, many pictures, sent as they are done.
#include <deque>
#include <future>
#include <thread>

#include "core/image/apng.h"
#include "server/http/api.h"
#include "server/http/negotiate.h"
#include "server/service/animation.h"
#include "server/service/zip.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kBoundary = "penumbra-frame";
// Between attempts to get a place in a full queue.
constexpr std::chrono::milliseconds kPatience{100};

enum class Container { apng, zip, multipart };

struct ContainerType {
    Container container;
    const char* media_type;
};
constexpr ContainerType kContainers[] = {
    {Container::apng, "image/apng"}, {Container::zip, "application/zip"}, {Container::multipart, "multipart/mixed"}};

// Renders frames ahead of the one that is asked for: as many as there are renderers, and one more.
class FrameSource {
public:
    FrameSource(RenderService& service, Animation animation, RenderRequest order, double allowance_ms)
        : service_(service), animation_(std::move(animation)), order_(std::move(order)), allowance_ms_(allowance_ms),
          ahead_(service.worker().status().workers + 1) {
        order_.text = animation_.scene;
    }
    ~FrameSource() {
        cancelled_ = true;
        for (auto& frame : frames_) frame.wait();
    }
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;

    std::size_t count() const { return animation_.frames.size(); }
    const Animation& animation() const { return animation_; }
    RenderRequest request_of(std::size_t index) const {
        RenderRequest order = order_;
        order.overrides = animation_.frames[index];
        return order;
    }

    RenderResponse next() {
        // The first alone: whatever is rendered beside it would delay it.
        const std::size_t most = begun_ == 0 ? 1 : ahead_;
        while (frames_.size() < most && begun_ < count()) {
            frames_.push_back(std::async(std::launch::async, [this, index = begun_] { return render(index); }));
            ++begun_;
        }
        RenderResponse response = frames_.front().get();
        frames_.pop_front();
        return response;
    }

private:
    RenderResponse render(std::size_t index) {
        RenderRequest order = request_of(index);
        order.allowance_ms = allowance_ms_;
        order.deadline = Clock::now() + std::chrono::milliseconds(std::int64_t(allowance_ms_));
        order.gone = [this] { return cancelled_ || (order_.gone && order_.gone()); };
        for (;;) {
            RenderResponse response = service_.render(order);
            const bool wait = response.failure == RenderFailure::queue_full || response.failure == RenderFailure::too_late;
            if (!wait || Clock::now() + kPatience > order.deadline || order.gone()) return response;
            std::this_thread::sleep_for(kPatience);
        }
    }

    RenderService& service_;
    const Animation animation_;
    RenderRequest order_;
    const double allowance_ms_;
    const std::size_t ahead_;
    std::atomic<bool> cancelled_{false};
    std::size_t begun_ = 0;
    std::deque<std::future<RenderResponse>> frames_;
};

std::string text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string frame_name(std::size_t index, const std::string& extension) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%04zu", index + 1);
    return name + extension;
}

// Writes frame after frame into a container.
class FrameWriter {
public:
    FrameWriter(Container container, const Animation& animation, glm::ivec2 size)
        : container_(container), animation_(animation),
          apng_(size.x, size.y, std::uint32_t(animation.frames.size()), std::uint32_t(animation.plays), animation.fps) {}

    // Empty when the frame does not fit in.
    std::string frame(std::size_t index, const RenderResponse& rendered) {
        const Answer& answer = *rendered.answer;
        const PictureFormat* format = find_format(answer.format);
        const std::string bytes = text_of(answer.picture);
        if (container_ == Container::zip) return zip_.file(frame_name(index, std::string(format->extension)), bytes);
        if (container_ == Container::multipart) {
            return std::string("--") + kBoundary + "\r\nContent-Type: " + std::string(format->media_type) +
                   "\r\nContent-Length: " + std::to_string(bytes.size()) + "\r\nContent-Disposition: attachment; filename=\"" +
                   frame_name(index, std::string(format->extension)) + "\"\r\nPenumbra-Values: " + animation_.values[index] + "\r\n\r\n" + bytes + "\r\n";
        }
        const auto decoded = decode_png(answer.picture);
        const Texels* texels = std::get_if<Texels>(&decoded);
        if (!texels) return "";
        return (index == 0 ? text_of(apng_.head()) : "") + text_of(apng_.frame(*texels));
    }
    // A frame that could not be rendered, where the container has a place for it.
    std::string failure(std::size_t index, const std::string& problem) {
        if (container_ == Container::zip) {
            const std::string file = zip_.file(frame_name(index, ".problem.json"), problem);
            return file + zip_.end();
        }
        if (container_ == Container::multipart) {
            return std::string("--") + kBoundary + "\r\nContent-Type: " + std::string(kProblemMediaType) + "\r\n\r\n" + problem + "\r\n--" + kBoundary + "--\r\n";
        }
        return "";
    }
    std::string end() {
        if (container_ == Container::zip) {
            const std::string file = zip_.file("values.json", values());
            return file + zip_.end();  // which lists it
        }
        return container_ == Container::multipart ? std::string("--") + kBoundary + "--\r\n" : text_of(apng_.end());
    }

private:
    std::string values() const {
        std::string text;
        for (const std::string& one : animation_.values) text += (text.empty() ? "[\n" : ",\n") + one;
        return text + "\n]\n";
    }

    const Container container_;
    const Animation& animation_;
    ApngWriter apng_;
    ZipWriter zip_;
};

}  // namespace

void Api::animate(const Request& request, Response& response, std::string&& body) {
    // Of what the client takes the best; without a word an APNG.
    std::vector<std::string_view> types;
    for (const ContainerType& type : kContainers) types.push_back(type.media_type);
    const std::optional<std::size_t> choice = choose_media_type(joined(header_values(request, "Accept")), types);
    if (!choice) {
        respond_.problem(response, make_problem(ProblemKind::not_acceptable, "Animations come as image/apng, application/zip, multipart/mixed."));
        return;
    }
    const Container container = kContainers[*choice].container;
    const auto refuse = [&](RenderResponse&& refused) { send_failure(response, refused); };

    AnimationLimits limits;
    limits.max_frames = config_.max_frames;
    ParsedAnimation parsed = parse_animation(body, service_.limits().text, limits);
    if (!parsed.animation) {
        RenderResponse refused;
        refused.failure = parsed.is_json ? RenderFailure::invalid_scene : RenderFailure::not_json;
        refused.problems = std::move(parsed.problems);
        return refuse(std::move(refused));
    }
    const StreamPlace place = place_for_stream(response);
    if (!place) return;
    RenderRequest order = *wanted(request, response, "");
    order.formats = container == Container::apng ? only_format("png") : any_format();
    order.partial = false;
    const auto source = std::make_shared<FrameSource>(service_, std::move(*parsed.animation), std::move(order), 1000.0 * config_.max_deadline_s);

    // All are looked at before the first is rendered: half an animation is of no use.
    double expected_ms = 0;
    glm::ivec2 size{0};
    for (std::size_t i = 0; i < source->count(); ++i) {
        RenderEstimate estimate = service_.estimate(source->request_of(i));
        if (estimate.refusal.failure != RenderFailure::none) {
            for (LocatedProblem& problem : estimate.refusal.problems) problem.problem.message += " (frame " + std::to_string(i + 1) + ")";
            return refuse(std::move(estimate.refusal));
        }
        if (!estimate.cached) expected_ms += estimate.quote.low_ms;
        if (i > 0 && container == Container::apng && estimate.quote.price.size != size) {
            RenderResponse refused;
            refused.failure = RenderFailure::invalid_scene;
            LocatedProblem& problem = refused.problems.emplace_back();
            problem.problem = {"/animate", "conflict", "makes frames of different sizes, which an APNG has not; ask for application/zip"};
            return refuse(std::move(refused));
        }
        size = estimate.quote.price.size;
    }
    if (expected_ms > 1000.0 * config_.max_job_s) {
        RenderResponse refused;
        refused.failure = RenderFailure::too_dear;
        refused.detail = "The frames take at least " + std::to_string(int(expected_ms / 1000)) + " s, and all of them may take " +
                         std::to_string(config_.max_job_s) + " s.";
        return refuse(std::move(refused));
    }
    // The first tells what can go wrong while there is still a status to say it with.
    const auto first = std::make_shared<RenderResponse>(source->next());
    if (first->failure != RenderFailure::none) return refuse(std::move(*first));

    const auto writer = std::make_shared<FrameWriter>(container, source->animation(), size);
    response.set_header("Cache-Control", "no-store");
    response.set_header("Penumbra-Frames", std::to_string(source->count()));
    std::string type = kContainers[*choice].media_type;
    if (container == Container::multipart) type += std::string("; boundary=") + kBoundary;
    if (container == Container::zip) response.set_header("Content-Disposition", "attachment; filename=\"frames.zip\"");
    stream(response, place, type, [this, source, writer, first, index = std::size_t(0)](std::string& part) mutable {
        const RenderResponse rendered = index == 0 ? *first : source->next();
        if (rendered.failure != RenderFailure::none) {
            const HttpProblem problem = problem_of(rendered, service_.worker().retry_after_s());
            log_.error("A frame failed", {{"frame", std::int64_t(index + 1)}, {"error", rendered.error}, {"id", Responder::request_id()}});
            part = writer->failure(index, body_of(problem, Responder::request_id()));
            // An APNG ends in the middle, which its readers notice.
            return false;
        }
        part = writer->frame(index, rendered);
        if (++index < source->count()) return true;
        part += writer->end();
        return false;
    });
}

}  // namespace penumbra
