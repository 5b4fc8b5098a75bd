// Measures archives beside other coders for `tessera bench codec`: in one process, on one thread, the same bytes, one
// right after the other.
//
// usage: tessera-codec-peers FOLDER       of volumes with sidecars
// Prints one line a coder, cells apart by tabs: data, coder, ratio, encode and decode MB of samples per CPU second,
// decode relative to zstd -3 on the same samples, largest error relative to the range. First a line "absent" with the
// names of coders that were not installed when this was built.
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/bench/peer_codecs.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <tbb/global_control.h>
#include <unistd.h>

namespace tessera::bench {

namespace {

namespace fs = std::filesystem;

double cpuSeconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// The least of several runs, as long as those do not take too long.
template <class Body> double best(Body&& body) {
    constexpr double kEnough = 0.25;
    constexpr int kMost = 15;
    double least = 1e300, all = 0;
    for (int run = 0; run < kMost && (run == 0 || all < kEnough); ++run) {
        const double start = cpuSeconds();
        body();
        const double took = cpuSeconds() - start;
        least = std::min(least, took), all += took;
    }
    return std::max(least, 1e-7);
}

/// A data set with all its frames in memory, time by time.
struct Loaded {
    volume::Dataset dataset;
    std::vector<volume::Field> fields;
    Bytes bytes;
    Samples samples;
};

Loaded load(const fs::path& sidecar) {
    Loaded loaded{volume::openFiles({sidecar.string()}, {}), {}, {}, {}};
    const volume::DatasetInfo& info = loaded.dataset.info;
    for (int t = 0; t < int(info.times.size()); ++t)
        for (int p = 0; p < int(info.parameters.size()); ++p)
            for (int c = 0; c < info.parameters[std::size_t(p)].components; ++c)
                loaded.fields.push_back(loaded.dataset.read(p, c, t));
    for (const volume::Field& field : loaded.fields)
        loaded.bytes.insert(loaded.bytes.end(), field.samples.begin(), field.samples.end());
    loaded.samples = {loaded.bytes, info.lattice.size, loaded.fields[0].type};
    // From here on loading is a copy.
    std::size_t components = 0;
    std::vector<std::size_t> first;
    for (const volume::Parameter& parameter : info.parameters) {
        first.push_back(components);
        components += std::size_t(parameter.components);
    }
    const auto shared = std::make_shared<const std::vector<volume::Field>>(loaded.fields);
    loaded.dataset.read = [shared, components, first](int p, int c, int t) {
        return (*shared)[std::size_t(t) * components + first[std::size_t(p)] + std::size_t(c)];
    };
    return loaded;
}

double largestError(std::span<const std::byte> one, std::span<const std::byte> other) {
    double largest = 0;
    for (std::size_t i = 0; i + sizeof(float) <= one.size(); i += sizeof(float)) {
        float a = 0, b = 0;
        std::memcpy(&a, one.data() + i, sizeof a);
        std::memcpy(&b, other.data() + i, sizeof b);
        largest = std::max(largest, std::abs(double(a) - double(b)));
    }
    return largest;
}

class Table {
public:
    explicit Table(const Loaded& loaded, std::string name) : loaded_(loaded), name_(std::move(name)) {}

    void row(const std::string& codec, std::size_t size, double encode, double decode, double error) {
        const double mb = double(loaded_.bytes.size()) / 1e6;
        if (codec == "zstd -3") zstd_ = decode;
        std::printf("%s\t%s\t%.3f\t%.1f\t%.0f\t%.2f\t%.1e\n", name_.c_str(), codec.c_str(), mb * 1e6 / double(size),
                    mb / encode, mb / decode, zstd_ > 0 ? zstd_ / decode : 0.0, error);
        std::fflush(stdout);
    }

