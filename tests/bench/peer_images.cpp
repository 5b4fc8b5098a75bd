#include "tests/bench/peer_codecs.h"

#include <algorithm>
#include <cstring>
#if PEER_FPZIP
#include <fpzip.h>
#endif
#if PEER_JXL
#include <jxl/decode_cxx.h>
#include <jxl/encode_cxx.h>
#endif
#if PEER_OPENJPEG
#include <openjpeg.h>
#endif
#if PEER_ZFP
#include <zfp.h>
#endif

namespace tessera::bench {

namespace {

#if PEER_OPENJPEG || PEER_JXL
/// Slices of whole numbers, each with its length before it, by coders of one picture.
PeerCodec slicesCodec(std::string name, Bytes (*encode)(const std::byte*, glm::ivec3, std::size_t),
                      bool (*decode)(std::span<const std::byte>, std::size_t, std::span<std::byte>)) {
    const auto sliceBytes = [](const Samples& of) {
        return std::size_t(of.size.x) * std::size_t(of.size.y) * of.sampleBytes();
    };
    return {std::move(name),
            [sliceBytes, encode](const Samples& in) {
                Bytes out;
                if (in.type != volume::ScalarType::U8 && in.type != volume::ScalarType::U16) return out;
                for (std::size_t at = 0; at < in.bytes.size(); at += sliceBytes(in)) {
                    const Bytes slice = encode(in.bytes.data() + at, in.size, in.sampleBytes());
                    const auto length = static_cast<std::uint32_t>(slice.size());
                    out.resize(out.size() + sizeof length);
                    std::memcpy(out.data() + out.size() - sizeof length, &length, sizeof length);
                    out.insert(out.end(), slice.begin(), slice.end());
                }
                return out;
            },
            [sliceBytes, decode](std::span<const std::byte> coded, const Samples& like, std::span<std::byte> out) {
                for (; !out.empty(); out = out.subspan(sliceBytes(like))) {
                    std::uint32_t length = 0;
                    std::memcpy(&length, coded.data(), sizeof length);
                    if (!decode(coded.subspan(sizeof length, length), like.sampleBytes(), out.first(sliceBytes(like))))
                        return false;
                    coded = coded.subspan(sizeof length + length);
                }
                return true;
            }};
}
#endif

#if PEER_OPENJPEG
/// Bytes as the library reads and writes them.
struct Memory {
    Bytes bytes;
    std::size_t at = 0;
};

OPJ_SIZE_T readMemory(void* to, OPJ_SIZE_T count, void* user) {
    auto& memory = *static_cast<Memory*>(user);
    const std::size_t n = std::min<std::size_t>(count, memory.bytes.size() - memory.at);
    if (n == 0) return OPJ_SIZE_T(-1);
    std::memcpy(to, memory.bytes.data() + memory.at, n);
    memory.at += n;
    return n;
}
OPJ_SIZE_T writeMemory(void* from, OPJ_SIZE_T count, void* user) {
    auto& memory = *static_cast<Memory*>(user);
    memory.bytes.resize(std::max(memory.bytes.size(), memory.at + count));
    std::memcpy(memory.bytes.data() + memory.at, from, count);
    memory.at += count;
    return count;
}
OPJ_BOOL seekMemory(OPJ_OFF_T to, void* user) {
    static_cast<Memory*>(user)->at = std::size_t(to);
    return OPJ_TRUE;
}
OPJ_OFF_T skipMemory(OPJ_OFF_T count, void* user) {
    static_cast<Memory*>(user)->at += std::size_t(count);
    return count;
}

opj_stream_t* streamOf(Memory& memory, bool reads) {
    opj_stream_t* stream = opj_stream_default_create(reads);
    opj_stream_set_user_data(stream, &memory, nullptr);
    opj_stream_set_user_data_length(stream, memory.bytes.size());
    opj_stream_set_read_function(stream, readMemory);
    opj_stream_set_write_function(stream, writeMemory);
    opj_stream_set_seek_function(stream, seekMemory);
    opj_stream_set_skip_function(stream, skipMemory);
    return stream;
}

Bytes encodeSlice(const std::byte* samples, glm::ivec3 size, std::size_t width) {
    opj_cparameters_t parameters;
    opj_set_default_encoder_parameters(&parameters);
    parameters.tcp_numlayers = 1;
    parameters.cp_disto_alloc = 1; // of everything: lossless
    parameters.numresolution = 1;
    while (parameters.numresolution < 6 && (std::min(size.x, size.y) >> parameters.numresolution) > 0)
        ++parameters.numresolution;
    opj_image_cmptparm_t component{};
    component.dx = component.dy = 1;
    component.w = OPJ_UINT32(size.x), component.h = OPJ_UINT32(size.y);
    component.prec = OPJ_UINT32(8 * width);
    opj_image_t* image = opj_image_create(1, &component, OPJ_CLRSPC_GRAY);
    image->x1 = component.w, image->y1 = component.h;
    for (std::size_t i = 0; i < std::size_t(size.x) * std::size_t(size.y); ++i) {
        std::uint16_t value = 0;
        std::memcpy(&value, samples + i * width, width);
        image->comps[0].data[i] = value;
    }
    opj_codec_t* codec = opj_create_compress(OPJ_CODEC_J2K);
    Memory memory;
    opj_stream_t* stream = streamOf(memory, false);
    const bool done = opj_setup_encoder(codec, &parameters, image) && opj_start_compress(codec, image, stream) &&
                      opj_encode(codec, stream) && opj_end_compress(codec, stream);
    opj_stream_destroy(stream);
    opj_destroy_codec(codec);
    opj_image_destroy(image);
    return done ? std::move(memory.bytes) : Bytes();
}

bool decodeSlice(std::span<const std::byte> coded, std::size_t width, std::span<std::byte> out) {
    Memory memory{{coded.begin(), coded.end()}, 0};
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    opj_codec_t* codec = opj_create_decompress(OPJ_CODEC_J2K);
    opj_stream_t* stream = streamOf(memory, true);
    opj_image_t* image = nullptr;
    const bool done = opj_setup_decoder(codec, &parameters) && opj_read_header(stream, codec, &image) &&
                      opj_decode(codec, stream, image);
    if (done)
        for (std::size_t i = 0; i < out.size() / width; ++i) {
            const auto value = static_cast<std::uint16_t>(image->comps[0].data[i]);
            std::memcpy(out.data() + i * width, &value, width);
        }
    opj_stream_destroy(stream);
    opj_destroy_codec(codec);
    if (image) opj_image_destroy(image);
    return done;
}

PeerCodec jpeg2000() {
    return slicesCodec("JPEG 2000 of slices", encodeSlice, decodeSlice);
}
#endif

#if PEER_JXL
JxlPixelFormat grey(std::size_t width) {
    return {1, width == 1 ? JXL_TYPE_UINT8 : JXL_TYPE_UINT16, JXL_LITTLE_ENDIAN, 0};
}

/// Lossless, effort 7, one thread.
Bytes encodeJxl(const std::byte* samples, glm::ivec3 size, std::size_t width) {
    const JxlEncoderPtr encoder = JxlEncoderMake(nullptr);
    JxlBasicInfo info;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = std::uint32_t(size.x), info.ysize = std::uint32_t(size.y);
    info.bits_per_sample = std::uint32_t(8 * width);
    info.num_color_channels = 1;
    info.uses_original_profile = JXL_TRUE;
    JxlColorEncoding color;
    JxlColorEncodingSetToSRGB(&color, JXL_TRUE);
    JxlEncoderFrameSettings* settings = JxlEncoderFrameSettingsCreate(encoder.get(), nullptr);
    const JxlPixelFormat format = grey(width);
    const std::size_t bytes = std::size_t(size.x) * std::size_t(size.y) * width;
    if (JxlEncoderSetBasicInfo(encoder.get(), &info) != JXL_ENC_SUCCESS ||
        JxlEncoderSetColorEncoding(encoder.get(), &color) != JXL_ENC_SUCCESS ||
        JxlEncoderSetFrameLossless(settings, JXL_TRUE) != JXL_ENC_SUCCESS ||
        JxlEncoderFrameSettingsSetOption(settings, JXL_ENC_FRAME_SETTING_EFFORT, 7) != JXL_ENC_SUCCESS ||
        JxlEncoderAddImageFrame(settings, &format, samples, bytes) != JXL_ENC_SUCCESS)
        return {};
    JxlEncoderCloseInput(encoder.get());
    Bytes out(bytes + 4096);
    auto* next = reinterpret_cast<std::uint8_t*>(out.data());
    std::size_t left = out.size();
    if (JxlEncoderProcessOutput(encoder.get(), &next, &left) != JXL_ENC_SUCCESS) return {};
    out.resize(out.size() - left);
    return out;
}

bool decodeJxl(std::span<const std::byte> coded, std::size_t width, std::span<std::byte> out) {
    const JxlDecoderPtr decoder = JxlDecoderMake(nullptr);
    const JxlPixelFormat format = grey(width);
    return JxlDecoderSubscribeEvents(decoder.get(), JXL_DEC_FULL_IMAGE) == JXL_DEC_SUCCESS &&
           JxlDecoderSetInput(decoder.get(), reinterpret_cast<const std::uint8_t*>(coded.data()), coded.size()) ==
               JXL_DEC_SUCCESS &&
           JxlDecoderProcessInput(decoder.get()) == JXL_DEC_NEED_IMAGE_OUT_BUFFER &&
           JxlDecoderSetImageOutBuffer(decoder.get(), &format, out.data(), out.size()) == JXL_DEC_SUCCESS &&
           JxlDecoderProcessInput(decoder.get()) == JXL_DEC_FULL_IMAGE;
}
#endif

#if PEER_FPZIP
PeerCodec fpzipCodec() {
    const auto shaped = [](FPZ* stream, glm::ivec3 size) {
        stream->type = FPZIP_TYPE_FLOAT;
        stream->prec = 32;
        stream->nx = size.x, stream->ny = size.y, stream->nz = size.z, stream->nf = 1;
    };
    return {"fpzip",
            [shaped](const Samples& in) {
                Bytes out;
                for (std::size_t f = 0; f < in.frames() && in.type == volume::ScalarType::F32; ++f) {
                    const std::size_t head = out.size() + sizeof(std::uint64_t);
                    out.resize(head + 2 * in.frameBytes() + 4096);
                    FPZ* stream = fpzip_write_to_buffer(out.data() + head, out.size() - head);
                    shaped(stream, in.size);
                    const std::uint64_t length = fpzip_write(stream, in.bytes.data() + f * in.frameBytes());
                    fpzip_write_close(stream);
                    std::memcpy(out.data() + head - sizeof length, &length, sizeof length);
                    out.resize(head + length);
                }
                return out;
            },
            [shaped](std::span<const std::byte> coded, const Samples& like, std::span<std::byte> out) {
                for (; !out.empty(); out = out.subspan(like.frameBytes())) {
                    std::uint64_t length = 0;
                    std::memcpy(&length, coded.data(), sizeof length);
                    FPZ* stream = fpzip_read_from_buffer(coded.data() + sizeof length);
                    shaped(stream, like.size);
                    const bool whole = fpzip_read(stream, out.data()) != 0;
                    fpzip_read_close(stream);
                    if (!whole) return false;
                    coded = coded.subspan(sizeof length + length);
                }
                return true;
            }};
}
#endif

#if PEER_ZFP
/// One frame in the type zfp knows: floats, or whole numbers as 31 bits.
struct ZfpFrame {
    zfp_field* field;
    zfp_stream* stream = zfp_stream_open(nullptr);
    ZfpFrame(void* values, glm::ivec3 size, bool isFloat, double bound)
        : field(zfp_field_3d(values, isFloat ? zfp_type_float : zfp_type_int32, std::size_t(size.x),
                             std::size_t(size.y), std::size_t(size.z))) {
        if (bound > 0)
            zfp_stream_set_accuracy(stream, bound);
        else
            zfp_stream_set_reversible(stream);
    }
    ~ZfpFrame() {
        zfp_field_free(field);
        zfp_stream_close(stream);
    }
    ZfpFrame(const ZfpFrame&) = delete;
    ZfpFrame& operator=(const ZfpFrame&) = delete;
    std::size_t run(std::byte* buffer, std::size_t size, bool encodes) {
        bitstream* bits = stream_open(buffer, size);
        zfp_stream_set_bit_stream(stream, bits);
        zfp_stream_rewind(stream);
        const std::size_t done = encodes ? zfp_compress(stream, field) : zfp_decompress(stream, field);
        stream_close(bits);
        return done;
    }
};

std::vector<std::int32_t> asInt32(const Samples& in, std::size_t frame) {
    std::vector<std::int32_t> values(in.frameBytes() / in.sampleBytes());
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, in.bytes.data() + frame * in.frameBytes() + i * in.sampleBytes(), in.sampleBytes());
        values[i] = static_cast<std::int32_t>(bits);
    }
    return values;
}

