#include "app/session/session.h"

#include "app/described/key_words.h"
#include "app/described/within_ranges.h"
#include "app/session/label_colors.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

DockNode stack(int id, std::vector<std::string> tabs) {
    DockNode node;
    node.id = id;
    node.tabs = std::move(tabs);
    return node;
}

DockNode split(int id, DockKind kind, float ratio, DockNode a, DockNode b) {
    DockNode node;
    node.id = id;
    node.kind = kind;
    node.ratio = ratio;
    node.children.push_back(std::move(a));
    node.children.push_back(std::move(b));
    return node;
}

/// 1, 2 or 5 times a power of ten, at or below `value`.
double niceBelow(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    const double digit = value / power;
    return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/// A domain up to four times as long as wide keeps its proportions; thinner axes are stretched to a quarter of the
/// longest.
glm::dvec3 defaultStretch(const volume::Box& bounds) {
    const glm::dvec3 size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    glm::dvec3 stretch{1};
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 0 && longest / size[axis] > 4) stretch[axis] = niceBelow(longest / (3 * size[axis]));
    return stretch;
}

} // namespace

Session::Session() = default;
Session::Session(const Session&) = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(const Session&) = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;
bool Session::operator==(const Session&) const = default;

vis::Scene sceneOf(const Session& session) {
    vis::Scene scene;
    scene.camera = session.camera;
    scene.layers = session.layers;
    scene.transfer = session.transfer;
    scene.selection = session.selection;
    scene.render = session.render;
    scene.lighting = session.lighting;
    scene.clips = session.clips;
    scene.lenses = session.lenses;
    scene.tone = session.tone;
    scene.depthMask = session.depthMask;
    scene.paper = session.paper;
    scene.stretch = session.stretch;
    scene.cursor = session.cursor;
    scene.time = session.time;
    const bool dark = session.appearance.theme == Theme::Dark;
    scene.background = dark ? glm::vec3(0.085f, 0.092f, 0.107f) : glm::vec3(0.965f, 0.968f, 0.975f);
    scene.boxColor = dark ? glm::vec3(0.42f) : glm::vec3(0.55f);
    return scene;
}

bool drawsToScale(PictureLattice lattice, const volume::DatasetInfo& info) {
    return lattice == PictureLattice::Even && !info.lattice.isEven() && info.lattice.kind == volume::LatticeKind::CC &&
           !info.remote && double(info.lattice.count()) <= kMostToScale;
}

PictureLattice latticeFor(PictureLattice chosen, const volume::DatasetInfo& info) {
    if (chosen != PictureLattice::Even || drawsToScale(chosen, info)) return chosen;
    return info.lattice.isEven() ? DataRef{}.lattice : PictureLattice::Grid;
}

namespace {

/// Beside the originals all is drawn as it is stored.
bool toScale(const DataRef& data, const volume::DatasetInfo& info) {
    return drawsToScale(data.lattice, info) && !(data.packed && data.originals);
}

} // namespace

vis::LensSpace lensSpace(const Session& session, const volume::DatasetInfo& info) {
    vis::WorldFrame frame = vis::worldFrame(info, session.stretch);
    if (toScale(session.data, info)) frame.axes = {};
    return {vis::placeLenses(session.lenses, frame, session.camera, session.cursor, session.time), frame};
}

vis::LensSpace brushSpace(const Session& session, const volume::DatasetInfo& info) {
    if (vis::selectsLens(session.selection)) return lensSpace(session, info);
    vis::LensSpace space;
    if (!toScale(session.data, info)) space.frame.axes = info.lattice.axes;
    return space;
}

std::vector<std::string> paneKeys(const Session& session) {
    std::vector<std::string> keys;
    for (const auto& [key, view] : session.views) keys.push_back(key);
    return keys;
}

std::string paneTitle(const Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    if (found == session.views.end()) return pane;
    std::string title(traitsOf(found->second).title);
    if (const auto dash = pane.rfind('-'); dash != std::string::npos) title += " " + pane.substr(dash + 1);
    return title;
}

std::optional<ViewState> viewOfKind(std::string_view kind) {
    std::optional<ViewState> view;
    forEachViewKind([&](const auto& row) {
        using State = typename std::decay_t<decltype(row)>::State;
        if (sameName(State::kType, kind)) view = State{};
    });
    return view;
}

std::string addView(Session& session, const ViewState& view) {
    const std::string base(std::visit([](const auto& v) { return std::decay_t<decltype(v)>::kType; }, view));
    std::string key = base;
    for (int number = 2; session.views.contains(key); ++number) key = base + "-" + std::to_string(number);
    session.views[key] = view;
    repair(session.dock, paneKeys(session));
    return key;
}

std::string firstVector(const volume::DatasetInfo& info) {
    for (const volume::Parameter& parameter : info.parameters)
        if (parameter.components == 3) return parameter.name;
    return {};
}

std::string layerName(const vis::Layer& layer) {
    if (!layer.name.empty()) return layer.name;
    if (const auto* slice = std::get_if<vis::SliceLayer>(&layer.technique)) {
        const bool oblique = slice->orientation == vis::SliceOrientation::Oblique;
        return slice->channel + (oblique ? " oblique slice" : " slice ") +
               (oblique ? "" : std::string(1, "xyz"[static_cast<int>(slice->orientation)]));
    }
    if (const auto* surface = std::get_if<vis::IsoLayer>(&layer.technique)) return surface->channel + " surface";
    if (const auto* flow = std::get_if<vis::FlowLayer>(&layer.technique))
        return (flow->vector.empty() ? flow->channel : flow->vector) + " flow";
    if (const auto* glyphs = std::get_if<vis::GlyphLayer>(&layer.technique)) return glyphs->channel + " glyphs";
    return std::get<vis::VolumeLayer>(layer.technique).channel + " volume";
}