    void peer(const PeerCodec& codec, double range) {
        Bytes coded, out(loaded_.bytes.size());
        const double encode = best([&] { coded = codec.encode(loaded_.samples); });
        if (coded.empty()) return;
        bool whole = true;
        const double decode = best([&] { whole = codec.decode(coded, loaded_.samples, out) && whole; });
        if (!whole || (codec.exact && out != loaded_.bytes)) {
            std::fprintf(stderr, "%s: %s does not give back its samples\n", name_.c_str(), codec.name.c_str());
            return;
        }
        row(codec.name, coded.size(), encode, decode, codec.exact ? 0 : largestError(loaded_.bytes, out) / range);
    }

    void archive(int effort, double maxError, double range) {
        const std::string path =
            (fs::temp_directory_path() / ("tessera-peers-" + std::to_string(::getpid()) + ".tsr")).string();
        codec::PackOptions options;
        options.lattice = codec::StoredLattice::CC;
        options.effort = effort;
        options.maxError = maxError;
        codec::PackSummary summary;
        const double encode = best([&] {
            volume::Dataset dataset = loaded_.dataset;
            summary = codec::pack(dataset, options, path);
        });
        const codec::Archive archive(path);
        const volume::DatasetInfo& info = archive.info();
        std::vector<volume::Field> fields;
        const double decode = best([&] {
            fields.clear();
            for (int t = 0; t < int(info.times.size()); ++t)
                for (int p = 0; p < int(info.parameters.size()); ++p)
                    for (int c = 0; c < info.parameters[std::size_t(p)].components; ++c)
                        fields.push_back(codec::readField(archive, p, c, t));
        });
        Bytes out;
        for (const volume::Field& field : fields) out.insert(out.end(), field.samples.begin(), field.samples.end());
        std::remove(path.c_str());
        if (maxError == 0 && out != loaded_.bytes)
            std::fprintf(stderr, "%s: the archive does not give back its samples\n", name_.c_str());
        const std::string name =
            effort == codec::PackOptions().effort ? "tessera" : "tessera --effort " + std::to_string(effort);
        row(name, summary.archiveBytes, encode, decode, maxError == 0 ? 0 : largestError(loaded_.bytes, out) / range);
    }

private:
    const Loaded& loaded_;
    std::string name_;
    double zstd_ = 0;
};

void measure(const fs::path& sidecar) {
    const Loaded loaded = load(sidecar);
    const std::string name = sidecar.stem().string();
    Table lossless(loaded, name);
    const auto codecs = byteCodecs();
    lossless.peer(codecs[0], 1);
    for (const int effort : {5, 1, 7, 9}) lossless.archive(effort, 0, 1);
    for (std::size_t i = 1; i < codecs.size(); ++i) lossless.peer(codecs[i], 1);
    for (const PeerCodec& codec : arrayCodecs()) lossless.peer(codec, 1);
    const auto& parameters = loaded.dataset.info.parameters;
    if (loaded.samples.type != volume::ScalarType::F32 || parameters.size() > 1 || parameters[0].components > 1) return;
    float lo = INFINITY, hi = -INFINITY;
    for (const volume::Field& field : loaded.fields)
        for (const float value : field.as<float>()) lo = std::min(lo, value), hi = std::max(hi, value);
    const double range = double(hi) - double(lo);
    for (const double bound : {1e-3, 1e-4}) {
        char text[32];
        std::snprintf(text, sizeof text, ", error <= %g", bound);
        Table bounded(loaded, name + text);
        bounded.archive(codec::PackOptions().effort, bound, range);
        for (const PeerCodec& codec : boundedCodecs(bound * range)) bounded.peer(codec, range);
    }
}

} // namespace

} // namespace tessera::bench

int main(int argc, char** argv) {
    using namespace tessera;
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    std::printf("absent");
    for (const std::string& name : bench::absentCodecs()) std::printf("\t%s", name.c_str());
    std::printf("\n");
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<std::filesystem::path> sidecars;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1], missing))
        if (entry.path().extension() == ".json") sidecars.push_back(entry.path());
    std::sort(sidecars.begin(), sidecars.end());
    for (const auto& sidecar : sidecars) bench::measure(sidecar);
    return 0;
}
