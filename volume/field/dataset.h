#pragma once

#include "volume/base/describe.h"
#include "volume/field/field.h"
#include "volume/field/frame_reader.h"
#include "volume/field/lattice.h"
#include "volume/field/parts.h"
#include "volume/field/space_time_plane.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tessera::volume {

/// A value of a categorical parameter, its name, e.g. 1 "air side", and its colour.
struct Label {
    int value = 0;
    std::string name;
    std::string color = {}; ///< "#rrggbb"; "" = chosen by the program
    bool operator==(const Label&) const = default;
};

/// A number that belongs to each time of a data set: a voltage, a current density, an operating point.
struct Quantity {
    std::string name, unit;
    std::vector<double> values; ///< one for each time, NaN where not known
    bool operator==(const Quantity&) const = default;
};

/// One quantity per point: a scalar (1 component) or a vector (3).
struct Parameter {
    std::string name, unit;
    int components = 1;
    ScalarType type = ScalarType::F32;
    bool categorical = false; ///< a label: nearest neighbour, named values, no arithmetic
    std::vector<Label> labels;
    /// Physical range of present samples over all times, one per component, then for a vector that of its magnitude.
    /// Empty while not yet known.
    std::vector<Range> ranges;
    /// Regions whose samples are never mixed (volume/field/parts.h).
    Parts parts = {};
    bool unitGuessed = false; ///< the unit follows from the name alone, no file and no user states it
    bool operator==(const Parameter&) const = default;
};

/// Largest extent of a component: what an error relative to the range of the parameter refers to.
double extentOf(const Parameter& parameter);

/// A scalar to look at: a component of a parameter, or the magnitude of a vector. Named "T", "U.x", "U.y", "U.z",
/// "|U|".
struct Channel {
    int parameter = 0;
    int component = 0; ///< == components of a vector parameter: its magnitude (derived, never stored)
    std::string name, unit;
    bool magnitude = false;
    bool operator==(const Channel&) const = default;
};

/// Description of a data set, known without reading a sample.
struct DatasetInfo {
    std::string name;
    Lattice lattice;
    Box bounds; ///< what is shown: the box of the first to the last sample of the CC grid it came from
    std::string lengthUnit = "m"; ///< "" where none is stated
    std::vector<Parameter> parameters;
    std::vector<double> times{0};     ///< strictly increasing
    std::string timeName = "time";    ///< what `times` count: time, operating point, voltage, step
    std::string timeUnit = "s";       ///< of `times`, "" where there is none
    std::vector<Quantity> quantities; ///< over the times
    std::string provenance;           ///< where it came from, free text
    std::vector<std::string> notes;   ///< for the user: how it was read, and what is guessed or left out
    bool remote = false;              ///< on another machine: reading a sample costs far more than decoding it
    /// Of positions, for files of data whose axes do not share `lengthUnit`, which is "" then; else all "".
    std::array<std::string, 3> axisUnits = {};
    std::optional<SpaceTimePlane> plane = {}; ///< that the data are, of others in space and time: of one time
    bool operator==(const DatasetInfo&) const = default;

    /// The unit of lengths as a factor of other units: "length" where none is stated, so that a gradient of K has
    /// K/length.
    std::string lengthFactor() const { return lengthUnit.empty() ? "length" : lengthUnit; }
    /// The unit of what moves with time: m/s; "length" and "time" stand for units that are not stated.
    std::string speedUnit() const { return lengthFactor() + "/" + (timeUnit.empty() ? "time" : timeUnit); }
    /// The axis of space along which time runs; none in most data.
    std::optional<int> timeAxis() const {
        return plane && plane->hasTimeAxis() ? std::optional<int>(plane->solved) : std::nullopt;
    }
    /// The place and time of a position of the data, at one of their times: of a plane the point in space and time.
    glm::dvec4 pointAt(glm::dvec3 position, double time) const {
        return plane ? plane->pointAt(position) : glm::dvec4(position, time);
    }
    /// Every channel: parameters in order, for vectors the components, then the magnitude.
    std::vector<Channel> channels() const;
    /// One of them, 0 .. channels().size() - 1; throws std::out_of_range.
    Channel channel(int index) const;
    /// Index into channels() of a channel name; a vector's plain name means its magnitude.
    std::optional<int> findChannel(std::string_view wanted) const;
    /// Index in channels() of a component, which the parameter must have.
    int channelIndex(int parameter, int component) const;
    /// Physical range of a channel, {0, 1} while not known.
    Range channelRange(const Channel& channel) const;
    /// Index of the time nearest to `time`.
    int nearestTime(double time) const;
};

/// A data set that is read on demand: `read(parameter, component, time index)` returns all of one stored component,
/// `read(parameter, component, time index, slices)` some slices of it.
struct Dataset {
    DatasetInfo info;
    FrameReader read;
};

/// A data set at some of its times: ascending indices. A quantity that has no value there has NaN.
Dataset withTimes(Dataset data, const std::vector<int>& times);

} // namespace tessera::volume
