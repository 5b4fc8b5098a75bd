#include "app/described/describe_json.h"

#include "codec/container/json_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

constexpr int kMaximumDepth = 100;

bool flat(const Json& json) {
    return std::all_of(json.begin(), json.end(), [](const Json& element) { return element.is_primitive(); });
}

void print(const Json& json, int indent, std::string& out) {
    const std::string inner(static_cast<std::size_t>(indent) + 2, ' ');
    if (json.is_object() && !json.empty()) {
        out += "{\n";
        bool first = true;
        for (const auto& [key, element] : json.items()) {
            if (!first) out += ",\n";
            first = false;
            out += inner + jsonText(key) + ": ";
            print(element, indent + 2, out);
        }
        out += "\n" + std::string(static_cast<std::size_t>(indent), ' ') + "}";
    } else if (json.is_array() && !json.empty()) {
        const bool line = flat(json) || std::all_of(json.begin(), json.end(), [](const Json& element) {
                              return element.is_array() && element.size() <= 4 && flat(element);
                          });
        out += line ? "[" : "[\n";
        bool first = true;
        for (const Json& element : json) {
            if (!first) out += line ? ", " : ",\n";
            first = false;
            if (!line) out += inner;
            print(element, indent + 2, out);
        }
        out += line ? "]" : "\n" + std::string(static_cast<std::size_t>(indent), ' ') + "]";
    } else {
        out += jsonText(json);
    }
}

} // namespace

namespace detail {

Json numberToJson(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return value;
}

Json numberToJson(float value) {
    if (!std::isfinite(value)) return numberToJson(static_cast<double>(value));
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double shortest = 0;
    std::from_chars(text, end, shortest);
    return shortest;
}

Json numberToJson(int value) {
    return value;
}

std::string joinPointer(const std::string& path, std::string_view key) {
    std::string out = path + "/";
    for (const char c : key) {
        if (c == '~')
            out += "~0";
        else if (c == '/')
            out += "~1";
        else
            out += c;
    }
    return out;
}

} // namespace detail

Json parseJson(std::string_view text, const std::string& file) {
    // Printing and comparing documents recurses, so a hostile depth is refused here once and for all.
    const Json::parser_callback_t callback = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > kMaximumDepth) throw Error("nested more than 100 deep", file);
        return true;
    };
    try {
        return Json::parse(text, callback);
    } catch (const Json::parse_error& error) {
        const std::string_view before = text.substr(0, std::min(text.size(), error.byte > 0 ? error.byte - 1 : 0));
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        const auto column = before.size() - (before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1);
        std::string reason = error.what();
        // nlohmann: "[json.exception.parse_error.101] parse error at line 1, column 2: reason".
        if (const auto colon = reason.find(": "); colon != std::string::npos) reason = reason.substr(colon + 2);
        throw Error("broken JSON: " + reason, file,
                    "line " + std::to_string(line) + ", column " + std::to_string(column + 1));
    } catch (const Json::exception& error) {
        throw Error(std::string("broken JSON: ") + error.what(), file);
    }
}

std::string printJson(const Json& json) {
    std::string out;
    print(json, 0, out);
    return out + "\n";
}

} // namespace tessera::app
