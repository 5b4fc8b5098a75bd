#pragma once

#include "app/session/session.h"

/// Names and colours of label values as the user types them, and brushes that hold a region.
namespace tessera::app {

/// The labels of a parameter with what the session states about them, whether the data show it already or not.
std::vector<volume::Label> statedLabels(const Session& session, const volume::Parameter& parameter);

/// States name and colour of a value: as a rule of the session's import options, which the data are then opened with,
/// and as the colours of the parameter's transfer function. A name that is empty, or that a rule cannot hold, stays
/// as it was.
void stateLabel(Session& session, const volume::Parameter& parameter, const volume::Label& label);

/// Takes the stated name of a value back: the data then have the one of their own again. A stated colour stays.
void unstateLabelName(Session& session, const volume::Parameter& parameter, int value);

/// Adds a brush that holds a region, with its name and colour; with other regions of the label it makes a union. One
/// that is there already goes instead.
void toggleRegionBrush(Session& session, const volume::Parameter& parameter, int value);
/// True when there is an enabled brush of this region alone.
bool regionBrushed(const Session& session, const volume::Parameter& parameter, int value);

} // namespace tessera::app
