#include "app/planes/contour_lines.h"

#include "app/pane/controls.h"
#include "app/ui/number_field.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <utility>

namespace tessera::app {

namespace {

constexpr ImU32 kInk = IM_COL32(12, 12, 12, 245), kHalo = IM_COL32(255, 255, 255, 110),
                kTextHalo = IM_COL32(255, 255, 255, 150); // drawn several times around the text

void layOut(ContourCache& cache, const Contours& contours, double step, const PlaneFrame& frame) {
    std::vector<PageLine> lines;
    for (const volume::ContourLine& line : contours.lines) {
        PageLine& own = lines.emplace_back(PageLine{contourText(line.level, step), {}});
        for (const glm::dvec2& point : line.points) {
            const ImVec2 at = frame.pixel(point);
            own.points.emplace_back(at.x, at.y);
        }
    }
    cache.labels.clear();
    if (cache.values)
        cache.labels = placeLabels(
            lines, {{frame.plot.min.x, frame.plot.min.y},
                    {frame.plot.max.x, frame.plot.max.y},
                    static_cast<double>(em()),
                    [](const std::string& text) { return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x); }});
    cache.pieces.clear();
    for (const std::vector<glm::dvec2>& piece : linesAround(lines, cache.labels)) {
        std::vector<ImVec2>& own = cache.pieces.emplace_back();
        for (const glm::dvec2& point : piece)
            own.emplace_back(static_cast<float>(point.x), static_cast<float>(point.y));
    }
}

} // namespace

void chooseContours(ToolRow& tools, const volume::DatasetInfo& info, ContourSettings& settings) {
    const float width = em() * 8;
    if (!tools.next(width)) return;
    ImGui::SetNextItemWidth(width);
    slider("##contours", settings.count, 0, 50, settings.count == 0 ? "no contours" : "%d contours");
    if (ImGui::IsItemHovered())
        tooltip("Number of contour lines over the colour range; of another parameter, or with values, at most this "
                "many at round values");
    if (settings.count == 0) return;
    if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        chooseChannel("##contourOf", &info, settings.channel, "same parameter");
        if (ImGui::IsItemHovered()) tooltip("Parameter of the contour lines");
    }
    if (!tools.next(checkboxWidth("values"))) return;
    ImGui::Checkbox("values", &settings.values);
    if (ImGui::IsItemHovered()) tooltip("Draw the lines at round values, labelled with them");
}

void drawContourNote(const std::string& note) {
    if (note.empty()) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(note.c_str());
    ImGui::PopTextWrapPos();
}

void drawContours(ViewContext& context, ContourCache& cache, const std::string& jobKey, const ContourQuery& query,
                  double step, bool values, const PlaneFrame& frame) {
    const auto contours = cache.answers.get(
        context, context.numbers, {.key = jobKey, .title = "Contour lines", .quiet = true}, query,
        [](const auto& source, const ContourQuery& asked, int, const Progress& progress) {
            return readContours(*source, asked, progress);
        },
        std::equal_to<>());
    if (!contours) return;
    const std::array<double, 5> page{frame.plot.min.x, frame.plot.min.y, frame.plot.max.x, frame.plot.max.y, em()};
    if (cache.drawn != contours || cache.page != page || cache.values != values) {
        cache.drawn = contours;
        cache.page = page;
        cache.values = values;
        layOut(cache, *contours, step, frame);
    }
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float width = std::max(1.2f, em() * 0.09f);
    for (const auto& [color, thick] : {std::pair{kHalo, width * 2.6f}, std::pair{kInk, width}})
        for (const std::vector<ImVec2>& piece : cache.pieces)
            draw.AddPolyline(piece.data(), static_cast<int>(piece.size()), color, 0, thick);
    for (const LineLabel& label : cache.labels) {
        const ImVec2 at{static_cast<float>(label.at.x), static_cast<float>(label.at.y)};
        for (const float x : {-1.0f, 0.0f, 1.0f})
            for (const float y : {-1.0f, 0.0f, 1.0f})
                if (x != 0 || y != 0)
                    addTextTurned(draw, {at.x + x, at.y + y}, static_cast<float>(label.angle), kTextHalo,
                                  label.text.c_str());
        addTextTurned(draw, at, static_cast<float>(label.angle), kInk, label.text.c_str());
    }
}

} // namespace tessera::app
