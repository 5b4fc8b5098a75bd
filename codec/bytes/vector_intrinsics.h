#pragma once

#include "volume/base/cpu.h"

/// x86 vector intrinsics, on x86 only.
#if TESSERA_X86
#if defined(__GNUC__) && !defined(__clang__)
// gcc 12 warns of its own undefined vectors.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>
#endif
