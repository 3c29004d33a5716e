// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "server/redis/connection.h"

namespace penumbra {
namespace {

RedisAddress address(std::string_view url) {
    const auto parsed = parse_redis_url(url);
    if (const auto* why = std::get_if<std::string>(&parsed)) {
        ADD_FAILURE() << url << ": " << *why;
        return {};
    }
    return std::get<RedisAddress>(parsed);
}

TEST(RedisUrl, HasHostPortLoginAndDatabase) {
    const RedisAddress plain = address("redis://localhost");
    EXPECT_EQ(plain.host, "localhost");
    EXPECT_EQ(plain.port, 6379);
    EXPECT_EQ(plain.database, 0);
    const RedisAddress full = address("redis://me:p%40ss%2f@10.0.0.7:7000/3");
    EXPECT_EQ(full.host, "10.0.0.7");
    EXPECT_EQ(full.port, 7000);
    EXPECT_EQ(full.user, "me");
    EXPECT_EQ(full.password, "p@ss/");
    EXPECT_EQ(full.database, 3);
    EXPECT_EQ(address("redis://:secret@h/").password, "secret");
    const RedisAddress v6 = address("redis://[::1]:7001/2");
    EXPECT_EQ(v6.host, "::1");
    EXPECT_EQ(v6.port, 7001);
    EXPECT_EQ(address("redis+unix:///run/redis.sock").socket, "/run/redis.sock");
    EXPECT_EQ(to_string(full), "redis://10.0.0.7:7000/3");  // without the password
}

TEST(RedisUrl, IsRefusedOtherwise) {
    for (const char* url : {"", "localhost", "http://localhost", "redis://", "redis://:6379", "redis://h:0", "redis://h:65536", "redis://h:x",
                            "redis://h/x", "redis://h/-1", "redis://me@h", "redis://a:%4@h", "redis://a:%zz@h", "redis://[::1", "redis+unix://relative"}) {
        EXPECT_TRUE(std::holds_alternative<std::string>(parse_redis_url(url))) << url;
    }
    EXPECT_NE(std::get<std::string>(parse_redis_url("rediss://h")).find("TLS"), std::string::npos);
}

}  // namespace
}  // namespace penumbra
