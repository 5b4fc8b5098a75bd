#include "vis/glyphs/glyph_parts.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

using Names = std::vector<std::string_view>;

const Names& namesOf(GlyphKind kind) {
    static const auto with = [](Names own) {
        Names all{"size", "color", "opacity", "tilt"};
        all.insert(all.end(), own.begin(), own.end());
        return all;
    };
    static const std::array<Names, std::size(kGlyphKindNames)> kNames{
        with({"length", "width"}),
        with({"length", "width"}),
        with({"side 1", "side 2", "side 3", "side 4", "side 5", "side 6"}),
        with({"spoke 1", "spoke 2", "spoke 3", "spoke 4", "spoke 5", "spoke 6", "spoke 7", "spoke 8"}),
        with({"bar 1", "bar 2", "bar 3", "bar 4", "bar 5", "bar 6", "bar 7", "bar 8"}),
        with({"slice 1", "slice 2", "slice 3", "slice 4", "slice 5", "slice 6", "slice 7", "slice 8"}),
        with({"left arm", "right arm", "left leg", "right leg", "head", "body"}),
        with({"alpha", "beta", "length", "width", "height"}),
        with({"xx", "yy", "zz", "xy", "yz", "xz"}),
    };
    return kNames[std::size_t(kind)];
}

} // namespace

std::span<const std::string_view> glyphPartNames(GlyphKind kind) {
    return namesOf(kind);
}

std::optional<std::size_t> findGlyphPart(GlyphKind kind, std::string_view name) {
    const auto names = glyphPartNames(kind);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return std::size_t(found - names.begin());
}

bool isWholeGlyph(GlyphKind kind, std::size_t part) {
    if (part < kCommonGlyphParts) return part != kColorPart;
    return !glyphPartColor(kind, part);
}

std::optional<glm::vec3> glyphPartColor(GlyphKind kind, std::size_t part) {
    // M. Okabe, K. Ito: Color universal design, 2008; a grey in place of black.
    static constexpr glm::vec3 kColors[] = {{0.90f, 0.62f, 0.00f}, {0.34f, 0.71f, 0.91f}, {0.00f, 0.62f, 0.45f},
                                            {0.94f, 0.89f, 0.26f}, {0.00f, 0.45f, 0.70f}, {0.84f, 0.37f, 0.00f},
                                            {0.80f, 0.47f, 0.65f}, {0.66f, 0.66f, 0.66f}};
    const bool many = kind == GlyphKind::SixSided || kind == GlyphKind::Star || kind == GlyphKind::Bars ||
                      kind == GlyphKind::Pie || kind == GlyphKind::JumpingJack;
    if (!many || part < kCommonGlyphParts) return std::nullopt;
    return kColors[(part - kCommonGlyphParts) % std::size(kColors)];
}

const std::string& glyphColorChannel(const GlyphLayer& layer) {
    for (const GlyphPart& part : layer.parts)
        if (part.part == glyphPartNames(layer.kind)[kColorPart] && !part.channel.empty()) return part.channel;
    return layer.channel;
}

bool glyphShowsColor(const GlyphLayer& layer) {
    if (!glyphPartColor(layer.kind, kCommonGlyphParts)) return true;
    return std::ranges::any_of(layer.parts, [&](const GlyphPart& part) {
        return part.part == glyphPartNames(layer.kind)[kColorPart] && !part.channel.empty();
    });
}

bool isFlatGlyph(GlyphKind kind) {
    return kind == GlyphKind::Star || kind == GlyphKind::Bars || kind == GlyphKind::Pie ||
           kind == GlyphKind::JumpingJack;
}

std::optional<Range> glyphPartRange(const GlyphPart& part, const volume::DatasetInfo& info) {
    const auto channel = part.channel.empty() ? std::nullopt : info.findChannel(part.channel);
    if (!channel) return std::nullopt;
    return part.range.lo != part.range.hi ? part.range : info.channelRange(info.channel(*channel));
}

std::vector<GlyphPart> firstGlyphParts(GlyphKind kind, const volume::DatasetInfo& info) {
    constexpr std::size_t kMost = 6; // more are hard to tell apart
    const auto names = glyphPartNames(kind);
    std::vector<GlyphPart> parts;
    for (const volume::Channel& channel : info.channels()) {
        const std::size_t next = kCommonGlyphParts + parts.size();
        if (next >= names.size() || parts.size() >= kMost) break;
        const volume::Parameter& parameter = info.parameters[std::size_t(channel.parameter)];
        const Range range = info.channelRange(channel);
        const bool one = parameter.components == 1 || channel.magnitude;
        if (one && !parameter.categorical && range.hi > range.lo)
            parts.push_back({.part = std::string(names[next]), .channel = channel.name});
    }
    return parts;
}

std::vector<GlyphPart> partsOnKind(std::span<const GlyphPart> parts, GlyphKind from, GlyphKind to) {
    const auto names = glyphPartNames(to);
    std::vector<GlyphPart> out;
    std::vector<std::pair<std::size_t, GlyphPart>> own;
    for (const GlyphPart& part : parts) {
        const auto index = findGlyphPart(from, part.part);
        if (index && *index < kCommonGlyphParts)
            out.push_back(part);
        else if (index)
            own.emplace_back(*index, part);
    }
    std::ranges::stable_sort(own, {}, [](const auto& each) { return each.first; });
    std::size_t next = kCommonGlyphParts;
    for (const auto& each : own) {
        if (next == names.size()) break;
        GlyphPart part = each.second;
        part.part = names[next++];
        out.push_back(std::move(part));
    }
    return out;
}

} // namespace tessera::vis
