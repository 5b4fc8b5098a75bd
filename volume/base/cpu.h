#pragma once

#include <cstdint>

/// Vector instruction sets for inner loops. All give identical results, which tests compare.
namespace tessera {

enum class Cpu : std::uint8_t { Portable, Avx2, Avx512 };

#if defined(__x86_64__)
#define TESSERA_X86 1
#define TESSERA_AVX2 [[gnu::target("avx2,bmi2")]]
#define TESSERA_AVX512 [[gnu::target("avx512f,avx512bw,avx512vl,avx512dq,avx512cd,avx2,bmi2")]]
#else
#define TESSERA_X86 0
#define TESSERA_AVX2
#define TESSERA_AVX512
#endif
/// For function bodies that are compiled once per instruction set.
#define TESSERA_INLINE [[gnu::always_inline]] inline

/// The best instruction set that this processor supports.
inline Cpu bestCpu() {
#if TESSERA_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("bmi2"))
        return Cpu::Avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2")) return Cpu::Avx2;
#endif
    return Cpu::Portable;
}

} // namespace tessera
