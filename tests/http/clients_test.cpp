// SPDX-License-Identifier: MIT
// The example clients when something is wrong: what they say, never a traceback.
#include <gmock/gmock.h>

#include "process.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

struct Client {
    const char* interpreter;
    const char* file;
};

class Clients : public testing::TestWithParam<Client> {
protected:
    void SetUp() override {
        if (run_program("/usr/bin/env", {GetParam().interpreter, "--version"}).exit_code != 0) {
            GTEST_SKIP() << "there is no " << GetParam().interpreter << " here";
        }
    }
    Finished run(const std::vector<std::string>& arguments, const std::string& input = kScene) const {
        std::vector<std::string> line{GetParam().interpreter,
                                      std::string(PENUMBRA_SOURCE_DIR "/examples/clients/") + GetParam().file};
        line.insert(line.end(), arguments.begin(), arguments.end());
        line.insert(line.end(), {"--url", "http://127.0.0.1:" + std::to_string(service.port())});
        return run_program("/usr/bin/env", line, input,
                           {{"no_proxy", "127.0.0.1"}, {"NO_PROXY", "127.0.0.1"}, {"PYTHONDONTWRITEBYTECODE", "1"}});
    }
    std::string name() const { return GetParam().file; }

    const Service service;
};

TEST_P(Clients, AFileThatCannotBeWrittenIsOneLine) {
    for (const char* picture : {"/no/such/folder/x.png", "/dev/full"}) {
        const Finished finished = run({"-", "-o", picture});
        EXPECT_EQ(finished.exit_code, 1) << finished.err;
        EXPECT_THAT(finished.err, testing::StartsWith(name() + ": cannot write " + picture + ": "));
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
        EXPECT_EQ(finished.out, "");
    }
}

TEST_P(Clients, APlaceWithoutAPointerIsOnlyItsLineAndColumn) {
    const Finished finished = run({"-", "-o", "-"}, "{\"version\": 1,}");
    EXPECT_EQ(finished.exit_code, 2);
    // render.sh without jq shows the answer as it came.
    EXPECT_THAT(finished.err, AnyOf(HasSubstr("\n  line 1, column 15: "), HasSubstr("\"line\": 1")));
    EXPECT_THAT(finished.err, Not(HasSubstr(" (line")));
    const Finished pointed = run({"-", "-o", "-"}, R"({"version": 1, "canvas": {"width": 0, "height": 1}})");
    EXPECT_THAT(pointed.err, AnyOf(HasSubstr("\n  /canvas/width (line 1, column 36): "), HasSubstr("\"line\": 1")));
}

INSTANTIATE_TEST_SUITE_P(, Clients,
                         testing::Values(Client{"python3", "render.py"}, Client{"bash", "render.sh"},
                                         Client{"node", "render.mjs"}),
                         [](const auto& client) { return std::string(client.param.interpreter); });

}  // namespace
}  // namespace penumbra::test
