#pragma once

#include "app/pane/controls.h"
#include "app/pane/legend.h"
#include "app/pane/tool_row.h"
#include "app/pane/view_context.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

/// Helpers that several views use.
namespace tessera::app {

/// Two or three lines in the middle of the pane where there is nothing to draw.
void drawHint(const char* title, const char* hint = "");

/// Whether the rest of a row of a list, which has a check box and a colour, is too narrow for all that belongs there:
/// then what is set rarely is in a second row.
bool narrowRows();

/// The height left in the pane for what a view is about, but at least `least` pixels: a smaller pane scrolls.
float heightAtLeast(float least);

/// originText of the view's numbers for these channels (none: all).
std::string originText(const ViewContext& context, const std::vector<int>& channels = {});
/// The same as faint text among the tools, truncated where the row has no room; complete on hover. Numbers `atOneTime`
/// are those of the session's time, which is said where a volume view has another one of its own.
void drawOrigin(const ViewContext& context, ToolRow& tools, const std::vector<int>& channels = {},
                bool atOneTime = true);
/// The same of words that the view has found.
void drawOriginText(const ViewContext& context, ToolRow& tools, std::string text, bool atOneTime = true);
/// Faint text among the tools; left out where these are narrow and its row has no room.
void drawNote(ToolRow& tools, const std::string& text);

/// The head row of a table whose columns are set up; names from column `right` on stand over right-aligned numbers.
void tableHeader(const std::vector<std::string>& names, int right = 1);
void tableHeader(std::initializer_list<const char*> names, int right = 1);
/// Text at the right edge of a table cell.
void textRight(const std::string& text, bool faint = false);
/// The same as something to click, underlined below the mouse, where `tip` says what happens; true if it was clicked.
bool linkRight(const std::string& id, const std::string& text, const std::string& tip, bool faint = false);

/// Indices into info.channels() of what statistics compare: scalars and vector magnitudes, no labels.
std::vector<int> comparedChannels(const volume::DatasetInfo& info);

/// The channels a view shows: those of its names that the data have, each once; without any, the compared ones up to
/// `most`.
std::vector<int> chosenChannels(const volume::DatasetInfo& info, const std::vector<std::string>& names,
                                std::size_t most);
/// A tool: a list with a tick for each of them.
void chooseChannels(ToolRow& tools, const volume::DatasetInfo& info, std::vector<std::string>& names,
                    const std::vector<int>& shown);

/// The channel a view shows: the wanted one if the data has it, else that of the first layer, else the first. Nothing
/// for data without parameters.
std::optional<int> resolveChannel(const volume::DatasetInfo& info, const Session& session, const std::string& wanted);

/// " at 0.85 V" of a layer that is drawn at another time than the one shown; else "".
std::string otherTimeText(const vis::Layer& layer, const volume::DatasetInfo& info, double shown);
/// The name of a layer; of a surface that the user has not named with its value: "T surface 350 K".
std::string layerTitle(const vis::Layer& layer, const volume::DatasetInfo& info);

/// The transfer function that the channel is drawn with.
const vis::TransferFunction& transferOf(const Session& session, const std::string& channel);
/// The same to edit: made on first use.
vis::TransferFunction& transferOf(Session& session, const std::string& channel);

/// Legend of a channel as it is drawn now, by the function of that name; "": its own.
LegendEntry legendOf(const Session& session, const volume::DatasetInfo& info, int channel,
                     const std::string& function = {});

/// The form that legends in corners have in a figure; nothing in the window, where they suit the pane.
std::optional<FigureLegends> figureLegends(const ViewContext& context);

/// A bar whose colours are those of a share that is absorbed, 0 to 100 %, and not of a value.
void measureShare(LegendEntry& entry);

/// Legends of the visible layers, each channel once for each function that it is drawn with, and for shares that are
/// absorbed and gradients (of which the bar shows the change over a cell, up to the function's gradientTop) apart; of a
/// layer that is coloured by another parameter both. Layers drawn in charcoal or chalk, whose colours the picture does
/// not show, have legends only with `drawings`.
std::vector<LegendEntry> sceneLegends(const Session& session, const volume::DatasetInfo& info, bool drawings = false);

/// The scene of the session, with its share of the limits of memory.
vis::Scene sceneWithLimits(const ViewContext& context);

/// A texture of GL as ImGui names it: by a pointer before 1.91.4, by a number after.
ImTextureID textureId(vis::TextureName name);
/// A picture of the renderer between two corners; its rows run upwards, as GL has them.
void addPicture(ImDrawList& draw, vis::TextureName texture, ImVec2 min, ImVec2 max);

/// The stretch of the box, if it has one, and what is drawn by cells, at the end of the line of tools. What is not to
/// scale always says so, if need be on a line of its own.
void drawStretch(const ViewContext& context);

} // namespace tessera::app
