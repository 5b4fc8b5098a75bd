#pragma once

#include "app/session/views/view_kind.h"
#include "volume/base/describe.h"

#include <map>
#include <string>
#include <vector>

/// The saved state of the comparison of variants of the scene.
namespace tessera::app {

/// How variants of the scene are put beside each other.
enum class CompareMode { Grid, Swipe, Blink, Difference };
inline constexpr std::string_view kCompareModeNames[] = {"grid", "swipe", "blink", "difference"};

/// What *difference* shows: how far the colours of the pictures differ, or the first layer's values, in their unit.
enum class DifferenceOf { Colors, Values };
inline constexpr std::string_view kDifferenceOfNames[] = {"colors", "values"};

/// The session with some settings changed.
struct CompareVariant {
    std::string name;                           ///< "" = made of the changes
    std::map<std::string, std::string> changes; ///< JSON pointer into the session -> JSON, or text
    bool operator==(const CompareVariant&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{"name", "Title above the picture; empty: its changes"});
        visit(self.changes, FieldInfo{.key = "changes",
                                      .doc = "Changed settings: the path in the session as for --set, and the value",
                                      .hidden = true});
    }
};

/// A question to whoever compares, and the answer.
struct CompareQuestion {
    std::string text, answer;
    double seconds = 0; ///< from when it came on screen to the answer; 0 = not answered
    bool operator==(const CompareQuestion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.text, FieldInfo{"text", "The question"});
        visit(self.answer, FieldInfo{"answer", "The answer"});
        visit(self.seconds, FieldInfo{.key = "seconds", .doc = "Time taken to answer", .unit = "s"});
    }
};

/// The 3D scene in several variants: cameras, time, cursor and brushes are those of the session.
struct CompareView {
    static constexpr std::string_view kType = "compare";
    CompareMode mode = CompareMode::Grid;
    std::string shows;                    ///< pane whose view is compared; "" = the 3D scene
    std::vector<CompareVariant> variants; ///< one without changes is the session as it is
    int reference = 0;                    ///< index of the variant that the others are measured against
    int other = 1;                        ///< index of the one swiped over the reference
    float swipe = 0.5f;                   ///< place of the line, share of the width
    float blinkSeconds = 0.8f;
    DifferenceOf differenceOf = DifferenceOf::Colors;
    float differenceTop = 0; ///< difference of 8-bit colours shown brightest; 0 = the largest there is
    bool showTable = true;
    std::vector<CompareQuestion> questions;
    bool operator==(const CompareView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.mode, FieldInfo{.key = "mode",
                                   .doc = "Side by side (grid), on either side of a line (swipe), in turn in one place "
                                          "(blink), or the difference from the reference",
                                   .names = kCompareModeNames});
        visit(self.shows, FieldInfo{.key = "shows",
                                    .doc = "Name of the view that is shown once for each variant, such as \"slices\"; "
                                           "empty: the 3D scene",
                                    .hidden = true});
        visit(self.variants,
              FieldInfo{.key = "variants", .doc = "Variants of the session with changed settings", .hidden = true});
        visit(self.reference, FieldInfo{.key = "reference",
                                        .doc = "Variant that the others are compared with, counted from 0",
                                        .range = Range{0, 15},
                                        .hidden = true});
        visit(self.other, FieldInfo{.key = "other",
                                    .doc = "Swipe: variant shown beside the reference, counted from 0",
                                    .range = Range{0, 15},
                                    .hidden = true});
        visit(self.swipe, FieldInfo{.key = "swipe",
                                    .doc = "Swipe: position of the dividing line",
                                    .range = Range{0, 1},
                                    .applies = self.mode == CompareMode::Swipe});
        visit(self.blinkSeconds, FieldInfo{.key = "blinkSeconds",
                                           .doc = "How long each variant is shown",
                                           .unit = "s",
                                           .range = Range{0.1, 10},
                                           .applies = self.mode == CompareMode::Blink});
        visit(self.differenceOf, FieldInfo{.key = "differenceOf",
                                           .doc = "Difference of the colours of the pictures, or of the values of the "
                                                  "parameter of the first layer, on the planes through the cross-hair",
                                           .names = kDifferenceOfNames,
                                           .applies = self.mode == CompareMode::Difference});
        visit(self.differenceTop,
              FieldInfo{.key = "differenceTop",
                        .doc = "Difference of colours that is drawn brightest; 0 = the largest that occurs",
                        .unit = "of 255",
                        .range = Range{0, 255},
                        .applies = self.mode == CompareMode::Difference && self.differenceOf == DifferenceOf::Colors});
        visit(self.showTable, FieldInfo{"table", "Show a table of changes, costs and errors"});
        visit(
            self.questions,
            FieldInfo{.key = "questions", .doc = "Questions about the comparison, with their answers", .hidden = true});
    }
};
DrawView<CompareView> drawCompareView;

} // namespace tessera::app
