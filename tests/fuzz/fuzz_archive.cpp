// A whole archive. Header, metadata and index get right checksums first, so that what lies behind them is reached.
#include "codec/archive/archive.h"
#include "codec/container/container.h"
#include "codec/unpack/unpack.h"

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

using namespace tessera;

namespace {

void seal(std::vector<std::uint8_t>& bytes) {
    const auto all = std::as_bytes(std::span(bytes));
    const auto part = [&](std::size_t offsetAt, std::size_t sumAt) {
        std::uint64_t offset = 0, length = 0;
        std::memcpy(&offset, bytes.data() + offsetAt, 8);
        std::memcpy(&length, bytes.data() + offsetAt + 8, 8);
        if (offset > bytes.size() || length > bytes.size() - offset) return;
        const std::uint64_t sum = codec::checksum(all.subspan(offset, length));
        std::memcpy(bytes.data() + sumAt, &sum, 8);
    };
    part(24, 40);
    part(48, 64);
    const std::uint64_t sum = codec::checksum(all.first(codec::kHeaderBytes - 8));
    std::memcpy(bytes.data() + codec::kHeaderBytes - 8, &sum, 8);
    if (bytes.size() >= 2 * codec::kHeaderBytes)
        std::memcpy(bytes.data() + codec::kHeaderBytes, bytes.data(), codec::kHeaderBytes);
}

void readAll(const std::string& path) {
    try {
        const auto archive = std::make_shared<const codec::Archive>(path);
        (void)codec::verifyArchive(*archive);
        const glm::ivec3 last = archive->grid().count() - 1;
        for (int level = 0; level < archive->grid().levels; ++level) try {
                (void)archive->read({0, int(archive->info().times.size()) - 1, level, last});
                (void)archive->read({0, 0, level, last});
                (void)archive->stats({0, 0, level, last});
                (void)archive->distribution({0, 0, level, last});
            } catch (const Error&) {
            }
        (void)codec::readField(*archive, 0, 0, 0);
        (void)codec::gridDataset(archive, 0).read(0, 0, 0);
    } catch (const Error&) { // the only answer to a bad file
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::uint8_t> bytes(data, data + size);
    if (size >= codec::kHeaderBytes) {
        const std::uint64_t length = size;
        std::memcpy(bytes.data() + 16, &length, 8);
        seal(bytes);
    }
    const int file = memfd_create("archive", 0);
    if (file < 0) return 0;
    if (write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()))
        readAll("/proc/self/fd/" + std::to_string(file));
    close(file);
    return 0;
}
