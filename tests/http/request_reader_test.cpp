// SPDX-License-Identifier: MIT
// The reader of requests by itself: what is whole, what is refused, and that it does not matter in which pieces bytes come.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "process.h"
#include "server/http/request_reader.h"

namespace penumbra::test {
namespace {

const std::string kPost = "POST /v1/render HTTP/1.1\r\nHost: x\r\n";

RequestLimits limits() { return {.header_bytes = 400, .header_lines = 5, .body_bytes = 100, .framed_bytes = 180}; }

struct Read {
    bool done = false, has_head = false, expects_body = false, has_body = false;
    Fault fault = Fault::none;
    std::string head, body;
    std::size_t taken = 0;
    bool operator==(const Read&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Read& read) {
    return out << (read.done ? "done" : "open") << " fault " << int(read.fault) << " taken " << read.taken << " body " << read.has_body << " '" << read.body << "'";
}

// In pieces of `piece` bytes.
Read read(std::string_view bytes, std::size_t piece, bool ends = false, const RequestLimits& bounds = limits()) {
    RequestReader reader(bounds);
    Read result;
    while (reader.state() != RequestReader::State::done && result.taken < bytes.size()) {
        std::string_view part = bytes.substr(result.taken, piece - result.taken % piece);
        result.taken += reader.take(part);
        if (reader.state() == RequestReader::State::asked) reader.go_on();
    }
    if (ends && reader.state() != RequestReader::State::done) reader.end();
    result.done = reader.state() == RequestReader::State::done;
    result.has_head = reader.has_head();
    result.expects_body = reader.expects_body();
    result.has_body = reader.has_body();
    result.fault = reader.fault();
    result.head = reader.head();
    result.body = reader.take_body();
    return result;
}

TEST(RequestReader, AWholeRequestEndsWhereTheNextBegins) {
    const std::string next = "GET /next HTTP/1.1\r\n\r\n";
    for (const std::size_t piece : {1, 2, 3, 7, 1000}) {
        const Read get = read("GET / HTTP/1.1\r\nA: b\r\n\r\n" + next, piece);
        EXPECT_TRUE(get.done && get.has_head && !get.expects_body) << get;
        EXPECT_EQ(get.head, "GET / HTTP/1.1\r\nA: b\r\n\r\n");
        EXPECT_EQ(get.taken, get.head.size());
        const std::string plain = kPost + "Content-Length: 5\r\n\r\nhello", chunked = kPost + "Transfer-Encoding: Chunked\r\n\r\n3;a=b\r\nhel\r\n02\r\nlo\r\n0\r\nTrailer: x\r\n\r\n";
        for (const std::string& text : {plain, chunked}) {
            const Read post = read(text + next, piece);
            EXPECT_TRUE(post.done && post.has_body) << post;
            EXPECT_EQ(post.fault, Fault::none);
            EXPECT_EQ(post.body, "hello");
            EXPECT_EQ(post.taken, text.size());
        }
        const Read empty = read(kPost + "Content-Length: 00\r\n\r\n" + next, piece);
        EXPECT_TRUE(empty.done && !empty.expects_body) << empty;
    }
}

TEST(RequestReader, EmptyLinesBeforeARequestAreNoneOfIt) {
    const Read with = read("\r\n\r\n\r\nGET / HTTP/1.1\r\n\r\n", 3);
    EXPECT_TRUE(with.done);
    EXPECT_EQ(with.head, "GET / HTTP/1.1\r\n\r\n");
    EXPECT_EQ(read("\r\n\r\n", 1, true).fault, Fault::malformed);
}

std::string head_of(std::size_t bytes) {
    const std::string frame = "GET / HTTP/1.1\r\nA: \r\n\r\n";
    return "GET / HTTP/1.1\r\nA: " + std::string(bytes - frame.size(), 'x') + "\r\n\r\n";
}
std::string head_of_lines(int lines) {
    std::string text = "GET / HTTP/1.1\r\n";
    for (int i = 0; i < lines; ++i) text += "A: b\r\n";
    return text + "\r\n";
}

TEST(RequestReader, LimitsHoldAtTheirValueAndNotOnePast) {
    for (const std::size_t piece : {1, 1000}) {
        EXPECT_EQ(read(head_of(400), piece).fault, Fault::none);
        EXPECT_EQ(read(head_of(401), piece).fault, Fault::headers_too_large);
        EXPECT_EQ(read(head_of_lines(5), piece).fault, Fault::none);
        EXPECT_EQ(read(head_of_lines(6), piece).fault, Fault::headers_too_large);
        for (const int size : {100, 101}) {
            const std::string body(std::size_t(size), 'x');
            const Fault fault = size == 100 ? Fault::none : Fault::body_too_large;
            EXPECT_EQ(read(kPost + "Content-Length: " + std::to_string(size) + "\r\n\r\n" + body, piece).fault, fault);
            const std::string chunk = std::to_string(size - 36) + "\r\n";  // hexadecimal: 64 is 100, 65 is 101
            EXPECT_EQ(read(kPost + "Transfer-Encoding: chunked\r\n\r\n" + chunk + body + "\r\n0\r\n\r\n", piece).fault, fault);
        }
        // One byte a chunk is six bytes; the last chunk has five: 29 * 6 + 5 = 179, and a byte of extension more is 180.
        for (const int more : {0, 1, 2}) {
            std::string text = kPost + "Transfer-Encoding: chunked\r\n\r\n";
            for (int i = 0; i < 29; ++i) text += "1\r\nx\r\n";
            text += "0" + std::string(std::size_t(more), ' ') + "\r\n\r\n";
            EXPECT_EQ(read(text, piece).fault, more < 2 ? Fault::none : Fault::body_too_large) << more;
        }
    }
}

TEST(RequestReader, ChunksThatOthersMayReadOtherwiseEndTheBody) {
    for (const std::string body : {"g\r\n", "-5\r\n", "0x5\r\nhello\r\n0\r\n\r\n", " 5\r\nhello\r\n0\r\n\r\n", "\r\n", ";a\r\n", "5\nhello\n0\n\n", "5\r\nhelloX\r\n",
                                   "5\r\nhello\rX", "5 \x01\r\n", "1000000000000000000\r\n", "0\r\n Folded: x\r\n\r\n", "0\r\nNo colon\r\n\r\n"}) {
        for (const std::size_t piece : {1, 1000}) {
            const Read result = read(kPost + "Transfer-Encoding: chunked\r\n\r\n" + body, piece);
            EXPECT_TRUE(result.done) << body;
            EXPECT_FALSE(result.has_body) << body;
            EXPECT_EQ(result.body, "") << body;
        }
    }
}

TEST(RequestReader, DoubtfulFramingLeavesTheBody) {
    for (const std::string framing : {"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "Content-Length: 5\r\nContent-Length: 5\r\n", "Content-Length:\r\n",
                                      "Content-Length: %35\r\n", "Transfer-Encoding: gzip\r\n"}) {
        const Read result = read(kPost + framing + "\r\nhello", 1000);
        EXPECT_TRUE(result.done && result.expects_body && !result.has_body) << framing;
        EXPECT_EQ(result.taken, result.head.size()) << framing;
    }
}

TEST(RequestReader, WhatEndsEarlyIsNotWhole) {
    EXPECT_EQ(read("GET / HT", 1000, true).fault, Fault::malformed);
    for (const std::string framing : {"Content-Length: 5\r\n\r\nhell", "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n"}) {
        const Read result = read(kPost + framing, 1000, true);
        EXPECT_TRUE(result.done && !result.has_body) << framing;
        EXPECT_EQ(result.fault, Fault::none);
    }
}

TEST(RequestReader, PiecesDoNotMatter) {
    const RequestLimits bounds{.header_bytes = 16384, .header_lines = 100, .body_bytes = 1 << 20, .framed_bytes = 2 << 20};
    int files = 0;
    for (const char* folder : {"/tests/corpus/requests", "/tests/fuzz/corpus/http"}) {
        for (const auto& entry : std::filesystem::directory_iterator(std::string(PENUMBRA_SOURCE_DIR) + folder)) {
            if (entry.path().extension() == ".json") continue;
            const std::string bytes = read_file(entry.path());
            const Read whole = read(bytes, std::max<std::size_t>(bytes.size(), 1), true, bounds);
            for (const std::size_t piece : {1, 5}) EXPECT_EQ(read(bytes, piece, true, bounds), whole) << entry.path();
            ++files;
        }
    }
    EXPECT_GE(files, 80);
}

}  // namespace
}  // namespace penumbra::test
