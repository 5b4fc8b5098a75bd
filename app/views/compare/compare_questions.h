#pragma once

#include "app/pane/controls.h"
#include "app/session/views/view_state.h"
#include "app/values/table.h"

#include <string>
#include <vector>

/// Questions about compared pictures ("Which spot is hotter?"), answered below them. The session stores the answers and
/// the time each took.
namespace tessera::app {

/// When the questions came on screen.
struct QuestionClock {
    double shown = -1; ///< s, of ImGui's clock
};

/// Questions, answers and the seconds they took.
Table questionsTable(const std::vector<CompareQuestion>& questions);

/// Height in pixels of the questions of a view, 0 where there are none.
float questionsHeight(const CompareView& view);

/// A row for each: the question, the answer (one of the variants' names, or any words), the time it took.
void drawQuestions(const ViewContext& context, CompareView& view, QuestionClock& clock,
                   const std::vector<std::string>& variants);

} // namespace tessera::app
