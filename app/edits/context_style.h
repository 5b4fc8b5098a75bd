#pragma once

#include "app/session/session.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <string_view>

/// Styles of drawing what is not brushed: settings of the selection, and for some a layer with the hull of what is
/// shown. All of them can be changed afterwards like any other setting.
namespace tessera::app {

enum class ContextStyle { Faint, Grey, Blurred, Hidden, Silhouette, Hull, Wire, Drawn };
inline constexpr std::string_view kContextStyleNames[] = {"faint",      "grey", "blurred",    "hidden",
                                                          "silhouette", "hull", "wire frame", "drawn"};
/// What a style does, for the tooltip.
std::string_view contextStyleHelp(ContextStyle style);

/// The name of the layer that carries a hull.
inline constexpr std::string_view kHullLayer = "context hull";
/// The hull's place in the session's layers, nothing where there is none.
std::optional<std::size_t> hullLayer(const Session& session);

/// Applies a style. Hulls are surfaces of the first visible volume's or surface's parameter, at the value where its
/// opacity reaches a tenth of its maximum (for curves without such a value, in the middle of the range); an existing
/// hull keeps its parameter and value.
void setContextStyle(Session& session, const volume::DatasetInfo& info, ContextStyle style);

} // namespace tessera::app
