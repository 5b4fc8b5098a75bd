#pragma once

#include "codec/bytes/cpu.h"

/// x86 vector instructions, if the processor is an x86.
#if TESSERA_X86
#if defined(__GNUC__) && !defined(__clang__)
// gcc 12 takes its own undefined vectors for a mistake.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>
#endif
