#pragma once

#include "volume/base/describe.h"
#include "volume/import/files/named_path.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::volume {

/// What becomes of options that fit nothing in the data. Sessions may hold units of other data.
enum class Misfits { Refused, Ignored };

/// The grid that meshes are sampled on, and grids with uneven spacing are kept on, if no size is stated.
enum class GridChoice : std::uint8_t {
    Planes, ///< where cells begin and end: layers keep their thickness, spacing may be uneven
    Even    ///< one spacing per axis
};
inline constexpr std::string_view kGridChoiceNames[] = {"planes", "even"};

/// What the user states about files that lack this information. Remembered per parameter name by the caller.
struct ImportOptions {
    glm::ivec3 gridSize{0}; ///< meshes are resampled to this even grid; 0 = as `grid` says
    GridChoice grid = GridChoice::Planes;
    std::string
        raw; ///< "dims=XxYxZ,type=u8,spacing=..,origin=..,components=N,times=N,big-endian,skip=BYTES" for headless raw
    /// Rules that make samples absent: "O2=region:0,3" (where the label has these values), "O2=0" (a value), "O2=nan".
    std::vector<std::string> absent;
    std::map<std::string, std::string> rename; ///< file's array name -> parameter name
    std::map<std::string, std::string> units;  ///< parameter name -> unit
    std::string lengthUnit;                    ///< "" = what the file or its format states
    std::vector<double> times;                 ///< overrides the times of a series
    std::vector<std::string> parameters;       ///< only these (by final name); empty = all
    /// Find a label such as `region` and parameters that are exactly 0 wherever the label has certain values, and treat
    /// them as absent there. Rules of `absent` for the same parameter take precedence ("O2=none": nothing is absent).
    bool autoAbsent = true;
    /// Names, and after a '#' colours, of label values: "region:0=cathode,1=anode#e07b39".
    std::vector<std::string> labels;
    /// Parts by parameter: "p=region:1|3" (1 and 3 are two parts), "T=region:0,1,3" (one part), "T=joined" (one part,
    /// whatever the data show), "p=jumps" (regions enclosed by jumps of its own samples, without a label;
    /// volume/import/data_jumps.h). For other parameters they are found from the data.
    std::vector<std::string> parts;
    std::string timeName, timeUnit; ///< of the axis of a series; "" = what the files say
    std::string overTime;           ///< CSV file with quantities over time, "" = none
    /// Files may name others outside of their folder. Not described: no session says so, only the user who opens it.
    bool allowOutside = false;

    bool operator==(const ImportOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.gridSize, FieldInfo{.key = "gridSize",
                                       .doc = "Even grid that meshes are resampled to; 0 = as grid says",
                                       .range = Range{0, 4096}});
        visit(self.grid,
              FieldInfo{.key = "grid",
                        .doc = "Samples of meshes: between the planes where cells begin and end, with uneven "
                               "spacing; or at even distances",
                        .names = kGridChoiceNames});
        visit(self.raw, FieldInfo{"raw", "Layout of a raw file: dims=..,type=..,..."});
        visit(self.absent, FieldInfo{"absent", "Rules for absent samples: O2=region:0,3"});
        visit(self.rename, FieldInfo{"rename", "New parameter names, by the names in the file"});
        visit(self.units, FieldInfo{"units", "Units by parameter"});
        visit(self.lengthUnit, FieldInfo{"lengthUnit", "Unit of length of the file"});
        visit(self.times, FieldInfo{"times", "Times of a series"});
        visit(self.parameters, FieldInfo{"parameters", "Parameters that are read; empty = all"});
        visit(self.autoAbsent, FieldInfo{"autoAbsent", "Find absent samples by a label such as region"});
        visit(self.labels, FieldInfo{"labels", "Names and colours of label values: region:0=cathode,1=anode#e07b39"});
        visit(self.parts,
              FieldInfo{"parts",
                        "Regions between which a parameter is never interpolated: p=region:1|3, T=joined, p=jumps"});
        visit(self.timeName, FieldInfo{"timeName", "What the times of a series count"});
        visit(self.timeUnit, FieldInfo{"timeUnit", "Unit of the times of a series"});
        visit(self.overTime, FieldInfo{"overTime", "CSV file with quantities over time"});
    }
};

inline Outside outsideBy(const ImportOptions& options) {
    return options.allowOutside ? Outside::Allowed : Outside::Refused;
}

} // namespace tessera::volume
