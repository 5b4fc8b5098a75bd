#pragma once

#include "app/session/session.h"
#include "app/values/table.h"

#include <string>
#include <vector>

/// What is selected in words: its name, which tables, plots and legends show, and its definition, which files state.
namespace tessera::app {

/// What a region holds, in one line: "O2  0 .. 0.2 mol/m3". `whole`: as files state it, with six digits, the width of
/// soft edges, places and corners, each with its unit.
std::string regionText(const volume::DatasetInfo& info, const vis::Region& region, bool whole = false);

/// How the enabled brushes combine, by what `nameOf` says of each: "(1 and 2) without 3", "not 1"; "" without any.
std::string combinedBrushes(const vis::Selection& selection, const std::function<std::string(std::size_t)>& nameOf);

/// The name of what is selected: that of the only enabled brush, or "not" and this; of several Selection::name, or how
/// they combine, "starved and flooded"; without brushes that of the lens that marks. "" if nothing is selected.
std::string selectionName(const Session& session);
/// The name of the rest: "not starved", "not (starved and flooded)".
std::string restName(const std::string& selectionName);
/// Names the only enabled brush, or what several select together.
void nameSelection(Session& session, const std::string& name);

/// Definition of what is selected, a line each: the name, and of each enabled brush what it holds. None if nothing is
/// selected.
std::vector<std::string> selectionNotes(const Session& session, const volume::DatasetInfo& info);

/// Says of a column of numbers of samples that they are weighted where one of them is not whole: its name in files
/// becomes "weightedSamples" or "weighted samples ...", and people read "Weighted samples", with one decimal.
void sayWeighted(TableColumn& samples);

} // namespace tessera::app
