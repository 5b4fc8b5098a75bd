#pragma once

#include "app/described/describe_json.h"

#include <CLI/CLI.hpp>
#include <sstream>

/// Command-line options of a described struct: one option per member, its key in kebab case (nested members joined by
/// dots), help, range, choices and default from the description.
namespace tessera::app {

namespace detail {

inline std::string optionName(const std::string& prefix, std::string_view key) {
    std::string name = prefix;
    for (const char c : key) {
        if (c >= 'A' && c <= 'Z') {
            name += '-';
            name += static_cast<char>(c - 'A' + 'a');
        } else {
            name += c;
        }
    }
    return name;
}

struct MemberToOption {
    CLI::App& app;
    std::string prefix;

    template <class T> void operator()(T& value, const FieldInfo& info) const {
        const std::string name = optionName(prefix, info.key);
        std::string help(info.doc);
        if (!info.unit.empty()) help += " [" + std::string(info.unit) + "]";
        const std::string option = "--" + name;
        if constexpr (Described<T>) {
            T::describe(value, MemberToOption{app, name + "."});
        } else if constexpr (std::is_same_v<T, bool>) {
            app.add_flag(option + ",!--no-" + name, value, help + (value ? " (default: yes)" : ""));
        } else if constexpr (std::is_enum_v<T>) {
            std::string choices;
            for (const std::string_view choice : info.names)
                choices += (choices.empty() ? "" : "|") + std::string(choice);
            const auto names = info.names;
            app.add_option_function<std::string>(
                   option,
                   [&value, names, option](const std::string& word) {
                       const auto found = std::find(names.begin(), names.end(), word);
                       if (found == names.end()) throw CLI::ValidationError(option, "unknown name \"" + word + "\"");
                       value = static_cast<T>(found - names.begin());
                   },
                   help)
                ->type_name(choices)
                ->default_str(std::string(info.names[static_cast<std::size_t>(value)]));
        } else if constexpr (IsOptional<T>::value) {
            app.add_option(option, value, help);
        } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
            CLI::Option* added = app.add_option(option, value, help);
            if constexpr (std::is_arithmetic_v<T>) {
                added->default_str(numberToJson(value).dump());
                if (info.range) added->check(CLI::Range(info.range->lo, info.range->hi));
            } else if (!value.empty()) {
                added->default_str(value);
            }
        } else if constexpr (IsVector<T>::value) {
            if constexpr (std::is_same_v<typename T::value_type, std::string> ||
                          std::is_arithmetic_v<typename T::value_type>)
                app.add_option(option, value, help);
        } else if constexpr (GlmLength<T>::value > 0) {
            app.add_option_function<std::vector<typename T::value_type>>(
                   option,
                   [&value](const std::vector<typename T::value_type>& parts) {
                       for (int i = 0; i < GlmLength<T>::value; ++i) value[i] = parts[static_cast<std::size_t>(i)];
                   },
                   help)
                ->expected(GlmLength<T>::value);
        }
        // Maps and variants have no option; `--set /pointer=value` sets those of a session.
    }
};

/// Options take effect in the order they were added in: a preset comes before the members.
template <HasPresets T> void addPresets(CLI::App& app, T& value, const std::string& option) {
    std::string choices;
    for (const std::string_view choice : T::kPresetNames) choices += (choices.empty() ? "" : "|") + std::string(choice);
    app.add_option_function<std::string>(
           option,
           [&value, option](const std::string& name) {
               const std::optional<T> preset = T::preset(name);
               if (!preset) throw CLI::ValidationError(option, "unknown name \"" + name + "\"");
               value = *preset;
           },
           std::string(T::kPresetDoc))
        ->type_name(choices);
}

} // namespace detail

/// Adds an option for every member of `value` that a command line can give, and --preset where it has presets; parsing
/// writes into `value`, which must outlive the parse. What is stated overrides a preset, wherever it stands.
template <class T> void addDescribed(CLI::App& app, T& value, const std::string& prefix = {}) {
    if constexpr (HasPresets<T>) detail::addPresets(app, value, "--" + prefix + "preset");
    T::describe(value, detail::MemberToOption{app, prefix});
}

} // namespace tessera::app
