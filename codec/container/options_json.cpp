#include "codec/container/options_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tessera::codec {

namespace {

using nlohmann::json;

struct ToJson {
    json& all;
    template <class T> void operator()(const T& value, const FieldInfo& field) {
        json& out = all[std::string(field.key)];
        if constexpr (Described<T>) {
            out = json::object();
            ToJson inner{out};
            T::describe(value, inner);
        } else if constexpr (std::is_enum_v<T>) {
            out = field.names[static_cast<std::size_t>(value)];
        } else {
            out = value;
        }
    }
};

struct FromJson {
    const json& all;
    template <class T> void operator()(T& value, const FieldInfo& field) {
        const auto found = all.is_object() ? all.find(std::string(field.key)) : all.end();
        if (!all.is_object() || found == all.end()) return;
        if constexpr (Described<T>) {
            T::describe(value, FromJson{*found});
        } else if constexpr (std::is_enum_v<T>) {
            if (!found->is_string()) return;
            const auto name = std::find(field.names.begin(), field.names.end(), found->template get<std::string>());
            if (name != field.names.end()) value = static_cast<T>(name - field.names.begin());
        } else if constexpr (std::is_same_v<T, bool>) {
            if (found->is_boolean()) value = found->template get<bool>();
        } else if (found->is_number()) {
            const auto number = found->template get<double>();
            if (!field.range || (number >= field.range->lo && number <= field.range->hi))
                value = static_cast<T>(number);
        }
    }
};

/// The entries of `all` that differ from `defaults`.
json difference(const json& all, const json& defaults) {
    json out = json::object();
    for (const auto& [key, value] : all.items()) {
        const json& before = defaults.at(key);
        if (value == before) continue;
        out[key] = value.is_object() ? difference(value, before) : value;
    }
    return out;
}

/// What options that an archive does not state are: its lattice was BCC when the first archives were written.
PackOptions unstated() {
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    return options;
}

json everything(const PackOptions& options) {
    json all = json::object();
    PackOptions::describe(options, ToJson{all});
    return all;
}

} // namespace

json toJson(const PackOptions& options) {
    return difference(everything(options), everything(unstated()));
}

PackOptions optionsFromJson(const json& all) {
    PackOptions options = unstated();
    PackOptions::describe(options, FromJson{all});
    return options;
}

} // namespace tessera::codec
