// SPDX-License-Identifier: MIT
#include "server/service/identity.h"

#include <fstream>
#include <iterator>

#include "server/service/digest.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

std::string read_own_file() {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string processor_features() {
    std::string features;
#if defined(__x86_64__) && defined(__GNUC__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("fma")) features += " fma";
    if (__builtin_cpu_supports("avx2")) features += " avx2";
    if (__builtin_cpu_supports("avx512f")) features += " avx512f";
#endif
    return features;
}

}  // namespace

const std::string& build_id() {
    static const std::string id = sha256({version(), read_own_file()});
    return id;
}

std::string device_class(const DeviceInfo& device) {
    if (device.renderer.empty()) return "";
    return device.kind + "\n" + device.vendor + "\n" + device.renderer + "\n" + device.gl_version +
           (device.kind == "cpu" ? processor_features() : "");
}

}  // namespace penumbra
