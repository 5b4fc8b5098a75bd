#pragma once

#include "volume/bricks/brick_source.h"

#include <optional>

/// Values that matter in a scan, or any field, for a first picture of it.
namespace tessera::app {

/// Upper end of the background of a scan, as a share 0..1 of the channel's range: just above nearly all samples on the
/// outer faces of the box. Only for measured integers (scanners have air and noise around the object, simulations do
/// not), and only if it leaves more than half of the range. Reads the outer bricks of one time; throws Error.
std::optional<double> backgroundShare(const volume::BrickSource& source, int channel, int time);

/// The value whose iso-surface follows the strongest boundary between materials, for a first picture: the peak over v
/// of the sum of |grad f|^3 of all samples of value v, which by the coarea formula is the integral of |grad f|^2 over
/// the surface f = v. Values that the background has do not count. From a coarse level of one
/// time, by differences inside bricks. nullopt: no gradient at all. Throws Error when a brick is damaged.
std::optional<double> boundaryValue(const volume::BrickSource& source, int channel, int time);

/// Two materials, as shares 0..1 of a channel's range.
struct Materials {
    double below = 0;    ///< just above the values of the lower one
    double boundary = 0; ///< in the middle of the strongest boundary above it
    bool operator==(const Materials&) const = default;
};

/// Whether a field, of whole numbers or not, is made of materials: most samples lie where nearly nothing changes, at
/// values around one of two, and between these it changes steeply. The lower one must reach the outer faces of the box,
/// so that it hides what is inside. From a coarse level of one time; nullopt: a field that varies smoothly, or labels.
/// Throws Error when a brick is damaged.
std::optional<Materials> materialsOf(const volume::BrickSource& source, int channel, int time);

/// Whether the object of a scan is made of materials rather than varying smoothly: above the background (a share of the
/// range) most samples lie where little changes, or around values that are far more common than some between them and
/// the background. Throws Error when a brick is damaged.
bool hasMaterials(const volume::BrickSource& source, int channel, int time, double background);

/// Two classes of whole numbers that both reach the faces of the box, such as fibres and the air between them: the
/// boundary is that of the classes that differ most (N. Otsu: A threshold selection method from gray-level histograms,
/// 1979), which neither bright nor dark rims of phase contrast move. `below` is two standard deviations above the lower
/// class. nullopt: the histogram has no valley between two peaks. Throws Error when a brick is damaged.
std::optional<Materials> classesOf(const volume::BrickSource& source, int channel, int time);

/// A value for a surface in a field without such boundaries: the middle between the 2 % and 98 % quantiles; nullopt:
/// these are equal, or there is no sample. Throws Error when a brick is damaged.
std::optional<double> middleValue(const volume::BrickSource& source, int channel, int time);

/// The first of these for measured integers (scans), else the second.
std::optional<double> surfaceValue(const volume::BrickSource& source, int channel, int time);

} // namespace tessera::app
