#include "volume/flow/flow_channels.h"

#include "volume/base/unit_conversion.h"
#include "volume/base/unit_product.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <sstream>

namespace tessera::volume {

namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool isSpeed(const std::string& unit) {
    const UnitPower alone[] = {{unit, 1}};
    return composedUnit(alone).unit == "m/s";
}

} // namespace

std::optional<std::array<int, 3>> velocityChannels(const DatasetInfo& info, const std::string& name) {
    static constexpr std::array<std::string_view, 5> kNames = {"u", "v", "vel", "velocity", "u.mean"};
    const std::vector<Channel> channels = info.channels();
    const auto found = [&](auto&& fits) -> std::optional<std::array<int, 3>> {
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
            if (parameter.components == 3 && channels[c].component == 0 && fits(parameter))
                return std::array{int(c), int(c) + 1, int(c) + 2};
        }
        return std::nullopt;
    };
    if (!name.empty()) return found([&](const Parameter& parameter) { return parameter.name == name; });
    if (const auto speed = found([](const Parameter& parameter) { return isSpeed(parameter.unit); })) return speed;
    return found([](const Parameter& parameter) {
        return parameter.unit.empty() && std::ranges::find(kNames, lower(parameter.name)) != kNames.end();
    });
}

FlowUnits flowUnits(const DatasetInfo& info, const Parameter& vector) {
    if (info.lengthUnit.empty() || info.timeUnit.empty() || vector.unit.empty()) return {};
    const auto conversion = unitConversion(vector.unit, info.speedUnit());
    return conversion ? FlowUnits{conversion->factor, true} : FlowUnits{};
}

std::string flowUnitsText(const DatasetInfo& info, const Parameter& vector) {
    const FlowUnits units = flowUnits(info, vector);
    std::ostringstream text;
    const std::string time = info.timeUnit.empty() ? "time" : info.timeUnit;
    if (units.stated) {
        text << "1 " << vector.unit << " = " << units.perTime << ' ' << info.lengthUnit << " per " << time;
        return text.str();
    }
    const std::string unit = vector.unit.empty() ? "no unit" : "the unit " + vector.unit;
    text << vector.name << " has " << unit << ", lengths have " << (info.lengthUnit.empty() ? "none" : info.lengthUnit)
         << ", times " << (info.timeUnit.empty() ? "none" : info.timeUnit) << ": a vector of 1 is taken as 1 "
         << info.lengthFactor() << " per " << time;
    return text.str();
}

std::optional<int> densityChannel(const DatasetInfo& info) {
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
        const std::string name = lower(parameter.name);
        const bool unit = parameter.unit.empty() || parameter.unit.starts_with("kg") || parameter.unit.starts_with("g");
        if (parameter.components == 1 && !parameter.categorical && unit && (name == "rho" || name == "density"))
            return int(c);
    }
    return std::nullopt;
}

std::optional<int> labelChannel(const DatasetInfo& info, const std::string& name) {
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
        if (parameter.categorical && (name.empty() || parameter.name == name)) return int(c);
    }
    return std::nullopt;
}

const Parameter& parameterOf(const DatasetInfo& info, int channel) {
    return info.parameters.at(std::size_t(info.channel(channel).parameter));
}

std::string channelNames(const DatasetInfo& info) {
    std::string names;
    for (const Channel& channel : info.channels()) names += (names.empty() ? "" : ", ") + channel.name;
    return names;
}

std::string labelName(const Parameter& label, int value) {
    for (const Label& known : label.labels)
        if (known.value == value && !known.name.empty()) return known.name;
    return label.name + " " + std::to_string(value);
}

std::optional<int> labelValue(const Parameter& label, const std::string& nameOrNumber) {
    for (const Label& known : label.labels)
        if (known.name == nameOrNumber) return known.value;
    int value = 0;
    const char* end = nameOrNumber.data() + nameOrNumber.size();
    const auto parsed = std::from_chars(nameOrNumber.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    return value;
}

} // namespace tessera::volume
