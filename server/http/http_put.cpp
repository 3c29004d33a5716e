// SPDX-License-Identifier: MIT
#include "server/http/http_put.h"

#include <httplib.h>

namespace penumbra {

std::string without_query(const std::string& url) { return url.substr(0, url.find_first_of("?#")); }

PutResult http_put(const std::string& url, std::span<const unsigned char> bytes, std::string_view media_type,
                   std::chrono::seconds patience) {
    const std::size_t scheme = url.find("://");
    const std::size_t path = scheme == std::string::npos ? scheme : url.find('/', scheme + 3);
    if (path == std::string::npos || (!url.starts_with("http://") && !url.starts_with("https://"))) {
        return {false, true, without_query(url) + " is no http:// or https:// URL with a path"};
    }
    httplib::Client client(url.substr(0, path));
    if (!client.is_valid()) return {false, true, without_query(url) + " cannot be asked: its scheme or host is not understood"};
    client.set_url_encode(false);
    client.set_connection_timeout(patience);
    client.set_read_timeout(patience);
    client.set_write_timeout(patience);
    const httplib::Result result =
        client.Put(url.substr(path, url.find('#') - path), reinterpret_cast<const char*>(bytes.data()), bytes.size(), std::string(media_type));
    if (!result) return {false, false, without_query(url) + ": " + httplib::to_string(result.error())};
    const int hundreds = result->status / 100;
    if (hundreds == 2) return {true, false, ""};
    // What the store refuses it refuses again; what fails on its side may go well later.
    return {false, hundreds != 5, without_query(url) + " answered " + std::to_string(result->status)};
}

}  // namespace penumbra
