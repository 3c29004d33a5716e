// SPDX-License-Identifier: MIT
// The form of a request's head, byte by byte (RFC 9112, sections 2.2, 3 and 5): what cpp-httplib passes over in silence, a
// proxy in front may read otherwise, and then the two do not agree where a request ends.
#pragma once

namespace penumbra {

class HeaderGrammar {
public:
    // False for the first byte that breaks the form. The end of the head, an empty line, begins anew.
    bool take(char c);
    // The lines after a chunked body have the form of headers.
    void begin_trailers() { state_ = State::line; }

private:
    enum class State {
        start,     // of the request line: empty lines before it are allowed
        request,   // method SP target SP version
        line,      // start of a header line
        name,      // of a header
        value,
        carriage,  // the CR that ends a line
    };

    State state_ = State::start;
    State after_line_ = State::line;
    int spaces_ = 0;         // in the request line
    bool last_space_ = true;  // the byte before was one, or there was none
};

}  // namespace penumbra
