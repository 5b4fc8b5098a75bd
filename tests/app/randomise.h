#pragma once

#include "app/described/describe_json.h"

#include <random>

/// Random values for everything described, within ranges: for round-trip tests.
namespace tessera::app {

struct Randomise {
    std::mt19937& random;
    int depth = 0;

    double number(const FieldInfo& info) const {
        if (info.range) return std::uniform_real_distribution(info.range->lo, info.range->hi)(random);
        switch (random() % 6) {
        case 0:
            return 0;
        case 1:
            return -1e-30;
        case 2:
            return 1e30;
        default:
            return std::uniform_real_distribution(-1000.0, 1000.0)(random);
        }
    }
    std::string text() const {
        static const char* const words[] = {"", "O2", "|U|", "a/b~c", "line\nbreak \"quoted\"", "µm·s⁻¹", "U.x"};
        return words[random() % std::size(words)];
    }

    template <class T> void operator()(T& value, const FieldInfo& info) const {
        if constexpr (Described<T>) {
            if (depth < 5) T::describe(value, Randomise{random, depth + 1});
        } else if constexpr (std::is_same_v<T, bool>) {
            value = (random() & 1) != 0;
        } else if constexpr (std::is_same_v<T, std::string>) {
            value = text();
        } else if constexpr (std::is_enum_v<T>) {
            value = static_cast<T>(random() % info.names.size());
        } else if constexpr (std::is_integral_v<T>) {
            value = info.range ? static_cast<T>(std::uniform_int_distribution<long>(
                                     static_cast<long>(info.range->lo), static_cast<long>(info.range->hi))(random))
                               : static_cast<T>(random());
        } else if constexpr (std::is_floating_point_v<T>) {
            value = static_cast<T>(number(info));
        } else if constexpr (std::is_same_v<T, Range>) {
            value = {number(info), number(info)};
        } else if constexpr (detail::GlmLength<T>::value > 0) {
            for (int i = 0; i < detail::GlmLength<T>::value; ++i)
                value[i] = static_cast<typename T::value_type>(number(info));
        } else if constexpr (detail::IsQuat<T>::value) {
            for (int i = 0; i < 4; ++i) value[i] = static_cast<typename T::value_type>(number(info));
        } else if constexpr (detail::IsVector<T>::value) {
            value.clear();
            const std::size_t count = depth > 3 ? 0 : random() % 4;
            for (std::size_t i = 0; i < count; ++i) {
                typename T::value_type element{};
                Randomise{random, depth + 1}(element, info);
                value.push_back(element);
            }
        } else if constexpr (detail::IsMap<T>::value) {
            value.clear();
            for (std::size_t i = random() % 4; i-- > 0;) Randomise{random, depth + 1}(value[text()], info);
        } else if constexpr (detail::IsOptional<T>::value) {
            value.reset();
            if (random() & 1) (*this)(value.emplace(), info);
        } else {
            static_assert(detail::IsVariant<T>::value);
            alternative(value, random() % std::variant_size_v<T>);
        }
    }

    template <std::size_t I = 0, class V> void alternative(V& value, std::size_t wanted) const {
        if constexpr (I < std::variant_size_v<V>) {
            if (I != wanted) return alternative<I + 1>(value, wanted);
            std::variant_alternative_t<I, V> made{};
            (*this)(made, FieldInfo{.key = "", .unit = "", .doc = ""});
            value = made;
        }
    }
};

template <class T> T randomValue(std::mt19937& random) {
    T value{};
    Randomise{random}(value, FieldInfo{.key = "", .unit = "", .doc = ""});
    return value;
}

} // namespace tessera::app
