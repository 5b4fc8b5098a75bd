#pragma once

#include "app/callouts/callout_part.h"

/// Numbers in callouts: of the samples inside of a body, or of the layer of samples nearest to a plane across an axis.
namespace tessera::app {

/// The samples whose numbers a callout shows, as a region for statistics; nothing for tilted planes and for planes
/// across an axis with uneven samples.
std::optional<vis::Region> samplesOfPlace(const CalloutPlace& place, const volume::DatasetInfo& info,
                                          glm::dvec3 cursor);

/// The line of a profile: through the middle of a body as far as that reaches, or through the cross-hair from one side
/// of the box to the other.
CalloutLine calloutLine(const Session& session, const volume::DatasetInfo& info, const vis::WorldFrame& world,
                        const Callout& callout, const CalloutPlace& place, int channel);

void drawCalloutHistogram(ViewContext& context, const CalloutPart& shown);
void drawCalloutProfile(ViewContext& context, const CalloutPart& shown);
void drawCalloutNumbers(ViewContext& context, const CalloutPart& shown);

} // namespace tessera::app
