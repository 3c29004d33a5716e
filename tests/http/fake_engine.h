// SPDX-License-Identifier: MIT
// A renderer that tests steer: blocks, throws, fails its self test, or gives a picture at once.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "server/service/engine.h"

namespace penumbra::test {

class FakeControl {
public:
    // While closed, renders wait inside the backend.
    void close_gate();
    void open_gate();
    // Waits until `count` renders have begun since the start.
    void wait_for_begun(int count);
    int begun() const;
    int stopped() const;  // renders that were ended before their end

    void set_self_test(std::string sentence);   // empty: passes
    void set_start_error(std::string sentence);  // empty: starts
    void close_start();                          // making a backend waits until open_start()
    void open_start();

    // For the backend.
    void on_start();
    void on_render(const StopCheck& stop);
    void count_stopped();
    std::string self_test() const;

private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool gate_open_ = true, start_open_ = true;
    int begun_ = 0, stopped_ = 0;
    std::string self_test_, start_error_;
};

// The sky's red says what the render does: 13 throws; 14 ends the process by a signal; 15 hangs and hears nothing; 100 + n takes
// n hundredths of a second, of quality "draft" a tenth of that. A tone map other than "none" and a format that
// is neither png nor pfm are not supported. The picture is a ramp of the scene's size.
Engine fake_engine(std::shared_ptr<FakeControl> control);

inline constexpr const char* kThrownSecret = "secret: /etc/driver.conf line 7";

}  // namespace penumbra::test
