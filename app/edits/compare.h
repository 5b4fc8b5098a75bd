#pragma once

#include "app/session/session.h"
#include "volume/sources/source_difference.h"

#include <string>
#include <vector>

/// Variants of a session for comparison, independent of drawing.
namespace tessera::app {

/// The session with a variant's changes. Throws Error naming the place where a change does not fit.
Session variantSession(const Session& session, const CompareVariant& variant);

/// Describes the changes of a variant, for its caption: "filter average, step 0.25"; "as it is" without changes.
std::string changesText(const Session& session, const CompareVariant& variant);
/// Its own name, else what it changes.
std::string variantName(const Session& session, const CompareVariant& variant);

/// The settings that a variant can change, as JSON pointers: those of parameterPaths and, of data that are not an
/// archive, those of packing (wavelet, threshold, lattice such as D4*, bound of the error) and of time along an axis.
std::vector<std::string> variantPaths(const Session& session);

/// Adds to a variant the change of the setting `path` to the value it has in the session, to be edited. Where the data
/// are not packed (not along time) so far, they become so by the defaults.
void startChange(CompareVariant& variant, const Session& session, const std::string& path);

/// Updates the changes of a variant for an edited parameter at `path`: sets those that differ from the session, removes
/// those that agree.
void recordChange(CompareVariant& variant, const Session& session, const Session& changed, const std::string& path);

/// Columns and rows for `count` pictures in an area that make each as large as possible at about 4:3.
struct GridShape {
    int columns = 1, rows = 1;
};
GridShape gridFor(int count, double width, double height);

/// One line of the table under the pictures.
struct CompareRow {
    std::string name, changes, failure;
    bool reference = false, measured = false;
    double milliseconds = 0; ///< of a full picture
    double samples = 0;      ///< stored lattice samples of the parameters shown
    double bytes = 0;        ///< of their textures
    double storedBytes = 0;  ///< of the archive they come from; 0 = none
    double maximum = 0, rmse = 0, psnr = 0, ssim = 0;
    std::optional<volume::SourceDifference> data; ///< of the first layer's samples, where both have them
};

/// The data of the scene of a variant: of those that are packed for it only the parameters that it draws, since packing
/// takes long. `info`: of the session's data.
DataRef drawnData(const Session& session, const volume::DatasetInfo& info);

} // namespace tessera::app
