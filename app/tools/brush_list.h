#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/view_context.h"
#include "app/ui/fitted_text.h"

/// The list of brushes, and brushes in space.
namespace tessera::app {

/// Every brush with its colour, name, switches and numbers, and buttons that add brushes in space at the cursor. The
/// list goes to `next` and unfolds it.
void drawBrushList(ViewContext& context, NextEntry next = {});

/// A field for the name of what is selected; nothing without an enabled brush.
void drawSelectionName(Session& session);

/// The combination of the enabled brushes by their numbers: "(1 and 2) or 3", with a hint on other combinations if they
/// only narrow the selection; "" for fewer than two.
std::string combinationText(const vis::Selection& selection);

/// A ball or box around the cross-hair that appears a sixth as wide as the box, whatever the stretch.
vis::Brush spaceBrush(const Session& session, const volume::DatasetInfo& info, bool box);

/// Adds one with a name and colour of its own, as "or" beside others in space.
void addSpaceBrush(Session& session, const volume::DatasetInfo& info, bool box);

/// Adds a brush of what is inside the newest lens. There must be one.
void addLensBrush(Session& session);

/// Removes every brush; of several by the command, which asks.
void clearBrushes(ViewContext& context);

/// Items of a view's menu that place a brush at the cursor and clear all brushes.
void drawBrushMenu(ViewContext& context);

/// Wire outlines of the brushes in space.
void drawSpaceBrushes(ImDrawList& draw, const SpaceFrame& frame, const vis::Selection& selection);

} // namespace tessera::app
