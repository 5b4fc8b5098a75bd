#pragma once

#include "volume/import/files/file_block.h"

#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The protocol between tessera-import and the main program.
///
/// `tessera-import [--allow-outside] [--like | --slices N] FILE ...` reads request lines from stdin and writes messages
/// to stdout; messages for people go to stderr. `tessera-import -` reads these words from stdin before the requests,
/// each ended by a zero byte, the last one empty: a command line has no room for the names of a long series. All
/// numbers are little-endian. A message is
///
///     u32 magic "TSI1"   u32 kind   u64 length   length bytes
///
/// kind 1, header: JSON text; one for each FILE, in order, before any request. A FILE after `--like` is expected to
/// have the layout of the one before it; N files after `--slices` are slices of one volume and count as one. With
/// `--allow-outside` files may name others outside of their folders. Keys:
/// "format", "blocks": [{"name", "mesh", "cellData", "dims", "spacing", "origin", "box" (6 numbers, x first), "cells",
/// "cellSize", "volume", "boxes", "cellArrays", "axes", "events", "lengthUnit", "timeName", "timeUnit", "notes",
/// "times", "quantities":
/// [{"name", "unit", "values": [a number or null for each time]}], "arrays": [{"name", "unit", "components", "type",
/// "labels": {"1": "air"}}]}]. "timeName", "notes" and "quantities" are optional. A grid of uneven axes has "axes"
/// (volume/field/axes_json.h), whose sheet "spacing" and "origin" are of, and the "cells" and "cellSize" of a mesh.
/// "volume", "boxes", "cellArrays" and "events" are of a mesh, the last for each axis the numbers of AxisEvent, seven
/// each.
///
/// kind 2, frame: u32 type (ScalarType), u32 mask (0 or 1), i32 nx, ny, nz, then nx*ny*nz samples, x fastest, then, if
/// mask is 1, as many bytes (1 present, 0 absent). It answers the line
///
///     frame FILE BLOCK ARRAY COMPONENT TIME NX NY NZ OX OY OZ SX SY SZ AXIS AXIS AXIS
///
/// with the indices of the headers, and the size, origin and spacing of the grid to sample on. AXIS is "even", or
/// "cells" or "points" and as many planes as the axis has. ARRAY -1 requests the
/// cover of the block: ones of uint8, absent outside.
///
/// The line
///
///     ranges FILE BLOCK ARRAY TIME BETWEEN
///
/// is answered with kind 1: {"ranges": [[lo, hi], ...]}, of the array's own values at points or cells (without NaN),
/// and if BETWEEN is 1 of those that cells give at their corners, one per component, then for a vector that of its
/// magnitude; null instead of a pair if there is no value.
///
/// kind 3, failure: one line of text instead of a header or frame. The program ends when stdin does.
namespace tessera::volume {

enum class MessageKind : std::uint32_t { Header = 1, Frame = 2, Failure = 3 };

struct MessageHead {
    MessageKind kind = MessageKind::Failure;
    std::uint64_t length = 0;
};

inline constexpr std::uint32_t kStreamMagic = 0x31495354; // "TSI1"
inline constexpr std::size_t kMessageHeadBytes = 16, kFrameHeadBytes = 20;
inline constexpr std::uint64_t kMostTextBytes = std::uint64_t(64) << 20;

/// Bytes of a frame message's contents.
std::uint64_t frameBytes(const Lattice& lattice, ScalarType type, bool mask);

/// Reads the head of a message. Throws Error unless the magic, the kind and the length are possible: text of at most
/// 64 MiB, or a frame of one of the two lengths that fit `lattice` and `type`.
MessageHead parseMessageHead(std::span<const std::byte> bytes, const Lattice& lattice, ScalarType type);

/// Blocks of a header message, without `read`. Throws Error for malformed messages.
std::vector<FileBlock> parseStreamHeader(std::string_view json, const std::string& file);

/// Ranges of an answer to "ranges". Throws Error for malformed messages.
std::vector<Range> parseRanges(std::string_view json, const std::string& file);

/// A lattice as the words of a request, and back. Throws Error for words that make no lattice.
std::string latticeWords(const Lattice& lattice);
Lattice parseLatticeWords(std::istream& in);

/// Samples of a frame message. Throws Error unless its size and type are those expected.
Field parseFrame(std::span<const std::byte> bytes, const Lattice& lattice, ScalarType type);

} // namespace tessera::volume
