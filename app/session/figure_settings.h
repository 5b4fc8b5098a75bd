#pragma once

#include "volume/base/describe.h"

#include <string>
#include <string_view>

/// What the user sets of figures beside their size: texts, numbers of axes, what fills the picture.
namespace tessera::app {

enum class TickNumbers { Automatic, Decimals, Exponents };
inline constexpr std::string_view kTickNumbersNames[] = {"automatic", "decimals", "exponents"};

/// How many numbers stand at an axis, and how they are written.
struct TickStyle {
    int most = 0; ///< steps between them; 0: as many as have room
    TickNumbers numbers = TickNumbers::Automatic;
    int decimals = 2;
    bool operator==(const TickStyle&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.most, FieldInfo{.key = "most",
                                   .doc = "Most steps between the numbers of an axis; 0: as many as have room",
                                   .range = Range{0, 20}});
        visit(
            self.numbers,
            FieldInfo{.key = "numbers",
                      .doc = "Numbers of axes: as short as can be, with a fixed number of decimals, or with exponents",
                      .names = kTickNumbersNames});
        visit(self.decimals, FieldInfo{.key = "decimals",
                                       .doc = "Digits behind the point",
                                       .range = Range{0, 9},
                                       .applies = self.numbers != TickNumbers::Automatic});
    }
};

struct FigureSettings {
    std::string title, captions;
    TickStyle ticks = {};
    bool fit = false;
    bool operator==(const FigureSettings&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.title, FieldInfo{"title", "Text above the figure; empty: none"});
        visit(self.captions, FieldInfo{"captions", "Texts in place of the names of axes, their units stay: "
                                                   "z = along the channel; T = temperature"});
        visit(self.ticks, FieldInfo{"ticks", "Numbers at axes"});
        visit(self.fit, FieldInfo{"fit", "Views in space: what is seen fills the picture, in place of the box"});
    }
};

/// What stands at an axis of this name: its caption, else the name.
std::string captionOf(const FigureSettings& settings, const std::string& name);

} // namespace tessera::app
