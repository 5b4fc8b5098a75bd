#include "tests/bench/peer_codecs.h"

#include <cstring>
#include <zstd.h>
#if PEER_LZ4
#include <lz4.h>
#endif
#if PEER_XZ
#include <lzma.h>
#endif
#if PEER_BLOSC
#include <blosc.h>
#endif
#if PEER_HDF5
#include <hdf5.h>
#endif

namespace tessera::bench {

namespace {

PeerCodec zstdCodec(int level) {
    return {"zstd -" + std::to_string(level),
            [level](const Samples& in) {
                Bytes out(ZSTD_compressBound(in.bytes.size()));
                out.resize(ZSTD_compress(out.data(), out.size(), in.bytes.data(), in.bytes.size(), level));
                return out;
            },
            [](std::span<const std::byte> coded, const Samples&, std::span<std::byte> out) {
                return ZSTD_decompress(out.data(), out.size(), coded.data(), coded.size()) == out.size();
            }};
}

#if PEER_LZ4
PeerCodec lz4Codec() {
    return {"lz4",
            [](const Samples& in) {
                Bytes out(std::size_t(LZ4_compressBound(int(in.bytes.size()))));
                out.resize(std::size_t(LZ4_compress_default(reinterpret_cast<const char*>(in.bytes.data()),
                                                            reinterpret_cast<char*>(out.data()), int(in.bytes.size()),
                                                            int(out.size()))));
                return out;
            },
            [](std::span<const std::byte> coded, const Samples&, std::span<std::byte> out) {
                return LZ4_decompress_safe(reinterpret_cast<const char*>(coded.data()),
                                           reinterpret_cast<char*>(out.data()), int(coded.size()),
                                           int(out.size())) == int(out.size());
            }};
}
#endif

#if PEER_XZ
PeerCodec xzCodec() {
    const auto data = [](const std::byte* bytes) { return reinterpret_cast<const std::uint8_t*>(bytes); };
    return {"xz -6",
            [data](const Samples& in) {
                Bytes out(lzma_stream_buffer_bound(in.bytes.size()));
                std::size_t size = 0;
                if (lzma_easy_buffer_encode(6, LZMA_CHECK_NONE, nullptr, data(in.bytes.data()), in.bytes.size(),
                                            reinterpret_cast<std::uint8_t*>(out.data()), &size, out.size()) != LZMA_OK)
                    size = 0;
                out.resize(size);
                return out;
            },
            [data](std::span<const std::byte> coded, const Samples&, std::span<std::byte> out) {
                std::uint64_t memory = UINT64_MAX;
                std::size_t read = 0, written = 0;
                return lzma_stream_buffer_decode(&memory, 0, nullptr, data(coded.data()), &read, coded.size(),
                                                 reinterpret_cast<std::uint8_t*>(out.data()), &written,
                                                 out.size()) == LZMA_OK &&
                       written == out.size();
            }};
}
#endif

#if PEER_BLOSC
PeerCodec bloscCodec(int shuffle, const char* name) {
    return {name,
            [shuffle](const Samples& in) {
                Bytes out(in.bytes.size() + BLOSC_MAX_OVERHEAD);
                const int size = blosc_compress_ctx(5, shuffle, in.sampleBytes(), in.bytes.size(), in.bytes.data(),
                                                    out.data(), out.size(), "zstd", 0, 1);
                out.resize(std::size_t(std::max(size, 0)));
                return out;
            },
            [](std::span<const std::byte> coded, const Samples&, std::span<std::byte> out) {
                return blosc_decompress_ctx(coded.data(), out.data(), out.size(), 1) == int(out.size());
            }};
}
#endif

#if PEER_HDF5
hid_t typeOf(volume::ScalarType type) {
    switch (type) {
    case volume::ScalarType::U8:
        return H5T_NATIVE_UINT8;
    case volume::ScalarType::I16:
        return H5T_NATIVE_INT16;
    case volume::ScalarType::U16:
        return H5T_NATIVE_UINT16;
    case volume::ScalarType::I32:
        return H5T_NATIVE_INT32;
    case volume::ScalarType::F32:
        break;
    }
    return H5T_NATIVE_FLOAT;
}

/// Files in memory, chunks of 64^3, as a simulation would write them.
PeerCodec hdf5Codec() {
    const auto driver = [] {
        const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
        H5Pset_fapl_core(access, 1 << 20, false);
        return access;
    };
    return {"HDF5 shuffle, gzip 6",
            [driver](const Samples& in) {
                const hsize_t whole[] = {in.frames(), hsize_t(in.size.z), hsize_t(in.size.y), hsize_t(in.size.x)};
                hsize_t chunk[] = {1, 64, 64, 64};
                for (int a = 1; a < 4; ++a) chunk[a] = std::min(chunk[a], whole[a]);
                const hid_t access = driver(), shape = H5Pcreate(H5P_DATASET_CREATE);
                H5Pset_chunk(shape, 4, chunk);
                H5Pset_shuffle(shape);
                H5Pset_deflate(shape, 6);
                const hid_t file = H5Fcreate("peer", H5F_ACC_TRUNC, H5P_DEFAULT, access);
                const hid_t space = H5Screate_simple(4, whole, nullptr);
                const hid_t set = H5Dcreate2(file, "v", typeOf(in.type), space, H5P_DEFAULT, shape, H5P_DEFAULT);
                H5Dwrite(set, typeOf(in.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, in.bytes.data());
                H5Dclose(set);
                H5Sclose(space);
                H5Fflush(file, H5F_SCOPE_GLOBAL);
                Bytes out(std::size_t(std::max<ssize_t>(H5Fget_file_image(file, nullptr, 0), 0)));
                H5Fget_file_image(file, out.data(), out.size());
                H5Fclose(file);
                H5Pclose(shape);
                H5Pclose(access);
                return out;
            },
            [driver](std::span<const std::byte> coded, const Samples& like, std::span<std::byte> out) {
                const hid_t access = driver();
                H5Pset_file_image(access, const_cast<std::byte*>(coded.data()), coded.size());
                const hid_t file = H5Fopen("peer", H5F_ACC_RDONLY, access), set = H5Dopen2(file, "v", H5P_DEFAULT);
                const bool read = H5Dread(set, typeOf(like.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) >= 0;
                H5Dclose(set);
                H5Fclose(file);
                H5Pclose(access);
                return read;
            }};
}
#endif

} // namespace

std::vector<PeerCodec> byteCodecs() {
    std::vector<PeerCodec> codecs{zstdCodec(3), zstdCodec(19)};
#if PEER_LZ4
    codecs.push_back(lz4Codec());
#endif
#if PEER_XZ
    codecs.push_back(xzCodec());
#endif
#if PEER_BLOSC
    codecs.push_back(bloscCodec(BLOSC_SHUFFLE, "blosc zstd, shuffle"));
    codecs.push_back(bloscCodec(BLOSC_BITSHUFFLE, "blosc zstd, bit shuffle"));
#endif
#if PEER_HDF5
    codecs.push_back(hdf5Codec());
#endif
    return codecs;
}

std::vector<std::string> absentCodecs() {
    std::vector<std::string> names;
#if !PEER_LZ4
    names.push_back("lz4");
#endif
#if !PEER_XZ
    names.push_back("xz");
#endif
#if !PEER_BLOSC
    names.push_back("blosc");
#endif
#if !PEER_HDF5
    names.push_back("HDF5");
#endif
#if !PEER_OPENJPEG
    names.push_back("OpenJPEG");
#endif
#if !PEER_JXL
    names.push_back("JPEG XL");
#endif
#if !PEER_FPZIP
    names.push_back("fpzip");
#endif
#if !PEER_ZFP
    names.push_back("zfp");
#endif
    return names;
}

} // namespace tessera::bench
