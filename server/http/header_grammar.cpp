// SPDX-License-Identifier: MIT
#include "server/http/header_grammar.h"

#include <string_view>

namespace penumbra {
namespace {

// RFC 9110, 5.6.2.
bool is_token(char c) {
    constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kOthers.find(c) != std::string_view::npos;
}

bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; }

}  // namespace

bool HeaderGrammar::take(char c) {
    switch (state_) {
        case State::carriage:
            state_ = after_line_;
            return c == '\n';
        case State::start:
            if (c == '\r') {
                state_ = State::carriage;
                after_line_ = State::start;
                return true;
            }
            spaces_ = 0;
            last_space_ = true;
            state_ = State::request;
            [[fallthrough]];
        case State::request:
            if (c == '\r') {
                state_ = State::carriage;
                after_line_ = State::line;
                return spaces_ == 2 && !last_space_;
            }
            if (c == ' ') {  // one at a time, after something
                const bool good = !last_space_ && ++spaces_ <= 2;
                last_space_ = true;
                return good;
            }
            last_space_ = false;
            return c != '\t' && !is_control(c);
        case State::line:
            if (c == '\r') {  // the end of the head
                state_ = State::carriage;
                after_line_ = State::start;
                return true;
            }
            state_ = State::name;
            return is_token(c);  // neither a folded line nor an empty name
        case State::name:
            if (c == ':') {
                state_ = State::value;
                return true;
            }
            return is_token(c);  // no space before the colon, no line without one
        case State::value:
            if (c == '\r') {
                state_ = State::carriage;
                after_line_ = State::line;
                return true;
            }
            return !is_control(c);
    }
    return false;
}

}  // namespace penumbra
