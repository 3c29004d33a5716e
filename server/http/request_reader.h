// SPDX-License-Identifier: MIT
// A request as it arrives, byte by byte: bytes go in, a whole request or a refusal comes out. Nothing here knows a socket, a
// clock or the HTTP library (docs/decisions/0080).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/http/fault.h"
#include "server/http/header_grammar.h"

namespace penumbra {

struct RequestLimits {
    std::size_t header_bytes = 0;
    std::size_t header_lines = 0;
    std::size_t body_bytes = 0;
    std::size_t framed_bytes = 0;  // of a body with its chunk framing
};

// Whatever their case.
bool same_name(std::string_view a, std::string_view b);

// Views into the text of a head.
struct RequestHead {
    std::string_view method, target, version;
    std::vector<std::pair<std::string_view, std::string_view>> fields;

    explicit RequestHead(std::string_view text);  // which keeps the grammar
    std::vector<std::string> values(std::string_view name) const;
};

class RequestReader {
public:
    enum class State {
        head,   // being read, or not begun
        asked,  // the head is there: go_on() or leave_body() comes next
        body,
        done,   // whole, refused, or cut off
    };

    explicit RequestReader(const RequestLimits& limits) : limits_(&limits) {}

    // Takes bytes until there is something to decide or the request ends; how many it has taken.
    std::size_t take(std::string_view bytes);
    void go_on();       // reads the body, where there is one
    void leave_body();  // somebody else has decided against it
    void end();         // the client sends no more
    void refuse(Fault fault);  // for a reason from outside: time, room

    State state() const { return state_; }
    bool begun() const { return !head_.empty() || state_ != State::head; }
    Fault fault() const { return fault_; }
    bool has_head() const { return has_head_; }  // the whole of it
    const std::string& head() const { return head_; }
    bool expects_body() const { return expects_body_; }
    bool has_body() const { return has_body_; }  // the whole of it
    std::string take_body() { return std::move(body_); }
    const std::string& framing_refusal() const { return framing_refusal_; }  // why the end of the body cannot be told
    std::size_t held() const { return head_.size() + body_.size(); }  // bytes

private:
    enum class Chunk { size, extension, size_end, data, data_return, data_end, trailers };

    Fault count_header(char c);
    void end_head();
    std::size_t take_plain(std::string_view bytes);
    std::size_t take_chunked(std::string_view bytes);
    bool take_framing(char c);
    void append(std::string_view bytes);

    const RequestLimits* limits_;
    State state_ = State::head;
    Fault fault_ = Fault::none;
    HeaderGrammar grammar_;
    std::size_t header_lines_ = 0;
    int line_end_ = 0;  // how much of CR LF CR LF has been seen
    std::string head_, body_, framing_refusal_;
    bool has_head_ = false, expects_body_ = false, has_body_ = false, chunked_ = false;
    std::uint64_t left_ = 0;  // of the body, or of the chunk
    Chunk chunk_ = Chunk::size;
    int digits_ = 0;
    std::size_t framed_bytes_ = 0;
};

}  // namespace penumbra
