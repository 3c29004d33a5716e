// SPDX-License-Identifier: MIT
// A shader that does not build ends in a sentence with its file and line. Each test has a context of its own.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/program.h"
#include "core/renderer.h"
#include "glsl/cascade.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

// A copy of glsl/ in a folder of its own, gone with the object.
class ShaderCopy {
public:
    ShaderCopy() {
        std::string name = (fs::temp_directory_path() / "penumbra-shaders-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        folder_ = name;
        fs::copy(PENUMBRA_SOURCE_DIR "/glsl", folder_, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }
    ~ShaderCopy() { fs::remove_all(folder_); }
    ShaderCopy(const ShaderCopy&) = delete;
    ShaderCopy& operator=(const ShaderCopy&) = delete;

    std::string folder() const { return folder_.string(); }

    // Puts `text` in place of the first line that holds `mark`; returns its number.
    int replace_line(const std::string& file, const std::string& mark, const std::string& text) const {
        std::vector<std::string> lines;
        std::string line;
        std::ifstream in(folder_ / file);
        while (std::getline(in, line)) lines.push_back(line);
        in.close();
        std::ofstream out(folder_ / file);
        int found = 0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const bool here = found == 0 && lines[i].find(mark) != std::string::npos;
            if (here) found = static_cast<int>(i) + 1;
            out << (here ? text : lines[i]) << "\n";
        }
        if (found == 0) throw std::runtime_error("no line of " + file + " holds " + mark);
        return found;
    }

private:
    fs::path folder_;
};

std::string failure(const std::string& folder, const std::string& shader = "cascade.comp",
                    std::size_t bytes = sizeof(glsl::CascadeParams)) {
    const gl::Context context(test_options().device);
    try {
        const gl::ComputeProgram program(shader, bytes, folder);
        return "it was built";
    } catch (const DeviceError& error) {
        return error.what();
    }
}

TEST(ShaderErrors, AnUntouchedCopyBuilds) { EXPECT_EQ(failure(ShaderCopy().folder()), "it was built"); }

TEST(ShaderErrors, NameTheFileAndLineOfALibrary) {
    const ShaderCopy copy;
    const int line = copy.replace_line("lib/scene.glsl", "vec2 along", "    vec2 along = no_such_name;");
    const std::string what = failure(copy.folder());
    EXPECT_NE(what.find("glsl/lib/scene.glsl:" + std::to_string(line) + ":"), std::string::npos) << what;
    EXPECT_NE(what.find("no_such_name"), std::string::npos) << what;
    EXPECT_NE(what.find("cascade.comp"), std::string::npos) << what;
}

TEST(ShaderErrors, NameTheFileAndLineOfTheShaderItself) {
    const ShaderCopy copy;
    const int line = copy.replace_line("cascade.comp", "int group", "    int group = = 3;");
    const std::string what = failure(copy.folder());
    EXPECT_NE(what.find("glsl/cascade.comp:" + std::to_string(line) + ":"), std::string::npos) << what;
}

TEST(ShaderErrors, NameAMissingInclude) {
    const ShaderCopy copy;
    fs::remove(fs::path(copy.folder()) / "lib/march.glsl");
    const std::string what = failure(copy.folder());
    EXPECT_NE(what.find("lib/march.glsl"), std::string::npos) << what;
}

TEST(ShaderErrors, AFunctionWithoutBodyIsALinkError) {
    const ShaderCopy copy;
    copy.replace_line("cascade.comp", "vec3 sum = vec3(0.0);", "    vec3 sum = nowhere_defined();");
    copy.replace_line("cascade.comp", "void main()", "vec3 nowhere_defined(); void main() {");
    const std::string what = failure(copy.folder());
    EXPECT_NE(what.find("cascade.comp"), std::string::npos) << what;
    EXPECT_NE(what.find("nowhere_defined"), std::string::npos) << what;
}

TEST(ShaderErrors, TheRendererPassesThemOn) {
    const ShaderCopy copy;
    const int line = copy.replace_line("lib/tonemap.glsl", "return c / (1.0 + c)", "vec3 tonemap_reinhard(vec3 c) { return 1; }");
    RendererOptions options = test_options();
    options.shader_dir = copy.folder();
    try {
        const Renderer renderer(options);
        FAIL() << "built with a broken shader";
    } catch (const DeviceError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("glsl/lib/tonemap.glsl:" + std::to_string(line) + ":"), std::string::npos) << what;
    }
}

TEST(ShaderErrors, TheRendererReadsALiveFolder) {
    const ShaderCopy copy;
    copy.replace_line("linear.comp", "imageStore", "    imageStore(linear_image, texel, vec4(0.125, 0.25, 0.5, solid_radiance(pixel, solid).r));");
    RendererOptions options = test_options();
    options.shader_dir = copy.folder();
    Renderer renderer(options);
    Scene scene;
    scene.canvas.width = 3;
    scene.canvas.height = 2;
    scene.output.format = "pfm";
    const ImageF picture = std::get<ImageF>(renderer.render(scene).picture);
    EXPECT_EQ(picture.data[0], 0.125f);
    EXPECT_EQ(picture.data[17], 0.5f);
}

TEST(Device, WhatIsNoDeviceIsRefusedInWords) {
    for (const std::string choice : {"teapot", "99", "-1", ""}) {
        RendererOptions options;
        options.device = choice;
        try {
            const Renderer renderer(options);
            FAIL() << "'" << choice << "' gave a renderer";
        } catch (const DeviceError& error) {
            const std::string what = error.what();
            EXPECT_NE(what.find(choice), std::string::npos) << what;
            EXPECT_EQ(what.back(), '.') << what;
        }
    }
}

TEST(Device, TwoRenderersOnOneThreadDoNotDisturbOneAnother) {
    Scene scene;
    scene.canvas.width = 40;
    scene.canvas.height = 30;
    scene.output.format = "pfm";
    scene.shapes.resize(1);
    scene.shapes[0].geometry = Circle{{12.3, 14.1}, 4};
    scene.shapes[0].emission = Colour(1);
    Renderer first(test_options());
    const ImageF alone = std::get<ImageF>(first.render(scene).picture);
    {
        Renderer second(test_options());
        EXPECT_EQ(std::get<ImageF>(second.render(scene).picture).data, alone.data);
        EXPECT_EQ(std::get<ImageF>(first.render(scene).picture).data, alone.data);
    }
    EXPECT_EQ(std::get<ImageF>(first.render(scene).picture).data, alone.data);
}

TEST(Device, EveryListedDeviceHasANameAndItsIndex) {
    const std::vector<DeviceListing> devices = Renderer::list_devices();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(devices[i].index, static_cast<int>(i));
        EXPECT_FALSE(devices[i].name.empty());
    }
}

TEST(Device, OnTheCpuItIsSoftware) {
    RendererOptions options;
    options.device = "cpu";
    const Renderer renderer(options);
    EXPECT_EQ(renderer.device().kind, "cpu");
}

}  // namespace
}  // namespace penumbra::test
