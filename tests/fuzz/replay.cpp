// Replays a folder of inputs through a fuzz target, and every truncation and a set of flipped bytes of each, for
// compilers without libFuzzer.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
    std::size_t inputs = 0;
    for (int i = 1; i < argc; ++i) {
        if (!std::filesystem::is_directory(argv[i])) {
            std::fprintf(stderr, "%s: no such folder\n", argv[i]);
            return 1;
        }
        for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
            std::ifstream in(entry.path(), std::ios::binary);
            const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
            std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
            LLVMFuzzerTestOneInput(data.data(), data.size());
            const std::size_t stride = data.size() / 257 + 1;
            for (std::size_t cut = 0; cut < data.size(); cut += stride) {
                const std::vector<std::uint8_t> shorter(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(cut));
                LLVMFuzzerTestOneInput(shorter.data(), shorter.size());
                data[cut] ^= 0x55;
                LLVMFuzzerTestOneInput(data.data(), data.size());
                data[cut] ^= 0x55;
            }
            ++inputs;
        }
    }
    std::printf("replayed %zu inputs\n", inputs);
    return inputs > 0 ? 0 : 1;
}
