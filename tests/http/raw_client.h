// SPDX-License-Identifier: MIT
// A socket without manners, for requests that no library would send.
#pragma once

#include <string>
#include <string_view>

namespace penumbra::test {

class RawClient {
public:
    explicit RawClient(int port);
    ~RawClient();
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    bool send(std::string_view bytes);  // false when the server has closed
    void end();                         // nothing more will be sent
    // One response: its head and the body that its Content-Length announces. "" when none came.
    std::string receive();
    bool closed_by_server();  // waits for the end

private:
    int fd_ = -1;
    std::string rest_;
};

int status_of(const std::string& response);  // 0 when there is none
std::string body_of(const std::string& response);

}  // namespace penumbra::test
