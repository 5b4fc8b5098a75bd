#pragma once

#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <string>

namespace tessera::vis::packet {

/// Why a scene cannot be drawn by packets of rays, in words for users; empty: it can. Everything else must be drawn by
/// OpenGL.
std::string packetRefusal(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice);

/// Bytes that the samples of a scene take, as PacketVolume lays them out.
double packetBytes(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice);

} // namespace tessera::vis::packet
