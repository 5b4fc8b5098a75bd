#include "app/views/volume/upper_texts.h"

#include "app/pane/plot.h"
#include "app/ui/fitted_text.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <sstream>

namespace tessera::app {

UpperTexts upperTextsOf(const std::string& state, const std::string& stretch, const std::vector<std::string>& notes,
                        float room) {
    UpperTexts out;
    const auto widthOf = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
    const auto add = [&](const std::string& text) {
        std::istringstream lines(wrappedAtSpaces(text, room));
        for (std::string line; std::getline(lines, line);) out.left.push_back(fitText(line, room));
    };
    add(state);
    out.faintFrom = out.left.size();
    const float taken = out.left.empty() ? 0 : widthOf(out.left.front()) + em() * 1.5f;
    if (out.left.size() > 1 || taken + widthOf(stretch) > room)
        add(stretch);
    else
        out.right = stretch;
    for (const std::string& note : notes) add(note);
    return out;
}

std::vector<std::string> geometryNotes(const vis::Scene& scene) {
    std::vector<std::string> notes;
    for (const vis::GeometryLayer& layer : scene.geometry)
        for (const std::string& note : layer.geometry->notes)
            if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
    return notes;
}

} // namespace tessera::app
