// SPDX-License-Identifier: MIT
// Where the pictures of a batch go: a folder, or a URL that takes PUT. Whole or not at all, and for good before the job is done.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace penumbra {

// Empty for the name of a result: letters, digits and ._- in parts that "/" separates, none of which begins with a dot. Else a
// sentence.
std::string refuse_name(std::string_view name);

struct Delivery {
    bool good = false;
    bool final = false;  // not good, and will not be when it is tried again
    std::string why;
};

// FOLDER/name, made durable before it has its name. What other workers left of the same name is removed. `part` tells this
// worker's unfinished files from theirs.
Delivery deliver_to_folder(const std::string& folder, const std::string& name, std::span<const unsigned char> bytes, const std::string& part);

// PUT to `url`, some times if need be.
Delivery deliver_by_put(const std::string& url, std::span<const unsigned char> bytes, std::string_view media_type);

}  // namespace penumbra
