#pragma once

#include "app/session/session.h"

/// Names and colours of label values as the user types them, and brushes that hold a region.
namespace tessera::app {

/// The labels of a parameter with what the session states about them, whether the data show it already or not.
std::vector<volume::Label> statedLabels(const Session& session, const volume::Parameter& parameter);

/// Sets name and colour of a label value: as a rule of the session's import options, with which the data are then
/// opened, and as colours of the parameter's transfer function. A name that is empty, or that a rule cannot contain, is
/// not changed.
void stateLabel(Session& session, const volume::Parameter& parameter, const volume::Label& label);

/// Removes the stated name of a value, so that the data's own name is used again. A stated colour stays.
void unstateLabelName(Session& session, const volume::Parameter& parameter, int value);

/// Adds a brush that selects a region, with its name and colour, combined with other regions of the label by "or";
/// removes it if it exists already.
void toggleRegionBrush(Session& session, const volume::Parameter& parameter, int value);
/// True when there is an enabled brush of this region alone.
bool regionBrushed(const Session& session, const volume::Parameter& parameter, int value);

} // namespace tessera::app