std::vector<int> scalarChannels(const volume::DatasetInfo& info) {
    const auto channels = info.channels();
    std::vector<int> out;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const volume::Parameter& parameter = info.parameters[std::size_t(channels[i].parameter)];
        const Range range = info.channelRange(channels[i]);
        if (!parameter.categorical && parameter.components == 1 && range.hi > range.lo) out.push_back(int(i));
    }
    return out;
}

std::string firstChannel(const volume::DatasetInfo& info) {
    if (const std::vector<int> scalars = scalarChannels(info); !scalars.empty()) return info.channel(scalars[0]).name;
    const auto channels = info.channels();
    for (const bool magnitude : {true, false})
        for (const volume::Channel& channel : channels) {
            const volume::Parameter& parameter = info.parameters[std::size_t(channel.parameter)];
            const bool whole = parameter.components > 1 && channel.component == parameter.components;
            if (!parameter.categorical && (whole || !magnitude)) return channel.name;
        }
    return channels.empty() ? std::string() : channels.front().name;
}

void colorDifferences(Session& session) {
    for (const volume::DerivedParameter& each : session.data.derived)
        if (std::holds_alternative<volume::DifferenceRecipe>(each.recipe))
            session.transfer.try_emplace(each.name, vis::divergingFunction());
}

Session defaultSession(const volume::DatasetInfo& info, const DataRef& data) {
    Session session;
    session.title = info.name;
    session.data = data;
    session.cursor = info.bounds.center();
    session.time = info.times.empty() ? 0 : info.times.front();
    session.stretch = defaultStretch(info.bounds);
    // The sphere around the box just fits between the upper and lower edge.
    const double radius = glm::length(vis::worldFrame(info, session.stretch).halfSize);
    const double half = glm::radians(static_cast<double>(session.camera.fieldOfView)) / 2;
    session.camera.distance = static_cast<float>(std::max(0.5, radius / std::sin(half)));
    const std::string channel = firstChannel(info);
    if (!channel.empty()) {
        // Data of one sample's thickness has no volume to look through.
        vis::SliceLayer slice{.channel = channel};
        const glm::dvec3 size = info.bounds.size();
        const bool flat = !(size.x > 0 && size.y > 0 && size.z > 0);
        if (flat)
            slice.orientation = !(size.z > 0)   ? vis::SliceOrientation::Z
                                : !(size.y > 0) ? vis::SliceOrientation::Y
                                                : vis::SliceOrientation::X;
        session.layers.push_back({channel, !flat, vis::VolumeLayer{.channel = channel}});
        // Where there is nothing but a vector, its flow is what there is to see.
        const std::string vector = flat || !scalarChannels(info).empty() ? std::string() : firstVector(info);
        if (!vector.empty())
            session.layers.push_back(
                {vector + " flow", true, vis::FlowLayer{.vector = vector, .channel = channel, .weight = channel}});
        session.layers.push_back({channel + " slice", flat, slice});
    }
    const auto channels = info.channels();
    // None that begins in black, which is not seen on a dark ground.
    static constexpr std::string_view maps[] = {"viridis", "plasma", "cividis"};
    std::size_t next = 0;
    colorDifferences(session);
    for (const volume::Channel& each : channels) {
        if (session.transfer.contains(each.name)) continue;
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(each.parameter)];
        vis::TransferFunction function;
        // Low values of a scan are mostly air or noise; those of a simulation are results.
        if (parameter.type != volume::ScalarType::F32 && !parameter.categorical)
            function.opacity = {{0.0f, 0.0f}, {0.15f, 0.0f}, {1.0f, 0.8f}};
        const Range range = info.channelRange(each);
        if (!parameter.categorical && each.component < parameter.components && range.lo < 0 && range.hi > 0 &&
            parameter.components > 1) {
            // A signed component of a vector: the white middle of the colour map is zero.
            const double most = std::max(-range.lo, range.hi);
            function.colormap = "blue-orange";
            function.autoRange = false;
            function.range = {-most, most};
        } else {
            function.colormap = std::string(maps[next++ % std::size(maps)]);
        }
        if (parameter.categorical) {
            function.colormap = "labels";
            function.colors = labelStops(parameter, range);
        }
        session.transfer[each.name] = function;
    }
    session.views["volume"] = VolumeView{};
    session.views["slices"] = SlicesView{};
    session.views["scatterMatrix"] = ScatterMatrixView{};
    session.views["transfer"] = TransferView{};
    session.views["layers"] = LayersView{};
    session.views["timeline"] = TimelineView{};
    session.views["data"] = DataView{};
    session.views["history"] = HistoryView{};
    session.views["log"] = LogView{};
    DockNode upper = split(2, DockKind::Row, 0.6f, stack(3, {"volume"}),
                           split(4, DockKind::Column, 0.5f, stack(5, {"slices"}), stack(6, {"scatterMatrix"})));
    DockNode left = split(7, DockKind::Column, 0.86f, std::move(upper), stack(8, {"timeline"}));
    DockNode right =
        split(9, DockKind::Column, 0.5f, stack(10, {"layers", "data", "history"}), stack(11, {"transfer", "log"}));
    session.dock.root = split(1, DockKind::Row, 0.79f, std::move(left), std::move(right));
    keepWithinRanges(session); // whatever the data are
    return session;
}

} // namespace tessera::app
