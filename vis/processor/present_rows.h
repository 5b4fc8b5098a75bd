#pragma once

#include "vis/packet/packet_renderer.h"
#include "vis/processor/presented_pixel.h"

#include <cstdint>

/// Pixels presented on vector units, compiled from the same source for each instruction set.
namespace tessera::vis {

/// A row of pixels: linear RGBA, premultiplied, and RGBA8, sRGB, that they become.
struct PixelRow {
    int count = 0;
    const float* rgba = nullptr;
    const float *behind = nullptr, *before = nullptr; ///< coverage by edges of the box
    std::uint8_t* out = nullptr;
};

void presentRowAvx512(const PresentedWith& with, const PixelRow& row); ///< not on other processors than x86
void presentRowAvx2(const PresentedWith& with, const PixelRow& row);   ///< the same
void presentRowPlain(const PresentedWith& with, const PixelRow& row);
void presentRow(packet::InstructionSet set, const PresentedWith& with, const PixelRow& row);

} // namespace tessera::vis
