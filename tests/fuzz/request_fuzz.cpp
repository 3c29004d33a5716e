// SPDX-License-Identifier: MIT
// Any bytes as what a client sends, through the reader of requests alone: every limit holds, a request ends at the same byte in
// whatever pieces it comes, and what has been taken for a body is one.
#include <string>
#include <string_view>

#include "check.h"
#include "server/http/request_reader.h"

using penumbra::RequestReader;
using penumbra::fuzz::check;

namespace {

constexpr penumbra::RequestLimits kLimits{.header_bytes = 2048, .header_lines = 20, .body_bytes = 512, .framed_bytes = 1024};

// The first request in `bytes`; how many bytes it takes.
std::size_t read(RequestReader& reader, std::string_view bytes, std::size_t piece) {
    std::size_t taken = 0;
    while (reader.state() != RequestReader::State::done && taken < bytes.size()) {
        const std::string_view part = bytes.substr(taken, piece);
        const std::size_t count = reader.take(part);
        check(count <= part.size(), "no more is taken than there is");
        check(count > 0 || reader.state() == RequestReader::State::done, "it goes on");
        taken += count;
        if (reader.state() == RequestReader::State::asked) reader.go_on();
        check(reader.held() <= kLimits.header_bytes + 1 + kLimits.body_bytes, "no more is held than allowed");
    }
    if (reader.state() != RequestReader::State::done) reader.end();
    return taken;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    while (!rest.empty()) {
        RequestReader whole(kLimits), pieces(kLimits);
        const std::size_t taken = read(whole, rest, rest.size());
        check(read(pieces, rest, 1 + rest.size() % 7) == taken, "pieces end where the whole ends");
        check(whole.fault() == pieces.fault() && whole.has_head() == pieces.has_head() && whole.has_body() == pieces.has_body() &&
                  whole.head() == pieces.head() && whole.framing_refusal() == pieces.framing_refusal(),
              "pieces are read as the whole is");
        if (whole.has_body()) {
            check(whole.fault() == penumbra::Fault::none && whole.expects_body() && whole.framing_refusal().empty(), "a body is announced");
        }
        const std::string body = whole.take_body();
        check(body == pieces.take_body(), "and so is the body");
        check(!whole.has_body() || body.size() <= kLimits.body_bytes, "a body keeps its limit");
        if (whole.has_head()) {
            const penumbra::RequestHead head(whole.head());
            check(!head.method.empty() && !head.target.empty() && !head.version.empty(), "a head has a request line");
            check(head.fields.size() <= kLimits.header_lines, "and no more fields than allowed");
        }
        // What follows a request that is whole is the next one.
        if (whole.fault() != penumbra::Fault::none || !whole.has_head() || (whole.expects_body() && !whole.has_body())) break;
        rest.remove_prefix(taken);
    }
    return 0;
}
