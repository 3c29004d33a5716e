// SPDX-License-Identifier: MIT
// What is kept between renders, and that it does not grow with their number.
#include "core/gl/texture_pool.h"

#include <gtest/gtest.h>

#include "tests/gpu/shared_context.h"

namespace penumbra::test {
namespace {

TEST(TexturePool, GivesBackWhatItWasGiven) {
    shared_context();
    gl::TexturePool pool(1 << 20);
    pool.give(gl::Texture2D(GL_RGBA32F, {16, 16}));
    EXPECT_EQ(pool.bytes(), 16u * 16 * 16);
    EXPECT_EQ(pool.take(GL_RGBA32F, {16, 16}).size(), glm::ivec2(16, 16));
    EXPECT_EQ(pool.count(), 0u);
    EXPECT_EQ(pool.bytes(), 0u);
}

TEST(TexturePool, HoldsNoMoreThanItsBytesAndItsNumber) {
    shared_context();
    gl::TexturePool pool(64u << 10);
    for (int i = 0; i < 40; ++i) pool.give(gl::Texture2D(GL_RGBA32F, {16, 16}));
    EXPECT_LE(pool.bytes(), 64u << 10);
    gl::TexturePool wide(64u << 20);
    for (int i = 0; i < 1000; ++i) wide.give(gl::Texture2D(GL_RGBA32F, {16 + i % 500, 8}));
    EXPECT_LE(wide.count(), gl::TexturePool::kMostTextures);
}

// Each render makes some textures of one texel, and nobody takes them again: 10,000 renders grew by 64 MiB.
TEST(TexturePool, KeepsNoTextureOfATexel) {
    shared_context();
    gl::TexturePool pool(64u << 20);
    for (int i = 0; i < 10; ++i) pool.give(gl::Texture2D(GL_RGBA32F, {1, 1}));
    EXPECT_EQ(pool.count(), 0u);
}

}  // namespace
}  // namespace penumbra::test
