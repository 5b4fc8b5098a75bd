#include "app/views/tesseract/tesseract_controls.h"

#include "app/pane/view_parts.h"
#include "app/ui/number_field.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"
#include "app/views/tesseract/tesseract_turn.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::array<const char*, 3> kHandWords{"drag turns", "drag selects a box", "drag selects by a lasso"};

void chooseHand(ToolRow& tools, TesseractHand& hand) {
    const float width = em() * 9.5f;
    if (!tools.next(width)) return;
    ImGui::SetNextItemWidth(width);
    if (ImGui::BeginCombo("##hand", kHandWords[std::size_t(hand)])) {
        for (std::size_t i = 0; i < kHandWords.size(); ++i)
            if (ImGui::Selectable(kHandWords[i], std::size_t(hand) == i)) hand = TesseractHand(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered())
        tooltip("What a drag does: turn, or draw a brush that all views share (where two axes face you); Shift adds to "
                "the selection, Ctrl removes from it");
}

/// Further axes: a list with a tick for each parameter.
void chooseFurther(ToolRow& tools, const volume::DatasetInfo& info, TesseractView& view, std::size_t axes) {
    const std::string label = std::to_string(axes) + " axes"; // parameters that the data lack have none
    const float width = em() * 5;
    if (!tools.next(width)) return;
    ImGui::SetNextItemWidth(width);
    if (ImGui::BeginCombo("##more", label.c_str())) {
        for (const volume::Channel& channel : info.channels()) {
            const auto found = std::find(view.more.begin(), view.more.end(), channel.name);
            const bool on = found != view.more.end();
            const bool full = view.more.size() >= std::size_t(vis::kMostAxes - 4);
            ImGui::BeginDisabled(full && !on);
            bool wanted = on;
            if (ImGui::Checkbox(channel.name.c_str(), &wanted)) {
                // Turns and stretches are of places in the list: those of a changed list would mean others.
                view.turnMore.clear();
                view.stretch.resize(std::min<std::size_t>(view.stretch.size(), 4));
                on ? void(view.more.erase(found)) : view.more.push_back(channel.name);
            }
            ImGui::EndDisabled();
        }
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Parameters along a fifth and further axes, up to eight");
}

struct SliderGrid {
    int columns, rows;
    float each, space;
};
SliderGrid sliderGrid(float width, int count) {
    SliderGrid grid{};
    grid.space = ImGui::GetStyle().ItemSpacing.x;
    const int most = std::max(2, int(width / (em() * 6.6f)));
    grid.columns = count <= 6 ? (width < em() * 20 ? 2 : 3) : std::min(most, count);
    grid.rows = (count + grid.columns - 1) / grid.columns;
    grid.each =
        std::floor((width - grid.space * static_cast<float>(grid.columns - 1)) / static_cast<float>(grid.columns));
    return grid;
}

/// A name within a format of printf.
std::string quotedFormat(const std::string& name) {
    std::string out;
    for (const char c : name) out += c == '%' ? std::string("%%") : std::string(1, c);
    return out;
}

/// Sliders: of the planes, and of the axes' stretch where there are more than four or one is stretched.
int sliderCount(int axes) {
    return vis::planeCount(axes) + (axes > 4 ? axes : 0);
}

} // namespace

void resetTurn(TesseractView& view, double& tour) {
    const TesseractView start;
    view.turn = start.turn;
    view.turn4 = start.turn4;
    view.turnMore = start.turnMore;
    view.zoom = start.zoom;
    view.parallel = start.parallel;
    view.tour = false;
    tour = 0;
}

void drawTesseractTools(ViewContext& context, TesseractView& view, const std::vector<TesseractAxis>& axes, double& tour,
                        const std::string& shown) {
    const volume::DatasetInfo& info = context.source->info();
    std::string channel = shown;
    ToolRow tools(context);
    const float list = std::min(em() * 7, tools.room() * 0.3f);
    if (tools.next(list)) {
        ImGui::SetNextItemWidth(list);
        if (chooseChannel("##channel", &info, channel)) view.channel = channel;
        if (ImGui::IsItemHovered()) tooltip("Parameter whose transfer function the points are drawn with");
    }
    if (tools.next(list)) {
        ImGui::SetNextItemWidth(list);
        chooseChannel("##fourth", &info, view.fourth, "time");
        if (ImGui::IsItemHovered()) tooltip("Along the fourth axis: time, or a parameter at the time shown");
    }
    chooseFurther(tools, info, view, axes.size());
    chooseHand(tools, view.hand);
    const auto button = [&](const char* id, Icon icon, const char* help, bool lit = false) {
        return tools.next(iconButtonWidth(context, icon)) && iconButton(context, id, icon, help, true, lit);
    };
    if (button("tour", view.tour ? icons::kPause : icons::kPlay, "Tour: keep turning in two planes at once", view.tour))
        view.tour = !view.tour;
    if (button("reset", {icon::kHome, "reset"}, "Reset the rotation (R)")) resetTurn(view, tour);
    if (button("options", {icon::kGear, "..."}, "Settings: projection, splats, samples, light, both eyes"))
        ImGui::OpenPopup("options");
    if (ImGui::BeginPopup("options")) {
        ImGui::Dummy({em() * 20, 0});
        drawDescribed(view, WidgetContext{.info = &info});
        ImGui::EndPopup();
    }
    drawNote(tools, "when and where values occur: what moves leans along " + axes[3].name);
}

float turnSlidersHeight(ImVec2 room, int axes) {
    if (room.y <= em() * 14 || room.x <= em() * 12) return 0;
    const int rows = sliderGrid(room.x, sliderCount(axes)).rows;
    const float height =
        static_cast<float>(rows) * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
    return height < room.y * 0.4f ? height : 0;
}

void drawTurnSliders(TesseractView& view, const std::vector<TesseractAxis>& axes, double& tour,
                     const vis::RotationN& rotation, float width) {
    const int count = int(axes.size());
    std::vector<double> angles = tour != 0 ? vis::anglesOf(rotation, count) : anglesOf(view, count);
    bool moved = false;
    const SliderGrid grid = sliderGrid(width, sliderCount(count));
    const auto place = [&](int i) {
        if (i % grid.columns != 0) ImGui::SameLine();
        ImGui::SetNextItemWidth(grid.each);
        ImGui::PushID(i);
    };
    for (int i = 0; i < vis::planeCount(count); ++i) {
        const auto [a, b] = vis::planeAxes(i);
        const std::string &first = axes[std::size_t(a)].name, &second = axes[std::size_t(b)].name;
        // Names of one letter stand together, as in xy; longer ones would run into each other.
        const std::string name = first.size() + second.size() <= 2 || b == 3 ? first + second : first + " " + second;
        auto angle = static_cast<float>(angles[std::size_t(i)]);
        place(i);
        // A drag leaves traces of a degree, which would be written "-0".
        const char* number = std::abs(angle) < 0.5f ? "0" : "%.0f";
        if (slider("##angle", angle, -180, 180, (quotedFormat(name) + "  " + number + "\xc2\xb0").c_str())) {
            angles[std::size_t(i)] = static_cast<double>(angle);
            moved = true;
        }
        ImGui::PopID();
        if (ImGui::IsItemHovered())
            tooltip(("Rotation in the plane of " + first + " and " + second + "; Ctrl+click to type").c_str());
    }
    for (int i = vis::planeCount(count); i < sliderCount(count); ++i) {
        const auto axis = std::size_t(i - vis::planeCount(count));
        auto factor = static_cast<float>(stretchOf(view, axis));
        place(i);
        if (slider("##stretch", factor, 0.1f, 10, (quotedFormat(axes[axis].name) + "  \xc3\x97 %.2g").c_str(),
                   ImGuiSliderFlags_Logarithmic)) {
            view.stretch.resize(std::max(view.stretch.size(), axis + 1), 1.0f);
            view.stretch[axis] = factor;
        }
        ImGui::PopID();
        if (ImGui::IsItemHovered()) tooltip(("Length of the axis " + axes[axis].name).c_str());
    }
    if (!moved) return;
    setAngles(view, angles);
    tour = 0;
}

} // namespace tessera::app
