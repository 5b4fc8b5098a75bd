#pragma once

#include "volume/base/describe.h"

#include <imgui.h>
#include <optional>
#include <string>

/// Fields for numbers that are dragged, stepped and typed into.
namespace tessera::app {

/// What a field of numbers needs to know of them.
struct NumberStyle {
    std::string format;         ///< for printf
    std::optional<Range> range; ///< a slider from end to end; none: a drag without limits
    double span = 1;            ///< of the range, or of the numbers' usual size
    bool logScale = false;      ///< of the slider
    bool integer = false;
};

/// The multiple of a round step (at least fifty in the span; on a log scale one significant digit) nearest to a value,
/// within the range.
double snappedNumber(double value, const NumberStyle& style);

/// `count` numbers beside one another, as wide as the next item. A drag moves a number; with Shift a tenth as far, from
/// where it is; with Ctrl to snappedNumber. Ctrl and the wheel step by as much, with Shift too by a tenth. A double
/// click or Ctrl+click types. True if a number has changed.
bool numberFields(const char* id, double* values, int count, const NumberStyle& style);

/// ImGui's slider, but what is typed into it stays between its ends, too.
bool slider(const char* id, float& value, float lo, float hi, const char* format, ImGuiSliderFlags flags = 0);
bool slider(const char* id, int& value, int lo, int hi, const char* format);

} // namespace tessera::app
