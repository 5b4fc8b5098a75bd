#include "tests/codec/plain/codes.h"

#include <algorithm>
#include <lzma.h>
#include <string_view>
#include <zstd.h>

namespace tessera::codec::plain {

void need(bool condition, const char* what) {
    if (!condition) throw std::runtime_error(what);
}

Octets unzstd(const Octets& packed, std::size_t size) {
    Octets out(size);
    need(ZSTD_decompress(out.data(), size, packed.data(), packed.size()) == size, "zstd");
    return out;
}

namespace {

/// What stands behind the header of a .lzma file.
Octets unlzma(const Octets& packed, std::size_t size, std::uint8_t literalBits) {
    Octets file{literalBits, 0, 0, 0, 4};
    for (int i = 0; i < 8; ++i) file.push_back(std::uint8_t(std::uint64_t(size) >> (8 * i)));
    file.insert(file.end(), packed.begin(), packed.end());
    Octets out(size);
    lzma_stream coder = LZMA_STREAM_INIT;
    need(literalBits <= 4 && lzma_alone_decoder(&coder, UINT64_MAX) == LZMA_OK, "lzma");
    coder.next_in = file.data(), coder.avail_in = file.size();
    coder.next_out = out.data(), coder.avail_out = size;
    const bool whole = lzma_code(&coder, LZMA_FINISH) == LZMA_STREAM_END;
    const bool all = coder.avail_in == 0 && coder.avail_out == 0;
    lzma_end(&coder);
    need(whole && all, "lzma");
    return out;
}

/// 1.5: the dictionary, numbers and text.
Octets dictionary() {
    const std::uint8_t numbers[] = {0, 0, 0, 0, 0xc2, 0x94, 0xd3, 0x38, 5,    0x80, 6, 0x2d, 0, 0,
                                    0, 0, 0, 0, 0xf0, 0x3f, 0,    0,    0x80, 0xbf, 0, 0,    0, 0};
    Octets all;
    for (const std::uint8_t number : numbers) all.push_back(number);
    const std::string_view text =
        R"("labels":[{"name":"","value":1},{"name":"magnitude","ranges":[[0.0,1.0]],"type":"int32","type":"int16","type":"float32","unit":"m/s","type":"uint16","kind":"bcc","kind":"d4","lossless":false,"categorical":true,)"
        R"({"data":{"bounds":{"hi":[63.0,63.0,63.0],"lo":[0.0,0.0,0.0]},"lattice":{"kind":"cc","origin":[0.0,0.0,0.0],"size":[64,64,64],"spacing":[1.0,1.0,1.0]},"lengthUnit":"","name":"","parameters":[{"categorical":false,"components":1,"labels":[],"name":"value","ranges":[[0.0,255.0]],"type":"uint8","unit":""}],"provenance":"","timeUnit":""},)"
        R"("grid":{"brickSize":64,"levels":5,"phase":0.0},"lossless":true,"maxError":0.0,"options":{"lattice":"cc"},"program":"tessera","source":{"kind":"cc","origin":[0.0,0.0,0.0],"size":[64,64,64],"spacing":[1.0,1.0,1.0]}})";
    for (const char letter : text) all.push_back(std::uint8_t(letter));
    return all;
}

} // namespace

Octets piece(const Octets& bytes) {
    Reader in(bytes);
    const std::size_t size = in.length();
    const Octets packed = in.take(std::size_t(in.end - in.at));
    if (packed.size() == size) return packed;
    need(size <= 65536, "piece");
    const Octets before = dictionary();
    lzma_options_lzma options{};
    options.dict_size = std::uint32_t(std::max<std::size_t>(4096, size + before.size()));
    options.preset_dict = before.data();
    options.preset_dict_size = std::uint32_t(before.size());
    lzma_set_ext_size(options, size);
    const lzma_filter filters[] = {{LZMA_FILTER_LZMA1EXT, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
    Octets out(size);
    std::size_t read = 0, written = 0;
    need(lzma_raw_buffer_decode(filters, nullptr, packed.data(), &read, packed.size(), out.data(), &written, size) ==
                 LZMA_OK &&
             read == packed.size() && written == size,
         "piece");
    return out;
}

std::vector<std::uint32_t> stream(Reader& in, std::size_t count) {
    std::vector<std::uint32_t> symbols(count);
    if (count == 0) return symbols;
    const auto mode = in.number(1);
    if (mode == 0) return symbols;
    if (mode == 1) return std::vector<std::uint32_t>(count, in.u32());
    need(mode == 2 || mode == 3 || mode == 7, "mode");
    const auto width = std::size_t(in.number(1));
    need(width >= 1 && width <= 4, "width");
    Octets planes;
    if (mode == 2) {
        planes = in.take(width * count);
    } else if (mode == 7) {
        const auto literalBits = std::uint8_t(in.number(1));
        const std::size_t length = in.length();
        planes = unlzma(in.take(length), width * count, literalBits);
    } else {
        const std::size_t length = in.u32();
        planes = unzstd(in.take(length), width * count);
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t p = 0; p < width; ++p) symbols[i] |= std::uint32_t(planes[p * count + i]) << (8 * p);
    return symbols;
}

std::uint32_t unzigzag(std::uint32_t symbol) {
    return symbol % 2 == 0 ? symbol / 2 : ~(symbol / 2);
}

std::int64_t asSigned(std::uint32_t code) {
    return std::int32_t(code);
}

float floatOf(std::uint32_t code) {
    return std::bit_cast<float>(code < 0x80000000u ? code : ~(code ^ 0x80000000u));
}

std::uint32_t codeOf(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits < 0x80000000u ? bits : ~bits ^ 0x80000000u;
}

} // namespace tessera::codec::plain
