// SPDX-License-Identifier: MIT
// Values as bytes and back, within one build: fixed order, no names, no versions. A struct is written by a function
// `template <class Archive> void fields(Archive& archive, Like<Archive, T>& value)` that takes it apart whole
// (`auto& [a, b] = value; archive(a, b);`), so that a new member does not compile until it is named there.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace penumbra {

class ByteWriter {
public:
    static constexpr bool kReads = false;

    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    std::string take() { return std::move(bytes_); }

private:
    void put(double value) { put_word(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }  // -0 is 0
    void put(const std::string& text) { put_bytes(text.data(), text.size()); }
    void put(const std::vector<std::uint8_t>& bytes) { put_bytes(bytes.data(), bytes.size()); }
    template <class T>
        requires(std::is_integral_v<T> || std::is_enum_v<T>)
    void put(T value) {
        put_word(std::uint64_t(value));
    }
    void put(const glm::dvec2& v) { (*this)(v.x, v.y); }
    void put(const glm::dvec3& v) { (*this)(v.x, v.y, v.z); }
    template <class T>
    void put(const std::vector<T>& list) {
        put_word(list.size());
        for (const T& item : list) put(item);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put_word(value.has_value());
        if (value) put(*value);
    }
    template <class T>
    void put(const std::shared_ptr<const T>& value) {
        put_word(value != nullptr);
        if (value) put(*value);
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put_word(value.index());
        std::visit([&](const auto& held) { put(held); }, value);
    }
    template <class T>
        requires(std::is_class_v<T>)
    void put(const T& value) {
        fields(*this, value);
    }

    void put_word(std::uint64_t word) {
        char bytes[sizeof word];
        std::memcpy(bytes, &word, sizeof word);
        bytes_.append(bytes, sizeof word);
    }
    void put_bytes(const void* data, std::size_t size) {
        put_word(size);
        bytes_.append(static_cast<const char*>(data), size);
    }

    std::string bytes_;
};

// Reads what ByteWriter wrote. Of other bytes it makes values that mean nothing, and good() is false in most cases; it never
// reads beyond them and never makes more than they hold.
class ByteReader {
public:
    static constexpr bool kReads = true;

    explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    bool good() const { return good_; }
    bool at_end() const { return good_ && rest_.empty(); }

private:
    void get(double& value) { value = std::bit_cast<double>(get_word()); }
    void get(std::string& text) { text = get_bytes(); }
    void get(std::vector<std::uint8_t>& bytes) {
        const std::string_view view = get_bytes();
        bytes.assign(view.begin(), view.end());
    }
    template <class T>
        requires(std::is_integral_v<T> || std::is_enum_v<T>)
    void get(T& value) {
        value = T(get_word());
    }
    void get(glm::dvec2& v) { (*this)(v.x, v.y); }
    void get(glm::dvec3& v) { (*this)(v.x, v.y, v.z); }
    template <class T>
    void get(std::vector<T>& list) {
        const std::uint64_t count = get_word();
        list.clear();
        // Every item has at least one word: a count that is a lie ends with the bytes.
        for (std::uint64_t i = 0; i < count && good_; ++i) get(list.emplace_back());
    }
    template <class T>
    void get(std::optional<T>& value) {
        value.reset();
        if (get_word() != 0) get(value.emplace());
    }
    template <class T>
    void get(std::shared_ptr<const T>& value) {
        value.reset();
        if (get_word() == 0) return;
        auto made = std::make_shared<T>();
        get(*made);
        value = std::move(made);
    }
    template <class... T>
    void get(std::variant<T...>& value) {
        const std::uint64_t index = get_word();
        good_ = good_ && index < sizeof...(T);
        if (good_) get_alternative<0, T...>(value, index);
    }
    template <class T>
        requires(std::is_class_v<T>)
    void get(T& value) {
        fields(*this, value);
    }
    template <std::size_t I, class... T>
    void get_alternative(std::variant<T...>& value, std::uint64_t index) {
        if constexpr (I < sizeof...(T)) {
            if (index == I) {
                get(value.template emplace<I>());
            } else {
                get_alternative<I + 1>(value, index);
            }
        }
    }

    std::uint64_t get_word() {
        std::uint64_t word = 0;
        good_ = good_ && rest_.size() >= sizeof word;
        if (!good_) return 0;
        std::memcpy(&word, rest_.data(), sizeof word);
        rest_.remove_prefix(sizeof word);
        return word;
    }
    std::string_view get_bytes() {
        const std::uint64_t size = get_word();
        good_ = good_ && size <= rest_.size();
        if (!good_) return {};
        const std::string_view bytes = rest_.substr(0, std::size_t(size));
        rest_.remove_prefix(std::size_t(size));
        return bytes;
    }

    std::string_view rest_;
    bool good_ = true;
};

// T for a reader, const T for a writer.
template <class Archive, class T>
using Like = std::conditional_t<Archive::kReads, T, const T>;

}  // namespace penumbra
