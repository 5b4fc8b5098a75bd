#include "app/views/shadow_cube/cube_faces.h"

#include "app/pane/view_parts.h"
#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr int kPatches = 8; ///< along either edge of a face

/// A rectangle of a face between two physical positions.
void outlineOnFace(ImDrawList& draw, const CubeFrame& frame, const CubeFace& face, glm::dvec3 lo, glm::dvec3 hi,
                   ImU32 line, ImU32 fill) {
    const glm::dvec3 a = frame.world.toWorld(lo), b = frame.world.toWorld(hi);
    ImVec2 corners[4];
    for (int i = 0; i < 4; ++i) {
        const bool right = i == 1 || i == 2, up = i >= 2;
        const auto at = frame.pixel(face.at((right ? b : a)[face.right()], (up ? b : a)[face.up()], frame.half));
        if (!at) return;
        corners[i] = *at;
    }
    draw.AddConvexPolyFilled(corners, 4, fill);
    draw.AddPolyline(corners, 4, line, ImDrawFlags_Closed, 1.5f);
}

} // namespace

void drawFace(ImDrawList& draw, const CubeFrame& frame, const CubeFace& face, vis::TextureName texture) {
    const auto corner = [&](double s, double t) { return frame.pixel(face.at(s, t, frame.half)); };
    const double right = frame.half[face.right()], up = frame.half[face.up()];
    const auto a = corner(-right, -up), b = corner(right, -up), c = corner(right, up), d = corner(-right, up);
    if (!a || !b || !c || !d) return;
    const bool dark = darkTheme();
    draw.AddQuadFilled(*a, *b, *c, *d, dark ? IM_COL32(36, 39, 45, 255) : IM_COL32(236, 237, 240, 255));
    const double s = frame.world.halfSize[face.right()], t = frame.world.halfSize[face.up()];
    const auto id = textureId(texture);
    for (int j = 0; j < kPatches; ++j)
        for (int i = 0; i < kPatches; ++i) {
            const auto at = [](int k) { return float(k) / kPatches; };
            const auto place = [&](int x, int y) {
                return corner((2 * double(at(x)) - 1) * s, (2 * double(at(y)) - 1) * t);
            };
            const auto p = place(i, j), q = place(i + 1, j), r = place(i + 1, j + 1), u = place(i, j + 1);
            if (!p || !q || !r || !u) continue;
            draw.AddImageQuad(id, *p, *q, *r, *u, {at(i), at(j)}, {at(i + 1), at(j)}, {at(i + 1), at(j + 1)},
                              {at(i), at(j + 1)});
        }
    draw.AddQuad(*a, *b, *c, *d, plotColors().frame);
}

double coveredByCube(const CubeFrame& frame, ImVec2 min, ImVec2 max) {
    double covered = coveredByBox(frame.space, min, max);
    for (const CubeFace& face : kCubeFaces) {
        if (!facesViewer(face, frame.half, frame.camera)) continue;
        // The projection: a box without depth, on the face.
        SpaceFrame flat = frame.space;
        const double at = frame.world.toPhysical(face.at(0, 0, frame.half))[face.axis];
        flat.bounds.lo[face.axis] = flat.bounds.hi[face.axis] = at;
        covered = std::max(covered, coveredByBox(flat, min, max));
    }
    return covered;
}

