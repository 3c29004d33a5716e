// SPDX-License-Identifier: MIT
// Where results go, and under which names.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../http/process.h"
#include "server/http/http_put.h"
#include "server/redis/result_place.h"

namespace penumbra::test {
namespace {

const std::vector<unsigned char> kBytes = {'a', 'b', 'c'};

TEST(ResultName, StaysInItsFolder) {
    for (const char* name : {"a.png", "a", "shots/a_1-2.png", "a.b.c/d", "0"}) EXPECT_EQ(refuse_name(name), "") << name;
    for (const std::string& name : {std::string(""), std::string("/a"), std::string("../a"), std::string("a/../b"), std::string("a//b"), std::string("a/"), std::string(".a"),
                                    std::string("a/.b"), std::string("a b"), std::string("a\nb"), std::string("a\\b"), std::string("a%2fb"), std::string("\xc3\xa4"), std::string("a\0b", 3),
                                    std::string(201, 'a')}) {
        EXPECT_NE(refuse_name(name), "") << name;
    }
}

TEST(ResultFolder, HoldsTheWholeFileAndNothingElse) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path("out/shots"));
    folder.write("out/shots/.a.png.part-dead", "half");
    folder.write("out/shots/.b.png.part-alive", "half");
    const Delivery delivery = deliver_to_folder(folder.path("out"), "shots/a.png", kBytes, "me");
    EXPECT_TRUE(delivery.good) << delivery.why;
    EXPECT_EQ(read_file(folder.path("out/shots/a.png")), "abc");
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/shots/.a.png.part-dead")));  // what a dead worker left
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/shots/.b.png.part-alive")));  // another picture's
    EXPECT_TRUE(deliver_to_folder(folder.path("out"), "shots/a.png", {}, "me").good);
    EXPECT_EQ(read_file(folder.path("out/shots/a.png")), "");
}

TEST(ResultFolder, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    folder.write("file", "");
    const Delivery delivery = deliver_to_folder(folder.path("file"), "a.png", kBytes, "me");
    EXPECT_FALSE(delivery.good);
    EXPECT_FALSE(delivery.final);  // a disk may be mended
    EXPECT_NE(delivery.why.find("cannot write"), std::string::npos);
}

TEST(ResultFolder, AFullDiskLeavesNothing) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.path(".a.png.part-me"));
    const Delivery delivery = deliver_to_folder(folder.path(""), "a.png", kBytes, "me");
    EXPECT_FALSE(delivery.good);
    EXPECT_NE(delivery.why.find("No space left"), std::string::npos) << delivery.why;
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.png")));
    EXPECT_FALSE(std::filesystem::is_symlink(folder.path(".a.png.part-me")));
}

TEST(Put, TellsNoSignature) { EXPECT_EQ(without_query("https://h/a/b.png?X-Amz-Signature=secret#x"), "https://h/a/b.png"); }

TEST(Put, RefusesWhatIsNoUrl) {
    for (const char* url : {"", "a.png", "ftp://h/a", "http://h", "file:///etc/passwd"}) {
        const PutResult result = http_put(url, kBytes, "image/png", std::chrono::seconds(1));
        EXPECT_FALSE(result.good) << url;
        EXPECT_TRUE(result.final) << url;
    }
}

}  // namespace
}  // namespace penumbra::test
