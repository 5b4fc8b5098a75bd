#pragma once

#include "app/pane/view_context.h"
#include "app/ui/widgets.h"

#include <string>

/// The settings below the tabs of the pane of layers.
namespace tessera::app {

/// Every setting of one layer; `path`: its place in the session.
void drawLayerSettings(ViewContext& context, const WidgetContext& widgets, vis::Layer& layer, const std::string& path);

/// How what is not brushed is drawn; `layersPath`: the place of the layers in the session.
void drawContextSettings(ViewContext& context, const WidgetContext& widgets, const std::string& layersPath);

/// Planes and bodies that cut the data open.
void drawClipSettings(ViewContext& context, const WidgetContext& widgets);

/// Lights, shadows, reflection.
void drawLightSettings(ViewContext& context, const WidgetContext& widgets);

/// Camera, proportions, paper, tone curve, shadows of depth and quality; `pane`: the volume view whose camera it is.
void drawPictureSettings(ViewContext& context, const WidgetContext& widgets, const std::string& pane);

} // namespace tessera::app
