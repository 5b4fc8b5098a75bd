#pragma once

#include "codec/container/metadata_node.h"
#include "volume/field/lattice.h"

#include <nlohmann/json_fwd.hpp>

/// Lattices in the metadata of archives, and what they must have in common.
namespace tessera::codec {

nlohmann::json vectorJson(const glm::dvec3& v);
nlohmann::json vectorJson(const glm::ivec3& v);

/// Kind, size, spacing and origin; `alternating`: of the frames of a D4* lattice.
nlohmann::json latticeJson(const volume::Lattice& lattice, bool alternating = false);
/// The same read. `alternating`: set if the frames form a D4* lattice; null: not allowed here. Throws Error.
volume::Lattice readLattice(const Node& node, bool* alternating = nullptr);

/// Reads the axes that the lattice of the data and the grid of its source share, into both. `lattice`: of the data.
/// Throws Error where they are not of the source.
void readAxes(const Node& lattice, volume::Lattice& source, volume::Lattice& stored);

/// Whether stored samples can be those of the source: on its own grid, or resampled from it.
bool isOfSource(const volume::Lattice& stored, const volume::Lattice& source, bool alternating);
/// Whether bounds can be those of samples on a lattice: they begin and end within a cell of the outermost ones.
bool areOf(const volume::Box& bounds, const volume::Lattice& lattice);

} // namespace tessera::codec
