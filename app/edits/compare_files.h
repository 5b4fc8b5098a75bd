#pragma once

#include "app/session/session.h"

#include <string>
#include <vector>

/// The data shown beside those of another file (DataRef::other): what a comparison shows of both.
namespace tessera::app {

/// The channel to compare: that of the first layer if the other data have it too, in a unit that can be converted,
/// else the first such one that is no label; "" if there is none.
std::string comparedChannel(const Session& session, const volume::DatasetInfo& info);

/// Adds the difference of a channel to the other data to the derived parameters, unless it is one of them, and returns
/// its name.
std::string addOtherDifference(std::vector<volume::DerivedParameter>& derived, const volume::DatasetInfo& info,
                               const std::string& channel);

/// Gives a channel and the same one of the other data one transfer function over the values of both. What is seen of
/// the first stays as it is, as its opacity curve and regions stay at their values.
void shareFunction(Session& session, const volume::DatasetInfo& info, const std::string& channel);

/// Makes a session, which has the other data, show the difference of a channel: derived, in colours of its own where
/// nothing shows that hardly differs, and beside the channel in both data sets with one function.
void showOtherDifference(Session& session, const volume::DatasetInfo& info, const std::string& channel);

/// What a comparison of both files shows: the session as it is, the same of the other file, and the difference of the
/// compared channel, where it has been derived. None without other data.
std::vector<CompareVariant> fileVariants(const Session& session, const volume::DatasetInfo& info);

/// Whether a channel is a derived difference, to other data or to another time.
bool isDifference(const DataRef& data, const volume::DatasetInfo& info, const std::string& channel);

/// "T minus other is 0 everywhere: nothing differs" where a derived difference is that, "" for other channels.
std::string equalText(const DataRef& data, const volume::DatasetInfo& info, const std::string& channel);

/// The same where all that the visible layers of a session show is such a difference: there is nothing to see.
std::string equalText(const Session& session, const volume::DatasetInfo& info);

/// Whether a variant shows something of the other data.
bool showsOtherData(const CompareVariant& variant);

/// Takes the other data out of a session: with their differences, and comparisons that show nothing else.
void dropOtherData(Session& session);

} // namespace tessera::app
