#pragma once

#include "app/session/session.h"

#include <cstddef>

namespace tessera::app {

/// Shows how far a surface may lie elsewhere where samples are off by up to `bound`, in the unit of its parameter: two
/// translucent surfaces at its value less and plus the bound, in its colour and lens and drawn as it is. Surfaces that
/// were added so before follow the value and the bound. Nothing where the layer is no surface of a value, where the
/// bound is 0, or where there is no room for both.
void showErrorBand(Session& session, std::size_t layer, double bound);

/// Whether a layer is one of such a band.
bool isOfErrorBand(const vis::Layer& layer);

} // namespace tessera::app
