#include "app/session/describe_markdown.h"

#include "app/session/session_types.h"

namespace tessera::app {

namespace detail {

namespace {

std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string rangeText(const FieldInfo& info) {
    std::string text;
    for (const std::string_view name : info.names) text += (text.empty() ? "" : ", ") + std::string(name);
    if (!info.names.empty()) return text;
    if (info.range) text = numberToJson(info.range->lo).dump() + " to " + numberToJson(info.range->hi).dump();
    return text + (info.logScale ? " (log)" : "");
}

/// One row of a table: key, default, range or choices, unit, help.
void appendRow(std::string& out, const std::string& key, const FieldInfo& info, const Json& value) {
    std::string shown = value.dump();
    if (value.is_structured() && shown.size() > 40) shown = "...";
    out += "| `" + key + "` | `" + cell(shown) + "` | " + cell(rangeText(info)) + " | " + std::string(info.unit) +
           " | " + cell(std::string(info.doc)) + " |\n";
}

void appendRows(std::string& out, const std::string& prefix, Value value) {
    value.visitMembers([&](Value member, const FieldInfo& info) {
        const std::string key = prefix + std::string(info.key);
        if (member.kind() == ValueKind::Struct)
            appendRows(out, key + ".", member);
        else
            appendRow(out, key, info, valueToJson(member, info));
    });
}

} // namespace

std::string markdownRows(Value value) {
    std::string rows;
    appendRows(rows, "", value);
    return rows;
}

} // namespace detail

namespace {

template <HasPresets T> std::string presetNames() {
    std::string all;
    for (const std::string_view name : T::kPresetNames) all += (all.empty() ? "`" : ", `") + std::string(name) + "`";
    return all;
}

/// What a kind of view shows, and what it can be exported as.
std::string describeKind(const ViewTraits& kind) {
    std::string text = std::string(kind.title) + ": " + std::string(kind.help) + ".";
    if (kind.figure || kind.csv)
        text += std::string(" Can be exported as ") +
                (!kind.figure ? "CSV"
                 : kind.csv   ? "SVG, PDF and CSV"
                              : "SVG and PDF") +
                ".";
    return text;
}

/// Of every way to compute a parameter.
std::string recipeSections() {
    return []<class... Recipe>(const std::variant<Recipe...>*) {
        return (markdownSection<Recipe>("Recipe of type `" + std::string(Recipe::kType) + "`",
                                        std::string(Recipe::kKind.doc)) +
                ...);
    }(static_cast<const volume::DerivedRecipe*>(nullptr));
}

} // namespace

std::string parameterReference() {
    std::string out =
        "# Settings\n\n"
        "Every setting of a session, written from the descriptions in the source. The key is the member's name in the\n"
        "session file and after `--set`; nested members are joined by a dot here and by a slash there\n"
        "(`tessera render overview --set /render/step=0.25 -o out.png`).\n"
        "The units `length` and `time` are those that the data state.\n\n";
    out += markdownSection<Session>("Session", "The whole session; the sections below list its parts.");
    out += markdownSection<DataFile>("data.files", "A file of the data set.");
    out += markdownSection<Probe>("probes", "A place and time whose values are kept in a list.");
    out +=
        markdownSection<vis::Layer>("layers", "A layer of the 3D views; `technique` is one of the five types below.");
    out += markdownSection<vis::VolumeLayer>("Layer of type `volume`", "A scalar drawn with its transfer function.");
    out += markdownSection<vis::IsoLayer>("Layer of type `iso`", "A surface of equal value.");
    out += markdownSection<vis::SliceLayer>("Layer of type `slice`", "A coloured plane with contour lines.");
    out += markdownSection<vis::FlowLayer>("Layer of type `flow`", "Lines, tubes and glyphs of a vector.");
    out += markdownSection<vis::GlyphLayer>("Layer of type `glyphs`", "Figures moved by many parameters at once.");
    out += markdownSection<vis::GlyphPart>("glyphs.parts", "A part of a glyph and the parameter that moves it.");
    out += markdownSection<vis::WarmCool>(
        "look.tone", "Part of a look. Instead of its parts, a look can be given as the name of a preset: " +
                         presetNames<vis::Look>() + ".");
    out += markdownSection<vis::BoundaryEnhancement>("look.boundary", "Part of a look.");
    out += markdownSection<vis::SilhouetteEnhancement>("look.silhouette", "Part of a look.");
    out += markdownSection<vis::DistanceColor>("look.distance", "Part of a look.");
    out += markdownSection<vis::Cartoon>("look.cartoon", "Part of a look.");
    out += markdownSection<vis::CharcoalDrawing>("look.charcoal", "Part of a look.");
    out += markdownSection<vis::Paper>("paper", "The background of the picture.");
    out += markdownSection<vis::TransferFunction>("transfer", "Colour and opacity of one parameter, by its name.");
    out += markdownSection<vis::ColorStop>("transfer.colors", "A colour of a user-defined colour map.");
    out += markdownSection<vis::TransferRegion>(
        "transfer.regions", "An area in the plane of value and gradient magnitude that has opacity.");
    out += markdownSection<vis::Brush>("selection.brushes",
                                       "A brush: what it selects, and how it combines with the others.");
    out += markdownSection<vis::BrushInterval>("selection.brushes.region.intervals",
                                               "A range of values of one parameter.");
    out += markdownSection<vis::EllipseRegion>("Region of type `ellipse`", "An ellipse in two parameters.");
    out += markdownSection<vis::LassoRegion>("Region of type `lasso`", "A polygon in two parameters.");
    out += markdownSection<vis::SphereRegion>("Region of type `sphere`", "A ball in space.");
    out += markdownSection<vis::BoxRegion>("Region of type `box`", "A box in space.");
    out += markdownSection<vis::LensRegion>("Region of type `lens`", "The inside of a lens.");
    out += markdownSection<vis::Light>("lighting.lights", "One light.");
    out += markdownSection<vis::Clip>("clips", "A plane or body that cuts the data open.");
    out += markdownSection<vis::Lens>("lenses", "A lens; layers refer to it by its name.");
    out += markdownSection<Callout>("callouts", "A detail beside the volume; it follows the place that it shows.");
    forEachViewKind([&](const auto& kind) {
        using View = typename std::decay_t<decltype(kind)>::State;
        out += markdownSection<View>("View of type `" + std::string(View::kType) + "`", describeKind(kind.traits));
    });
    out += markdownSection<CompareVariant>("views.variants", "One variant.");
    out += markdownSection<Track>("animation.tracks", "The keyframes of one setting.");
    out += markdownSection<Keyframe>("animation.tracks.keys", "One keyframe.");
    out += markdownSection<volume::DerivedParameter>("data.derived", "A parameter computed from others.");
    out += recipeSections();
    return out;
}

} // namespace tessera::app
