#pragma once

#include "volume/base/error.h"
#include "volume/base/printable.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace tessera::codec {

/// A node of the metadata with typed access, and its path for messages.
class Node {
public:
    Node(const nlohmann::json& value, std::string path, const std::string& file)
        : value_(value), path_(std::move(path)), file_(file) {}

    [[noreturn]] void fail(const std::string& reason) const { throw Error(reason, file_, place()); }
    Node operator[](const char* key) const {
        if (!value_.is_object() || !value_.contains(key)) fail(std::string("the key '") + key + "' is missing");
        return {value_.at(key), path_ + "/" + key, file_};
    }
    bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
    bool isNull() const { return value_.is_null(); }
    const nlohmann::json& value() const { return value_; }
    const std::string& file() const { return file_; }
    /// As messages name it.
    std::string place() const { return "metadata " + path_; }
    std::vector<Node> items(std::size_t most) const {
        if (!value_.is_array() || value_.size() > most) fail("not a list of at most " + std::to_string(most));
        std::vector<Node> all;
        for (std::size_t i = 0; i < value_.size(); ++i)
            all.emplace_back(value_[i], path_ + "/" + std::to_string(i), file_);
        return all;
    }
    std::string text() const {
        if (!value_.is_string()) fail("not a text");
        return printable(value_.get<std::string>());
    }
    double number() const {
        if (!value_.is_number()) fail("not a number");
        return value_.get<double>();
    }
    int integer(int lo, int hi) const {
        if (!value_.is_number_integer()) fail("not an integer");
        const auto value = value_.get<std::int64_t>();
        if (value < lo || value > hi) fail("not between " + std::to_string(lo) + " and " + std::to_string(hi));
        return static_cast<int>(value);
    }
    std::uint64_t count() const {
        if (!value_.is_number_unsigned()) fail("not a whole number");
        return value_.get<std::uint64_t>();
    }
    bool flag() const {
        if (!value_.is_boolean()) fail("not true or false");
        return value_.get<bool>();
    }
    glm::dvec3 vector() const {
        const auto parts = items(3);
        if (parts.size() != 3) fail("not three numbers");
        return {parts[0].number(), parts[1].number(), parts[2].number()};
    }

private:
    const nlohmann::json& value_;
    std::string path_;
    const std::string& file_;
};

} // namespace tessera::codec
