#pragma once

#include "volume/base/describe.h"
#include "volume/base/error.h"

#include <cmath>
#include <concepts>
#include <map>
#include <string>

namespace tessera::volume {

/// Fills a described struct of numbers from settings by key. Throws Error naming `model` for an unknown key, a value
/// out of range, or a fraction where a whole number is wanted.
template <Described T> T settingsFrom(const std::map<std::string, double>& given, const std::string& model) {
    T settings;
    std::map<std::string, double> left = given;
    T::describe(settings, [&]<class Member>(Member& member, const FieldInfo& info) {
        const auto found = left.find(std::string(info.key));
        if (found == left.end()) return;
        const double value = found->second;
        left.erase(found);
        const auto text = [](double number) {
            std::string digits = std::to_string(number);
            digits.erase(digits.find_last_not_of('0') + 1);
            return digits.back() == '.' ? digits.substr(0, digits.size() - 1) : digits;
        };
        if (!std::isfinite(value) || (info.range && !(value >= info.range->lo && value <= info.range->hi)))
            throw Error(text(value) + (info.range
                                           ? " is outside " + text(info.range->lo) + " .. " + text(info.range->hi)
                                           : " is not a number"),
                        model, std::string(info.key));
        if (std::integral<Member> && value != std::floor(value))
            throw Error(text(value) + " is not a whole number", model, std::string(info.key));
        member = static_cast<Member>(value);
    });
    if (!left.empty()) throw Error("unknown setting", model, left.begin()->first);
    return settings;
}

} // namespace tessera::volume