PeerCodec zfpCodec(double bound) {
    return {bound > 0 ? "zfp accuracy" : "zfp reversible",
            [bound](const Samples& in) {
                Bytes out;
                const bool isFloat = in.type == volume::ScalarType::F32;
                for (std::size_t f = 0; f < in.frames(); ++f) {
                    std::vector<std::int32_t> values = asInt32(in, f); // floats: their bits
                    ZfpFrame frame(values.data(), in.size, isFloat, bound);
                    const std::size_t head = out.size() + sizeof(std::uint64_t);
                    out.resize(head + zfp_stream_maximum_size(frame.stream, frame.field));
                    const std::uint64_t length = frame.run(out.data() + head, out.size() - head, true);
                    std::memcpy(out.data() + head - sizeof length, &length, sizeof length);
                    out.resize(head + length);
                }
                return out;
            },
            [bound](std::span<const std::byte> coded, const Samples& like, std::span<std::byte> out) {
                const bool isFloat = like.type == volume::ScalarType::F32;
                std::vector<std::int32_t> values(like.frameBytes() / like.sampleBytes());
                for (; !out.empty(); out = out.subspan(like.frameBytes())) {
                    std::uint64_t length = 0;
                    std::memcpy(&length, coded.data(), sizeof length);
                    Bytes copy(coded.begin() + sizeof length, coded.begin() + std::ptrdiff_t(sizeof length + length));
                    ZfpFrame frame(isFloat ? static_cast<void*>(out.data()) : values.data(), like.size, isFloat, bound);
                    if (frame.run(copy.data(), copy.size(), false) == 0) return false;
                    for (std::size_t i = 0; !isFloat && i < values.size(); ++i)
                        std::memcpy(out.data() + i * like.sampleBytes(), &values[i], like.sampleBytes());
                    coded = coded.subspan(sizeof length + length);
                }
                return true;
            },
            bound == 0};
}
#endif

} // namespace

std::vector<PeerCodec> arrayCodecs() {
    std::vector<PeerCodec> codecs;
#if PEER_OPENJPEG
    codecs.push_back(jpeg2000());
#endif
#if PEER_JXL
    codecs.push_back(slicesCodec("JPEG XL of slices", encodeJxl, decodeJxl));
#endif
#if PEER_FPZIP
    codecs.push_back(fpzipCodec());
#endif
#if PEER_ZFP
    codecs.push_back(zfpCodec(0));
#endif
    return codecs;
}

std::vector<PeerCodec> boundedCodecs(double bound) {
    std::vector<PeerCodec> codecs;
#if PEER_ZFP
    codecs.push_back(zfpCodec(bound));
#endif
    (void)bound;
    return codecs;
}

} // namespace tessera::bench