ImVec2 faceTitlePlace(const CubeFrame& frame, std::size_t index, ImVec2 size,
                      const std::vector<std::pair<ImVec2, ImVec2>>& taken) {
    const CubeFace& face = kCubeFaces[index];
    const glm::dvec3 box = frame.world.halfSize;
    const ImVec2 middle{frame.min.x + frame.size.x / 2, frame.min.y + frame.size.y / 2};
    const auto keptIn = [](float at, float half, float lo, float hi) {
        return std::clamp(at, lo + half + em() * 0.5f, std::max(lo + half + em() * 0.5f, hi - half - em() * 0.5f));
    };
    ImVec2 best = middle;
    double bestScore = -1e30;
    for (const int end : {-1, 1})
        for (const bool along : {false, true})
            for (const double out : {0.5, 1.0, 1.5}) { // in the margin, over the edge of the face, or beside it
                const int axis = along ? face.right() : face.up();
                const double place = end * glm::mix(box[axis], frame.half[axis], out);
                const auto p = frame.pixel(along ? face.at(place, 0, frame.half) : face.at(0, place, frame.half));
                if (!p) continue;
                const ImVec2 at{keptIn(p->x, size.x / 2, frame.min.x, frame.max().x),
                                keptIn(p->y, size.y / 2, frame.min.y, frame.max().y)};
                const ImVec2 lo{at.x - size.x / 2 - em() * 0.3f, at.y - size.y / 2},
                    hi{at.x + size.x / 2 + em() * 0.3f, at.y + size.y / 2};
                double over = coveredByCube(frame, lo, hi);
                for (const auto& [from, to] : taken)
                    if (lo.x < to.x && from.x < hi.x && lo.y < to.y && from.y < hi.y) over += 1;
                const double away = std::hypot(p->x - middle.x, p->y - middle.y) / std::max(1.0f, frame.size.x);
                const double score = away - 2 * over - 0.1 * out;
                if (score > bestScore) bestScore = score, best = at;
            }
    return best;
}

void drawMarks(ImDrawList& draw, const CubeFrame& frame, const Session& session, const Decoration& shown,
               std::size_t index) {
    const CubeFace& face = kCubeFaces[index];
    const PlotColors colors = plotColors();
    for (const vis::Brush& brush : session.selection.brushes) {
        const auto* box = std::get_if<vis::BoxRegion>(&brush.region);
        if (!shown.outlines || !brush.enabled || !box) continue;
        const glm::dvec3 lo = glm::max(box->center - box->radius, frame.info.bounds.lo),
                         hi = glm::min(box->center + box->radius, frame.info.bounds.hi);
        outlineOnFace(draw, frame, face, lo, hi, brushColor(brush), brushColor(brush, 0.12f));
    }
    const glm::dvec3 cursor = frame.world.toWorld(session.cursor);
    const double s = cursor[face.right()], t = cursor[face.up()];
    const glm::dvec3 box = frame.world.halfSize;
    const auto line = [&](glm::dvec3 from, glm::dvec3 to, ImU32 color) {
        const auto a = frame.pixel(from), b = frame.pixel(to);
        if (a && b && shown.cursor) draw.AddLine(*a, *b, color, 1.2f);
    };
    line(face.at(-box[face.right()], t, frame.half), face.at(box[face.right()], t, frame.half), colors.cursor);
    line(face.at(s, -box[face.up()], frame.half), face.at(s, box[face.up()], frame.half), colors.cursor);
    line(cursor, face.at(s, t, frame.half), (colors.cursor & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 110));
}

void drawFaceTitle(ImDrawList& draw, const CubeFrame& frame, std::size_t index, const std::string& title,
                   std::vector<std::pair<ImVec2, ImVec2>>& taken) {
    for (const float share : {0.5f, 0.33f, 0.2f}) { // of the width of the picture: shorter where others are in the way
        const std::string shown = fitText(title, (frame.max().x - frame.min.x) * share);
        const ImVec2 size = ImGui::CalcTextSize(shown.c_str()), at = faceTitlePlace(frame, index, size, taken);
        const ImVec2 lo{at.x - size.x / 2, at.y - size.y / 2}, hi{at.x + size.x / 2, at.y + size.y / 2};
        const bool free = std::ranges::none_of(taken, [&](const auto& each) {
            return lo.x < each.second.x && each.first.x < hi.x && lo.y < each.second.y && each.first.y < hi.y;
        });
        if (!free) continue;
        taken.emplace_back(lo, hi);
        addTextWithBackdrop(draw, at, {0.5f, 0.5f}, plotColors().text, shown.c_str());
        return tellWhole(lo, hi, title, shown);
    }
    taken.emplace_back(frame.min, frame.min); // no place at all
}

} // namespace tessera::app
