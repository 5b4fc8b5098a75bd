#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <string_view>

/// Describe once: a parameter block is a plain struct with one static function template that names each member:
///
///     struct IsoLayer {
///         double value = 0.5;
///         bool operator==(const IsoLayer&) const = default;
///         static void describe(auto& self, auto&& visit) {
///             visit(self.value, {"value", "Value at which the surface lies"});
///         }
///     };
///
/// From that come widgets, JSON, command-line options and the reference page. Members may be bool, int, float, double,
/// std::string, enumerations (with `names`), glm vectors and quaternions, other described structs, std::vector,
/// std::map<std::string, T>, std::optional and std::variant of these (alternatives of a variant carry
/// `static constexpr std::string_view kType`).
namespace tessera {

struct Range {
    double lo = 0, hi = 1;
    bool operator==(const Range&) const = default;
};

struct FieldInfo {
    std::string_view key;       ///< JSON key and option name, lower camel case, never reused
    std::string_view doc = {};  ///< one line of help
    std::string_view unit = {}; ///< "" where there is none
    std::optional<Range> range = {};
    std::span<const std::string_view> names = {}; ///< enumerators in order
    bool logScale = false;
    /// What a text member names, so that a widget can offer a choice: "" (free text), "channel", "colormap", "path".
    std::string_view refersTo = {};
    bool hidden = false; ///< stored and validated, but not drawn as a widget (edited by hand in a view)
    bool applies = true; ///< has an effect beside the other members as they are: else not drawn either
    /// Heading under which its widget lies, folded, with others of the group; "": one of the few that matter first,
    /// drawn above all groups.
    std::string_view group = {};
};

namespace detail {
struct IgnoreField {
    template <class T> void operator()(T&, const FieldInfo&) const {}
};
} // namespace detail

template <class T>
concept Described = requires(T& value) {
    T::describe(value, detail::IgnoreField{});
};

} // namespace tessera
