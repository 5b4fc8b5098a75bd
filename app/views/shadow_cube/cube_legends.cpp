#include "app/views/shadow_cube/cube_legends.h"

#include "app/values/selection_text.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// Whether two faces of one parameter have different colours for a value.
bool coloredApart(const Wall& a, const Wall& b) {
    return a.transfer != b.transfer || (a.kind == WallKind::XRay) != (b.kind == WallKind::XRay);
}

/// Bars for faces with the same colours for the same values.
struct FaceBar {
    const Wall* wall;
    int channel;
    std::string titles; ///< of all its faces
};

} // namespace

std::string kindName(WallKind kind) {
    static constexpr const char* kNames[] = {"slice", "mean", "maximum", "absorption", "shadow", "volume"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::string kindText(WallKind kind, const volume::DatasetInfo& info, int axis, const std::string& parameter) {
    const bool drawn = info.lattice.axes[axis] && (kind == WallKind::Mean || kind == WallKind::XRay);
    return kindName(kind) + " " + parameter + (drawn ? " over the drawing" : "");
}

std::string faceName(std::size_t face) {
    static constexpr const char* kNames[] = {"left", "right", "bottom", "top", "back", "front"};
    return kNames[face];
}

std::vector<ShownFace> shownFaces(const Session& session, const CubeFrame& frame, const ShadowCubeView& view) {
    std::vector<ShownFace> faces;
    for (std::size_t i = 0; i < kCubeFaces.size(); ++i) {
        const Wall& wall = wallOf(view, i);
        const auto channel = resolveChannel(frame.info, session, wall.channel);
        if (!channel || !facesViewer(kCubeFaces[i], frame.half, frame.camera)) continue;
        const bool selection = wall.kind == WallKind::Shadow && session.selection.active();
        faces.push_back({i, *channel,
                         selection
                             ? "shadow of " + selectionName(session)
                             : kindText(wall.kind, frame.info, kCubeFaces[i].axis, frame.info.channel(*channel).name)});
    }
    std::vector<std::size_t> ambiguous;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (std::ranges::any_of(faces, [&](const ShownFace& other) {
                return other.title == faces[i].title &&
                       wallOf(view, other.face).transfer != wallOf(view, faces[i].face).transfer;
            }))
            ambiguous.push_back(i);
    for (const std::size_t i : ambiguous)
        if (wallOf(view, faces[i].face).kind != WallKind::Shadow) faces[i].title += ", " + faceName(faces[i].face);
    return faces;
}

std::vector<LegendEntry> faceLegends(const Session& session, const volume::DatasetInfo& info,
                                     const ShadowCubeView& view, const std::vector<ShownFace>& faces) {
    std::vector<FaceBar> bars;
    for (const ShownFace& face : faces) {
        const Wall& wall = wallOf(view, face.face);
        if (wall.kind == WallKind::Shadow) continue; // of one colour
        const auto same = std::ranges::find_if(
            bars, [&](const FaceBar& bar) { return bar.channel == face.channel && !coloredApart(*bar.wall, wall); });
        if (same == bars.end())
            bars.push_back({&wall, face.channel, face.title});
        else if (!same->titles.ends_with(face.title))
            same->titles += ", " + face.title;
    }
    std::ranges::stable_sort(bars, {}, &FaceBar::channel);
    std::vector<LegendEntry> legends;
    for (const FaceBar& bar : bars) {
        LegendEntry entry = legendOf(session, info, bar.channel, bar.wall->transfer);
        const auto count = std::ranges::count(bars, bar.channel, &FaceBar::channel);
        const bool share = bar.wall->kind == WallKind::XRay;
        if (count > 1 || share || !bar.wall->transfer.empty()) entry.title = bar.titles;
        if (share) measureShare(entry);
        legends.push_back(std::move(entry));
    }
    return legends;
}

} // namespace tessera::app
