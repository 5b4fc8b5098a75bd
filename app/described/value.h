#pragma once

#include "volume/base/presets.h"

#include <algorithm>
#include <array>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

/// Values of described structs and their members without their C++ types. Code that reads, writes or shows them is
/// compiled once, not for each struct: a template for each of a hundred structs takes the compiler ten times as long.
namespace tessera::app {

namespace detail {

template <class T> struct IsVector : std::false_type {};
template <class T> struct IsVector<std::vector<T>> : std::true_type {};
template <class T> struct IsMap : std::false_type {};
template <class T> struct IsMap<std::map<std::string, T>> : std::true_type {};
template <class T> struct IsOptional : std::false_type {};
template <class T> struct IsOptional<std::optional<T>> : std::true_type {};
template <class T> struct IsVariant : std::false_type {};
template <class... Ts> struct IsVariant<std::variant<Ts...>> : std::true_type {};
template <class T> struct GlmLength : std::integral_constant<int, 0> {};
template <int N, class T, glm::qualifier Q> struct GlmLength<glm::vec<N, T, Q>> : std::integral_constant<int, N> {};
template <class T> struct IsQuat : std::false_type {};
template <class T, glm::qualifier Q> struct IsQuat<glm::qua<T, Q>> : std::true_type {};

} // namespace detail

enum class ValueKind { Flag, Choice, Number, Range, Vector, Quaternion, Text, Struct, List, Map, Optional, Variant };

struct ValueType;
struct Value;
using VisitMember = std::function<void(Value member, const FieldInfo& info)>;

/// A pointer to a value with its type. The one of a constant is only read.
struct Value {
    const ValueType* type = nullptr;
    void* at = nullptr;

    ValueKind kind() const;
    std::string& text() const { return *static_cast<std::string*>(at); }
    double number(int i = 0) const;
    void setNumber(double number, int i = 0) const;
    void visitMembers(const VisitMember& visit) const; ///< of a struct
    std::size_t size() const;                          ///< of a list
    Value element(std::size_t i) const;
    Value inside() const; ///< of an optional that has a value, of a variant
};

/// What can be done with values of one type. Functions that do not suit the kind are null.
struct ValueType {
    ValueKind kind{};

    // Flags (0, 1), choices (their index), numbers, ranges, vectors, quaternions (w, x, y, z).
    int numbers = 0;
    bool whole = false;  ///< int
    bool single = false; ///< float
    double (*number)(const void* at, int i) = nullptr;
    void (*setNumber)(void* at, int i, double number) = nullptr;

    // Structs, which may have presets.
    void (*visitMembers)(void* at, const VisitMember& visit) = nullptr;
    std::span<const std::string_view> presets = {};
    void (*setPreset)(void* at, std::string_view name) = nullptr;
    bool (*isPreset)(const void* at, std::string_view name) = nullptr;

    // Lists. New elements have their defaults.
    std::size_t (*size)(const void* at) = nullptr;
    void (*resize)(void* at, std::size_t size) = nullptr;
    void (*erase)(void* at, std::size_t i) = nullptr;
    Value (*element)(void* at, std::size_t i) = nullptr;
    const ValueType& (*elementType)() = nullptr; ///< of an optional, too

    // Maps.
    void (*visitElements)(void* at, const std::function<void(const std::string& key, Value element)>& visit) = nullptr;
    Value (*find)(void* at, const std::string& key) = nullptr; ///< with a null pointer if there is none
    Value (*insert)(void* at, const std::string& key) = nullptr;

    // Optionals and maps: without a value. Optionals: with the default.
    void (*clear)(void* at) = nullptr;
    void (*emplace)(void* at) = nullptr;

    // Optionals (a null pointer if there is none) and variants.
    Value (*inside)(void* at) = nullptr;

