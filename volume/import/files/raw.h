#pragma once

#include "volume/import/files/file_block.h"
#include "volume/import/files/named_path.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::volume {

/// Number types of raw files; those that are not ScalarTypes are converted when read.
enum class RawType : std::uint8_t { U8, I8, U16, I16, I32, F32, F64 };

/// Layout of a file without header `[time][component][z][y][x]`, x fastest; components can have different types.
struct RawForm {
    struct Component {
        std::string name, unit;
        RawType type = RawType::U8;
        double scale = 1, offset = 0; ///< physical = offset + scale * stored
        std::vector<double> missing;  ///< stored values that mean "absent" (NaN always does)
        std::string presenceOf;       ///< this component says where that one is present (0 = absent)
        bool categorical = false;
        std::vector<Label> labels;
    };
    Lattice lattice;
    std::vector<Component> components;
    std::vector<double> times; ///< empty: one frame without a stated time
    bool bigEndian = false;
    std::size_t skip = 0; ///< bytes before the first sample
    std::string dataFile; ///< name of the samples' file, relative to the sidecar; "" = same name with .raw
    std::string lengthUnit, timeName, timeUnit, provenance;
    std::vector<Quantity> quantities; ///< one value for each frame

    std::size_t frames() const { return times.empty() ? 1 : times.size(); }
    /// Size in bytes of a file with this layout; does not overflow for layouts that the parsers accept.
    std::size_t bytes() const;
};

/// What a JSON text is if not a sidecar, which has dims: "an object with name, license". "" for sidecars, and for texts
/// that are not JSON at all, of which parseSidecar tells.
std::string otherThanSidecar(std::string_view json);

/// Reads a JSON sidecar. Required keys: dims, dtype. Throws Error (file is `file`) for anything that is missing, of the
/// wrong type or out of range.
RawForm parseSidecar(std::string_view json, const std::string& file);

/// Reads the text of `--raw`: "dims=XxYxZ,type=u8,spacing=AxBxC,origin=AxBxC,components=N,times=N,big-endian,skip=N".
RawForm parseRawOption(std::string_view text);

/// The layout that `--raw` states: its text, or the sidecar that it names (*.json). Throws Error.
RawForm statedForm(const std::string& rawOption);

/// The text of `--raw` derived from a file name: "engine_149x208x110_uint8.raw" gives "dims=149x208x110,type=u8". "" if
/// the name has no dims or no type, or the file has another size. The words c5 and t12 in a name mean 5 components and
/// 12 times.
std::string rawOptionOfName(const std::string& path);

/// True for a *.raw file beside which lies a sidecar of its name: a JSON file with dims.
bool hasSidecar(const std::string& path);

/// Opens a raw file named by itself or by its sidecar; `rawOption` (may be empty) takes the place of the sidecar.
/// `outside`: whether the sidecar may name a file elsewhere. Checks the size of the file against the form; samples are
/// read on demand.
FileBlock openRaw(const std::string& path, const std::string& rawOption, Outside outside = Outside::Refused);

/// Opens a file with a known layout; `named` is the name the user gave, `data` the file with the samples. Checks its
/// size.
FileBlock openForm(const RawForm& form, const std::string& named, const std::string& data, const std::string& format);

/// True for paths openRaw takes: *.raw, *.bin, *.dat with a form, or a *.json that is a sidecar.
bool isRaw(const std::string& path, const std::string& rawOption);

} // namespace tessera::volume
