// What a broken tessera-import could send: heads, headers and frames.
#include "volume/base/error.h"
#include "volume/import/files/stream.h"

#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

using namespace tessera;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
    volume::Lattice lattice;
    lattice.size = {3, 2, 2};
    try {
        const volume::MessageHead head = volume::parseMessageHead(bytes, lattice, volume::ScalarType::I16);
        const auto rest = bytes.subspan(volume::kMessageHeadBytes);
        if (head.kind == volume::MessageKind::Frame) {
            const volume::Field field = volume::parseFrame(rest, lattice, volume::ScalarType::I16);
            if (field.count() != 12 || field.samples.size() != 24) std::abort();
        } else {
            for (const volume::FileBlock& block : volume::parseStreamHeader(
                     std::string_view(reinterpret_cast<const char*>(rest.data()), rest.size()), "a"))
                if (block.lattice.size.x < 1) std::abort();
        }
    } catch (const Error&) {
    }
    return 0;
}
