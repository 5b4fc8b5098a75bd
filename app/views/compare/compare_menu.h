#pragma once

#include "app/pane/tool_row.h"
#include "app/views/compare/compare_pictures.h"

/// Editing of a comparison: which variants there are and what each changes.
namespace tessera::app {

/// What the menus keep while they are open.
struct CompareMenuState {
    std::string search, path;
};

/// Mode, variants to add, what is compared, the table's switch.
/// `variants` are those shown; what changes them makes them the view's own.
void drawCompareToolbar(ViewContext& context, ToolRow& tools, CompareView& view, std::vector<CompareVariant> variants);

/// The popup `id` of one variant: its name, what it changes, its role.
void drawVariantMenu(ViewContext& context, const char* id, CompareView& view, std::vector<CompareVariant> variants,
                     std::size_t index, const CompareCell* cell, CompareMenuState& state);

} // namespace tessera::app
