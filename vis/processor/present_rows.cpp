#include "vis/processor/present_rows.h"

namespace tessera::vis {

void presentRow([[maybe_unused]] packet::InstructionSet set, const PresentedWith& with, const PixelRow& row) {
#ifdef TESSERA_X86
    if (set == packet::InstructionSet::Avx512) return presentRowAvx512(with, row);
    if (set == packet::InstructionSet::Avx2) return presentRowAvx2(with, row);
#endif
    presentRowPlain(with, row);
}

} // namespace tessera::vis
