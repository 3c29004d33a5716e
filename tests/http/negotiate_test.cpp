// SPDX-License-Identifier: MIT
#include "server/http/negotiate.h"

#include <gtest/gtest.h>

#include "server/cli/cpu_quota.h"

namespace penumbra {
namespace {

TEST(Accept, FollowsTheMostSpecificRange) {
    EXPECT_EQ(parse_accept("").choose("pfm"), "pfm");
    EXPECT_EQ(parse_accept("*/*").choose("exr"), "exr") << "told later that it cannot be written";
    EXPECT_EQ(parse_accept("image/png").choose("exr"), "png");
    EXPECT_EQ(parse_accept("image/*, image/png;q=0").choose("png"), "pfm");
    EXPECT_EQ(parse_accept("image/png;q=0.2,image/x-pfm;q=0.3").choose("png"), "pfm");
    EXPECT_EQ(parse_accept("image/png, image/x-pfm").choose("pfm"), "pfm");
    EXPECT_EQ(parse_accept(" IMAGE/PNG ; q=1.000 , */* ; q=0.001").choose("pfm"), "png");
    EXPECT_TRUE(parse_accept("text/html").nothing_fits());
    EXPECT_TRUE(parse_accept("image/png;q=nonsense").nothing_fits());
    EXPECT_TRUE(parse_accept("image/png;q=2").nothing_fits());
    EXPECT_FALSE(parse_accept(",,").nothing_fits());
}

TEST(ContentType, IsJsonInUtf8) {
    EXPECT_EQ(refuse_content_type(""), "");
    EXPECT_EQ(refuse_content_type("application/json"), "");
    EXPECT_EQ(refuse_content_type("application/scene+json ; charset=UTF-8"), "");
    EXPECT_NE(refuse_content_type("application/json;charset=utf-16"), "");
    EXPECT_NE(refuse_content_type("text/json5"), "");
    EXPECT_NE(refuse_content_type("application/jsonp"), "");
}

TEST(RequestId, IsShortAndPlain) {
    EXPECT_TRUE(is_request_id("a"));
    EXPECT_TRUE(is_request_id(std::string(64, 'z')));
    EXPECT_FALSE(is_request_id(std::string(65, 'z')));
    EXPECT_FALSE(is_request_id(""));
    EXPECT_FALSE(is_request_id("a b"));
    EXPECT_FALSE(is_request_id("\xc3\xa9"));
    EXPECT_TRUE(is_request_id(new_request_id()));
    EXPECT_NE(new_request_id(), new_request_id());
}

TEST(Framing, LeavesNoDoubt) {
    EXPECT_EQ(refuse_framing({}, {}), "");
    EXPECT_EQ(refuse_framing({"12"}, {}), "");
    EXPECT_EQ(refuse_framing({}, {"Chunked"}), "");
    EXPECT_NE(refuse_framing({"12", "12"}, {}), "");
    EXPECT_NE(refuse_framing({"+12"}, {}), "");
    EXPECT_NE(refuse_framing({""}, {}), "");
    EXPECT_NE(refuse_framing({"12"}, {"chunked"}), "");
    EXPECT_NE(refuse_framing({}, {"identity"}), "");
}

TEST(ServerTiming, NamesAreTokens) {
    EXPECT_EQ(timing_entry("cascade 3", 1.234), "cascade-3;dur=1.23");
    EXPECT_EQ(timing_name("a;b,c=\"d\""), "a-b-c--d-");
    EXPECT_EQ(timing_name(""), "pass");
}

TEST(CpuQuota, IsReadFromTheControlGroup) {
    EXPECT_EQ(processors_of_cpu_max("max 100000"), 0);
    EXPECT_EQ(processors_of_cpu_max("200000 100000"), 2);
    EXPECT_EQ(processors_of_cpu_max("150000 100000"), 2);
    EXPECT_EQ(processors_of_cpu_max("5000 100000"), 1);
    EXPECT_EQ(processors_of_cpu_max(""), 0);
}

}  // namespace
}  // namespace penumbra