    // Variants: the kType of what is held, those of all, and the default of one unless that is held.
    std::string_view (*heldName)(const void* at) = nullptr;
    std::span<const std::string_view> names = {};
    void (*hold)(void* at, std::size_t name) = nullptr;
};

/// The type of values that a described struct may have. `extern template` where many files use the same large struct.
template <class T> const ValueType& valueType();

template <class T> Value valueOf(T& value) {
    return {&valueType<std::remove_const_t<T>>(), const_cast<std::remove_const_t<T>*>(&value)};
}

inline ValueKind Value::kind() const {
    return type->kind;
}
inline double Value::number(int i) const {
    return type->number(at, i);
}
inline void Value::setNumber(double number, int i) const {
    type->setNumber(at, i, number);
}
inline void Value::visitMembers(const VisitMember& visit) const {
    type->visitMembers(at, visit);
}
inline std::size_t Value::size() const {
    return type->size(at);
}
inline Value Value::element(std::size_t i) const {
    return type->element(at, i);
}
inline Value Value::inside() const {
    return type->inside(at);
}

namespace detail {

struct EraseType {
    const VisitMember& visit;
    template <class M> void operator()(M& member, const FieldInfo& info) const { visit(valueOf(member), info); }
};

template <class T> constexpr ValueType structType() {
    ValueType type{.kind = ValueKind::Struct};
    type.visitMembers = [](void* at, const VisitMember& visit) { T::describe(*static_cast<T*>(at), EraseType{visit}); };
    if constexpr (HasPresets<T>) {
        type.presets = T::kPresetNames;
        type.setPreset = [](void* at, std::string_view name) { *static_cast<T*>(at) = *T::preset(name); };
        type.isPreset = [](const void* at, std::string_view name) {
            return T::preset(name) == *static_cast<const T*>(at);
        };
    }
    return type;
}

template <class T> constexpr ValueType listType() {
    using List = std::vector<T>;
    ValueType type{.kind = ValueKind::List};
    type.size = [](const void* at) { return static_cast<const List*>(at)->size(); };
    type.resize = [](void* at, std::size_t size) { static_cast<List*>(at)->resize(size); };
    type.erase = [](void* at, std::size_t i) {
        auto& list = *static_cast<List*>(at);
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
    };
    type.element = [](void* at, std::size_t i) { return valueOf((*static_cast<List*>(at))[i]); };
    type.elementType = valueType<T>;
    return type;
}

template <class T> constexpr ValueType mapType() {
    using Map = std::map<std::string, T>;
    ValueType type{.kind = ValueKind::Map};
    type.visitElements = [](void* at, const std::function<void(const std::string&, Value)>& visit) {
        for (auto& [key, element] : *static_cast<Map*>(at)) visit(key, valueOf(element));
    };
    type.find = [](void* at, const std::string& key) {
        auto& map = *static_cast<Map*>(at);
        const auto found = map.find(key);
        return found == map.end() ? Value{} : valueOf(found->second);
    };
    type.insert = [](void* at, const std::string& key) { return valueOf((*static_cast<Map*>(at))[key]); };
    type.clear = [](void* at) { static_cast<Map*>(at)->clear(); };
    return type;
}

template <class T> constexpr ValueType optionalType() {
    using Optional = std::optional<T>;
    ValueType type{.kind = ValueKind::Optional};
    type.inside = [](void* at) {
        auto& optional = *static_cast<Optional*>(at);
        return optional ? valueOf(*optional) : Value{};
    };
    type.elementType = valueType<T>;
    type.clear = [](void* at) { static_cast<Optional*>(at)->reset(); };
    type.emplace = [](void* at) { static_cast<Optional*>(at)->emplace(); };
    return type;
}

template <class... Ts> constexpr std::array<std::string_view, sizeof...(Ts)> kTypeNames{Ts::kType...};

template <class... Ts> constexpr ValueType variantType(std::type_identity<std::variant<Ts...>>) {
    using Variant = std::variant<Ts...>;
    ValueType type{.kind = ValueKind::Variant};
    type.inside = [](void* at) {
        return std::visit([](auto& held) { return valueOf(held); }, *static_cast<Variant*>(at));
    };
    type.heldName = [](const void* at) { return kTypeNames<Ts...>[static_cast<const Variant*>(at)->index()]; };
    type.names = kTypeNames<Ts...>;
    type.hold = [](void* at, std::size_t name) {
        auto& variant = *static_cast<Variant*>(at);
        std::size_t i = 0;
        if (variant.index() != name) ((i++ == name ? void(variant.template emplace<Ts>()) : void()), ...);
    };
    return type;
}

/// The i-th number of a value, to read or to write.
template <class T> auto& numberOf(T& value, int i) {
    using V = std::remove_const_t<T>;
    if constexpr (std::is_same_v<V, Range>)
        return i == 0 ? value.lo : value.hi;
    else if constexpr (IsQuat<V>::value)
        return i == 0 ? value.w : i == 1 ? value.x : i == 2 ? value.y : value.z;
    else if constexpr (GlmLength<V>::value > 0)
        return value[i];
    else
        return value;
}

template <class T> constexpr ValueType numbersType() {
    using N = std::remove_cvref_t<decltype(numberOf(std::declval<T&>(), 0))>;
    ValueType type;
    type.kind = std::is_same_v<T, bool>    ? ValueKind::Flag
                : std::is_enum_v<T>        ? ValueKind::Choice
                : std::is_arithmetic_v<T>  ? ValueKind::Number
                : std::is_same_v<T, Range> ? ValueKind::Range
                : IsQuat<T>::value         ? ValueKind::Quaternion
                                           : ValueKind::Vector;
    type.numbers = std::is_same_v<T, Range> ? 2 : IsQuat<T>::value ? 4 : std::max(1, GlmLength<T>::value);
    type.whole = std::is_integral_v<N>;
    type.single = std::is_same_v<N, float>;
    type.number = [](const void* at, int i) { return static_cast<double>(numberOf(*static_cast<const T*>(at), i)); };
    type.setNumber = [](void* at, int i, double number) {
        if constexpr (std::is_enum_v<N>)
            numberOf(*static_cast<T*>(at), i) = static_cast<N>(static_cast<int>(number));
        else
            numberOf(*static_cast<T*>(at), i) = static_cast<N>(number);
    };
    return type;
}

} // namespace detail

template <class T> const ValueType& valueType() {
    static constexpr ValueType type = [] {
        if constexpr (Described<T>)
            return detail::structType<T>();
        else if constexpr (std::is_same_v<T, std::string>)
            return ValueType{.kind = ValueKind::Text};
        else if constexpr (detail::IsVector<T>::value)
            return detail::listType<typename T::value_type>();
        else if constexpr (detail::IsMap<T>::value)
            return detail::mapType<typename T::mapped_type>();
        else if constexpr (detail::IsOptional<T>::value)
            return detail::optionalType<typename T::value_type>();
        else if constexpr (detail::IsVariant<T>::value)
            return detail::variantType(std::type_identity<T>{});
        else
            return detail::numbersType<T>();
    }();
    return type;
}

} // namespace tessera::app
