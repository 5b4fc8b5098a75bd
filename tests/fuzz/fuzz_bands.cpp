// A model and bands coded with it: every kind of processor gives the same answer.
#include "codec/bands/band_coder.h"

#include <cstdint>
#include <cstdlib>

using namespace tessera;
using namespace tessera::codec;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kHead = 5;
    if (size < kHead) return 0;
    const auto bytes = std::as_bytes(std::span(data + kHead, size - kHead));
    const std::size_t modelBytes = std::min<std::size_t>(bytes.size(), data[0] + 256u * (data[1] % 4));
    Model model;
    if (parseModel(bytes.first(modelBytes), 1, model) != DecodeStatus::Ok) return 0;
    if (parseModel(serialise(model), 1, model) != DecodeStatus::Ok) std::abort();
    const glm::ivec3 shape(1 + data[2] % 40, 1 + data[3] % 9, 1 + data[4] % 9);
    const std::size_t count = std::size_t(shape.x) * std::size_t(shape.y) * std::size_t(shape.z);
    const Bytes coded(bytes.begin() + std::ptrdiff_t(modelBytes), bytes.end());
    const BandDecoder decoder(model);
    std::vector<std::int32_t> results[3];
    DecodeStatus statuses[3] = {};
    const Cpu cpus[] = {Cpu::Portable, Cpu::Avx2, Cpu::Avx512};
    for (std::size_t i = 0; i < 3 && cpus[i] <= bestCpu(); ++i) {
        results[i].resize(count);
        const Band<std::int32_t> band{
            results[i].data(), nullptr, shape, shape.x, std::ptrdiff_t(shape.x) * shape.y, data[1] / 4 % kBandKinds};
        statuses[i] = decoder.decode<std::int32_t>(coded, std::span(&band, 1), 0, cpus[i]);
        if (statuses[i] != statuses[0]) std::abort();
        if (statuses[0] == DecodeStatus::Ok && results[i] != results[0]) std::abort();
    }
    return 0;
}
