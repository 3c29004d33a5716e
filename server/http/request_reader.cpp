// SPDX-License-Identifier: MIT
#include "server/http/request_reader.h"

#include <algorithm>
#include <cctype>

#include "server/http/negotiate.h"

namespace penumbra {
namespace {

// Of a chunk's size: what fits in 64 bits.
constexpr int kMostDigits = 15;
// Room for a body is made at once when so much of it has come, not when it is promised.
constexpr std::size_t kWorthReserving = 1u << 20;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string_view next_line(std::string_view& text) {
    const std::size_t end = text.find("\r\n");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    return line;
}

}  // namespace

bool same_name(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
               return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
           });
}

RequestHead::RequestHead(std::string_view text) {
    std::string_view line = next_line(text);
    const std::size_t first = line.find(' '), second = line.rfind(' ');
    if (first == std::string_view::npos || first == second) return;
    method = line.substr(0, first);
    target = line.substr(first + 1, second - first - 1);
    version = line.substr(second + 1);
    for (line = next_line(text); !line.empty(); line = next_line(text)) {
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) continue;
        std::string_view value = line.substr(colon + 1);
        while (!value.empty() && (value.front() == ' ' || value.front() == '\t')) value.remove_prefix(1);
        while (!value.empty() && (value.back() == ' ' || value.back() == '\t')) value.remove_suffix(1);
        fields.emplace_back(line.substr(0, colon), value);
    }
}

std::vector<std::string> RequestHead::values(std::string_view name) const {
    std::vector<std::string> found;
    for (const auto& [field, value] : fields) {
        if (same_name(field, name)) found.emplace_back(value);
    }
    return found;
}

std::size_t RequestReader::take(std::string_view bytes) {
    if (state_ == State::body) return chunked_ ? take_chunked(bytes) : take_plain(bytes);
    std::size_t taken = 0;
    while (taken < bytes.size() && state_ == State::head) {
        const char c = bytes[taken++];
        if (const Fault fault = count_header(c); fault != Fault::none) {
            refuse(fault);
        } else if (line_end_ == 4) {
            end_head();
        }
    }
    return taken;
}

// Counts one byte of the header section and finds its end.
Fault RequestReader::count_header(char c) {
    head_ += c;
    if (head_.size() > limits_->header_bytes) return Fault::headers_too_large;
    // One line too many is known by its first byte: the library's own count (0.18) would come at its end.
    if (line_end_ == 2 && c != '\r' && header_lines_ > limits_->header_lines) return Fault::headers_too_large;
    if (c == '\n' && ++header_lines_ > limits_->header_lines + 2) return Fault::headers_too_large;  // request line, blank line
    if (!grammar_.take(c)) return Fault::malformed;
    line_end_ = c == "\r\n\r\n"[line_end_] ? line_end_ + 1 : (c == '\r' ? 1 : 0);
    return Fault::none;
}

void RequestReader::end_head() {
    // Empty lines before a request are allowed and none of its head.
    const std::size_t begin = head_.find_first_not_of("\r\n");
    if (begin == std::string::npos) {
        line_end_ = 0;
        return;
    }
    head_.erase(0, begin);
    has_head_ = true;
    state_ = State::asked;
    const RequestHead head(head_);
    const auto lengths = head.values("Content-Length"), codings = head.values("Transfer-Encoding");
    framing_refusal_ = refuse_framing(lengths, codings);
    expects_body_ = !framing_refusal_.empty() || !codings.empty() || (!lengths.empty() && lengths[0].find_first_not_of('0') != std::string::npos);
    chunked_ = !codings.empty();
    if (framing_refusal_.empty() && !lengths.empty()) left_ = std::stoull(lengths[0]);
}

void RequestReader::go_on() {
    if (!expects_body_ || !framing_refusal_.empty()) {
        leave_body();
    } else if (left_ > limits_->body_bytes) {
        refuse(Fault::body_too_large);
    } else {
        state_ = State::body;
    }
}

void RequestReader::leave_body() { state_ = State::done; }

void RequestReader::end() {
    if (state_ == State::head && begun()) {
        refuse(Fault::malformed);
    } else {
        state_ = State::done;
    }
}

void RequestReader::refuse(Fault fault) {
    fault_ = fault;
    state_ = State::done;
    body_ = {};
    has_body_ = false;
}

void RequestReader::append(std::string_view bytes) {
    if (body_.size() + bytes.size() > body_.capacity() && !chunked_ && body_.size() >= kWorthReserving) {
        body_.reserve(body_.size() + std::size_t(left_));
    }
    body_.append(bytes);
}

std::size_t RequestReader::take_plain(std::string_view bytes) {
    const std::size_t taken = std::size_t(std::min<std::uint64_t>(bytes.size(), left_));
    append(bytes.substr(0, taken));
    left_ -= taken;
    if (left_ == 0) {
        has_body_ = true;
        state_ = State::done;
    }
    return taken;
}

std::size_t RequestReader::take_chunked(std::string_view bytes) {
    std::size_t taken = 0;
    while (taken < bytes.size() && state_ == State::body) {
        std::size_t count = 1;
        if (chunk_ == Chunk::data) {
            count = std::size_t(std::min<std::uint64_t>(bytes.size() - taken, left_));
            count = std::min(count, limits_->framed_bytes + 1 - framed_bytes_);  // refused at the same byte in whatever pieces
            append(bytes.substr(taken, count));
            left_ -= count;
            if (left_ == 0) chunk_ = Chunk::data_return;
        } else if (!take_framing(bytes[taken]) && fault_ == Fault::none) {
            body_ = {};  // it is not known where it ends
            has_body_ = false;
            state_ = State::done;
        }
        taken += count;
        framed_bytes_ += count;
        if (framed_bytes_ > limits_->framed_bytes) refuse(Fault::body_too_large);
    }
    return taken;
}

// RFC 9112, 7.1. Lines end with CR LF alone, and a size has digits alone: what others read otherwise is refused.
bool RequestReader::take_framing(char c) {
    switch (chunk_) {
        case Chunk::size:
            if (const int digit = hex_digit(c); digit >= 0) {
                left_ = 16 * left_ + std::uint64_t(digit);
                return ++digits_ <= kMostDigits;
            }
            if (digits_ == 0) return false;
            chunk_ = c == '\r' ? Chunk::size_end : Chunk::extension;
            return c == '\r' || c == ';' || c == ' ' || c == '\t';
        case Chunk::extension:
            if (c == '\r') {
                chunk_ = Chunk::size_end;
                return true;
            }
            return c == '\t' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
        case Chunk::size_end:
            chunk_ = left_ > 0 ? Chunk::data : Chunk::trailers;
            if (left_ == 0) {
                grammar_.begin_trailers();
                line_end_ = 2;
            }
            digits_ = 0;
            if (left_ > limits_->body_bytes - body_.size()) refuse(Fault::body_too_large);
            return c == '\n';
        case Chunk::data_return:
            chunk_ = Chunk::data_end;
            return c == '\r';
        case Chunk::data_end:
            chunk_ = Chunk::size;
            return c == '\n';
        case Chunk::trailers:  // which nobody here reads
            if (!grammar_.take(c)) return false;
            line_end_ = c == "\r\n\r\n"[line_end_] ? line_end_ + 1 : (c == '\r' ? 1 : 0);
            if (line_end_ == 4) {
                has_body_ = true;
                state_ = State::done;
            }
            return true;
        case Chunk::data: break;
    }
    return false;
}

}  // namespace penumbra
