// Archives changed behind right checksums: they are read, drawn by the processor and by the reference, unpacked and
// packed again.
#include "codec/unpack/stored_dataset.h"
#include "codec/unpack/unpack.h"
#include "tests/fuzz/changed_archive.h"
#include "tests/reference/raycast.h"
#include "vis/processor/processor_renderer.h"
#include "volume/export/export.h"

#include <memory>

using namespace tessera;
using changed_archives::TemporaryFolder;

namespace {

/// Only Error may come of it.
template <class Call> void attempt(const Call& call) {
    try {
        call();
    } catch (const Error&) {
    }
}

void draw(const std::shared_ptr<const volume::BrickSource>& source) {
    vis::Scene scene;
    vis::RendererOptions options;
    options.memoryBudget = std::size_t(256) << 20;
    const volume::DatasetInfo& info = source->info();
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t kind = 0; kind < 4; ++kind) {
        const volume::Channel& channel = channels[kind % channels.size()];
        const Range range = info.channelRange(channel);
        vis::Technique technique = vis::VolumeLayer{.channel = channel.name};
        if (kind == 1) technique = vis::IsoLayer{.channel = channel.name, .value = (range.lo + range.hi) / 2};
        if (kind == 2) technique = vis::SliceLayer{.channel = channel.name};
        if (kind == 3) technique = vis::VolumeLayer{.channel = channel.name, .style = vis::RayStyle::Average};
        scene.layers = {{"", true, technique}};
        attempt([&] {
            vis::ProcessorRenderer renderer(options);
            renderer.setSource(source);
            vis::ProcessorPicture picture;
            renderer.draw(picture, scene, {33, 21});
            (void)renderer.pick(picture, {16, 10});
        });
        if (kind == 0) attempt([&] { (void)vis::reference::render(scene, *source, {5, 4}); });
        scene.camera.distance = 0.2f;
    }
}

void use(const std::string& path, const TemporaryFolder& folder) {
    std::shared_ptr<const codec::Archive> archive;
    attempt([&] { archive = std::make_shared<const codec::Archive>(path); });
    if (!archive) return;
    attempt([&] { (void)codec::verifyArchive(*archive); });
    // Few bytes may state many samples, all alike: what they take is asked for before, and not tried here.
    constexpr std::size_t kMost = 1 << 19;
    if (archive->metadata().source.count() * archive->info().channels().size() > kMost ||
        archive->info().times.size() > 20 || archive->metadata().sourceTimes.size() > 20)
        return;
    attempt([&] {
        volume::Dataset grid = codec::gridDataset(archive, 0);
        volume::exportDataset(grid, {}, folder / "out.raw");
    });
    attempt([&] {
        volume::Dataset stored = codec::storedDataset(archive);
        codec::pack(stored, archive->metadata().options, folder / "again.tsr");
    });
    attempt([&] { draw(archive); });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const TemporaryFolder folder;
    codec::testing::writeFile(folder / "changed.tsr", changed_archives::archiveOf(data, size));
    use(folder / "changed.tsr", folder);
    return 0;
}
